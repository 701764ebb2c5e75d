// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/floor_plane.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace prodomos::localization::rgbd {

namespace {

using geometry::Plane;
using geometry::Pose3;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLeastShare = 0.06;   ///< of what is known of the image
constexpr double kLeastSpread = 0.12;  ///< metres, standard deviation along the plane's shorter side

/// Noise of depth grows with its square, calibration errors with depth.
double tolerance(const Eigen::Vector3d& point_in_camera) {
  return 0.02 + 0.004 * point_in_camera.z() * point_in_camera.z();
}

std::vector<Eigen::Vector3d> thinned(const DepthGrid& depth) {
  constexpr int kStep = 2;  // cells
  std::vector<Eigen::Vector3d> points;
  for (int y = 0; y < depth.height(); y += kStep) {
    for (int x = 0; x < depth.width(); x += kStep) {
      if (const auto& cell = depth.at(x, y); cell.depth > 0.0F) points.push_back(pointOf(cell));
    }
  }
  return points;
}

bool isLarge(const std::vector<Eigen::Vector3d>& points, std::size_t known) {
  constexpr std::size_t kLeastPoints = 150;
  if (points.size() < std::max(kLeastPoints, static_cast<std::size_t>(kLeastShare * static_cast<double>(known)))) {
    return false;
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& point : points) scatter += (point - mean) * (point - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter / static_cast<double>(points.size()),
                                                            Eigen::EigenvaluesOnly);
  return axes.eigenvalues()(1) > kLeastSpread * kLeastSpread;
}

/// Surface elements of all views, in the world.
struct Surface {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  double noise;  ///< metres
};

std::vector<Surface> surfaces(std::span<const PosedDepth> views) {
  constexpr int kStep = 2;           // cells
  constexpr float kFurthest = 4.0F;  // metres; depths beyond are too long, and lift the floor
  std::vector<Surface> result;
  for (const auto& view : views) {
    for (int y = 0; y < view.depth->height(); y += kStep) {
      for (int x = 0; x < view.depth->width(); x += kStep) {
        const auto& cell = view.depth->at(x, y);
        if (cell.normalZ == 0.0F || cell.depth > kFurthest) continue;
        const Eigen::Vector3d point = pointOf(cell);
        result.push_back(
            {view.T_world_camera * point, view.T_world_camera.linear() * normalOf(cell), tolerance(point)});
      }
    }
  }
  return result;
}

/// The direction within 50° of `up` that most normals share: the best of all within a tenth of a radian, then the mean
/// of those about it. None where they are too few.
std::optional<Eigen::Vector3d> commonNormal(const std::vector<Surface>& all, const Eigen::Vector3d& up,
                                            std::size_t least) {
  constexpr double kMostTilt = 50.0 * kDegree;
  constexpr double kBin = 6.0 * kDegree;
  constexpr double kAlike = 8.0 * kDegree;
  constexpr int kRings = 8;
  const Eigen::Vector3d right = up.unitOrthogonal();
  const Eigen::Vector3d ahead = up.cross(right);
  std::vector<Eigen::Vector3d> candidates{up};
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int i = 0; i < 6 * ring; ++i) {
      const double tilt = ring * kBin;
      const double heading = 2.0 * std::numbers::pi * i / (6.0 * ring);
      candidates.push_back(std::cos(tilt) * up +
                           std::sin(tilt) * (std::cos(heading) * right + std::sin(heading) * ahead));
    }
  }
  std::vector<std::size_t> votes(candidates.size(), 0);
  for (const auto& surface : all) {
    if (surface.normal.dot(up) < std::cos(kMostTilt + kAlike)) continue;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      votes[i] += candidates[i].dot(surface.normal) > std::cos(kAlike) ? 1 : 0;
    }
  }
  const auto best = std::ranges::max_element(votes);
  if (*best < least) return std::nullopt;
  Eigen::Vector3d mean = candidates[static_cast<std::size_t>(best - votes.begin())];
  for (int round = 0; round < 5; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& surface : all) {
      if (surface.normal.dot(mean) > std::cos(kAlike)) sum += surface.normal;
    }
    mean = sum.normalized();
  }
  return mean.dot(up) > std::cos(kMostTilt) ? std::optional(mean) : std::nullopt;
}

/// Of the heights that level surfaces lie at, the lowest that is large and has next to nothing below it.
std::optional<double> lowestLevel(const std::vector<Surface>& all, const Eigen::Vector3d& up, double highest,
                                  std::size_t least) {
  constexpr double kBin = 0.05;     // metres
  constexpr double kDeepest = 3.0;  // metres under the cameras
  constexpr double kAlike = 10.0 * kDegree;
  constexpr double kBelow = 0.03;  // share of points that mirrors and noise may put below the floor
  const auto bins = static_cast<std::size_t>(kDeepest / kBin);
  std::vector<std::size_t> level(bins, 0);
  std::vector<std::size_t> any(bins, 0);
  std::size_t deeper = 0;
  for (const auto& surface : all) {
    const double under = highest - up.dot(surface.point);
    if (under < 0.0) continue;
    const auto bin = static_cast<std::size_t>(under / kBin);
    if (bin >= bins) {
      ++deeper;
      continue;
    }
    ++any[bin];
    level[bin] += surface.normal.dot(up) > std::cos(kAlike) ? 1 : 0;
  }
  const auto most = static_cast<std::size_t>(kBelow * static_cast<double>(all.size()));
  std::size_t below = deeper;
  for (std::size_t bin = bins - 1; bin > 0 && below <= most; --bin) {
    const std::size_t here = level[bin] + level[bin - 1];
    const bool isPeak = bin < 2 || level[bin - 2] <= level[bin];
    if (here >= least && isPeak) return highest - static_cast<double>(bin) * kBin;
    if (bin + 2 < bins) below += any[bin + 2];
  }
  return std::nullopt;
}

}  // namespace

std::optional<Plane> findFloor(std::span<const PosedDepth> views, const Eigen::Vector3d& up_in_world) {
  constexpr std::size_t kLeast = 250;  // surface elements of 8 x 8 pixels
  constexpr double kLeastHeight = 0.25;
  constexpr double kAlike = 15.0 * kDegree;
  const auto all = surfaces(views);
  const auto up = commonNormal(all, up_in_world.normalized(), kLeast);
  if (!up) return std::nullopt;
  double lowestCamera = up->dot(views.front().T_world_camera.translation());
  for (const auto& view : views) lowestCamera = std::min(lowestCamera, up->dot(view.T_world_camera.translation()));
  const auto height = lowestLevel(all, *up, lowestCamera - kLeastHeight, kLeast);
  if (!height) return std::nullopt;

  Plane plane{*up, *height};
  std::vector<Eigen::Vector3d> near;
  for (int round = 0; round < 4; ++round) {
    const double band = round == 0 ? 0.05 : 0.0;
    near.clear();
    for (const auto& surface : all) {
      if (surface.normal.dot(plane.normal) < std::cos(kAlike)) continue;
      if (std::abs(plane.signedDistance(surface.point)) < band + surface.noise) near.push_back(surface.point);
    }
    const auto fitted = geometry::fitPlane(near);
    if (!fitted) return std::nullopt;
    plane = fitted->normal.dot(*up) < 0.0 ? fitted->flipped() : *fitted;
  }
  if (!isLarge(near, 0) || plane.normal.dot(*up) < std::cos(kAlike)) return std::nullopt;
  return plane;
}

std::optional<Plane> confirmFloor(const DepthGrid& depth, const Pose3& T_world_camera) {
  constexpr double kMostOff = 0.1;  // metres
  constexpr double kMostTilt = 3.0 * kDegree;
  const auto points = thinned(depth);
  const Eigen::Vector3d up = T_world_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
  Plane plane{up, -T_world_camera.translation().z()};  // z = 0, in the camera
  std::vector<Eigen::Vector3d> near;
  for (int round = 0; round < 3; ++round) {  // from a wide band to the plane's own
    const double band = round == 0 ? kMostOff : 0.0;
    near.clear();
    for (const auto& point : points) {
      if (std::abs(plane.signedDistance(point)) < band + tolerance(point)) near.push_back(point);
    }
    const auto fitted = geometry::fitPlane(near);
    if (!fitted) return std::nullopt;
    plane = fitted->normal.dot(up) < 0.0 ? fitted->flipped() : *fitted;
  }
  if (!isLarge(near, points.size()) || plane.normal.dot(up) < std::cos(kMostTilt)) return std::nullopt;
  if (std::abs(T_world_camera.translation().z() + plane.offset) > kMostOff) return std::nullopt;
  return plane;
}

Pose3 poseOverFloor(const Eigen::Vector3d& up_in_camera, double height, const Eigen::Vector3d& ahead_in_camera) {
  const Eigen::Vector3d up = up_in_camera.normalized();
  Eigen::Vector3d ahead = ahead_in_camera - up.dot(ahead_in_camera) * up;
  if (ahead.norm() < 1e-3) ahead = up.unitOrthogonal();  // it looks straight down: any heading is as good
  ahead.normalize();
  Pose3 T_world_camera = Pose3::Identity();
  T_world_camera.linear().row(0) = ahead.transpose();
  T_world_camera.linear().row(1) = up.cross(ahead).transpose();
  T_world_camera.linear().row(2) = up.transpose();
  T_world_camera.translation().z() = height;
  return T_world_camera;
}

}  // namespace prodomos::localization::rgbd
