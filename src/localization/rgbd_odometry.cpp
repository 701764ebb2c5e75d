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
  rgbd::Belief predict(base::Time time, const std::optional<Pose3>& T_last_body) const;
  Estimate begin(base::Time time, View view);
  std::optional<Pose3> guess(const View& view, const rgbd::Belief& belief) const;
  Found alignNear(const View& view, const Pose3& start, double radius, const rgbd::Belief& belief) const;
  std::optional<Found> find(const View& view, const rgbd::Belief& belief) const;
  Estimate accept(base::Time time, const Found& found);
  Estimate lost(base::Time time, const rgbd::Belief& belief);
  void beginAgain(View view, const Pose3& T_world_camera);
  std::optional<Pose3> level();

  RgbdOdometryConfig config_;
  rgbd::KeyFrames keyFrames_;
  std::size_t lastReference_ = 0;
  std::uint64_t frames_ = 0;
  int lostFrames_ = 0;    ///< since the pose was known last
  int unrecognized_ = 0;  ///< of these, those that show something
  bool isLevelled_ = false;
  Pose3 T_world_first_ = Pose3::Identity();  ///< of the first camera
  Eigen::Vector3d ahead_in_first_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up_in_world_ = Eigen::Vector3d::Zero();  ///< sum of where the body's up pointed to
  base::Time lastTime_{};
  Pose3 T_body_camera_ = Pose3::Identity();             ///< of the last usable frame
  Pose3 T_world_last_ = Pose3::Identity();              ///< of the body
  double lastInterval_ = 0.0;                           ///< seconds; 0: there is no speed to go on with
  Vector6 lastMotion_ = Vector6::Zero();                ///< of the body in that interval, in its own axes
  map::Matrix6 lastCovariance_ = map::Matrix6::Zero();  ///< of the last pose against the key frames, body axes
};

View RgbdOdometry::Implementation::look(const sensors::RgbdFrame& frame, const sensors::Mask* movers) const {
  const sensors::Mask* masked = movers != nullptr && !movers->empty() ? movers : nullptr;
  View view;
  view.camera = rgbd::Camera(frame.camera, frame.depth.width(), frame.depth.height());
  view.points = rgbd::findKeyPoints(view.camera, frame, masked, config_.keyPoints, config_.maxDepth);
  const auto* earlier = keyFrames_.empty() ? nullptr : &keyFrames_[keyFrames_.size() - 1].view.depth;
  view.depth = rgbd::DepthGrid(view.camera, frame.depth, masked, config_.maxDepth, earlier);
  return view;
}

/// Where the camera must be now, and how sure that is.
rgbd::Belief RgbdOdometry::Implementation::predict(base::Time time, const std::optional<Pose3>& T_last_body) const {
  constexpr double kLongGap = 1.0;       // seconds, after which speed says nothing
  constexpr double kLeastSigma = 0.05;   // metres or radians
  constexpr double kSigmaASecond = 1.0;  // metres or radians
  constexpr double kOdometrySigma = 0.03;
  constexpr double kOdometryShare = 0.1;
  rgbd::Belief belief;
  if (T_last_body && geometry::isFinite(*T_last_body)) {
    belief.T_world_camera = T_world_last_ * *T_last_body * T_body_camera_;
    const double moved = T_last_body->translation().norm() + geometry::rotationAngle(*T_last_body);
    belief.sigma.setConstant(kOdometrySigma + kOdometryShare * moved);
    return belief;
  }
  const double interval = std::max(0.0, base::seconds(time - lastTime_));
  const bool hasSpeed = lastInterval_ > 0.0 && interval < kLongGap && lostFrames_ == 0;
  const Vector6 motion = hasSpeed ? Vector6(lastMotion_ * (interval / lastInterval_)) : Vector6(Vector6::Zero());
  belief.T_world_camera = T_world_last_ * rgbd::smallMotion(motion) * T_body_camera_;
  belief.sigma.setConstant(kLeastSigma + kSigmaASecond * std::min(interval, 10.0));
  return belief;
}

/// The first frame that is of any use.
RgbdOdometry::Estimate RgbdOdometry::Implementation::begin(base::Time time, View view) {
  const Eigen::Vector3d up = T_body_camera_.linear().transpose() * Eigen::Vector3d::UnitZ();
  ahead_in_first_ = T_body_camera_.linear().transpose() * Eigen::Vector3d::UnitX();
  constexpr double kMounted = 0.05;  // metres, from which on the body's origin must be on the floor
  const double mounted = T_body_camera_.translation().z();
  T_world_first_ = rgbd::poseOverFloor(up, mounted > kMounted ? mounted : config_.assumedHeight, ahead_in_first_);
  T_world_last_ = T_world_first_ * T_body_camera_.inverse();
  up_in_world_ = T_world_last_.linear().col(2);
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
  estimate.T_world_body = T_world_last_;
  estimate.covariance = map::Matrix6::Identity() * 1e-6;  // it is where the world is
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

RgbdOdometry::Estimate RgbdOdometry::Implementation::lost(base::Time time, const rgbd::Belief& belief) {
  ++lostFrames_;
  T_world_last_ = belief.T_world_camera * T_body_camera_.inverse();
  lastTime_ = time;
  lastInterval_ = 0.0;
  lastCovariance_.setZero();
  Estimate estimate;
  estimate.isLost = true;
  estimate.isLevelled = isLevelled_;
  estimate.T_world_body = T_world_last_;
  const map::Matrix6 toBody = geometry::adjoint(T_body_camera_);
  estimate.covariance = toBody * belief.sigma.cwiseAbs2().asDiagonal() * toBody.transpose();
  return estimate;
}

/// Recognises nothing for so long that this must be another place: goes on from where it is believed to be.
void RgbdOdometry::Implementation::beginAgain(View view, const Pose3& T_world_camera) {
  keyFrames_.clear();
  view.depth.computeNormals();
  keyFrames_.add({frames_, std::move(view), T_world_camera});
  lastReference_ = 0;
  lostFrames_ = 0;
  unrecognized_ = 0;
}

/// Takes over a pose that was found: the step since the last one, and its covariance.
RgbdOdometry::Estimate RgbdOdometry::Implementation::accept(base::Time time, const Found& found) {
  const Pose3 T_world_body = found.alignment.T_world_camera * T_body_camera_.inverse();
  const Pose3 T_last_body = T_world_last_.inverse() * T_world_body;
  const Eigen::AngleAxisd turn(T_last_body.linear());
  lastInterval_ = lostFrames_ == 0 ? std::max(0.0, base::seconds(time - lastTime_)) : 0.0;
  lastMotion_ << T_last_body.translation(), turn.angle() * turn.axis();
  lastTime_ = time;
  T_world_last_ = T_world_body;
  lastReference_ = found.best;
  up_in_world_ += T_world_body.linear().col(2);
  lostFrames_ = 0;
  unrecognized_ = 0;
  const map::Matrix6 toBody = geometry::adjoint(T_body_camera_);
  const map::Matrix6 covariance =
      toBody * found.alignment.information.ldlt().solve(map::Matrix6::Identity()) * toBody.transpose();
  const map::Matrix6 back = geometry::adjoint(T_last_body.inverse());
  Estimate estimate;
  estimate.covariance = covariance + back * lastCovariance_ * back.transpose();
  lastCovariance_ = covariance;
  return estimate;
}

RgbdOdometry::Estimate RgbdOdometry::Implementation::track(base::Time time, const sensors::RgbdFrame& frame,
                                                           const sensors::Mask* movers,
                                                           const std::optional<Pose3>& T_last_body) {
  const bool usable = isUsable(frame, movers);
  if (usable) T_body_camera_ = frame.T_body_camera;
  const rgbd::Belief belief = predict(time, T_last_body);
  if (!usable) return lost(time, belief);
  View view = look(frame, movers);
  ++frames_;
  if (keyFrames_.empty()) return begin(time, std::move(view));
  const bool isSurface = view.depth.known() >= kLeastDepths;
  if (view.points.size() < kLeastPoints && !isSurface) return lost(time, belief);

  const auto found = find(view, belief);
  if (!found) {
    constexpr int kLostForGood = 10;  // frames
    auto estimate = lost(time, belief);
    if (++unrecognized_ >= kLostForGood && isSurface) beginAgain(std::move(view), belief.T_world_camera);
    return estimate;
  }
  Estimate estimate = accept(time, *found);
  constexpr double kNewKeyFrame = 0.75;
  constexpr double kGood = 0.9;  // what came out blurred or doubtful is nothing to align with
  if (isSurface && found->overlap < kNewKeyFrame && found->alignment.quality() > kGood) {
    view.depth.computeNormals();
    keyFrames_.add({frames_, std::move(view), found->alignment.T_world_camera});
    lastReference_ = keyFrames_.size() - 1;
    estimate.T_world_before = level();
  }
  estimate.isLevelled = isLevelled_;
  estimate.T_world_body = T_world_last_;
  return estimate;
}

void RgbdOdometry::Implementation::save(base::ByteWriter& out) const {
  keyFrames_.save(out);
  out << static_cast<std::uint64_t>(lastReference_) << frames_ << lostFrames_ << unrecognized_ << isLevelled_;
  savePose(out, T_world_first_);
  out.append(ahead_in_first_.data(), 3 * sizeof(double));
  out.append(up_in_world_.data(), 3 * sizeof(double));
  out << base::toNanoseconds(lastTime_);
  savePose(out, T_body_camera_);
  savePose(out, T_world_last_);
  out << lastInterval_;
  out.append(lastMotion_.data(), 6 * sizeof(double));
  out.append(lastCovariance_.data(), 36 * sizeof(double));
}

void RgbdOdometry::Implementation::load(base::ByteReader& in) {
  keyFrames_.load(in);
  lastReference_ = static_cast<std::size_t>(in.read<std::uint64_t>());
  in >> frames_ >> lostFrames_ >> unrecognized_ >> isLevelled_;
  loadPose(in, T_world_first_);
  in.take(ahead_in_first_.data(), 3 * sizeof(double));
  in.take(up_in_world_.data(), 3 * sizeof(double));
  lastTime_ = base::fromNanoseconds(in.read<std::int64_t>());
  loadPose(in, T_body_camera_);
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
