// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/open_door_leaf.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <numbers>

namespace prodomos::perception::open_doors {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLeastAngle = 8.0 * kDegree;  // less is a leaf that is closed in its recess
constexpr double kMostAngle = 100.0 * kDegree;
// Heights above the floor, metres.
constexpr double kLowest = 0.15;
constexpr double kLeafTop = 1.9;
constexpr double kAboveLeaf = 2.25;
constexpr double kHighest = 2.7;

constexpr double kNearAxis = 0.12;  // metres; jamb and frame are there too
constexpr double kBin = 0.05;       // metres
constexpr double kBeyond = 0.35;    // metres past the leaf's edge, where a wall would go on
constexpr double kRoughness = 0.03;
constexpr double kSigmas = 2.0;

/// In the plane: along the closed leaf from its axis, and behind the wall's plane.
struct Flat {
  Eigen::Vector2d point;
  Eigen::Vector2d normal;
  double z = 0.0;
  double sigma = 0.0;
};

using Flats = std::vector<Flat>;

/// Whether bins of length have points.
class Coverage {
 public:
  void add(double length) {
    if (length >= 0.0 && length < kCount * kBin) ++counts_[static_cast<std::size_t>(length / kBin)];
  }
  double share(double from, double to) const {
    const int first = static_cast<int>(std::ceil(from / kBin));
    const int last = std::min(static_cast<int>(std::floor(to / kBin)), kCount);
    int covered = 0;
    for (int i = first; i < last; ++i) covered += counts_[static_cast<std::size_t>(i)] >= 2 ? 1 : 0;
    return last > first ? static_cast<double>(covered) / (last - first) : 0.0;
  }

 private:
  static constexpr int kCount = 60;
  std::array<int, kCount> counts_{};
};

struct Line {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  // of the axis
  double angle = 0.0;

  Eigen::Vector2d along() const { return {std::cos(angle), std::sin(angle)}; }
  double length(const Flat& flat) const { return along().dot(flat.point - origin); }
  double distance(const Flat& flat) const {
    const Eigen::Vector2d offset = flat.point - origin;
    return std::abs(along().x() * offset.y() - along().y() * offset.x());
  }
  bool holds(const Flat& flat) const { return distance(flat) < kRoughness + kSigmas * flat.sigma; }
};

/// The direction from the axis in which most of a leaf's length is covered, and how much of it.
std::pair<double, double> bestDirection(const Flats& flats, const Eigen::Vector2d& origin, double width) {
  constexpr double kStep = 4.0 * kDegree;
  constexpr int kDirections = 61;
  std::array<std::bitset<64>, kDirections> covered{};
  for (const auto& flat : flats) {
    if (flat.z > kLeafTop) continue;
    const Eigen::Vector2d offset = flat.point - origin;
    const double length = offset.norm();
    if (length < kNearAxis || length > width) continue;
    const double angle = std::atan2(offset.y(), offset.x());
    const int direction = static_cast<int>(std::lround(angle / kStep)) + kDirections / 2;
    if (std::abs(angle) < kLeastAngle || direction < 0 || direction >= kDirections) continue;
    covered[static_cast<std::size_t>(direction)].set(static_cast<std::size_t>(length / kBin));
  }
  const auto best = std::max_element(covered.begin(), covered.end(),
                                     [](const auto& a, const auto& b) { return a.count() < b.count(); });
  const double bins = std::floor(width / kBin) - std::floor(kNearAxis / kBin);
  const int direction = static_cast<int>(best - covered.begin()) - kDirections / 2;
  return {direction * kStep, static_cast<double>(best->count()) / std::max(1.0, bins)};
}

/// Least squares of the points that it holds.
Line refined(const Flats& flats, Line line, double width) {
  for (int round = 0; round < 3; ++round) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    double weight = 0.0;
    for (const auto& flat : flats) {
      const double length = line.length(flat);
      if (flat.z > kLeafTop || length < kNearAxis || length > width || !line.holds(flat)) continue;
      const double w = 1.0 / (kRoughness * kRoughness + flat.sigma * flat.sigma);
      sum += w * flat.point;
      squares += w * flat.point * flat.point.transpose();
      weight += w;
    }
    if (weight <= 0.0) return line;
    const Eigen::Vector2d mean = sum / weight;
    const Eigen::Matrix2d spread = squares / weight - mean * mean.transpose();
    double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    if (std::cos(angle - line.angle) < 0.0) angle += std::numbers::pi;
    line.angle = std::remainder(angle, 2.0 * std::numbers::pi);
    // The axis stays where the line comes nearest to it.
    const Eigen::Vector2d along = line.along();
    line.origin = mean + along * along.dot(line.origin - mean);
  }
  return line;
}

std::optional<Leaf> verified(const Flats& flats, const Line& line, double width) {
  constexpr double kLeastCovered = 0.65;
  constexpr double kMostBeyond = 0.35;
  constexpr double kMostAbove = 0.3;
  constexpr double kOffAxis = 0.12;
  constexpr double kMostTurned = 0.5;   // sine between surface and leaf
  constexpr double kLeastFacing = 0.6;  // people are not flat
  if (std::abs(line.angle) < kLeastAngle || std::abs(line.angle) > kMostAngle) return std::nullopt;
  if (std::abs(line.origin.x()) > kOffAxis) return std::nullopt;
  Coverage along;
  Coverage upwards;
  Coverage above;
  int hasNormal = 0;
  int faces = 0;
  for (const auto& flat : flats) {
    if (!line.holds(flat)) continue;
    const double length = line.length(flat);
    if (length > kNearAxis && length < width) {
      hasNormal += flat.normal.isZero() ? 0 : 1;
      faces += std::abs(flat.normal.dot(line.along())) < kMostTurned && !flat.normal.isZero() ? 1 : 0;
    }
    if (flat.z < kLeafTop) along.add(length);
    if (length < kNearAxis || length > width) continue;
    upwards.add(flat.z);
    if (flat.z > kAboveLeaf) above.add(length);
  }
  double lowest = kLeafTop;
  double highest = kLowest;
  for (const auto& flat : flats) {
    lowest = std::min(lowest, flat.z);
    highest = std::max(highest, std::min(flat.z, kLeafTop));
  }
  if (faces < kLeastFacing * hasNormal) return std::nullopt;
  const double covered = along.share(kNearAxis, width - 0.05);
  const double upright = upwards.share(lowest + kBin, highest - kBin);
  if (covered < kLeastCovered || upright < kLeastCovered) return std::nullopt;
  if (along.share(width + 0.1, width + kBeyond) > kMostBeyond) return std::nullopt;
  if (above.share(kNearAxis, width) > kMostAbove) return std::nullopt;
  return Leaf{line.angle, line.origin.y(), std::min(covered, upright)};
}

}  // namespace

std::vector<Spot> spotsNear(const RgbdView& view, const Surfaces& surfaces, const Wall& wall, double x, double radius) {
  const geometry::Pose3 T_wall_camera = wall.T_submap_wall.inverse() * view.T_submap_camera;
  std::vector<Spot> spots;
  for (int v = 0; v < surfaces.depth.height(); ++v) {
    for (int u = 0; u < surfaces.depth.width(); ++u) {
      const auto& cell = surfaces.depth.at(u, v);
      if (!(cell.depth > 0.0F)) continue;
      const Eigen::Vector3d point = T_wall_camera * pointOf(cell);
      if (point.z() < kLowest || point.z() > kHighest) continue;
      if ((point.head<2>() - Eigen::Vector2d(x, 0.0)).squaredNorm() > radius * radius) continue;
      spots.push_back(
          {point, T_wall_camera.linear() * normalOf(cell), sensors::depthSigma(static_cast<double>(cell.depth))});
    }
  }
  return spots;
}

std::optional<Leaf> findLeaf(const std::vector<Spot>& spots, const Hinge& hinge) {
  constexpr double kLeastCovered = 0.6;
  Flats flats;
  for (const auto& spot : spots) {
    const Eigen::Vector2d point(hinge.closing * (spot.point_in_wall.x() - hinge.x), spot.point_in_wall.y());
    if (point.x() < -0.6 * hinge.leafWidth) continue;
    const Eigen::Vector2d normal(hinge.closing * spot.normal_in_wall.x(), spot.normal_in_wall.y());
    flats.push_back({point, normal, spot.point_in_wall.z(), spot.sigma});
  }
  Line line;
  double most = 0.0;
  for (const double y : {0.0, 0.06, 0.12, 0.18, 0.24}) {  // leaves hang on either side of thick walls, or between
    const Eigen::Vector2d origin(0.0, y);
    const auto [angle, covered] = bestDirection(flats, origin, hinge.leafWidth);
    if (covered <= most) continue;
    most = covered;
    line = {origin, angle};
  }
  if (most < kLeastCovered) return std::nullopt;
  return verified(flats, refined(flats, line, hinge.leafWidth), hinge.leafWidth);
}

}  // namespace prodomos::perception::open_doors
