// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <mrpt/core/Clock.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <streambuf>
#include <string>

namespace prodomos::io {

/// Nothing where MRPT's stamp is missing or beyond what nanoseconds hold.
std::optional<base::Time> toTime(mrpt::Clock::time_point stamp);
/// To MRPT's tick of 100 ns, rounded down.
mrpt::Clock::time_point toMrpt(base::Time time);

geometry::Pose3 toPose3(const mrpt::poses::CPose3D& pose);
geometry::Pose3 toPose3(const mrpt::poses::CPose2D& pose);
mrpt::poses::CPose3D toMrpt(const geometry::Pose3& pose);

/// Nothing where the camera is of a kind that CameraIntrinsics does not hold.
std::optional<sensors::CameraIntrinsics> toIntrinsics(const mrpt::img::TCamera& camera);
mrpt::img::TCamera toMrpt(const sensors::CameraIntrinsics& camera, int width, int height);

/// While one lives, MRPT writes nothing to std::cerr, where it reports what it throws as well. Where `externals` is
/// given, MRPT looks there for images beside a log. Both are settings of the whole process, hence the lock.
class MrptScope {
 public:
  explicit MrptScope(const std::optional<std::filesystem::path>& externals = std::nullopt);
  MrptScope(const MrptScope&) = delete;
  MrptScope& operator=(const MrptScope&) = delete;
  ~MrptScope();

 private:
  std::lock_guard<std::mutex> lock_;
  std::streambuf* errors_;
  std::optional<std::string> externalsBefore_;
};

}  // namespace prodomos::io
