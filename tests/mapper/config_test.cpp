// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/config.hpp"

#include "prodomos/base/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::mapper {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(MapperConfig, HasEveryKeyInTheTextOfTheDefaults) {
  const auto text = base::writeConfig(MapperConfig(), true);
  for (const char* key :
       {"poses", "sensors", "start", "end", "fps", "pose_gap", "max_distance", "least_overlap", "overlap_step",
        "least_height", "translation_per_metre", "rotation_per_metre", "rotation_per_radian", "resolution", "voxel"}) {
    EXPECT_THAT(text, HasSubstr(std::string("  ") + key + ": ")) << key;
  }
}

TEST(MapperConfig, ReadsBackWhatItWritesToTheLetter) {  // a session is resumed under the text that its map holds
  MapperConfig config;
  config.input = {"/data/a b: #c.txt", "front, rear", "976052857.33753", "", 1.0 / 3.0, 0.1};
  config.submap.maxDistance = 4.0 / 3.0;
  config.odometryNoise.rotationPerMetre = 1e-5;
  for (const auto& written : {base::writeConfig(config, false), base::writeConfig(MapperConfig(), false)}) {
    EXPECT_EQ(base::writeConfig(base::readConfig<MapperConfig>({{}, written, {}}), false), written);
  }
  const auto again = base::readConfig<MapperConfig>({{}, base::writeConfig(config, false), {}});
  EXPECT_EQ(again.input.poses, config.input.poses);
  EXPECT_EQ(again.input.start, config.input.start);
  EXPECT_EQ(again.submap.maxDistance, config.submap.maxDistance);
}

TEST(MapperConfig, RefusesAllMistakesAtOnce) {
  try {
    base::readConfig<MapperConfig>(
        {{}, "", {"submap.max_distance=0", "submap.least_overlap=1.5", "floor.least_hight=2", "input.fps=often"}});
    FAIL() << "nothing was refused";
  } catch (const base::UsageError& error) {
    EXPECT_THAT(error.faults(), SizeIs(4));
    EXPECT_THAT(error.faults(), Each(::testing::Not(HasSubstr("\n"))));
  }
}

}  // namespace
}  // namespace prodomos::mapper
