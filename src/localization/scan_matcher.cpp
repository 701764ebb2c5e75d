// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/scan_matcher.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace prodomos::localization {

namespace {

// A heap of points, as thick as it is wide, tells a place but no line.
constexpr double kMostThickness = 0.5;  // of the extent
constexpr double kLeastExtent = 0.03;   // metres; less, and a line's direction is noise

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double squares = 0.0;
  double weights = 0.0;
  int onSurface = 0;
};

/// Of all points at one pose; deviations in the body's own axes.
NormalEquations linearize(std::span<const Eigen::Vector2d> points, const map::SurfaceLayer& surface,
                          const geometry::Pose2& pose, double noise, double outlier) {
  NormalEquations sum;
  const Eigen::Rotation2Dd R_map_body(pose.theta);
  const Eigen::Matrix2d rotation = R_map_body.toRotationMatrix();
  for (const auto& point : points) {
    const Eigen::Vector2d place = rotation * point + Eigen::Vector2d(pose.x, pose.y);
    const auto patch = surface.patchAt(place);
    if (!patch || patch->extent < kLeastExtent || patch->thickness > kMostThickness * patch->extent) continue;
    const double distance = patch->normal.dot(place - patch->mean);
    // Geman-McClure: of what is far from any surface, most is something else.
    const double ratio = distance / outlier;
    const double root = 1.0 / (1.0 + ratio * ratio);
    const double weight = root * root / (noise * noise);
    const Eigen::Vector2d normal_in_body = rotation.transpose() * patch->normal;
    const Eigen::Vector3d jacobian(normal_in_body.x(), normal_in_body.y(),
                                   normal_in_body.y() * point.x() - normal_in_body.x() * point.y());
    sum.information += weight * jacobian * jacobian.transpose();
    sum.gradient += weight * distance * jacobian;
    if (std::abs(distance) < outlier) {
      ++sum.onSurface;
      sum.squares += distance * distance;
    }
  }
  return sum;
}

/// Adds what the prior tells of the pose. Deviations from it are in its own axes; the body has turned since.
void addPrior(const PosePrior& prior, const geometry::Pose2& pose, NormalEquations& sum) {
  const auto deviation = geometry::inverse(prior.T_map_body) * pose;
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(deviation.theta).toRotationMatrix();
  sum.information += jacobian.transpose() * prior.information * jacobian;
  sum.gradient += jacobian.transpose() * prior.information * Eigen::Vector3d(deviation.x, deviation.y, deviation.theta);
}

}  // namespace

Match matchScan(std::span<const Eigen::Vector2d> points_in_body, const map::SurfaceLayer& surface,
                const PosePrior& prior, const ScanMatcherConfig& config) {
  Match match{.T_map_body = prior.T_map_body};
  double outlier = std::max(map::SurfaceLayer::kReach, config.outlier);
  for (int i = 0; i < config.iterations; ++i) {
    auto equations = linearize(points_in_body, surface, match.T_map_body, config.noise, outlier);
    match.information = equations.information;
    match.explained = equations.onSurface / static_cast<double>(std::max<std::size_t>(points_in_body.size(), 1));
    match.residual = equations.onSurface > 0 ? std::sqrt(equations.squares / equations.onSurface) : 0.0;

    addPrior(prior, match.T_map_body, equations);
    constexpr double kDamping = 1e-6;
    equations.information.diagonal().array() += kDamping;
    const Eigen::Vector3d step = -equations.information.ldlt().solve(equations.gradient);
    match.T_map_body = match.T_map_body * geometry::Pose2{step.x(), step.y(), step.z()};
    const bool isSettled = step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5;
    if (isSettled && outlier <= config.outlier) break;
    outlier = std::max(config.outlier, 0.7 * outlier);
  }
  return match;
}

}  // namespace prodomos::localization
