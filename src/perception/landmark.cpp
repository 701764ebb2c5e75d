// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/landmark.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>

namespace prodomos::perception {

namespace {

/// Of those that are not sure yet the last ones are told.
constexpr std::size_t kMostTidings = 200;

}  // namespace

void Landmark::noteDetection(base::Time time) {
  if (observations == 0) firstSeen = time;
  ++observations;
  lastSeen = std::max(lastSeen, time);
  lastDetected = time;
  hasChanged = true;
  if (tidings.size() >= kMostTidings) tidings.erase(tidings.begin());
  tidings.push_back({time, map::DoorState::kUnknown});
}

void Landmark::takeOver(const Landmark& other) {
  observations += other.observations;
  firstSeen = std::min(firstSeen, other.firstSeen);
  lastSeen = std::max(lastSeen, other.lastSeen);
  lastDetected = std::max(lastDetected, other.lastDetected);
  tidings.insert(tidings.end(), other.tidings.begin(), other.tidings.end());
  std::ranges::stable_sort(tidings, {}, &Tiding::time);
  hasChanged = true;
}

map::Entity Landmark::entity() const {
  map::Entity entity;
  entity.id = id.value_or(base::EntityId{});
  entity.submap = submap;
  entity.confidence = logistic(logOdds);
  entity.observations = observations;
  entity.firstSeen = firstSeen;
  entity.lastSeen = lastSeen;
  return entity;
}

bool isOlder(const Landmark& a, const Landmark& b) {
  if (a.id && b.id) return *a.id < *b.id;
  return a.id.has_value() != b.id.has_value() ? a.id.has_value() : a.firstSeen < b.firstSeen;
}

const geometry::Pose3& Frames::T_submap_other(base::SubMapId other) const {
  const auto [found, isNew] = others_.try_emplace(other);
  if (isNew) found->second = other == submap_ ? geometry::Pose3::Identity() : T_submap_map_ * poses_(other);
  return found->second;
}

Eigen::Matrix4d uncertaintyBetween(const EntityMemoryConfig& config, double reach) {
  const double turned = config.submapHeading * reach;
  const double position = config.submapPosition * config.submapPosition + turned * turned;
  return Eigen::Vector4d(position, position, position, config.submapHeading * config.submapHeading).asDiagonal();
}

Vector4 vectorOf(const geometry::Pose3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  return {t.x(), t.y(), t.z(), geometry::yaw(pose)};
}

geometry::Pose3 poseOf(const Vector4& vector) {
  return geometry::toPose3({vector.x(), vector.y(), vector.w()}, vector.z());
}

Eigen::Matrix4d turned(const geometry::Pose3& T_a_b, const Eigen::Matrix4d& covariance_in_b) {
  Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
  rotation.topLeftCorner<3, 3>() = T_a_b.linear();
  return rotation * covariance_in_b * rotation.transpose();
}

Eigen::Matrix<double, 6, 6> covariance6(const Eigen::Matrix4d& covariance) {
  constexpr std::array<int, 4> kAxes = {0, 1, 2, 5};
  Eigen::Matrix<double, 6, 6> full = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      full(kAxes.at(static_cast<std::size_t>(i)), kAxes.at(static_cast<std::size_t>(j))) = covariance(i, j);
  }
  return full;
}

bool isCovariance(const Eigen::Matrix4d& covariance) {
  return covariance.allFinite() && covariance.isApprox(covariance.transpose(), 1e-6) &&
         Eigen::LLT<Eigen::Matrix4d>(covariance).info() == Eigen::Success;
}

}  // namespace prodomos::perception
