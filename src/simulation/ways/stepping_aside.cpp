// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/stepping_aside.hpp"

#include "prodomos/simulation/population.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

namespace prodomos::simulation {

namespace {

/// Between the middles of robot and person: nearer than this one gives way, and this is what it tries to keep, metres.
constexpr double kNear = 0.75;
constexpr double kKept = 0.7;
constexpr double kFarthestStep = 1.2;
constexpr double kStepLength = 0.1;
/// It begins to step aside so long before and is back as long after, seconds.
constexpr double kEasing = 1.2;
constexpr double kSample = 0.1;

struct Encounter {
  double from;
  double to;
};

class Passing {
 public:
  Passing(const std::vector<DrivenPose>& driven, const FloorGrid& grid, const Person& person)
      : driven_(driven), grid_(grid), person_(person) {}

  std::optional<Encounter> nextEncounter(double after) const {
    std::optional<Encounter> encounter;
    for (double time = std::max(after, 0.0); time <= driven_.back().time; time += kSample) {
      const bool isNear = distanceTo(positionAt(person_, time), time) < kNear;
      if (isNear && !encounter) encounter = {time, time};
      if (isNear) encounter->to = time;
      if (encounter && time - encounter->to > 2.0 * kEasing) break;
    }
    return encounter;
  }

  /// The shortest step that keeps the distance, or else the one that keeps most of it; empty where none is better than
  /// going straight on.
  std::vector<Waypoint> wayRound(const Encounter& encounter) const {
    std::vector<Waypoint> best;
    double most = leastDistance(detour(encounter, Eigen::Vector2d::Zero()));
    for (double length = kStepLength; length <= kFarthestStep && most < kKept; length += kStepLength) {
      for (const auto& direction : directions(encounter)) {
        auto way = detour(encounter, length * direction);
        const double distance = isFree(way) ? leastDistance(way) : 0.0;
        if (distance <= most) continue;
        most = distance;
        best = std::move(way);
      }
    }
    return best;
  }

 private:
  const DrivenPose& robotAt(double time) const {
    const auto index = static_cast<std::size_t>(std::lround(std::max(time, 0.0) / Driver::kTick));
    return driven_[std::min(index, driven_.size() - 1)];
  }

  double distanceTo(const Eigen::Vector2d& position, double time) const {
    const auto& robot = robotAt(time);
    if (robot.storey != person_.storey) return std::numeric_limits<double>::infinity();
    return (position - Eigen::Vector2d(robot.pose.x, robot.pose.y)).norm();
  }

  double leastDistance(const std::vector<Waypoint>& way) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& point : way) least = std::min(least, distanceTo(point.position, point.time));
    return least;
  }

  bool isFree(const std::vector<Waypoint>& way) const {
    for (std::size_t i = 1; i < way.size(); ++i) {
      if (!grid_.isFreeLine(way[i - 1].position, way[i].position)) return false;
    }
    return true;
  }

  /// To both sides of its own way and of the robot's.
  std::array<Eigen::Vector2d, 4> directions(const Encounter& encounter) const {
    const double heading = robotAt(std::midpoint(encounter.from, encounter.to)).pose.theta;
    const Eigen::Vector2d besideRobot(-std::sin(heading), std::cos(heading));
    const Eigen::Vector2d walked =
        positionAt(person_, encounter.to + kEasing) - positionAt(person_, encounter.from - kEasing);
    const Eigen::Vector2d besideWay = Eigen::Vector2d(-walked.y(), walked.x()).stableNormalized();
    // People rather keep to the right.
    return {-besideWay, besideWay, besideRobot, -besideRobot};
  }

  /// Its way with a step aside, which it has taken fully during the encounter.
  std::vector<Waypoint> detour(const Encounter& encounter, const Eigen::Vector2d& step) const {
    std::vector<Waypoint> way;
    const double begin = encounter.from - kEasing;
    const int samples = static_cast<int>(std::ceil((encounter.to + kEasing - begin) / kSample));
    for (int i = 0; i <= samples; ++i) {
      const double time = begin + i * kSample;
      const double outside = std::max({encounter.from - time, time - encounter.to, 0.0});
      const double share = std::max(0.0, 1.0 - outside / kEasing);
      const double eased = share * share * (3.0 - 2.0 * share);
      way.push_back({time, positionAt(person_, time) + eased * step});
    }
    return way;
  }

  const std::vector<DrivenPose>& driven_;
  const FloorGrid& grid_;
  const Person& person_;
};

}  // namespace

void stepAside(const std::vector<DrivenPose>& driven, const std::vector<FloorGrid>& grids, Person& person) {
  if (person.sits) return;
  const Passing passing(driven, grids[static_cast<std::size_t>(person.storey)], person);
  std::optional<Encounter> encounter = passing.nextEncounter(0.0);
  for (; encounter; encounter = passing.nextEncounter(encounter->to + 2.0 * kEasing)) {
    const auto round = passing.wayRound(*encounter);
    if (round.empty()) continue;
    std::vector<Waypoint> way;
    std::ranges::copy_if(person.way, std::back_inserter(way),
                         [&](const Waypoint& point) { return point.time < round.front().time; });
    way.insert(way.end(), round.begin(), round.end());
    std::ranges::copy_if(person.way, std::back_inserter(way),
                         [&](const Waypoint& point) { return point.time > round.back().time; });
    person.way = std::move(way);
  }
}

}  // namespace prodomos::simulation
