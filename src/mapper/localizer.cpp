// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/localizer.hpp"

#include "prodomos/io/trajectory_file.hpp"

namespace prodomos::mapper {

namespace {

// A log may tell all its poses before its first scan, or poses alone for hours: so many are kept.
constexpr std::size_t kMostPoses = 100'000;

}  // namespace

Localizer::Origin Localizer::originOf(const InputConfig& config, const sensors::SourceInfo& log) {
  if (config.poses == "odometry") return Origin::kOdometry;
  if (config.poses == "recorded") return Origin::kRecorded;
  if (config.poses == "auto") return log.hasRecordedPoses ? Origin::kRecorded : Origin::kOdometry;
  return Origin::kFile;
}

Localizer::Localizer(const InputConfig& config, const sensors::SourceInfo& log)
    : origin_(originOf(config, log)), poseGap_(config.poseGap) {
  switch (origin_) {
    case Origin::kOdometry:
      name_ = "odometry";
      break;
    case Origin::kRecorded:
      name_ = "recorded";
      break;
    case Origin::kFile:
      name_ = config.poses;
      for (const auto& pose : io::readTrajectory(config.poses)) track_.add(pose.time, pose.T_world_body);
  }
}

bool Localizer::isPose(const sensors::Reading& reading) {
  return std::holds_alternative<sensors::Odometry>(reading.data) ||
         std::holds_alternative<sensors::RecordedPose>(reading.data);
}

std::string Localizer::take(const sensors::Reading& reading) {
  const auto* odometry = std::get_if<sensors::Odometry>(&reading.data);
  if (origin_ != (odometry != nullptr ? Origin::kOdometry : Origin::kRecorded)) {
    return std::string(kindName(reading.data)) + " not asked for";
  }
  const auto& pose =
      odometry != nullptr ? odometry->T_odom_body : std::get<sensors::RecordedPose>(reading.data).T_world_body;
  if (!geometry::isFinite(pose)) return "pose is not finite";
  track_.add(reading.time, pose);
  track_.forgetAllBut(kMostPoses);
  return {};
}

std::optional<geometry::Pose3> Localizer::poseAt(base::Time time) const {
  // Wheels that stand still may say nothing, and a robot without odometry stays where it is; other poses have gaps.
  if (origin_ != Origin::kOdometry) {
    const auto gap = track_.distanceTo(time);
    if (!gap || base::seconds(*gap) > poseGap_) return std::nullopt;
  }
  return track_.at(time);
}

void Localizer::forgetBefore(base::Time time) {
  if (origin_ != Origin::kFile) track_.forgetBefore(time);
}

void Localizer::save(base::ByteWriter& out) const {
  if (origin_ != Origin::kFile) track_.save(out);  // a file is read again
}

void Localizer::load(base::ByteReader& in) {
  if (origin_ != Origin::kFile) track_.load(in);
}

}  // namespace prodomos::mapper
