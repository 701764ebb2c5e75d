// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/leg_detector.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

namespace prodomos::perception {

namespace {

using Eigen::Vector2d;

// As they are seen at the height of shins to thighs.
constexpr double kLeastWidth = 0.05;  ///< metres, of a leg
constexpr double kMostWidth = 0.25;
constexpr double kMostStride = 0.6;  ///< metres between the middles of two legs
constexpr double kLeastStride = 0.08;
constexpr double kBreak = 0.12;     ///< metres between ranges of neighbouring beams on different things
constexpr double kLeastGap = 0.25;  ///< metres that what is beside a leg lies behind it
constexpr double kMostRange = 6.0;
constexpr std::size_t kLeastBeams = 3;
constexpr double kMostTilt = 0.1;    ///< radians
constexpr double kMostHeight = 0.8;  ///< metres above the floor
constexpr double kShin = 0.05;       ///< metres, radius of a leg

struct Leg {
  Vector2d middle = Vector2d::Zero();  ///< in the sensor
};

struct Beam {
  double range;  ///< infinite: nothing there; negative: the beam says nothing
  Vector2d end;  ///< in the sensor
};

std::vector<Beam> beamsOf(const sensors::LaserScan& scan) {
  std::vector<Beam> beams;
  beams.reserve(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = scan.firstAngle + static_cast<double>(i) * scan.angleStep;
    const double range = std::isnan(scan.ranges[i]) ? -1.0 : double{scan.ranges[i]};
    const Vector2d direction(std::cos(angle), std::sin(angle));
    beams.push_back({range, std::isfinite(range) && range > 0.0 ? Vector2d(range * direction) : Vector2d::Zero()});
  }
  return beams;
}

/// How far the thing at a beam lies behind a range; none where the beam says nothing.
std::optional<double> gapBehind(const std::vector<Beam>& beams, std::ptrdiff_t at, double range) {
  if (at < 0 || at >= std::ssize(beams)) return std::nullopt;
  const double other = beams[static_cast<std::size_t>(at)].range;
  if (other <= 0.0) return std::nullopt;
  return other - range;
}

/// The beams [first, end) lie on one thing: is it as a leg is, round, thin, and free on both sides?
std::optional<Leg> legOf(const std::vector<Beam>& beams, std::size_t first, std::size_t end) {
  if (end - first < kLeastBeams) return std::nullopt;
  const Beam& left = beams[first];
  const Beam& right = beams[end - 1];
  const double width = (left.end - right.end).norm();
  if (left.range > kMostRange || width < kLeastWidth || width > kMostWidth) return std::nullopt;
  const auto before = gapBehind(beams, static_cast<std::ptrdiff_t>(first) - 1, left.range);
  const auto after = gapBehind(beams, static_cast<std::ptrdiff_t>(end), right.range);
  if (!before || !after || *before < kLeastGap || *after < kLeastGap) return std::nullopt;
  // A leg bulges towards the sensor; the edge of a wall or a board does not.
  const Vector2d chord = (left.end + right.end) / 2.0;
  double nearest = chord.norm();
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = first; i < end; ++i) {
    nearest = std::min(nearest, beams[i].range);
    sum += beams[i].end;
  }
  const double bulge = chord.norm() - nearest;
  if (bulge < 0.05 * width || bulge > width) return std::nullopt;
  const Vector2d surface = sum / static_cast<double>(end - first);
  return Leg{surface + kShin * surface.normalized()};
}

std::vector<Leg> legsOf(const std::vector<Beam>& beams) {
  std::vector<Leg> legs;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= beams.size(); ++i) {
    const bool goesOn = i < beams.size() && beams[i].range > 0.0 && beams[i - 1].range > 0.0 &&
                        std::abs(beams[i].range - beams[i - 1].range) < kBreak;
    if (goesOn) continue;
    if (beams[first].range > 0.0 && std::isfinite(beams[first].range)) {
      if (const auto leg = legOf(beams, first, i)) legs.push_back(*leg);
    }
    first = i;
  }
  return legs;
}

bool isLevelAndLow(const geometry::Pose3& T_body_sensor) {
  const double tilt = std::acos(std::clamp(T_body_sensor.linear()(2, 2), -1.0, 1.0));
  return tilt < kMostTilt && T_body_sensor.translation().z() < kMostHeight;
}

}  // namespace

std::vector<PersonSighting> findLegs(const sensors::LaserScan& scan, const geometry::Pose3& T_submap_body,
                                     base::Time time) {
  if (!geometry::isFinite(T_submap_body) || !geometry::isFinite(scan.T_body_sensor)) return {};
  if (!isLevelAndLow(scan.T_body_sensor)) return {};
  const auto legs = legsOf(beamsOf(scan));
  struct Pair {
    std::size_t a, b;
    double stride;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < legs.size(); ++a) {
    for (std::size_t b = a + 1; b < legs.size(); ++b) {
      const double stride = (legs[a].middle - legs[b].middle).norm();
      if (stride >= kLeastStride && stride <= kMostStride) pairs.push_back({a, b, stride});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::stride);
  const geometry::Pose3 T_submap_sensor = T_submap_body * scan.T_body_sensor;
  std::vector<bool> taken(legs.size(), false);
  std::vector<PersonSighting> people;
  for (const auto& [a, b, stride] : pairs) {
    if (taken[a] || taken[b]) continue;
    taken[a] = taken[b] = true;
    const Vector2d middle = (legs[a].middle + legs[b].middle) / 2.0;
    PersonSighting person{.time = time, .positionSigma = 0.08, .score = 0.6, .mustMove = true};
    person.position_in_submap = T_submap_sensor * Eigen::Vector3d(middle.x(), middle.y(), 0.0);
    person.position_in_submap.z() = T_submap_body.translation().z();
    people.push_back(person);
  }
  return people;
}

}  // namespace prodomos::perception
