// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// fit_extrapolation PLANS SPLIT.yaml PART [KEY=VALUE …]
//
// What the sizes of prediction::ExtrapolationConfig make of floor plans (PART of the split: train, validation): the
// precision of predicted floor and its area, by threshold, behind closed doors, beyond stairs and along people's ways.
// Values are read over the defaults, as "prediction.door_sigma=2".
//
// Doors: corridors count as seen, and of the other rooms 0, 30 or 60 %, drawn by seed; what is seen is known with the
// surfaces of its walls. Each closed door between a seen room and an unseen one is a case, its pose that of the leaf.
// Beside it half-discs of one radius that are as great together. Stairs: of plans doubled to two storeys, the upper one
// not seen at all. People: as the simulator has them walk; what is extrapolated after the last half second of each
// straight piece that is left to see, with nothing known around, and with the room known that they are in, its doors
// open. An area comes true where no more than a fifth of it is no floor.
#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/half_disc.hpp"
#include "prodomos/prediction/extrapolation.hpp"
#include "prodomos/simulation/floor_plan.hpp"
#include "prodomos/simulation/population.hpp"
#include "prodomos/simulation/shell.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <numbers>

namespace prodomos {
namespace {

using geometry::CellIndex;
using geometry::CellMap;
using geometry::Pose2;
using map::CellState;

constexpr double kResolution = 0.05;  // metres
constexpr std::array kSharesSeen = {0.0, 0.3, 0.6};
constexpr std::array kThresholds = {0.5, 0.6, 0.7};
constexpr std::uint64_t kSeed = 0;

CellIndex cellOf(const Eigen::Vector2d& point) {
  return geometry::cellAt(point.x(), point.y(), kResolution);
}

geometry::Polygon rectangle(const Pose2& pose, double length, double width) {
  geometry::Polygon corners;
  for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    corners.emplace_back(pose * Eigen::Vector2d(x * length / 2.0, y * width / 2.0));
  }
  return corners;
}

Pose2 leafPose(const simulation::Building& building, std::size_t door) {
  return building.doors[door].pose * Pose2{simulation::leafOffset(building, door, kSeed), 0.0, 0.0};
}

/// One storey of a building in cells.
class Plan {
 public:
  Plan(const simulation::Building& building, int storey) : building_(building) {
    std::vector<geometry::Polygon> outlines;
    for (const auto& room : building.rooms) outlines.push_back(room.outline);
    rooms_ = CellMap<std::int32_t>(geometry::boxOf(outlines, kResolution), -1);
    openings_ = CellMap<std::uint8_t>(rooms_.box(), 0);
    for (std::size_t i = 0; i < building.rooms.size(); ++i) {
      if (building.rooms[i].storey != storey) continue;
      rooms_.fill(building.rooms[i].outline, static_cast<std::int32_t>(i), kResolution);
    }
    for (std::size_t i = 0; i < building.doors.size(); ++i) {
      const auto& door = building.doors[i];
      if (door.storey != storey) continue;
      openings_.fill(rectangle(door.pose, door.wallThickness, door.width), 1, kResolution);
      if (door.leaves > 0) openings_.fill(rectangle(leafPose(building, i), kResolution, door.width), 0, kResolution);
    }
  }

  /// -1: none.
  std::int32_t roomAt(CellIndex cell) const { return rooms_.at(cell); }
  bool isFloor(CellIndex cell) const { return rooms_.at(cell) >= 0 || openings_.at(cell) != 0; }

  /// Floor of the seen rooms, and one cell of the walls around; of doors too, unless they stand open.
  CellMap<CellState> known(const std::vector<bool>& seen, bool doorsAreOpen = false) const {
    const auto& box = rooms_.box();
    CellMap<CellState> known(box, CellState::kUnknown);
    const auto isSeen = [&](CellIndex cell) {
      return rooms_.at(cell) >= 0 && seen[static_cast<std::size_t>(rooms_.at(cell))];
    };
    for (int y = box.first.y; y <= box.last.y; ++y) {
      for (int x = box.first.x; x <= box.last.x; ++x) {
        if (isSeen({x, y})) {
          *known.find({x, y}) = CellState::kFree;
        } else if (doorsAreOpen && openings_.at({x, y}) != 0) {
          continue;
        } else if (isSeen({x + 1, y}) || isSeen({x - 1, y}) || isSeen({x, y + 1}) || isSeen({x, y - 1})) {
          *known.find({x, y}) = CellState::kOccupied;
        }
      }
    }
    return known;
  }

 private:
  const simulation::Building& building_;
  CellMap<std::int32_t> rooms_;
  CellMap<std::uint8_t> openings_;
};

struct Counts {
  double right = 0.0;
  double all = 0.0;
};

/// By threshold.
struct Table {
  std::array<Counts, kThresholds.size()> levels;
  evaluation::ByRadius discRight{};
  evaluation::ByRadius discAll{};
  std::size_t cases = 0;
  std::size_t bets = 0;      ///< areas at the least threshold, of unknown cells
  std::size_t cameTrue = 0;  ///< of them those that are floor, but for a fifth
  double slowest = 0.0;      ///< seconds
  double time = 0.0;

  void add(const Plan& plan, const CellMap<CellState>& known, const geometry::Pose3& T_world_areas,
           const std::vector<map::PredictedArea>& areas) {
    for (const auto& area : areas) {
      auto& counts =
          levels[static_cast<std::size_t>(std::ranges::find(kThresholds, area.threshold) - kThresholds.begin())];
      Counts here;
      for (const auto cell : geometry::cellsIn(geometry::transformed(T_world_areas, area.outline_in_node))) {
        if (known.at(cell) != CellState::kUnknown) continue;
        here.all += 1.0;
        here.right += plan.isFloor(cell) ? 1.0 : 0.0;
      }
      counts.all += here.all;
      counts.right += here.right;
      if (area.threshold != kThresholds.front() || here.all == 0.0) continue;
      ++bets;
      if (here.right >= 0.8 * here.all) ++cameTrue;
    }
  }

  void addDiscs(const Plan& plan, const CellMap<CellState>& known, const Pose2& T_world_door) {
    evaluation::ByRadius right{};
    evaluation::ByRadius all{};
    for (double x = evaluation::kWallHalf + kResolution / 2.0; x < 6.0; x += kResolution) {
      for (double y = -6.0 + kResolution / 2.0; y < 6.0; y += kResolution) {
        const auto cell = cellOf(T_world_door * Eigen::Vector2d(x, y));
        const auto radius = evaluation::radiusIndex(std::hypot(x, y));
        if (radius >= evaluation::kRadiusSteps || known.at(cell) != CellState::kUnknown) continue;
        all[radius] += 1.0;
        right[radius] += plan.isFloor(cell) ? 1.0 : 0.0;
      }
    }
    evaluation::accumulate(right);
    evaluation::accumulate(all);
    evaluation::add(discRight, right);
    evaluation::add(discAll, all);
  }

  void print(const std::string& name) const {
    std::cout << std::left << std::setw(22) << name << std::right << std::setw(6) << cases << std::fixed;
    for (const auto& level : levels) {
      std::cout << std::setprecision(3) << "   " << (level.all > 0.0 ? level.right / level.all : 0.0)
                << std::setprecision(2) << " " << level.all * kResolution * kResolution / static_cast<double>(cases)
                << " m²";
      const auto disc = std::ranges::lower_bound(discAll, level.all);
      if (level.all == 0.0 || disc == discAll.end() || *disc == 0.0) continue;
      std::cout << std::setprecision(3) << " (disc "
                << discRight[static_cast<std::size_t>(disc - discAll.begin())] / *disc << ")";
    }
    std::cout << std::setprecision(3) << "   " << 1e3 * time / static_cast<double>(cases) << " ms, at most "
              << 1e3 * slowest << " ms; " << static_cast<double>(cameTrue) / static_cast<double>(bets) << " of " << bets
              << " areas come true\n";
  }
};

template <typename Function>
auto timed(Table& table, const Function& function) {
  const auto begin = std::clock();
  auto result = function();
  const double spent = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  table.time += spent;
  table.slowest = std::max(table.slowest, spent);
  ++table.cases;
  return result;
}

std::vector<bool> drawSeen(const simulation::Building& building, double share) {
  base::Random random(static_cast<std::uint64_t>(100 * share), "fit_extrapolation " + building.name);
  std::vector<bool> seen;
  for (const auto& room : building.rooms) {
    seen.push_back(room.use == simulation::RoomUse::kCorridor || random.uniform() < share);
  }
  return seen;
}

prediction::Surroundings surroundingsOf(const CellMap<CellState>& known, const Pose2& T_world_here) {
  prediction::Surroundings around(geometry::toPose3(T_world_here), {});
  const auto& box = prediction::Surroundings::kBox;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      auto state = CellState::kUnknown;
      for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const auto quarter = geometry::centreOf({2 * x + dx, 2 * y + dy}, kResolution);
        state = std::max(state, known.at(cellOf(T_world_here * quarter)));  // unknown < free < occupied
      }
      around.set({x, y}, state);
    }
  }
  return around;
}

void addOpenings(const simulation::Building& building, const std::vector<bool>& seen, std::size_t own,
                 const Pose2& T_world_here, prediction::Surroundings& around) {
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const auto& door = building.doors[i];
    const auto isSeen = [&](int room) { return room != simulation::kOutside && seen[static_cast<std::size_t>(room)]; };
    if (i == own || door.storey != building.doors[own].storey || (!isSeen(door.rooms[0]) && !isSeen(door.rooms[1]))) {
      continue;
    }
    const Pose2 turn{0.0, 0.0, isSeen(door.rooms[0]) ? 0.0 : std::numbers::pi};
    const auto T_world_door = door.leaves > 0 ? leafPose(building, i) : door.pose;
    around.openings.push_back({base::EntityId{static_cast<std::int64_t>(i)},
                               geometry::inverse(T_world_here) * T_world_door * turn, door.width, door.leaves > 0});
  }
}

void addDoors(const simulation::Building& building, double share, const prediction::ExtrapolationConfig& config,
              Table& blind, Table& guessed) {
  const Plan plan(building, 0);
  const auto seen = drawSeen(building, share);
  const auto known = plan.known(seen);
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const auto& door = building.doors[i];
    if (door.leaves == 0) continue;
    for (const std::size_t far : {0U, 1U}) {
      const int room = door.rooms[far];
      const int other = door.rooms[1 - far];
      if (room == simulation::kOutside || other == simulation::kOutside) continue;
      if (seen[static_cast<std::size_t>(room)] || !seen[static_cast<std::size_t>(other)]) continue;
      const auto T_world_here = leafPose(building, i) * Pose2{0.0, 0.0, far == 1 ? 0.0 : std::numbers::pi};
      auto around = surroundingsOf(known, T_world_here);
      addOpenings(building, seen, i, T_world_here, around);
      auto hinge = door.leaves == 1 ? door.hingeSide : map::HingeSide::kUnknown;
      if (far == 0 && hinge != map::HingeSide::kUnknown) {
        hinge = hinge == map::HingeSide::kLeft ? map::HingeSide::kRight : map::HingeSide::kLeft;
      }
      map::Entity entity;
      entity.attributes = map::Door{.width = door.width, .hingeSide = hinge};
      const auto addTo = [&](Table& table, const prediction::RoomGuess* guess) {
        const auto told = timed(table, [&] { return prediction::extrapolate(entity, around, guess, config); });
        const auto& submap = std::get<prediction::PredictedSubMap>(told);
        table.add(plan, known, geometry::toPose3(T_world_here) * submap.T_i_j, submap.areas);
        table.addDiscs(plan, known, T_world_here);
      };
      addTo(blind, nullptr);
      const auto guess = prediction::guessRoom(around, door.width);
      addTo(guessed, &guess);
    }
  }
}

void addStairs(const simulation::Building& building, const prediction::ExtrapolationConfig& config, Table& up,
               Table& down) {
  const CellMap<CellState> nothing;
  for (const auto& stairs : building.stairs) {
    const double height = stairs.stepHeight * stairs.stepCount;
    const double run = stairs.stepDepth * (stairs.stepCount - 1);
    const Eigen::Vector2d middle =
        stairs.foot.head<2>() + Eigen::Vector2d(std::cos(stairs.direction), std::sin(stairs.direction)) * run / 2.0;
    map::Entity entity;
    entity.T_submap_entity.translation().z() = height / 2.0;
    const Pose2 T_world_submap{middle.x(), middle.y(), stairs.direction};
    for (const double sign : {1.0, -1.0}) {
      const int storey = sign > 0.0 ? stairs.upperStorey : stairs.lowerStorey;
      if (storey < 0 || storey >= static_cast<int>(building.storeys.size())) continue;
      entity.attributes = map::Staircase{.height = sign * height,
                                         .stepWidth = stairs.width,
                                         .stepHeight = height / (stairs.stepCount - 1),
                                         .stepDepth = stairs.stepDepth};
      auto& table = sign > 0.0 ? up : down;
      const auto told = timed(table, [&] { return prediction::extrapolate(entity, {}, nullptr, config); });
      const auto& submap = std::get<prediction::PredictedSubMap>(told);
      table.add(Plan(building, storey), nothing, geometry::toPose3(T_world_submap) * submap.T_i_j, submap.areas);
    }
  }
}

/// `blind`: with nothing known; `seen`: with the room known that the person leaves, or is about to.
void addPeople(simulation::Building building, const prediction::ExtrapolationConfig& config, Table& blind,
               Table& seen) {
  constexpr double kDuration = 120.0;  // seconds
  constexpr double kWatched = 0.5;
  simulation::populate(building, kSeed, kDuration);
  const CellMap<CellState> nothing;
  const Plan plan(building, 0);
  for (const auto& person : building.people) {
    if (person.sits || person.storey != 0) continue;
    for (double time = 1.0; time < kDuration; time += 3.0) {
      const Eigen::Vector2d origin = simulation::positionAt(person, time);  // of the sub-map
      prediction::Walk walk{.left = true};
      for (double watched = time - kWatched; watched <= time; watched += 0.1) {
        const auto position = simulation::positionAt(person, watched);
        const Eigen::Vector2d step = position - simulation::positionAt(person, watched - 0.1);
        walk.states.push_back({base::fromNanoseconds(0) + base::fromSeconds(watched),
                               {position.x() - origin.x(), position.y() - origin.y(), std::atan2(step.y(), step.x())},
                               step / 0.1});
      }
      if (prediction::paceAtEnd(walk).norm() < 0.5) continue;
      const auto T_world_submap = geometry::toPose3({origin.x(), origin.y(), 0.0});
      const auto addTo = [&](Table& table, const CellMap<CellState>& known, const prediction::Surroundings& around) {
        const auto told = timed(table, [&] { return prediction::extrapolate(walk, around, config); });
        for (const auto& strip : std::get<prediction::ConditionalFloor>(told).strips) {
          table.add(plan, known, T_world_submap, strip);
        }
      };
      addTo(blind, nothing, {});
      const auto room = plan.roomAt(cellOf(simulation::positionAt(person, time)));
      if (room < 0) continue;
      std::vector<bool> isSeen(building.rooms.size(), false);
      isSeen[static_cast<std::size_t>(room)] = true;
      const auto known = plan.known(isSeen, true);
      addTo(seen, known, surroundingsOf(known, geometry::toPose2(T_world_submap * prediction::T_submap_here(walk))));
    }
  }
}

int run(const std::filesystem::path& plans, const YAML::Node& names, const prediction::ExtrapolationConfig& config) {
  std::array<Table, kSharesSeen.size()> blind;
  std::array<Table, kSharesSeen.size()> guessed;
  Table up;
  Table down;
  Table people;
  Table leaving;
  for (const auto& name : names) {
    const auto plan = plans / name.as<std::string>();
    try {
      const auto building = simulation::readFloorPlan(plan, {});
      for (std::size_t i = 0; i < kSharesSeen.size(); ++i) {
        addDoors(building, kSharesSeen[i], config, blind[i], guessed[i]);
      }
      addPeople(building, config, people, leaving);
      addStairs(simulation::readFloorPlan(plan, {.storeys = 2}), config, up, down);
    } catch (const std::exception& fault) {
      std::cerr << fault.what() << '\n';
    }
  }
  std::cout << "case                   count   precision and area a case at 0.5, 0.6, 0.7; time\n";
  for (std::size_t i = 0; i < kSharesSeen.size(); ++i) {
    const auto share = std::to_string(static_cast<int>(100.0 * kSharesSeen[i])) + " %";
    blind[i].print("doors, seen " + share);
    guessed[i].print("  with the room's guess");
  }
  up.print("stairs up");
  down.print("stairs down");
  people.print("people");
  leaving.print("people leaving rooms");
  return 0;
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: fit_extrapolation PLANS SPLIT.yaml PART [KEY=VALUE …]\n";
    return 2;
  }
  prodomos::base::ConfigInput input;
  input.assignments.assign(argv + 4, argv + argc);
  const auto config = prodomos::base::readConfig<prodomos::prediction::ExtrapolationConfig>(input);
  return prodomos::run(argv[1], YAML::LoadFile(argv[2])[std::string(argv[3])], config);
}
