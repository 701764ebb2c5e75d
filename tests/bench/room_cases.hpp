// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/door_view.hpp"
#include "prodomos/simulation/floor_plan.hpp"
#include "prodomos/simulation/furniture.hpp"

#include "prediction/room_features.hpp"
#include "support/plan_doors.hpp"
#include "support/seen_world.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// Doors of floor plans from the side that was seen, with the truth about the other side: what a guess of rooms is
/// learned from and judged by (docs/rooms.md).
namespace prodomos::bench {

struct Plan {
  std::string name;
  simulation::Building building;
  simulation::Building furnished;

  Plan(const std::filesystem::path& folder, const std::string& file)
      : name(file), building(simulation::readFloorPlan(folder / file, {})), furnished(building) {
    simulation::furnish(furnished, 1);
  }
  bool isSchool() const { return name.starts_with("school"); }
};

/// How the robot came to know what it knows.
enum class Knowledge { kWholeRooms, kLaser };

struct RoomCase {
  const Plan* plan = nullptr;
  const simulation::Door* door = nullptr;
  const simulation::Room* room = nullptr;  ///< on the far side; null: none is modelled there
  Knowledge knowledge = Knowledge::kWholeRooms;
  geometry::Pose2 T_world_here;
  std::shared_ptr<const test::SeenWorld> world;
  prediction::Surroundings around;
  bool isClosed = true;           ///< the door; else one may look in
  bool isUnseen = false;          ///< nobody was in the room, and at least 2 m² of it are unknown
  evaluation::DoorBox bestBox{};  ///< of an unseen room
  double area = 0.0;              ///< m², of the room

  bool hasUnseenRoom() const { return isUnseen && room != nullptr && room->use == simulation::RoomUse::kRoom; }
  bool isOrdinary() const { return isClosed && hasUnseenRoom() && area <= evaluation::kLargestRoom; }
  evaluation::DoorView view() const {
    const auto isKnown = [this](const Eigen::Vector2d& point) { return world->at(point) != map::CellState::kUnknown; };
    return {T_world_here, room->outline, isKnown, test::kPlanResolution};
  }
};

/// The door-aligned box of the greatest IoU with the room, step by step from the room's bounding box.
inline evaluation::DoorBox bestBoxOf(const evaluation::DoorView& view, const geometry::Polygon& room_here) {
  evaluation::DoorBox best;
  const auto step = [](double metres) { return test::kPlanResolution * std::round(metres / test::kPlanResolution); };
  for (const auto& corner : room_here) {
    best.left = std::max(best.left, step(corner.y()));
    best.right = std::max(best.right, step(-corner.y()));
    best.depth = std::max(best.depth, step(corner.x()));
  }
  double greatest = view.iou(best);
  const auto climb = [&](double evaluation::DoorBox::*edge, double move) {
    auto moved = best;
    moved.*edge = std::max(0.0, moved.*edge + move);
    const double value = view.iou(moved);
    if (value <= greatest) return false;
    greatest = value;
    best = moved;
    return true;
  };
  for (const double size : {1.6, 0.8, 0.4, 0.2, 0.1}) {
    for (bool isBetter = true; isBetter;) {
      isBetter = false;
      for (const double move : {size, -size}) {
        isBetter |= climb(&evaluation::DoorBox::left, move);
        isBetter |= climb(&evaluation::DoorBox::right, move);
        isBetter |= climb(&evaluation::DoorBox::depth, move);
      }
    }
  }
  return best;
}

/// All cases of a plan in one state of knowledge.
class CaseMaker {
 public:
  explicit CaseMaker(const Plan& plan) : plan_(plan) {}

  using Visit = std::function<void(RoomCase&&)>;

  /// Doors with a seen room in front, in the order of the plan: closed ones, for the laser also open and ajar ones.
  void visit(double shareSeen, std::uint64_t draw, Knowledge knowledge, const Visit& visit) {
    const auto seed = static_cast<std::uint64_t>(100 * shareSeen) + 1000 * draw;
    base::Random random(seed, "room cases " + plan_.name);
    const auto& building = plan_.building;
    const auto seen = test::drawSeen(building, shareSeen, seed);
    const bool isLaser = knowledge == Knowledge::kLaser;
    std::vector<double> gaps;
    for (const auto& door : building.doors) gaps.push_back(door.leaves == 0 ? 1.0 : isLaser ? drawGap(random) : 0.0);
    const auto world = std::make_shared<const test::SeenWorld>(isLaser ? laserWorld(seen, gaps, random)
                                                                       : test::wholeRooms(building, seen));
    for (std::size_t i = 0; i < building.doors.size(); ++i) {
      for (const std::size_t far : {0U, 1U}) {
        const auto& door = building.doors[i];
        const int near = door.rooms[1 - far];
        if (near == simulation::kOutside || !seen[static_cast<std::size_t>(near)]) continue;
        const bool isClosed = gaps[i] == 0.0;
        if (!isClosed && !isLaser) continue;
        RoomCase made{.plan = &plan_, .door = &door, .knowledge = knowledge, .world = world, .isClosed = isClosed};
        made.T_world_here = test::poseTowards(door, far);
        if (!isFreeAhead(made, -0.6)) continue;
        const int room = door.rooms[far];
        if (room != simulation::kOutside) {
          tellTruth(made, static_cast<std::size_t>(room), i, far);
          made.isUnseen = made.isUnseen && !seen[static_cast<std::size_t>(room)];
        }
        if (isLaser) disturb(made.T_world_here, random);
        made.around = world->around(made.T_world_here);
        addOpenings(made, random);
        visit(std::move(made));
      }
    }
  }

 private:
  static constexpr double kOpen = 0.2;         // share of doors that stand open when the laser passes
  static constexpr double kAjar = 0.25;        // … that show a part of their opening
  static constexpr double kFurnished = 0.5;    // share of states in which things stand about
  static constexpr double kMissed = 0.33;      // share of other doors that the robot did not find
  static constexpr double kLeastUnseen = 2.0;  // m²

  static double drawGap(base::Random& random) {
    const double draw = random.uniform();
    if (draw < kOpen) return 1.0;
    const double gap = random.uniform(0.1, 0.7);
    if (draw < kOpen + kAjar) return random.uniform() < 0.5 ? gap : -gap;
    return 0.0;
  }

  test::SeenWorld laserWorld(const std::vector<bool>& seen, const std::vector<double>& gaps,
                             base::Random& random) const {
    const test::LaserRounds::Options options{.spacing = 1.5, .range = random.uniform(8.0, 25.0), .peeked = 0.5};
    const auto& building = random.uniform() < kFurnished ? plan_.furnished : plan_.building;
    return test::LaserRounds(building, gaps).seenFrom(plan_.building, seen, options, random);
  }

  static bool isFreeAhead(const RoomCase& made, double metres) {
    const auto there = made.T_world_here * geometry::Pose2{metres, 0.0, 0.0};
    return made.world->at({there.x, there.y}) == map::CellState::kFree;
  }

  static void disturb(geometry::Pose2& pose, base::Random& random) {
    const double ahead = random.normal(0.0, 0.03);
    const double across = random.normal(0.0, 0.03);
    pose = pose * geometry::Pose2{ahead, across, random.normal(0.0, 0.035)};
  }

  void tellTruth(RoomCase& made, std::size_t room, std::size_t door, std::size_t far) {
    made.room = &plan_.building.rooms[room];
    const auto cells = geometry::cellsIn(made.room->outline, test::kPlanResolution);
    const auto unknown = std::ranges::count_if(cells, [&](auto cell) {
      return made.world->at(geometry::centreOf(cell, test::kPlanResolution)) == map::CellState::kUnknown;
    });
    constexpr double kCellArea = test::kPlanResolution * test::kPlanResolution;
    made.area = kCellArea * static_cast<double>(cells.size());
    made.isUnseen = kCellArea * static_cast<double>(unknown) >= kLeastUnseen;
    if (!made.isUnseen) return;
    auto [found, isNew] = boxes_.try_emplace({door, far});
    if (isNew) {
      const auto room_here = geometry::transformed(geometry::inverse(made.T_world_here), made.room->outline);
      found->second = bestBoxOf(made.view(), room_here);
    }
    made.bestBox = found->second;
  }

  /// Other doors and doorways that can be seen from one side at least.
  void addOpenings(RoomCase& made, base::Random& random) const {
    const bool isLaser = made.knowledge == Knowledge::kLaser;
    const auto T_here_world = geometry::inverse(made.T_world_here);
    for (const auto& door : plan_.building.doors) {
      if (&door == made.door || (isLaser && random.uniform() < kMissed)) continue;
      auto pose = T_here_world * door.pose;
      if (isLaser) disturb(pose, random);
      const auto centre = geometry::cellAt(pose.x, pose.y, prediction::Surroundings::kCell);
      if (!prediction::Surroundings::kBox.contains(centre)) continue;
      const auto isFree = [&](double metres) {
        const auto there = door.pose * geometry::Pose2{metres, 0.0, 0.0};
        return made.world->at({there.x, there.y}) == map::CellState::kFree;
      };
      if (!isFree(0.5) && !isFree(-0.5)) continue;
      made.around.openings.push_back(
          {.id = {}, .T_here_opening = pose, .width = door.width, .hasLeaf = door.leaves > 0});
    }
  }

  const Plan& plan_;
  std::map<std::pair<std::size_t, std::size_t>, evaluation::DoorBox> boxes_;  // by door and side
};

}  // namespace prodomos::bench
