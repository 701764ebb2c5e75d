// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/mapper/config.hpp"
#include "prodomos/sensors/source.hpp"

#include "mapper/pose_track.hpp"

namespace prodomos::mapper {

/// Where was the robot? As odometry says, as the log has recorded, or as a file says. Estimated poses will be one more
/// origin here.
class Localizer {
 public:
  /// Throws base::FileError where the configuration names a trajectory file that cannot be read.
  Localizer(const InputConfig& config, const sensors::SourceInfo& log);

  /// "odometry", "recorded", or the path of the file.
  const std::string& name() const { return name_; }
  /// Poses in a world whose floor is z = 0, rather than from wherever the robot began.
  bool knowsHeight() const { return origin_ != Origin::kOdometry; }

  /// Is this reading about the robot's pose, rather than about what it sees?
  static bool isPose(const sensors::Reading& reading);
  /// Learns from a reading that isPose(). Empty, or why it is of no use.
  std::string take(const sensors::Reading& reading);

  /// May the pose at this time still become better known?
  bool awaits(base::Time time) const { return !track_.reaches(time); }
  /// None where no pose is known near this time.
  std::optional<geometry::Pose3> poseAt(base::Time time) const;
  /// No more questions will come of times much before.
  void forgetBefore(base::Time time);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  enum class Origin { kOdometry, kRecorded, kFile };
  static Origin originOf(const InputConfig& config, const sensors::SourceInfo& log);

  Origin origin_;
  std::string name_;
  double poseGap_;
  PoseTrack track_;
};

}  // namespace prodomos::mapper
