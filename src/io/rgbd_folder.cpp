// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/rgbd_folder.hpp"

#include "prodomos/base/error.hpp"

#include "io/images.hpp"

#include <algorithm>

namespace prodomos::io {

namespace {

/// Frames and recorded poses, merged in the order of time; of equal times the pose comes first.
class RgbdFolderSource final : public sensors::SensorSource {
 public:
  explicit RgbdFolderSource(RgbdFolder folder) : folder_(std::move(folder)) {
    folder_.info.hasRecordedPoses = !folder_.poses.empty();
  }

  const sensors::SourceInfo& info() const override { return folder_.info; }
  base::Progress progress() const override {
    return {static_cast<double>(frame_ + pose_), static_cast<double>(folder_.frames.size() + folder_.poses.size())};
  }

  void skip(std::size_t count) override {
    for (std::size_t i = 0; i < count && !atEnd(); ++i) ++(poseIsNext() ? pose_ : frame_);
  }

  sensors::SourceItem next() override {
    if (atEnd()) return sensors::EndOfLog{};
    if (!poseIsNext()) return read(folder_.frames[frame_++]);
    const auto& pose = folder_.poses[pose_++];
    return sensors::Reading{pose.time, "recorded_pose", sensors::RecordedPose{pose.T_world_body}};
  }

 private:
  bool atEnd() const { return frame_ == folder_.frames.size() && pose_ == folder_.poses.size(); }

  bool poseIsNext() const {
    if (pose_ == folder_.poses.size()) return false;
    return frame_ == folder_.frames.size() || folder_.poses[pose_].time <= folder_.frames[frame_].time;
  }

  sensors::SourceItem read(const RgbdFolder::Frame& files) const {
    auto color = readColorImage(files.color);
    if (const auto* fault = std::get_if<ImageFault>(&color)) {
      return sensors::Skipped{fault->reason, fault->fault, files.time};
    }
    auto depth = readDepthImage(files.depth, folder_.depthScale);
    if (const auto* fault = std::get_if<ImageFault>(&depth)) {
      return sensors::Skipped{fault->reason, fault->fault, files.time};
    }
    sensors::RgbdFrame frame{sensors::cameraAxesInBody(), folder_.camera, std::get<sensors::Image<float>>(depth),
                             std::get<sensors::Image<sensors::Rgb>>(color), std::nullopt};
    if (frame.depth.width() != frame.color.width() || frame.depth.height() != frame.color.height()) {
      const auto size = [](const auto& image) {
        return std::to_string(image.width()) + "x" + std::to_string(image.height());
      };
      return sensors::Skipped{
          "unequal images",
          base::expectedFound(files.depth.string(), "the " + size(frame.color) + " pixels of its colour image",
                              size(frame.depth)),
          files.time};
    }
    return sensors::Reading{files.time, kFolderCamera, std::move(frame)};
  }

  RgbdFolder folder_;
  std::size_t frame_ = 0;
  std::size_t pose_ = 0;
};

}  // namespace

std::unique_ptr<sensors::SensorSource> openRgbdFolder(RgbdFolder folder) {
  return std::make_unique<RgbdFolderSource>(std::move(folder));
}

}  // namespace prodomos::io
