// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <filesystem>
#include <memory>
#include <optional>

namespace prodomos::io {

/// What a log may not say itself.
struct SourceOptions {
  double framesPerSecond = 30.0;                    ///< of RGB-D folders without time stamps
  std::optional<sensors::CameraIntrinsics> camera;  ///< overrides what the folder says
  std::optional<double> depthScale;                 ///< units a metre of depth images (TUM: 5000, millimetres: 1000)
  std::optional<std::filesystem::path> labels;      ///< folder of label images, <time or frame>.png + classes.yaml
  std::optional<std::filesystem::path> detections;  ///< side file of boxes
  std::optional<std::filesystem::path> keyPoints;   ///< side file of joints
};

/// Opens a log of any kind that prodomos reads, recognised by its content. Throws base::FileError where it is missing,
/// empty or of no known kind; the message says what was looked for.
std::unique_ptr<sensors::SensorSource> openSource(const std::filesystem::path& log, const SourceOptions& options = {});

}  // namespace prodomos::io
