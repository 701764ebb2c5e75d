// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/random.hpp"

#include "simulation/scenes/scene_people.hpp"
#include "simulation/scenes/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

/// Furniture, people and light of scene files.

namespace prodomos::simulation {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace

void SceneReader::readThing(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "furniture");
  Thing thing;
  thing.storey = storey;
  map.require("kind", "what it is: desk, chair, poster");
  map.require("at", "a point [x, y]");
  thing.kind = map.text("kind").value_or("");
  map.rename("furniture '" + thing.kind + "'");
  thing.id = map.has("id") ? readId(map, "furniture") : thing.kind + "_" + std::to_string(building_.things.size() + 1);
  const auto* kind = findThingKind(thing.kind);
  if (kind == nullptr && map.has("kind")) {
    std::string known;
    for (const auto& each : thingKinds()) known += (known.empty() ? "" : ", ") + std::string(each.name);
    map.fault("kind", "one of " + known, "'" + thing.kind + "'");
  }
  const auto at = map.point("at");
  const auto size = map.numbers("size", 3);
  if (size && std::ranges::any_of(*size, [](double side) { return side < 0.005 || side > 10.0; })) {
    map.fault("size", "[depth, width, height], each of 0.005 to 10 m", shown(*map.find("size")));
  }
  if (kind != nullptr) thing.size = (kind->least + kind->most) / 2.0;
  if (size) thing.size = Eigen::Vector3d((*size)[0], (*size)[1], (*size)[2]);
  if (kind != nullptr && at) placeThing(map, *kind, *at, thing);
  map.finish();
  building_.things.push_back(std::move(thing));
}

/// What hangs is drawn to the nearest wall, unless its yaw is given.
void SceneReader::placeThing(YamlMap& map, const ThingKind& kind, const Eigen::Vector2d& at, Thing& thing) {
  constexpr double kReach = 0.5;  // metres
  const auto& storey = building_.storeys[static_cast<std::size_t>(thing.storey)];
  const double bottom = map.number("z", {0.0, storey.ceilingHeight}).value_or(kind.bottom);
  const auto given = map.number("yaw", {-360.0, 360.0});
  double yaw = given.value_or(0.0) * kDegree;
  Eigen::Vector2d middle = at;
  const int in = roomAt(building_, thing.storey, at);
  if (in == kOutside) {
    map.fault("at", "a point in a room", toText(at));
    return;
  }
  if (kind.hangs && !given) {
    double nearest = kReach;
    for (const auto& wall : wallsOf(room(in).outline)) {
      const double distance = distanceToSegment(at, wall.from, wall.to);
      if (distance >= nearest) continue;
      nearest = distance;
      middle = at + (thing.size.x() / 2.0 - wall.inward().dot(at - wall.from)) * wall.inward();
      yaw = std::atan2(wall.inward().y(), wall.inward().x());
    }
    if (nearest == kReach) map.fault("at", "a point within 0.5 m of a wall, or a yaw", toText(at));
  }
  thing.T_world_thing =
      geometry::toPose3({middle.x(), middle.y(), yaw}, storey.floor_z + bottom + thing.size.z() / 2.0);
  if (bottom + thing.size.z() > storey.ceilingHeight) {
    map.fault("z", "a thing below the ceiling", "one up to " + toText(bottom + thing.size.z()) + " m");
  }
  if (!isWithin(room(in).outline, placeOf(thing))) {
    map.fault("at", "a thing within the walls of '" + room(in).id + "'", "one that cuts them at " + toText(at));
  }
}

void SceneReader::readPersonOf(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "person");
  std::vector<Passage> passages;
  auto person = readPerson(map, building_, storey, passages);
  if (!person.id.empty() && !ids_.insert(person.id).second) {
    map.fault("id", "a name that nothing else has", "'" + person.id + "'");
  }
  if (!map.has("look")) person.look = base::Random(seed_, "scene person " + person.id).integer(0, 1 << 30);
  building_.people.push_back(std::move(person));
  for (const auto& passage : passages) {
    passed_.insert(passage.door);
    const auto& door = building_.doors[passage.door];
    const bool closed = stateGiven_[passage.door] && door.leaves > 0 &&
                        stateOf(openingAngle(door, passage.time)) != map::DoorState::kOpen;
    if (!closed) continue;
    map.fault("path", "an open door",
              "'" + door.id + "' not open at " + toText(std::round(passage.time * 10.0) / 10.0) + " s");
    break;
  }
}

/// Who sits, sits on something.
void SceneReader::seatPeople() {
  for (const auto& person : building_.people) {
    if (!person.sits) continue;
    const auto& seat = person.way.front().position;
    const auto isBelow = [&](const Thing& thing) {
      return thing.storey == person.storey && placeOf(thing).distanceTo(seat) < 0.2;
    };
    if (std::ranges::any_of(building_.things, isBelow)) continue;
    const auto* kind = findThingKind("chair");
    Thing chair{.id = person.id + "_chair", .kind = "chair", .storey = person.storey};
    chair.size = (kind->least + kind->most) / 2.0;
    const double level = building_.storeys[static_cast<std::size_t>(person.storey)].floor_z;
    chair.T_world_thing = geometry::toPose3({seat.x(), seat.y(), person.heading}, level + chair.size.z() / 2.0);
    building_.things.push_back(std::move(chair));
  }
}

/// A room is furnished by seed where the file puts nothing into it, or asks for it.
void SceneReader::markFurnished() {
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    auto& room = building_.rooms[i];
    const auto standsIn = [&](const Thing& thing) {
      return thing.storey == room.storey && contains(room.outline, placeOf(thing).middle);
    };
    room.furnished = furnish_[i] ? !*furnish_[i] : std::ranges::any_of(building_.things, standsIn);
  }
}

void SceneReader::readLighting(YamlMap& map) {
  const auto node = map.find("lighting");
  if (!node) return;
  YamlMap lighting(faults_, *node, "lighting");
  auto& light = building_.lighting;
  light.brightness = lighting.number("brightness", {0.05, 4.0}).value_or(light.brightness);
  light.ambient = lighting.number("ambient", {0.0, 1.0}).value_or(light.ambient);
  if (const auto tint = lighting.numbers("tint", 3)) {
    for (int i = 0; i < 3; ++i) light.tint[i] = static_cast<float>((*tint)[static_cast<std::size_t>(i)]);
    if (light.tint.minCoeff() < 0.0F || light.tint.maxCoeff() > 2.0F) {
      lighting.fault("tint", "three numbers of 0 to 2", shown(*lighting.find("tint")));
    }
  }
  lighting.finish();
  if (light.lamps.empty()) light.lamps = lampsOf(building_);
}

}  // namespace prodomos::simulation
