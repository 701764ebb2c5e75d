// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/rgbd_odometry.hpp"

#include "localization/floor_plane.hpp"
#include "localization/rgbd_alignment.hpp"
#include "localization/rgbd_keyframes.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace prodomos::localization {

using geometry::Pose3;
using rgbd::Alignment;
using rgbd::KeyFrame;
using rgbd::Vector6;
using rgbd::View;

namespace {

/// A frame says something only with so many corners, or so many known depths (cells of 4 x 4 pixels).
constexpr std::size_t kLeastPoints = 20;
constexpr std::size_t kLeastDepths = 400;

bool isUsable(const sensors::RgbdFrame& frame, const sensors::Mask* movers) {
  const auto& camera = frame.camera;
  const bool isPinhole = camera.fx > 0.0 && camera.fy > 0.0 && std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                         std::isfinite(camera.cx) && std::isfinite(camera.cy);
  if (!isPinhole || frame.depth.empty() || !geometry::isFinite(frame.T_body_camera)) return false;
  const auto fits = [&](const auto& image) {
    return image.empty() || (image.width() == frame.depth.width() && image.height() == frame.depth.height());
  };
  return fits(frame.color) && (movers == nullptr || fits(*movers));
}

/// Maps errors in one frame's own axes into those of another that is fixed to it (Barfoot 2017, eq. 7.37).
map::Matrix6 adjoint(const Pose3& T_to_from) {
  map::Matrix6 result = map::Matrix6::Zero();
  const Eigen::Vector3d& t = T_to_from.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  result.topLeftCorner<3, 3>() = T_to_from.linear();
  result.bottomRightCorner<3, 3>() = T_to_from.linear();
  result.topRightCorner<3, 3>() = cross * T_to_from.linear();
  return result;
}

/// The body's z-axis in the world.
Eigen::Vector3d upOf(const Pose3& T_world_camera, const Pose3& T_body_camera) {
  return T_world_camera.linear() * T_body_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
}

void savePose(base::ByteWriter& out, const Pose3& pose) {
  out.append(pose.matrix().data(), 16 * sizeof(double));
}
void loadPose(base::ByteReader& in, Pose3& pose) {
  in.take(pose.matrix().data(), 16 * sizeof(double));
}

}  // namespace

void describe(base::ConfigVisitor& visitor, RgbdOdometryConfig& config) {
  visitor.section("rgbd_odometry", "poses from RGB-D images");
  visitor.key("key_points", config.keyPoints, "", {50, 5000}, "corners looked for in each image");
  visitor.key("max_depth", config.maxDepth, "m", {0.5, 50.0}, "depths are used up to here");
  visitor.key("key_frames", config.keyFrames, "", {2, 500}, "key frames kept to be recognised again");
  visitor.key("references", config.references, "", {1, 20}, "key frames that a frame is aligned with at once");
  visitor.key("assumed_height", config.assumedHeight, "m", {0.0, 5.0},
              "of the camera over a floor that was not seen yet");
  visitor.key("level_frames", config.levelFrames, "", {1, 100000},
              "a floor first seen after so many frames no longer levels the world");
  visitor.key("seed", config.seed, "of all chance");
  visitor.endSection();
}

class RgbdOdometry::Implementation {
 public:
  explicit Implementation(const RgbdOdometryConfig& config) : config_(config), keyFrames_(config.keyFrames) {}

  Estimate track(base::Time time, const sensors::RgbdFrame& frame, const sensors::Mask* movers,
                 const std::optional<Pose3>& T_last_body);
  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  struct Found {
    Alignment alignment;
    std::size_t best = 0;  ///< index of the key frame that has most in common with the view
    double overlap = 0.0;  ///< how much, 0 … 1
  };

  View look(const sensors::RgbdFrame& frame, const sensors::Mask* movers) const;
  rgbd::Belief predict(base::Time time, const Pose3& T_body_camera, const std::optional<Pose3>& T_last_body) const;
  Estimate begin(base::Time time, View view, const Pose3& T_body_camera);
  std::optional<Pose3> guess(const View& view, const rgbd::Belief& belief) const;
  Found alignNear(const View& view, const Pose3& start, double radius, const rgbd::Belief& belief) const;
  std::optional<Found> find(const View& view, const rgbd::Belief& belief) const;
  Estimate lost(base::Time time, const rgbd::Belief& belief, const Pose3& T_body_camera);
  std::optional<Pose3> level();

  RgbdOdometryConfig config_;
  rgbd::KeyFrames keyFrames_;
  std::size_t lastReference_ = 0;
  std::uint64_t frames_ = 0;
  int lostFrames_ = 0;
  bool isLevelled_ = false;
  Pose3 T_world_first_ = Pose3::Identity();  ///< of the first camera
  Eigen::Vector3d ahead_in_first_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up_in_world_ = Eigen::Vector3d::Zero();  ///< sum of where the body's up pointed to
  base::Time lastTime_{};
  Pose3 T_world_last_ = Pose3::Identity();  ///< of the camera
  double lastInterval_ = 0.0;               ///< seconds; 0: there is no speed to go on with
  Vector6 lastMotion_ = Vector6::Zero();    ///< of the camera in that interval, in its own axes
  map::Matrix6 lastCovariance_ = map::Matrix6::Zero();
};

View RgbdOdometry::Implementation::look(const sensors::RgbdFrame& frame, const sensors::Mask* movers) const {
  const sensors::Mask* masked = movers != nullptr && !movers->empty() ? movers : nullptr;
  View view;
  view.camera = rgbd::Camera(frame.camera, frame.depth.width(), frame.depth.height());
  view.points = rgbd::findKeyPoints(view.camera, frame, masked, config_.keyPoints, config_.maxDepth);
  view.depth = rgbd::DepthGrid(view.camera, frame.depth, masked, config_.maxDepth);
  return view;
}

/// Where the camera must be now, and how sure that is.
rgbd::Belief RgbdOdometry::Implementation::predict(base::Time time, const Pose3& T_body_camera,
                                                   const std::optional<Pose3>& T_last_body) const {
  constexpr double kLongGap = 1.0;       // seconds, after which speed says nothing
  constexpr double kLeastSigma = 0.05;   // metres or radians
  constexpr double kSigmaASecond = 1.0;  // metres or radians
  constexpr double kOdometrySigma = 0.03;
  rgbd::Belief belief;
  const double interval = std::max(0.0, base::seconds(time - lastTime_));
  if (T_last_body && geometry::isFinite(*T_last_body)) {
    const Pose3 T_lastCamera_camera = T_body_camera.inverse() * *T_last_body * T_body_camera;
    belief.T_world_camera = T_world_last_ * T_lastCamera_camera;
    const double moved = T_last_body->translation().norm() + geometry::rotationAngle(*T_last_body);
    belief.sigma.setConstant(kOdometrySigma + 0.1 * moved);
    return belief;
  }
  const bool hasSpeed = lastInterval_ > 0.0 && interval < kLongGap && lostFrames_ == 0;
  belief.T_world_camera =
      hasSpeed ? Pose3(T_world_last_ * rgbd::smallMotion(lastMotion_ * (interval / lastInterval_))) : T_world_last_;
  belief.sigma.setConstant(kLeastSigma + kSigmaASecond * std::min(interval, 10.0));
  return belief;
}

RgbdOdometry::Estimate RgbdOdometry::Implementation::begin(base::Time time, View view, const Pose3& T_body_camera) {
  const Eigen::Vector3d up = T_body_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
  ahead_in_first_ = T_body_camera.linear().transpose() * Eigen::Vector3d::UnitX();
  const double mounted = T_body_camera.translation().z();
  const double height = mounted > 0.05 ? mounted : config_.assumedHeight;  // a body whose origin is on the floor
  T_world_first_ = rgbd::poseOverFloor(up, height, ahead_in_first_);
  T_world_last_ = T_world_first_;
  up_in_world_ = upOf(T_world_first_, T_body_camera);
  lastTime_ = time;
  Estimate estimate;
  if (view.depth.known() < kLeastDepths) {
    estimate.isLost = true;
  } else {
    view.depth.computeNormals();
    keyFrames_.add({frames_, std::move(view), T_world_first_});
    level();
  }
  estimate.isLevelled = isLevelled_;
  estimate.T_world_body = T_world_last_ * T_body_camera.inverse();
  estimate.covariance = map::Matrix6::Identity() * 1e-6;
  return estimate;
}

/// Levels the world by the floor that the key frames have seen so far, in the first frames only: gives T_new_old.
std::optional<Pose3> RgbdOdometry::Implementation::level() {
  constexpr double kLeastChange = 0.01;  // metres, radians
  if (frames_ > static_cast<std::uint64_t>(config_.levelFrames)) return std::nullopt;
  constexpr std::size_t kViews = 12;  // enough of them, the latest
  std::vector<rgbd::PosedDepth> views;
  for (std::size_t i = keyFrames_.size() - std::min(kViews, keyFrames_.size()); i < keyFrames_.size(); ++i) {
    views.push_back({&keyFrames_[i].view.depth, keyFrames_[i].T_world_camera});
  }
  const auto floor = rgbd::findFloor(views, up_in_world_);
  if (!floor) return std::nullopt;
  const Eigen::Vector3d up_in_first = T_world_first_.linear().transpose() * floor->normal;
  const Pose3 T_new_first =
      rgbd::poseOverFloor(up_in_first, floor->signedDistance(T_world_first_.translation()), ahead_in_first_);
  const Pose3 T_new_old = T_new_first * T_world_first_.inverse();
  const bool wasLevelled = std::exchange(isLevelled_, true);
  const double change = std::max(T_new_old.translation().norm(), geometry::rotationAngle(T_new_old));
  if (wasLevelled && change < kLeastChange) return std::nullopt;
  keyFrames_.transform(T_new_old);
  T_world_first_ = T_new_first;
  T_world_last_ = T_new_old * T_world_last_;
  up_in_world_ = T_new_old.linear() * up_in_world_;
  return T_new_old;
}

/// From key points alone, however far from what was expected.
std::optional<Pose3> RgbdOdometry::Implementation::guess(const View& view, const rgbd::Belief& belief) const {
  constexpr std::size_t kTried = 4;
  constexpr std::size_t kTriedWhenLost = 12;
  constexpr int kBeyondDoubt = 80;
  const std::size_t tried = std::min(keyFrames_.size(), lostFrames_ > 0 ? kTriedWhenLost : kTried);
  const auto order = keyFrames_.nearestFirst(view, belief.T_world_camera, lastReference_);
  base::Random random(config_.seed + 0x9e3779b97f4a7c15U * (frames_ + 1));
  std::optional<Pose3> best;
  int most = 0;
  for (std::size_t i = 0; i < tried && most < kBeyondDoubt; ++i) {
    const KeyFrame& key = keyFrames_[order[i]];
    const auto matches = rgbd::matchAnywhere(key.view.points, view.points);
    const auto pose = rgbd::poseFromMatches(key.view, view, matches, random);
    if (!pose || pose->inliers <= most) continue;
    most = pose->inliers;
    best = key.T_world_camera * pose->T_reference_current;
  }
  return best;
}

/// Against the key frames that have most in common with what is seen, if the camera is near `start`.
RgbdOdometry::Implementation::Found RgbdOdometry::Implementation::alignNear(const View& view, const Pose3& start,
                                                                            double radius,
                                                                            const rgbd::Belief& belief) const {
  constexpr double kLeastOverlap = 0.3;
  Found found;
  std::vector<rgbd::Reference> references;
  for (const auto& [index, share] : keyFrames_.byOverlap(view, start)) {
    if (references.size() == static_cast<std::size_t>(config_.references)) break;
    if (share < kLeastOverlap && !references.empty()) break;
    const KeyFrame& key = keyFrames_[index];
    if (references.empty()) {
      found.best = index;
      found.overlap = share;
    }
    auto matches =
        rgbd::matchNear(key.view.points, view.points, start.inverse() * key.T_world_camera, view.camera, radius);
    references.push_back({&key.view, key.T_world_camera, std::move(matches)});
  }
  std::optional<rgbd::FloorSeen> floor;
  if (isLevelled_) {
    if (const auto plane = rgbd::confirmFloor(view.depth, start)) floor = rgbd::FloorSeen{*plane};
  }
  found.alignment = rgbd::align(view, references, start, belief, floor);
  return found;
}

std::optional<RgbdOdometry::Implementation::Found> RgbdOdometry::Implementation::find(
    const View& view, const rgbd::Belief& belief) const {
  constexpr double kRadius = 12.0;      // pixels, around where the key points put it
  constexpr double kWideRadius = 40.0;  // around where it was expected
  constexpr double kBeyondDoubt = 1.5;  // of at most 2
  std::optional<Found> found;
  if (const auto start = guess(view, belief)) found = alignNear(view, *start, kRadius, belief);
  const bool isExpected = lostFrames_ == 0;  // a place that was lost is not found by surfaces alone
  if (isExpected && (!found || found->alignment.quality() < kBeyondDoubt)) {
    auto other = alignNear(view, belief.T_world_camera, kWideRadius, belief);
    if (!found || other.alignment.quality() > found->alignment.quality()) found = std::move(other);
  }
  if (!found || !found->alignment.isConvincing()) return std::nullopt;
  return found;
}

RgbdOdometry::Estimate RgbdOdometry::Implementation::lost(base::Time time, const rgbd::Belief& belief,
                                                          const Pose3& T_body_camera) {
  ++lostFrames_;
  T_world_last_ = belief.T_world_camera;
  lastTime_ = time;
  lastInterval_ = 0.0;
  lastCovariance_.setZero();
  Estimate estimate;
  estimate.isLost = true;
  estimate.isLevelled = isLevelled_;
  estimate.T_world_body = T_world_last_ * T_body_camera.inverse();
  const map::Matrix6 toBody = adjoint(T_body_camera);
  estimate.covariance = toBody * belief.sigma.cwiseAbs2().asDiagonal() * toBody.transpose();
  return estimate;
}

RgbdOdometry::Estimate RgbdOdometry::Implementation::track(base::Time time, const sensors::RgbdFrame& frame,
                                                           const sensors::Mask* movers,
                                                           const std::optional<Pose3>& T_last_body) {
  const Pose3& T_body_camera = frame.T_body_camera;
  const std::uint64_t number = frames_;
  const rgbd::Belief belief = predict(time, T_body_camera, T_last_body);
  if (!isUsable(frame, movers)) {
    return lost(time, belief, T_body_camera);
  }
  View view = look(frame, movers);
  if (keyFrames_.empty()) {
    auto estimate = begin(time, std::move(view), T_body_camera);
    ++frames_;
    return estimate;
  }
  ++frames_;
  if (view.points.size() < kLeastPoints && view.depth.known() < kLeastDepths) return lost(time, belief, T_body_camera);
  const auto found = find(view, belief);
  if (!found) return lost(time, belief, T_body_camera);

  const Pose3 T_last_camera = T_world_last_.inverse() * found->alignment.T_world_camera;
  const Eigen::AngleAxisd turn(T_last_camera.linear());
  lastInterval_ = lostFrames_ == 0 ? std::max(0.0, base::seconds(time - lastTime_)) : 0.0;
  lastMotion_ << T_last_camera.translation(), turn.angle() * turn.axis();
  lastTime_ = time;
  T_world_last_ = found->alignment.T_world_camera;
  lastReference_ = found->best;
  up_in_world_ += upOf(T_world_last_, T_body_camera);
  lostFrames_ = 0;
  Estimate estimate;
  const map::Matrix6 covariance = found->alignment.information.ldlt().solve(map::Matrix6::Identity());
  const map::Matrix6 back = adjoint(T_last_camera.inverse());
  const map::Matrix6 step = covariance + back * lastCovariance_ * back.transpose();
  const map::Matrix6 toBody = adjoint(T_body_camera);
  estimate.covariance = toBody * step * toBody.transpose();
  lastCovariance_ = covariance;

  constexpr double kNewKeyFrame = 0.75;
  constexpr double kGood = 0.9;  // what came out blurred or doubtful is nothing to align with
  if (found->overlap < kNewKeyFrame && found->alignment.quality() > kGood && view.depth.known() >= kLeastDepths) {
    view.depth.computeNormals();
    keyFrames_.add({number, std::move(view), T_world_last_});
    lastReference_ = keyFrames_.size() - 1;
    estimate.T_world_before = level();
  }
  estimate.isLevelled = isLevelled_;
  estimate.T_world_body = T_world_last_ * T_body_camera.inverse();
  return estimate;
}

void RgbdOdometry::Implementation::save(base::ByteWriter& out) const {
  keyFrames_.save(out);
  out << static_cast<std::uint64_t>(lastReference_) << frames_ << lostFrames_ << isLevelled_;
  savePose(out, T_world_first_);
  out.append(ahead_in_first_.data(), 3 * sizeof(double));
  out.append(up_in_world_.data(), 3 * sizeof(double));
  out << base::toNanoseconds(lastTime_);
  savePose(out, T_world_last_);
  out << lastInterval_;
  out.append(lastMotion_.data(), 6 * sizeof(double));
  out.append(lastCovariance_.data(), 36 * sizeof(double));
}

void RgbdOdometry::Implementation::load(base::ByteReader& in) {
  keyFrames_.load(in);
  lastReference_ = static_cast<std::size_t>(in.read<std::uint64_t>());
  in >> frames_ >> lostFrames_ >> isLevelled_;
  loadPose(in, T_world_first_);
  in.take(ahead_in_first_.data(), 3 * sizeof(double));
  in.take(up_in_world_.data(), 3 * sizeof(double));
  lastTime_ = base::fromNanoseconds(in.read<std::int64_t>());
  loadPose(in, T_world_last_);
  in >> lastInterval_;
  in.take(lastMotion_.data(), 6 * sizeof(double));
  in.take(lastCovariance_.data(), 36 * sizeof(double));
}

RgbdOdometry::RgbdOdometry(const RgbdOdometryConfig& config)
    : implementation_(std::make_unique<Implementation>(config)) {}
RgbdOdometry::~RgbdOdometry() = default;
RgbdOdometry::RgbdOdometry(RgbdOdometry&&) noexcept = default;
RgbdOdometry& RgbdOdometry::operator=(RgbdOdometry&&) noexcept = default;

RgbdOdometry::Estimate RgbdOdometry::track(base::Time time, const sensors::RgbdFrame& frame,
                                           const sensors::Mask* movers, const std::optional<Pose3>& T_last_body) {
  return implementation_->track(time, frame, movers, T_last_body);
}

void RgbdOdometry::save(base::ByteWriter& out) const {
  implementation_->save(out);
}

void RgbdOdometry::load(base::ByteReader& in) {
  implementation_->load(in);
}

}  // namespace prodomos::localization
