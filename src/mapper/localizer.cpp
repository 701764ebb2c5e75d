// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/localizer.hpp"

#include "prodomos/io/trajectory_file.hpp"
#include "prodomos/map/level_beams.hpp"

#include "mapper/graph_bytes.hpp"

#include <cmath>

namespace prodomos::mapper {

namespace {

// A log may tell all its poses before its first scan, or poses alone for hours: so many are kept.
constexpr std::size_t kMostPoses = 100'000;

constexpr double kLeastSigma = 1e-3;  // metres, radians, after a metre; nothing is known better

/// Of a motion in the plane: up, roll and pitch are as good as known.
map::Matrix6 lifted(const Eigen::Matrix3d& planar, double way) {
  map::Matrix6 covariance = map::Matrix6::Identity() * (kLeastSigma * kLeastSigma * way);
  covariance(geometry::kPlanarAxes, geometry::kPlanarAxes) += planar;
  return covariance;
}

}  // namespace

Localizer::Origin Localizer::originOf(const InputConfig& config, const sensors::SourceInfo& log) {
  if (config.poses == "estimated") return Origin::kEstimated;
  if (config.poses == "odometry") return Origin::kOdometry;
  if (config.poses == "recorded") return Origin::kRecorded;
  if (config.poses == "auto") return log.hasRecordedPoses ? Origin::kRecorded : Origin::kEstimated;
  return Origin::kFile;
}

Localizer::Localizer(const MapperConfig& config, const sensors::SourceInfo& log)
    : origin_(originOf(config.input, log)),
      poseGap_(config.input.poseGap),
      noise_(config.odometryNoise),
      heightBand_(config.layers.grid.heightBand),
      maxRange_(config.laserOdometry.maxRange),
      laser_(config.laserOdometry),
      rgbd_(config.rgbdOdometry) {
  switch (origin_) {
    case Origin::kEstimated:
      name_ = "estimated";
      break;
    case Origin::kOdometry:
      name_ = "odometry";
      break;
    case Origin::kRecorded:
      name_ = "recorded";
      break;
    case Origin::kFile:
      name_ = config.input.poses;
      for (const auto& pose : io::readTrajectory(config.input.poses)) track_.add(pose.time, pose.T_world_body);
  }
}

bool Localizer::isPose(const sensors::Reading& reading) {
  return std::holds_alternative<sensors::Odometry>(reading.data) ||
         std::holds_alternative<sensors::RecordedPose>(reading.data);
}

std::string Localizer::take(const sensors::Reading& reading) {
  const auto* odometry = std::get_if<sensors::Odometry>(&reading.data);
  const bool isWanted = odometry != nullptr ? origin_ == Origin::kOdometry || origin_ == Origin::kEstimated
                                            : origin_ == Origin::kRecorded;
  if (!isWanted) return std::string(kindName(reading.data)) + " not asked for";
  const auto& pose =
      odometry != nullptr ? odometry->T_odom_body : std::get<sensors::RecordedPose>(reading.data).T_world_body;
  if (!geometry::isFinite(pose)) return "pose is not finite";
  track_.add(reading.time, pose);
  track_.forgetAllBut(kMostPoses);
  return {};
}

Localizer::Followed Localizer::kindOf(const sensors::Reading& reading) {
  if (std::holds_alternative<sensors::LaserScan>(reading.data)) return Followed::kLaser;
  if (std::holds_alternative<sensors::PointCloud>(reading.data)) return Followed::kCloud;
  const auto* frame = std::get_if<sensors::RgbdFrame>(&reading.data);
  return frame != nullptr && !frame->depth.empty() ? Followed::kRgbd : Followed::kNothing;
}

bool Localizer::isFollowed(const sensors::Reading& reading) const {
  return !isEstimated() || (reading.sensor == sensor_ && kindOf(reading) == followed_);
}

/// Lasers tell poses best; the choice stays once the first reading has been located.
void Localizer::expect(const sensors::Reading& reading) {
  if (hasLocated_ || kindOf(reading) <= followed_) return;
  followed_ = kindOf(reading);
  sensor_ = reading.sensor;
}

bool Localizer::awaits(base::Time time) const {
  if (origin_ == Origin::kEstimated && hasLocated_ && track_.empty()) return false;  // there is no odometry
  return !track_.reaches(time);
}

std::optional<Localizer::Located> Localizer::locate(const sensors::Reading& reading, const sensors::Mask* movers) {
  auto located = isEstimated() ? std::optional(estimate(reading, movers)) : follow(reading.time);
  if (!located || !isFollowed(reading)) return located;
  if (hasLocated_) velocity_ = velocityOver(T_travel_last_.inverse() * located->T_travel_body, reading.time);
  hasLocated_ = true;
  lastTime_ = reading.time;
  T_travel_last_ = located->T_travel_body;
  return located;
}

/// The poses that are told.
std::optional<Localizer::Located> Localizer::follow(base::Time time) {
  // Wheels that stand still may say nothing, and a robot without odometry stays where it is; other poses have gaps.
  if (origin_ != Origin::kOdometry) {
    const auto gap = track_.distanceTo(time);
    if (!gap || base::seconds(*gap) > poseGap_) return std::nullopt;
  }
  Located located{.T_travel_body = track_.at(time)};
  if (hasLocated_) located.covariance = wheelNoise(T_travel_last_.inverse() * located.T_travel_body);
  return located;
}

Localizer::Located Localizer::estimate(const sensors::Reading& reading, const sensors::Mask* movers) {
  if (isFollowed(reading))
    return followed_ == Followed::kRgbd ? trackRgbd(reading, movers) : trackLaser(reading, movers);
  // Other sensors' readings come between: as the wheels tell, or where the robot was just before.
  return {.T_travel_body = T_travel_last_ * stepOfWheels(reading.time).value_or(geometry::Pose3::Identity())};
}

Localizer::Located Localizer::trackLaser(const sensors::Reading& reading, const sensors::Mask* movers) {
  const auto step = stepOfWheels(reading.time);
  // As fast as the wheels say; without, as fast as before.
  const Eigen::Vector3d velocity = step ? velocityOver(*step, reading.time) : velocity_;
  std::vector<map::OccupancyGrid::Beam> beams;
  const auto origin =
      map::appendLevelBeams({.reading = reading, .velocity = velocity, .movers = movers}, heightBand_, beams);
  std::vector<Eigen::Vector2d> points_in_body;
  for (const auto& beam : beams) {
    if (beam.hit && (beam.end - *origin).norm() <= maxRange_) points_in_body.push_back(beam.end);
  }
  const auto estimate = laser_.track(points_in_body, step ? std::optional(geometry::toPose2(*step)) : std::nullopt);
  lost_ += estimate.isLost ? 1 : 0;
  Located located{.T_travel_body = geometry::toPose3(estimate.T_travel_body)};
  const double way = (T_travel_last_.inverse() * located.T_travel_body).translation().norm();
  located.covariance = lifted(estimate.covariance, way);
  return located;
}

Localizer::Located Localizer::trackRgbd(const sensors::Reading& reading, const sensors::Mask* movers) {
  const auto estimate =
      rgbd_.track(reading.time, std::get<sensors::RgbdFrame>(reading.data), movers, stepOfWheels(reading.time));
  lost_ += estimate.isLost ? 1 : 0;
  Located located;
  if (estimate.T_world_before) {
    T_travel_world_ = T_travel_world_ * estimate.T_world_before->inverse();
    located.T_upright_travel = T_travel_world_.inverse();
  }
  located.T_travel_body = T_travel_world_ * estimate.T_world_body;
  located.covariance = estimate.covariance;
  return located;
}

/// Since the last reading of what is followed; none without odometry.
std::optional<geometry::Pose3> Localizer::stepOfWheels(base::Time time) const {
  if (!hasLocated_ || track_.empty()) return std::nullopt;
  return track_.at(lastTime_).inverse() * track_.at(time);
}

/// Mean, since the last reading of what is followed.
Eigen::Vector3d Localizer::velocityOver(const geometry::Pose3& T_last_body, base::Time time) const {
  const double seconds = base::seconds(time - lastTime_);
  if (!(seconds > 0.0)) return Eigen::Vector3d::Zero();
  const auto step = geometry::toPose2(T_last_body);
  return Eigen::Vector3d(step.x, step.y, step.theta) / seconds;
}

map::Matrix6 Localizer::wheelNoise(const geometry::Pose3& T_last_body) const {
  const double way = T_last_body.translation().norm();
  const double turn = geometry::rotationAngle(T_last_body);
  const auto variance = [](double sigma) { return sigma * sigma; };
  const double translation = variance(noise_.translationPerMetre) * way;
  const double rotation = variance(noise_.rotationPerMetre) * way + variance(noise_.rotationPerRadian) * turn;
  map::Matrix6 covariance = map::Matrix6::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return covariance;
}

void Localizer::forgetBefore(base::Time time) {
  if (origin_ != Origin::kFile) track_.forgetBefore(time);
}

void Localizer::save(base::ByteWriter& out) const {
  if (origin_ != Origin::kFile) track_.save(out);  // a file is read again
  out << followed_ << sensor_;
  laser_.save(out);
  rgbd_.save(out);
  savePose(out, T_travel_world_);
  out << hasLocated_;
  saveTime(out, lastTime_);
  savePose(out, T_travel_last_);
  saveMatrix(out, velocity_);
  out << lost_;
}

void Localizer::load(base::ByteReader& in) {
  if (origin_ != Origin::kFile) track_.load(in);
  in >> followed_ >> sensor_;
  laser_.load(in);
  rgbd_.load(in);
  T_travel_world_ = loadPose(in);
  in >> hasLocated_;
  lastTime_ = loadTime(in);
  T_travel_last_ = loadPose(in);
  loadMatrix(in, velocity_);
  in >> lost_;
}

}  // namespace prodomos::mapper
