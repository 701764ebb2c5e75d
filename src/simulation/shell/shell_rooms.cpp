// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/polygons.hpp"
#include "simulation/shell/openings.hpp"
#include "simulation/shell/shell_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kSkirtingDepth = 0.012;

struct Hole {
  double from = 0.0;
  double to = 0.0;
  double height = 0.0;
  double frameWidth = 0.0;
};

Eigen::Vector3d lifted(const Eigen::Vector2d& point, double z) {
  return {point.x(), point.y(), z};
}

/// Holes of an edge from its first corner on.
std::vector<Hole> holesIn(const Building& building, const Level& level, std::size_t edge, const HouseLook& look) {
  std::vector<Hole> holes;
  if (!level.isModelled) return holes;
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const Door& door = building.doors[i];
    for (const int side : {0, 1}) {
      const int room = door.rooms[static_cast<std::size_t>(side)];
      if (room == kOutside || building.rooms[static_cast<std::size_t>(room)].id != level.room.id) continue;
      const auto opening = openingIn(level.room.outline, door, side);
      if (!opening || opening->edge != edge) continue;
      const double frameWidth = hasFrame(building, door) ? look.door(i).frameWidth : 0.0;
      holes.push_back({opening->from, opening->to, std::min(door.height, level.ceilingHeight), frameWidth});
    }
  }
  std::ranges::sort(holes, {}, &Hole::from);
  return holes;
}

/// Where stairs leave no floor along an edge: nothing for a skirting to stand on.
std::vector<std::array<double, 2>> floorGaps(const Level& level, const Edge& edge) {
  constexpr double kNear = 0.3;
  std::vector<std::array<double, 2>> gaps;
  for (const auto& hole : level.floorHoles) {
    double from = edge.length();
    double to = 0.0;
    for (const auto& corner : hole) {
      if (std::abs((corner - edge.from).dot(edge.outward())) > kNear) continue;
      const double along = (corner - edge.from).dot(edge.direction());
      from = std::min(from, along);
      to = std::max(to, along);
    }
    if (from < to) gaps.push_back({from, to});
  }
  return gaps;
}

/// The face of a wall along an edge of a room's outline, seen from inside.
class WallFace {
 public:
  WallFace(const Edge& edge, double floorHeight) : edge_(edge), floorHeight_(floorHeight) {}

  /// From one place along the edge to another, from one height above the floor to another, and standing out.
  void add(Surface& surface, std::array<double, 2> along, std::array<double, 2> heights, double out = 0.0) const {
    if (along[1] <= along[0] || heights[1] <= heights[0]) return;
    const Eigen::Vector2d span = (along[1] - along[0]) * edge_.direction();
    addRectangle(surface, at(along[1], heights[0], out), lifted(-span, 0.0), {0.0, 0.0, heights[1] - heights[0]});
  }

  void addSkirting(Surface& surface, double from, double to, double height) const {
    if (to <= from) return;
    add(surface, {from, to}, {0.0, height}, kSkirtingDepth);
    const Eigen::Vector3d back = lifted(edge_.outward() * kSkirtingDepth, 0.0);
    const Eigen::Vector3d span = lifted((to - from) * edge_.direction(), 0.0);
    const Eigen::Vector3d up(0.0, 0.0, height);
    addRectangle(surface, at(to, height, kSkirtingDepth), -span, back);
    addRectangle(surface, at(from, 0.0, kSkirtingDepth), back, up);
    addRectangle(surface, at(to, 0.0, 0.0), -back, up);
  }

 private:
  Eigen::Vector3d at(double along, double height, double out) const {
    return lifted(edge_.from + along * edge_.direction() - out * edge_.outward(), floorHeight_ + height);
  }

  Edge edge_;
  double floorHeight_;
};

void addTriangles(Surface& surface, const std::vector<std::array<Eigen::Vector2d, 3>>& triangles, double z,
                  bool facesUp) {
  for (const auto& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (const auto& corner : triangle) {
      surface.vertices.push_back(lifted(corner, z).cast<float>());
      surface.textureCoordinates.push_back(corner.cast<float>());
    }
    surface.triangles.push_back({first, first + (facesUp ? 1U : 2U), first + (facesUp ? 2U : 1U)});
  }
}

/// Between a ceiling and the floor above it, around a hole in both.
void addSlabEdge(const Polygon& hole, double bottom, double top, Surface& surface) {
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const Edge edge = edgeOf(hole, i);
    WallFace(edge, bottom).add(surface, {0.0, edge.length()}, {0.0, top - bottom});
  }
}

void addWalls(const Building& building, const Level& level, const HouseLook& look, std::vector<Surface>& surfaces) {
  Surface upper{.material = look.wall(level.room), .classId = classId("wall")};
  Surface lower = upper;
  const auto dado = look.dado(level.room);
  if (dado) lower.material = *dado;
  Surface skirting{.material = look.skirting(), .classId = classId("skirting")};
  const double split = dado ? look.dadoHeight() : 0.0;
  for (std::size_t i = 0; i < level.room.outline.size(); ++i) {
    const Edge edge = edgeOf(level.room.outline, i);
    const WallFace face(edge, level.floorHeight);
    const auto addPiece = [&](double from, double to, double bottom) {
      face.add(lower, {from, to}, {bottom, split});
      face.add(upper, {from, to}, {std::max(bottom, split), level.ceilingHeight});
    };
    double from = 0.0;
    auto gaps = floorGaps(level, edge);
    for (const Hole& hole : holesIn(building, level, i, look)) {
      addPiece(from, hole.from, 0.0);
      addPiece(hole.from, hole.to, hole.height);
      gaps.push_back({hole.from - hole.frameWidth, hole.to + hole.frameWidth});
      from = hole.to;
    }
    addPiece(from, edge.length(), 0.0);
    std::ranges::sort(gaps);
    from = 0.0;
    for (const auto& gap : gaps) {
      face.addSkirting(skirting, from, gap[0], look.skirtingHeight());
      from = std::max(from, gap[1]);
    }
    face.addSkirting(skirting, from, edge.length(), look.skirtingHeight());
  }
  surfaces.insert(surfaces.end(), {std::move(upper), std::move(lower), std::move(skirting)});
}

/// The hole that flights to and from a storey leave in its floor.
std::vector<Polygon> stairHoles(const Building& building, int upperStorey) {
  std::vector<Polygon> footprints;
  for (const auto& stairs : building.stairs) {
    if (stairs.upperStorey == upperStorey) footprints.push_back(footprintOf(stairs));
  }
  for (const auto& landing : building.landings) {
    if (landing.lowerStorey + 1 == upperStorey) footprints.push_back(landing.outline);
  }
  return united(footprints);
}

Eigen::Vector2d middleOf(const Polygon& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& corner : polygon) sum += corner;
  return sum / static_cast<double>(polygon.size());
}

std::vector<Polygon> within(const Polygon& outline, const std::vector<Polygon>& holes) {
  std::vector<Polygon> inside;
  std::ranges::copy_if(holes, std::back_inserter(inside),
                       [&](const Polygon& hole) { return contains(outline, middleOf(hole)); });
  return inside;
}

/// Of a storey that is not modelled: where flights up to it end.
double floorOf(const Building& building, int storey) {
  if (std::cmp_less(storey, building.storeys.size())) return building.storeys[static_cast<std::size_t>(storey)].floor_z;
  double highest = 0.0;
  for (const auto& stairs : building.stairs) {
    if (stairs.upperStorey == storey) highest = std::max(highest, headOf(stairs).z());
  }
  return highest;
}

}  // namespace

std::vector<Level> levelsOf(const Building& building) {
  std::vector<Level> levels;
  const int top = static_cast<int>(building.storeys.size());
  for (const auto& room : building.rooms) {
    const auto& storey = building.storeys[static_cast<std::size_t>(room.storey)];
    levels.push_back({.room = room, .floorHeight = storey.floor_z, .ceilingHeight = storey.ceilingHeight});
  }
  for (const auto& stairs : building.stairs) {
    if (stairs.upperStorey < top || stairs.rooms[0] == kOutside) continue;
    Level above = levels[static_cast<std::size_t>(stairs.rooms[0])];
    above.room.storey = stairs.upperStorey;
    above.room.id += "'";
    above.floorHeight = floorOf(building, stairs.upperStorey);
    above.isModelled = false;
    const auto isSame = [&](const Level& level) { return level.room.id == above.room.id; };
    if (std::ranges::none_of(levels, isSame)) levels.push_back(std::move(above));
  }
  for (auto& level : levels) {
    level.floorHoles = within(level.room.outline, stairHoles(building, level.room.storey));
    level.ceilingHoles = within(level.room.outline, stairHoles(building, level.room.storey + 1));
  }
  return levels;
}

void addRoom(const Building& building, const Level& level, const HouseLook& look, std::vector<Surface>& surfaces) {
  Surface floor{.material = look.floor(level.room), .classId = classId("floor")};
  addTriangles(floor, triangulate(level.room.outline, level.floorHoles), level.floorHeight, true);
  Surface ceiling{.material = look.ceiling(), .classId = classId("ceiling")};
  const double ceilingLevel = level.floorHeight + level.ceilingHeight;
  addTriangles(ceiling, triangulate(level.room.outline, level.ceilingHoles), ceilingLevel, false);
  surfaces.insert(surfaces.end(), {std::move(floor), std::move(ceiling)});
  addWalls(building, level, look, surfaces);

  Surface slab{.material = look.wall(level.room), .classId = classId("wall")};
  for (const auto& hole : level.ceilingHoles) {
    addSlabEdge(hole, ceilingLevel, floorOf(building, level.room.storey + 1), slab);
  }
  if (!slab.triangles.empty()) surfaces.push_back(std::move(slab));
}

}  // namespace prodomos::simulation
