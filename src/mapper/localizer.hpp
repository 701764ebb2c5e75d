// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/laser_odometry.hpp"
#include "prodomos/localization/rgbd_odometry.hpp"
#include "prodomos/mapper/config.hpp"
#include "prodomos/sensors/source.hpp"

#include "mapper/pose_track.hpp"

namespace prodomos::mapper {

/// Where was the robot? As its sensors tell (estimated), as odometry says, as the log has recorded, or as a file says.
class Localizer {
 public:
  /// Throws base::FileError where the configuration names a trajectory file that cannot be read.
  Localizer(const MapperConfig& config, const sensors::SourceInfo& log);

  /// "estimated", "odometry", "recorded", or the path of the file.
  const std::string& name() const { return name_; }
  bool isEstimated() const { return origin_ == Origin::kEstimated; }
  /// Poses in a world whose floor is z = 0, rather than from wherever the robot began.
  bool knowsHeight() const { return origin_ != Origin::kOdometry; }

  /// Is this reading about the robot's pose, rather than about what it sees?
  static bool isPose(const sensors::Reading& reading);
  /// Learns from a reading that isPose(). Empty, or why it is of no use.
  std::string take(const sensors::Reading& reading);
  /// A reading that is not, and will be located later: which sensors there are decides which one is followed.
  void expect(const sensors::Reading& reading);

  struct Located {
    geometry::Pose3 T_travel_body = geometry::Pose3::Identity();
    /// Of the step since the reading located before, in the axes of the body now: metres, radians. Zero where another
    /// sensor is followed, which tells the whole step.
    map::Matrix6 covariance = map::Matrix6::Zero();
    /// The floor has just shown that `travel` is not upright, or at the wrong height: how it lies in a world that is.
    std::optional<geometry::Pose3> T_upright_travel;
  };
  /// May the pose at this time still become better known?
  bool awaits(base::Time time) const;
  /// Readings in their order, each once. None where no pose is known near.
  std::optional<Located> locate(const sensors::Reading& reading, const sensors::Mask* movers);
  /// Of the body at the reading located last, as PlacedReading has it.
  const Eigen::Vector3d& velocity() const { return velocity_; }
  /// Of the readings located, those that were not recognised and got no more than what was to be expected.
  std::int64_t lost() const { return lost_; }
  /// No more questions will come of times much before.
  void forgetBefore(base::Time time);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  enum class Origin { kEstimated, kOdometry, kRecorded, kFile };
  enum class Followed { kNothing, kRgbd, kCloud, kLaser };
  static Origin originOf(const InputConfig& config, const sensors::SourceInfo& log);
  static Followed kindOf(const sensors::Reading& reading);
  bool isFollowed(const sensors::Reading& reading) const;

  std::optional<Located> follow(base::Time time);
  Located estimate(const sensors::Reading& reading, const sensors::Mask* movers);
  Located trackLaser(const sensors::Reading& reading, const sensors::Mask* movers);
  Located trackRgbd(const sensors::Reading& reading, const sensors::Mask* movers);
  std::optional<geometry::Pose3> stepOfWheels(base::Time time) const;
  Eigen::Vector3d velocityOver(const geometry::Pose3& T_last_body, base::Time time) const;
  map::Matrix6 wheelNoise(const geometry::Pose3& T_last_body) const;

  Origin origin_;
  std::string name_;
  double poseGap_;
  OdometryNoiseConfig noise_;
  map::HeightBand heightBand_;
  double maxRange_;

  PoseTrack track_;  // what is told of poses: by wheels, by the log, by a file
  Followed followed_ = Followed::kNothing;
  std::string sensor_;  // the label of what is followed
  localization::LaserOdometry laser_;
  localization::RgbdOdometry rgbd_;
  geometry::Pose3 T_travel_world_ = geometry::Pose3::Identity();  // world: of the RGB-D odometry
  // The step goes on from the last reading of what is followed.
  bool hasLocated_ = false;
  base::Time lastTime_{};
  geometry::Pose3 T_travel_last_ = geometry::Pose3::Identity();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  std::int64_t lost_ = 0;
};

}  // namespace prodomos::mapper
