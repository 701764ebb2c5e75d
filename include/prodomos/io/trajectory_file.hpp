// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"

#include <filesystem>
#include <vector>

namespace prodomos::io {

struct TimedPose {
  base::Time time;
  geometry::Pose3 T_world_body = geometry::Pose3::Identity();
};

/// `time x y z qx qy qz qw` a line, `#` comments: the format of the TUM tools. Throws base::FileError naming the line
/// where one is malformed or earlier than the line before.
std::vector<TimedPose> readTrajectory(const std::filesystem::path& path);

}  // namespace prodomos::io
