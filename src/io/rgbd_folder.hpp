// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/io/open_source.hpp"
#include "prodomos/io/trajectory_file.hpp"
#include "prodomos/sensors/source.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace prodomos::io {

/// A folder of image files, as found in its lists: what both kinds of folders are once they are opened.
struct RgbdFolder {
  struct Frame {
    base::Time time;
    std::filesystem::path color;
    std::filesystem::path depth;
  };

  sensors::SourceInfo info;
  sensors::CameraIntrinsics camera;
  double depthScale = 1000.0;  ///< units a metre
  std::vector<Frame> frames;   ///< in the order of time
  std::vector<TimedPose> poses;
};

/// The label of the camera of a folder's readings.
inline constexpr const char* kFolderCamera = "camera";

bool isTumFolder(const std::filesystem::path& folder);
RgbdFolder readTumFolder(const std::filesystem::path& path, const SourceOptions& options);

bool isPlainFolder(const std::filesystem::path& folder);
RgbdFolder readPlainFolder(const std::filesystem::path& path, const SourceOptions& options);

std::unique_ptr<sensors::SensorSource> openRgbdFolder(RgbdFolder folder);

}  // namespace prodomos::io
