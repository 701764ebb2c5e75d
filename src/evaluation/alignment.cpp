// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/alignment.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/evaluation/relations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::evaluation {

namespace {

constexpr base::Duration kLongestGap = std::chrono::milliseconds(500);

/// What a radian of heading counts against a metre of position.
constexpr double kMetresPerRadian = 1.0;

constexpr double kSameStorey = 1.0;  // metres between its floor and what lies on it

/// A pose and the true one of the same time.
using PosePair = std::pair<geometry::Pose3, geometry::Pose3>;

std::vector<PosePair> pairsOf(const std::vector<TimedPose>& poses, const Truth& truth) {
  std::vector<PosePair> pairs;
  for (const auto& pose : poses) {
    if (const auto actual = poseAt(truth.trajectory, pose.time)) pairs.emplace_back(pose.pose, *actual);
  }
  return pairs;
}

/// T_true_estimated, level, of the least squares. There must be a pair.
geometry::Pose3 levelAlignment(const std::vector<PosePair>& pairs) {
  Eigen::Vector3d estimatedMean = Eigen::Vector3d::Zero();
  Eigen::Vector3d trueMean = Eigen::Vector3d::Zero();
  for (const auto& [estimated, actual] : pairs) {
    estimatedMean += estimated.translation() / static_cast<double>(pairs.size());
    trueMean += actual.translation() / static_cast<double>(pairs.size());
  }
  // The heading θ that maximises Σ (R(θ) p_i) · q_i + L² Σ cos(δ_i - θ).
  double cosine = 0.0;
  double sine = 0.0;
  for (const auto& [estimated, actual] : pairs) {
    const Eigen::Vector3d p = estimated.translation() - estimatedMean;
    const Eigen::Vector3d q = actual.translation() - trueMean;
    const double turn = geometry::yaw(actual) - geometry::yaw(estimated);
    cosine += p.x() * q.x() + p.y() * q.y() + kMetresPerRadian * kMetresPerRadian * std::cos(turn);
    sine += p.x() * q.y() - p.y() * q.x() + kMetresPerRadian * kMetresPerRadian * std::sin(turn);
  }
  const auto T_true_estimated = geometry::fromYawPitchRoll(Eigen::Vector3d::Zero(), std::atan2(sine, cosine), 0.0, 0.0);
  return Eigen::Translation3d(trueMean - T_true_estimated * estimatedMean) * T_true_estimated;
}

std::vector<double> floorsOf(const Truth& truth) {
  std::vector<double> floors_z;
  for (const auto& storey : truth.storeys) floors_z.push_back(storey.floor_z);
  return floors_z;
}

int indexOfNearest(const std::vector<double>& floors_z, double z) {
  const auto nearest = std::ranges::min_element(floors_z, {}, [z](double floor_z) { return std::abs(floor_z - z); });
  return nearest == floors_z.end() ? 0 : static_cast<int>(nearest - floors_z.begin());
}

std::string spanOf(const std::vector<TimedPose>& poses) {
  if (poses.empty()) return "none";
  return base::toString(poses.front().time) + " to " + base::toString(poses.back().time);
}

}  // namespace

std::optional<geometry::Pose3> poseAt(const std::vector<TimedPose>& poses, base::Time time) {
  const auto after = std::ranges::lower_bound(poses, time - kStampTolerance, {}, &TimedPose::time);
  if (after == poses.end()) return std::nullopt;
  if (after->time - time <= kStampTolerance) return after->pose;
  if (after == poses.begin()) return std::nullopt;
  const auto& before = *std::prev(after);
  const base::Duration gap = after->time - before.time;
  if (gap > kLongestGap) return std::nullopt;
  return geometry::interpolate(before.pose, after->pose, base::seconds(time - before.time) / base::seconds(gap));
}

geometry::Pose3 truthFromMap(const std::vector<TimedPose>& mapPoses, const Truth& truth) {
  const auto pairs = pairsOf(mapPoses, truth);
  if (pairs.empty()) {
    throw base::Error(
        base::expectedFound("truth and map", "times in common",
                            "a true way of " + spanOf(truth.trajectory) + ", a map's of " + spanOf(mapPoses)));
  }
  return levelAlignment(pairs);
}

std::map<base::SubMapId, geometry::Pose3> truthFromSubMaps(const map::MapView& view, const Truth& truth) {
  const auto way = view.trajectory();
  const auto T_world_map = truthFromMap(bodyPoses(way, Poses::kRefined), truth);
  std::map<base::SubMapId, std::vector<TimedPose>> wayOf;
  for (const auto& point : way) wayOf[point.submap].push_back({point.time, point.T_map_body});

  std::map<base::SubMapId, geometry::Pose3> T_world_submap;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (node.kind != map::SubMapKind::kObserved) continue;
    const auto pairs = pairsOf(wayOf[id], truth);
    T_world_submap[id] = (pairs.empty() ? T_world_map : levelAlignment(pairs)) * node.T_map_submap;
  }
  return T_world_submap;
}

int storeyAt(const Truth& truth, double z) {
  return indexOfNearest(floorsOf(truth), z);
}

int Placement::storeyAt(double z) const {
  return indexOfNearest(floors_z, z);
}

std::optional<int> Placement::modelledStoreyAt(double z) const {
  const int storey = storeyAt(z);
  const auto index = static_cast<std::size_t>(storey);
  if (index >= floors_z.size() || std::abs(floors_z[index] - z) > kSameStorey) return std::nullopt;
  return storey;
}

Placement placementOf(const map::MapView& view, const Truth& truth) {
  return {truthFromSubMaps(view, truth), floorsOf(truth)};
}

Placement placementOf(const map::MapView& view) {
  Placement placement;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (node.kind == map::SubMapKind::kObserved) placement.T_world_submap[id] = node.T_map_submap;
  }
  for (const auto& floor : view.floors()) placement.floors_z.push_back(floor.height);
  if (placement.floors_z.empty()) placement.floors_z.push_back(0.0);
  std::ranges::sort(placement.floors_z);
  return placement;
}

}  // namespace prodomos::evaluation
