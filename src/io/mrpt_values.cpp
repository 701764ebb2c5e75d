// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/mrpt_values.hpp"

#include <mrpt/io/lazy_load_path.h>

#include <algorithm>
#include <iostream>
#include <streambuf>

namespace prodomos::io {

namespace {

// MRPT counts 100 ns from 1601-01-01.
constexpr std::int64_t kEpoch = 116'444'736'000'000'000;
constexpr std::int64_t kNanosecondsPerTick = 100;

/// Takes all that is written, and forgets it. Others may write while MRPT is silenced, so there must be something.
class Nowhere final : public std::streambuf {
 protected:
  std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
  int_type overflow(int_type character) override { return traits_type::not_eof(character); }
};

std::streambuf* nowhere() {
  static Nowhere buffer;
  return &buffer;
}

std::mutex& processSettings() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

std::optional<base::Time> toTime(mrpt::Clock::time_point stamp) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / kNanosecondsPerTick;
  const std::int64_t ticks = stamp.time_since_epoch().count();
  if (ticks <= 0 || ticks - kEpoch > kMost || ticks - kEpoch < -kMost) return std::nullopt;
  return base::fromNanoseconds((ticks - kEpoch) * kNanosecondsPerTick);
}

mrpt::Clock::time_point toMrpt(base::Time time) {
  const std::int64_t nanoseconds = base::toNanoseconds(time);
  std::int64_t ticks = nanoseconds / kNanosecondsPerTick;
  if (ticks * kNanosecondsPerTick > nanoseconds) --ticks;
  return mrpt::Clock::time_point(mrpt::Clock::duration(ticks + kEpoch));
}

geometry::Pose3 toPose3(const mrpt::poses::CPose3D& pose) {
  geometry::Pose3 result = geometry::Pose3::Identity();
  const auto& rotation = pose.getRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result.linear()(row, column) = rotation(row, column);
  }
  result.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  return result;
}

geometry::Pose3 toPose3(const mrpt::poses::CPose2D& pose) {
  return geometry::toPose3(geometry::Pose2{pose.x(), pose.y(), pose.phi()});
}

mrpt::poses::CPose3D toMrpt(const geometry::Pose3& pose) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = pose.matrix()(row, column);
  }
  return mrpt::poses::CPose3D(matrix);
}

std::optional<sensors::CameraIntrinsics> toIntrinsics(const mrpt::img::TCamera& camera) {
  if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt) return std::nullopt;
  sensors::CameraIntrinsics result{camera.fx(), camera.fy(), camera.cx(), camera.cy(), {}};
  if (camera.distortion == mrpt::img::DistortionModel::plumb_bob) {
    std::copy_n(camera.dist.begin(), result.distortion.size(), result.distortion.begin());
  }
  return result;
}

mrpt::img::TCamera toMrpt(const sensors::CameraIntrinsics& camera, int width, int height) {
  mrpt::img::TCamera result;
  result.ncols = static_cast<std::uint32_t>(width);
  result.nrows = static_cast<std::uint32_t>(height);
  result.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  result.setDistortionPlumbBob(k1, k2, p1, p2, k3);
  return result;
}

MrptScope::MrptScope(const std::optional<std::filesystem::path>& externals)
    : lock_(processSettings()), errors_(std::cerr.rdbuf(nowhere())) {
  if (!externals) return;
  externalsBefore_ = mrpt::io::getLazyLoadPathBase();
  mrpt::io::setLazyLoadPathBase(externals->string());
}

MrptScope::~MrptScope() {
  if (externalsBefore_) mrpt::io::setLazyLoadPathBase(*externalsBefore_);
  std::cerr.rdbuf(errors_);
}

}  // namespace prodomos::io
