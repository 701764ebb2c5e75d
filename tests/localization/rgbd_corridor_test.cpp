// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"
#include "prodomos/localization/rgbd_odometry.hpp"

#include "support/datasets.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace prodomos::localization {
namespace {

std::vector<sensors::Reading> framesOf(const std::filesystem::path& log) {
  const auto source = io::openSource(log);
  std::vector<sensors::Reading> frames;
  for (;;) {
    auto item = source->next();
    if (std::holds_alternative<sensors::EndOfLog>(item)) return frames;
    if (auto* reading = std::get_if<sensors::Reading>(&item);
        reading != nullptr && std::holds_alternative<sensors::RgbdFrame>(reading->data)) {
      frames.push_back(std::move(*reading));
    }
  }
}

/// From the first frame to the last, in the order given, a thirtieth of a second apart.
geometry::Pose3 wayThrough(const std::vector<sensors::Reading>& frames) {
  RgbdOdometry odometry;
  std::optional<geometry::Pose3> first;
  geometry::Pose3 last;
  base::Time time{};
  for (const auto& frame : frames) {
    time += std::chrono::milliseconds(33);
    const auto estimate = odometry.track(time, std::get<sensors::RgbdFrame>(frame.data));
    if (!first) first = estimate.T_world_body;
    if (estimate.T_world_before) first = *estimate.T_world_before * *first;
    last = estimate.T_world_body;
    EXPECT_FALSE(estimate.isLost);
  }
  return first->inverse() * last;
}

TEST(RgbdOdometry, MeasuresARealCorridorAlikeForthAndBack) {
  const auto log = test::dataset("rgbd/icsl_corridor");
  if (!log) GTEST_SKIP() << "needs rgbd/icsl_corridor";
  auto frames = framesOf(*log);
  const double forth = wayThrough(frames).translation().norm();
  std::ranges::reverse(frames);
  const double back = wayThrough(frames).translation().norm();
  EXPECT_GT(forth, 10.0);
  EXPECT_NEAR(back, forth, 0.02 * forth);
  RecordProperty("forth_m", std::to_string(forth));
  RecordProperty("back_m", std::to_string(back));
}

}  // namespace
}  // namespace prodomos::localization
