// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/plane.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>

namespace prodomos::geometry {

namespace {

Plane facing(const Plane& plane, const Eigen::Vector3d& side) {
  return plane.normal.dot(side) < 0.0 ? plane.flipped() : plane;
}

std::optional<Plane> throughThree(std::span<const Eigen::Vector3d> points, base::Random& random) {
  const int last = static_cast<int>(points.size()) - 1;
  const auto draw = [&]() -> const Eigen::Vector3d& {
    return points[static_cast<std::size_t>(random.integer(0, last))];
  };
  const Eigen::Vector3d& a = draw();
  const Eigen::Vector3d& b = draw();
  const Eigen::Vector3d& c = draw();
  const Eigen::Vector3d across = (b - a).cross(c - a);
  const double length = across.norm();
  if (!(length > 1e-9)) return std::nullopt;
  const Eigen::Vector3d normal = across / length;
  return Plane{normal, normal.dot(a)};
}

}  // namespace

std::optional<Plane> fitPlane(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 3) return std::nullopt;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& point : points) scatter += (point - mean) * (point - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);  // in ascending order
  if (!(axes.eigenvalues()(1) > 1e-12 * axes.eigenvalues()(2))) return std::nullopt;
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  return Plane{normal, normal.dot(mean)};
}

std::optional<FoundPlane> findPlane(std::span<const Eigen::Vector3d> points, const PlaneSearch& search,
                                    base::Random& random) {
  if (points.size() < 3) return std::nullopt;
  std::vector<double> tolerances(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) tolerances[i] = search.tolerance(points[i]);

  const auto inliersOf = [&](const Plane& plane) {
    std::vector<std::uint32_t> inliers;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(plane.signedDistance(points[i])) <= tolerances[i]) inliers.push_back(static_cast<std::uint32_t>(i));
    }
    return inliers;
  };

  std::optional<Plane> best;
  std::size_t bestCount = 2;
  for (int trial = 0; trial < search.trials; ++trial) {
    const auto plane = throughThree(points, random);
    if (!plane || !search.accepts(facing(*plane, search.facing))) continue;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      count += std::abs(plane->signedDistance(points[i])) <= tolerances[i] ? 1 : 0;
    }
    if (count <= bestCount) continue;
    bestCount = count;
    best = plane;
  }
  if (!best) return std::nullopt;

  FoundPlane found{facing(*best, search.facing), inliersOf(*best)};
  for (int round = 0; round < 2; ++round) {  // a better plane gathers more of its points
    std::vector<Eigen::Vector3d> chosen;
    chosen.reserve(found.inliers.size());
    for (const auto i : found.inliers) chosen.push_back(points[i]);
    const auto fitted = fitPlane(chosen);
    if (!fitted) break;
    const Plane turned = facing(*fitted, search.facing);
    auto inliers = inliersOf(turned);
    if (!search.accepts(turned) || inliers.size() < found.inliers.size()) break;
    found = {turned, std::move(inliers)};
  }
  return found;
}

}  // namespace prodomos::geometry
