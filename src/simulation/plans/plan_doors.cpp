// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plans/plan_doors.hpp"

#include "prodomos/base/random.hpp"

#include "simulation/plans/shared_walls.hpp"
#include "simulation/shell/openings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kThinnestWall = 0.05;
constexpr double kThickestWall = 1.0;  // Outlines of neighbours are drawn up to 0.6 m apart.
constexpr double kFarthestMove = 1.5;  // From a portal to its door.
constexpr double kLeastDoubleWidth = 1.2;

/// What a door should be like, before the walls have their say.
struct Wish {
  int leaves = 1;
  double width = 0.9;
  double height = 2.05;
  bool fillsWall = false;  ///< a passage: as wide as may be
};

bool isOneOf(std::string_view label, std::initializer_list<std::string_view> labels) {
  return std::ranges::find(labels, label) != labels.end();
}

bool isForMany(std::string_view label) {
  return isOneOf(label, {"GYM", "CANTEEN", "CAFETERIA", "CONFERENCE HALL", "HALL", "LOBBY", "ENTRANCE", "LIBRARY",
                         "CONVENIENCE STORE"});
}

bool isSmall(std::string_view label) {
  return isOneOf(label, {"CLOSET", "BATHROOM", "WASHROOM"});
}

class DoorPlacer {
 public:
  DoorPlacer(const PlanDrawing& drawing, const std::vector<std::optional<int>>& roomOfSpace, std::uint64_t seed,
             Building& building)
      : drawing_(drawing), roomOfSpace_(roomOfSpace), random_(seed, "doors of a plan"), building_(building) {}

  void place() {
    leafHeight_ = random_.uniform(2.0, 2.1);
    lintelHeight_ = random_.uniform(2.2, 2.45);
    std::vector<Wish> wishes;
    for (const auto& portal : drawing_.portals) wishes.push_back(wishFor(portal));
    // Doors first: passages take what is left of a wall.
    for (const bool passages : {false, true}) {
      for (std::size_t i = 0; i < wishes.size(); ++i) {
        if (wishes[i].fillsWall == passages) placeOne(drawing_.portals[i], wishes[i]);
      }
    }
  }

 private:
  const std::string& labelOf(const DrawnPortal& portal, std::size_t side) const {
    return drawing_.spaces[portal.spaces[side]].label;
  }

  template <typename Predicate>
  bool either(const DrawnPortal& portal, Predicate holds) const {
    return holds(labelOf(portal, 0)) || holds(labelOf(portal, 1));
  }

  /// Draws as many random numbers for every portal, so that the kind of one has no influence on the others.
  Wish wishFor(const DrawnPortal& portal) {
    const double chance = random_.uniform();
    const double doorwayChance = random_.uniform();
    const double narrow = random_.uniform(0.8, 0.85);
    const double single = random_.uniform(0.88, 1.0);
    const double wide = random_.uniform(1.4, 1.8);
    const bool joinsCorridors = labelOf(portal, 0) == "CORRIDOR" && labelOf(portal, 1) == "CORRIDOR";
    if (portal.isOpen || (joinsCorridors && !portal.isDouble)) {
      const double ceiling = building_.storeys.front().ceilingHeight;
      return {.leaves = 0, .height = chance < 0.5 ? ceiling : lintelHeight_, .fillsWall = true};
    }
    const auto isFor = [](RoomUse use) { return [use](const std::string& label) { return useOfLabel(label) == use; }; };
    if (either(portal, isFor(RoomUse::kLift))) return {.leaves = 2, .width = single, .height = leafHeight_};
    if (portal.isDouble.value_or(either(portal, isForMany) && chance < 0.6)) {
      return {.leaves = 2, .width = wide, .height = leafHeight_};
    }
    const double shareOfDoorways = either(portal, isFor(RoomUse::kStairs)) ? 0.25 : 0.04;
    return {.leaves = doorwayChance < shareOfDoorways ? 0 : 1,
            .width = either(portal, isSmall) ? narrow : single,
            .height = leafHeight_};
  }

  void remark(const DrawnPortal& portal, const std::string& why) {
    building_.remarks.push_back("portal " + portal.id + " between " + labelOf(portal, 0) + " and " +
                                labelOf(portal, 1) + " is left out: " + why);
  }

  void placeOne(const DrawnPortal& portal, const Wish& wish) {
    const auto first = roomOfSpace_[portal.spaces[0]];
    const auto second = roomOfSpace_[portal.spaces[1]];
    if (!first || !second) return remark(portal, "so was its room");
    const std::array rooms{*first, *second};
    if (wish.fillsWall && liesInPassage(portal.position, rooms)) return;
    std::optional<Door> best;
    double leastCost = std::numeric_limits<double>::infinity();
    for (const auto& wall : sharedWalls(building_, rooms, portal.position)) {
      for (const auto& part : wall.free) {
        Door door{.storey = 0, .rooms = rooms, .height = wish.height, .leaves = wish.leaves};
        const double moved = fit(door, wall, part, wish);
        // A door that must be narrower is worse than one that moves a little.
        constexpr double kCostOfNarrowing = 2.0;
        const double cost = moved + (wish.fillsWall ? 0.0 : kCostOfNarrowing * (wish.width - door.width));
        if (moved > kFarthestMove || cost >= leastCost || !isSound(door, wall)) continue;
        leastCost = cost;
        best = std::move(door);
      }
    }
    if (!best) return remark(portal, "no wall between its rooms within 1.5 m has space for it");
    building_.doors.push_back(std::move(*best));
  }

  /// Several portals of an open boundary stand for one passage.
  bool liesInPassage(const Eigen::Vector2d& position, const std::array<int, 2>& rooms) const {
    constexpr double kReach = 0.5;
    return std::ranges::any_of(building_.doors, [&](const Door& door) {
      const Eigen::Vector2d position_in_door = geometry::inverse(door.pose) * position;
      return door.leaves == 0 && door.rooms == rooms && std::abs(position_in_door.x()) < kReach &&
             std::abs(position_in_door.y()) < door.width / 2.0 + kReach;
    });
  }

  /// Places the door in that part of a wall as near to the portal as may be; returns how far it has moved, metres.
  double fit(Door& door, const SharedWall& wall, const Interval& part, const Wish& wish) const {
    door.width = wish.fillsWall ? part.length() : std::min(wish.width, part.length());
    if (door.leaves == 2 && door.width < kLeastDoubleWidth && wish.width >= kLeastDoubleWidth) {
      door.leaves = 1;
      door.width = std::min(door.width, 1.0);
    }
    const double centre = std::clamp(0.0, part.from + door.width / 2.0, part.to - door.width / 2.0);
    const double middle = (wall.faceAt(0, centre) + wall.faceAt(1, centre)) / 2.0;
    const Eigen::Vector2d position = wall.origin + centre * wall.along + middle * wall.normal();
    door.pose = {position.x(), position.y(), std::atan2(wall.normal().y(), wall.normal().x())};
    door.wallThickness = wall.thicknessAt(centre);
    // A passage is as near as its nearest end.
    const double along = wish.fillsWall ? std::max({part.from, -part.to, 0.0}) : centre;
    return std::hypot(along, middle);
  }

  /// Both jambs stand in a wall of sensible thickness, and no other room lies in the way.
  bool isSound(const Door& door, const SharedWall& wall) const {
    const Eigen::Vector2d position(door.pose.x, door.pose.y);
    const double centre = (position - wall.origin).dot(wall.along);
    for (const double share : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      const double at = centre + share * door.width;
      const double thickness = wall.thicknessAt(at);
      if (thickness < kThinnestWall || thickness > kThickestWall) return false;
      for (const double depth : {0.02, 0.5, 0.98}) {
        const double x = std::lerp(wall.faceAt(0, at), wall.faceAt(1, at), depth);
        if (roomAt(building_, 0, wall.origin + at * wall.along + x * wall.normal()) != kOutside) return false;
      }
    }
    return true;
  }

  const PlanDrawing& drawing_;
  const std::vector<std::optional<int>>& roomOfSpace_;
  base::Random random_;
  Building& building_;
  double leafHeight_ = 0.0;
  double lintelHeight_ = 0.0;
};

}  // namespace

void placeDoors(const PlanDrawing& drawing, const std::vector<std::optional<int>>& roomOfSpace, std::uint64_t seed,
                Building& building) {
  DoorPlacer(drawing, roomOfSpace, seed, building).place();
}

}  // namespace prodomos::simulation
