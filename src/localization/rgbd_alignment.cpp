// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/rgbd_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::localization::rgbd {

namespace {

using geometry::Pose3;

constexpr double kReprojectionGate = 4.0;  ///< pixels at the finest scale, beyond which a match is none
constexpr double kDepthGate = 5.0;         ///< standard deviations
constexpr int kLeastMatches = 12;

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Of three points each, in both frames.
Pose3 rigid(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  Pose3 T_to_from = Pose3::Identity();
  T_to_from.matrix() = Eigen::umeyama(from, to, false);
  return T_to_from;
}

/// Squared, in units of the gate; at least 1: an outlier.
double cost(const KeyPoint& reference, const KeyPoint& current, const Pose3& T_current_reference, double focalLength) {
  const Eigen::Vector3d point = T_current_reference * pointOf(reference);
  if (point.z() < 0.1) return 1.0;
  const double gate = kReprojectionGate * static_cast<double>(current.sigma) / focalLength;
  double squared = (point.head<2>() / point.z() - rayOf(current)).squaredNorm() / (gate * gate);
  if (current.depth > 0.0F) {
    const double off = (point.z() - static_cast<double>(current.depth)) /
                       (kDepthGate * (depthSigma(point.z()) + depthSigma(static_cast<double>(reference.depth))));
    squared = std::max(squared, off * off);
  }
  return squared;
}

/// Sums of weighted squares in the six freedoms of the camera, in its own axes.
struct NormalEquations {
  map::Matrix6 squares = map::Matrix6::Zero();
  Vector6 products = Vector6::Zero();

  void add(const Vector6& jacobian, double residual, double weight) {
    squares.noalias() += weight * jacobian * jacobian.transpose();
    products.noalias() += weight * residual * jacobian;
  }
  void operator*=(double weight) {
    squares *= weight;
    products *= weight;
  }
};

/// What the images say is less than it seems: blur, calibration and noise err alike in one place. So many measurements
/// are worth one (measured against motion capture: the squared errors in units of the covariance, which should be 1).
constexpr double kDependence = 10.0;

struct Counts {
  int inliers = 0;
  int known = 0;
};

/// Standard deviation of the difference of two depths, metres.
double depthNoise(double one, float other) {
  const double a = depthSigma(one);
  const double b = depthSigma(static_cast<double>(other));
  return std::sqrt(a * a + b * b);
}

/// Cauchy's weight of a residual in standard deviations.
double robustWeight(double squared) {
  constexpr double kScale = 2.0;
  return 1.0 / (1.0 + squared / (kScale * kScale));
}

Counts addMatches(const View& current, const Reference& reference, const Pose3& T_current_world, NormalEquations& sum) {
  Counts counts;
  const Pose3 T_current_reference = T_current_world * reference.T_world_camera;
  const double focal = current.camera.focalLength();
  for (const auto& match : reference.matches) {
    const KeyPoint& from = reference.view->points[match.reference];
    const KeyPoint& to = current.points[match.current];
    ++counts.known;
    if (!(from.depth > 0.0F) || cost(from, to, T_current_reference, focal) >= 1.0) continue;
    ++counts.inliers;
    const Eigen::Vector3d p = T_current_reference * pointOf(from);
    Eigen::Matrix<double, 3, 6> pointBy;  // p moves by -v + p x w when the camera moves by (v, w)
    pointBy << -Eigen::Matrix3d::Identity(), crossMatrix(p);
    const double inverse = 1.0 / p.z();
    const Eigen::Vector2d off = p.head<2>() * inverse - rayOf(to);
    const double sigma = static_cast<double>(to.sigma) / focal;
    const double weight = robustWeight(off.squaredNorm() / (sigma * sigma)) / (sigma * sigma);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector6 jacobian = inverse * (pointBy.row(axis) - p(axis) * inverse * pointBy.row(2)).transpose();
      sum.add(jacobian, off(axis), weight);
    }
    if (!(to.depth > 0.0F)) continue;
    const double depthOff = p.z() - static_cast<double>(to.depth);
    const double noise = depthNoise(p.z(), from.depth);
    const double depthWeight = robustWeight(depthOff * depthOff / (noise * noise)) / (noise * noise);
    sum.add(pointBy.row(2).transpose(), depthOff, depthWeight);
  }
  return counts;
}

/// Depths are smooth noise: so many neighbours count as one.
constexpr double kDepthsInOne = 10.0;
constexpr int kDepthStep = 2;  ///< cells of the current grid

Counts addDepths(const View& current, const Reference& reference, const Pose3& T_current_world, double gate,
                 NormalEquations& sum) {
  Counts counts;
  const Pose3 T_reference_current = (T_current_world * reference.T_world_camera).inverse();
  const Eigen::Matrix3d R_current_reference = T_reference_current.linear().transpose();
  for (int y = kDepthStep / 2; y < current.depth.height(); y += kDepthStep) {
    for (int x = kDepthStep / 2; x < current.depth.width(); x += kDepthStep) {
      const auto& cell = current.depth.at(x, y);
      if (!(cell.depth > 0.0F)) continue;
      const Eigen::Vector3d p = pointOf(cell);
      const Eigen::Vector3d p_in_reference = T_reference_current * p;
      const auto* seen = reference.view->depth.cellAt(p_in_reference);
      if (seen == nullptr || seen->normalZ == 0.0F) continue;
      // What lies behind what was seen from there may be new: it says nothing for or against the pose.
      const double hidden = p_in_reference.z() - static_cast<double>(seen->depth);
      const double noise = depthNoise(p.z(), seen->depth);
      if (hidden > gate + 0.1 + 3.0 * noise) continue;
      ++counts.known;
      const Eigen::Vector3d normal = normalOf(*seen);
      const double off = normal.dot(p_in_reference - pointOf(*seen));
      if (std::abs(off) > gate + 3.0 * noise) continue;
      ++counts.inliers;
      const Eigen::Vector3d n = R_current_reference * normal;
      Vector6 jacobian;
      jacobian << n, p.cross(n);
      const double weight = robustWeight(off * off / (noise * noise)) / (noise * noise * kDepthsInOne);
      sum.add(jacobian, off, weight);
    }
  }
  return counts;
}

Vector6 differenceOf(const Pose3& T_a_b) {
  const Eigen::AngleAxisd turn(T_a_b.linear());
  Vector6 difference;
  difference << T_a_b.translation(), turn.angle() * turn.axis();
  return difference;
}

void addBelief(const Belief& belief, const Pose3& T_world_camera, NormalEquations& sum) {
  const Vector6 off = differenceOf(belief.T_world_camera.inverse() * T_world_camera);
  const Vector6 weights = belief.sigma.cwiseAbs2().cwiseInverse();
  sum.squares.diagonal() += weights;
  sum.products += weights.cwiseProduct(off);
}

void addFloor(const FloorSeen& floor, const Pose3& T_world_camera, NormalEquations& sum) {
  const Eigen::Matrix3d& R_world_camera = T_world_camera.linear();
  const Eigen::Vector3d normal = R_world_camera * floor.plane_in_camera.normal;  // should be up
  const Eigen::Matrix3d normalBy = -R_world_camera * crossMatrix(floor.plane_in_camera.normal);
  for (int axis = 0; axis < 2; ++axis) {
    Vector6 jacobian = Vector6::Zero();
    jacobian.tail<3>() = normalBy.row(axis).transpose();
    sum.add(jacobian, normal(axis), 1.0 / (floor.tiltSigma * floor.tiltSigma));
  }
  // Height of the camera over the plane that it sees, against its height in the world.
  const double off = T_world_camera.translation().z() + floor.plane_in_camera.offset;
  Vector6 jacobian = Vector6::Zero();
  jacobian.head<3>() = R_world_camera.row(2).transpose();
  sum.add(jacobian, off, 1.0 / (floor.heightSigma * floor.heightSigma));
}

}  // namespace

double Alignment::quality() const {
  constexpr double kManyPoints = 100.0;
  return std::min(1.0, pointInliers / kManyPoints) + depthInliers;
}

bool Alignment::isConvincing() const {
  constexpr int kEnoughDepths = 400;
  if (depthCount < kEnoughDepths) return pointInliers >= 30;
  return (pointInliers >= 60 && depthInliers >= 0.5) || (pointInliers >= 20 && depthInliers >= 0.7) ||
         depthInliers >= 0.85;
}

Pose3 smallMotion(const Vector6& motion) {
  Pose3 T_before_after = Pose3::Identity();
  T_before_after.translation() = motion.head<3>();
  const double angle = motion.tail<3>().norm();
  if (angle > 0.0) T_before_after.linear() = Eigen::AngleAxisd(angle, motion.tail<3>() / angle).toRotationMatrix();
  return T_before_after;
}

std::optional<MatchedPose> poseFromMatches(const View& reference, const View& current, std::span<const Match> matches,
                                           base::Random& random) {
  std::vector<Match> both;  // with depth in both views: what poses are made of
  std::vector<Match> all;
  for (const auto& match : matches) {
    if (!(reference.points[match.reference].depth > 0.0F)) continue;
    all.push_back(match);
    if (current.points[match.current].depth > 0.0F) both.push_back(match);
  }
  if (both.size() < 3 || all.size() < static_cast<std::size_t>(kLeastMatches)) return std::nullopt;
  const double focal = current.camera.focalLength();
  const auto totalCost = [&](const Pose3& T_current_reference) {
    double total = 0.0;
    for (const auto& match : all) {
      total += std::min(
          1.0, cost(reference.points[match.reference], current.points[match.current], T_current_reference, focal));
    }
    return total;
  };
  constexpr int kTrials = 400;
  Pose3 best = Pose3::Identity();
  double least = totalCost(best);
  const int last = static_cast<int>(both.size()) - 1;
  int trials = kTrials;
  for (int trial = 0; trial < trials; ++trial) {
    Eigen::Matrix3d from;
    Eigen::Matrix3d to;
    for (int i = 0; i < 3; ++i) {
      const Match& match = both[static_cast<std::size_t>(random.integer(0, last))];
      from.col(i) = pointOf(reference.points[match.reference]);
      to.col(i) = pointOf(current.points[match.current]);
    }
    bool alike = true;  // a rigid motion keeps lengths
    for (int i = 0; i < 3; ++i) {
      const double before = (from.col(i) - from.col((i + 1) % 3)).norm();
      const double after = (to.col(i) - to.col((i + 1) % 3)).norm();
      alike = alike && before > 0.05 && std::abs(before - after) < 0.03 + 0.05 * before;
    }
    if (!alike) continue;
    const Pose3 T_current_reference = rigid(from, to);
    const double total = totalCost(T_current_reference);
    if (total >= least) continue;
    least = total;
    best = T_current_reference;
    const double share = 1.0 - least / static_cast<double>(all.size());
    const double needed = std::log(0.001) / std::log(1.0 - std::min(0.99, std::pow(share, 3)));
    trials = std::min(kTrials, std::max(30, static_cast<int>(needed) * 3));
  }
  int agree = 0;
  for (const auto& match : all) {
    agree += cost(reference.points[match.reference], current.points[match.current], best, focal) < 1.0 ? 1 : 0;
  }
  if (agree < kLeastMatches) return std::nullopt;
  return MatchedPose{best.inverse(), agree};
}

Alignment align(const View& current, std::span<const Reference> references, const Pose3& start, const Belief& belief,
                const std::optional<FloorSeen>& floor) {
  constexpr int kRounds = 12;
  constexpr double kWidestGate = 0.12;  // metres
  constexpr double kNarrowestGate = 0.03;
  Alignment result;
  result.T_world_camera = start;
  double gate = kWidestGate;
  for (int round = 0; round < kRounds; ++round) {
    const Pose3 T_camera_world = result.T_world_camera.inverse();
    NormalEquations sum;
    Counts points;
    Counts depths;
    for (const auto& reference : references) {
      const Counts matched = addMatches(current, reference, T_camera_world, sum);
      const Counts fallen = addDepths(current, reference, T_camera_world, gate, sum);
      points.inliers += matched.inliers;
      depths.inliers += fallen.inliers;
      depths.known += fallen.known;
    }
    sum *= 1.0 / kDependence;
    addBelief(belief, result.T_world_camera, sum);
    if (floor) addFloor(*floor, result.T_world_camera, sum);
    result.information = sum.squares;
    result.pointInliers = points.inliers;
    result.depthCount = depths.known;
    result.depthInliers = depths.known > 0 ? static_cast<double>(depths.inliers) / depths.known : 0.0;
    const Vector6 step = -sum.squares.ldlt().solve(sum.products);
    if (!step.allFinite()) break;
    result.T_world_camera = result.T_world_camera * smallMotion(step);
    const bool still = step.head<3>().norm() < 1e-4 && step.tail<3>().norm() < 1e-4;
    if (still && gate <= kNarrowestGate) break;
    gate = std::max(kNarrowestGate, 0.6 * gate);
  }
  return result;
}

double overlap(const View& current, const View& other, const Pose3& T_other_current) {
  constexpr int kStep = 8;  // cells
  int known = 0;
  int fallen = 0;
  for (int y = kStep / 2; y < current.depth.height(); y += kStep) {
    for (int x = kStep / 2; x < current.depth.width(); x += kStep) {
      const auto& cell = current.depth.at(x, y);
      if (!(cell.depth > 0.0F)) continue;
      ++known;
      const Eigen::Vector3d point = T_other_current * pointOf(cell);
      const auto* seen = other.depth.cellAt(point);
      if (seen == nullptr) continue;
      const double apart = std::abs(point.z() - static_cast<double>(seen->depth));
      fallen += apart < 0.1 + 3.0 * depthSigma(point.z()) ? 1 : 0;
    }
  }
  return known == 0 ? 0.0 : static_cast<double>(fallen) / known;
}

}  // namespace prodomos::localization::rgbd
