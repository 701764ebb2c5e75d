// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/simulation/furniture.hpp"

#include "simulation/furniture/furniture_shapes.hpp"

#include <algorithm>
#include <string>

namespace prodomos::simulation {

namespace {

const ThingShape& shapeOf(std::string_view kind) {
  for (const auto shapes : {seatShapes(), storageShapes(), wallShapes(), otherShapes()}) {
    const auto shape = std::ranges::find(shapes, kind, &ThingShape::kind);
    if (shape != shapes.end()) return *shape;
  }
  throw base::Error("there is no thing of the kind \"" + std::string(kind) + "\"");
}

/// Things of one kind in one room look alike: "ROOM/KIND_3".
std::string groupOf(const Thing& thing) {
  const auto room = thing.id.find('/');
  return (room == std::string::npos ? "" : thing.id.substr(0, room)) + "/" + thing.kind;
}

}  // namespace

std::vector<Surface> surfacesOf(const Building& building, std::size_t thing, std::uint64_t seed) {
  const auto& it = building.things[thing];
  const auto& shapeOfKind = shapeOf(it.kind);
  Shape shape(it, classId(findThingKind(it.kind)->className), thingInstance(building, thing));
  FurnitureLook look(seed, groupOf(it), it.id);
  shapeOfKind.build(shape, look);
  return shape.surfaces();
}

}  // namespace prodomos::simulation
