// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/gazebo_world.hpp"

#include "prodomos/base/error.hpp"

#include "tiny_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::simulation {
namespace {

using ::testing::HasSubstr;

std::string faultOf(const std::filesystem::path& path) {
  try {
    readGazeboWorld(path);
  } catch (const base::FileError& error) {
    return error.what();
  }
  return "none";
}

TEST(GazeboWorld, ModelsStandWhereTheirPosesSay) {
  const test::TemporaryFolder folder;
  const auto world = readGazeboWorld(folder.write(
      "w.world", test::worldText("<include><uri>model://sun</uri></include>"
                                 "<model name=\"chair_7\"><pose>10 0 0 0 0 1.5707963</pose><include>"
                                 "<uri>model://Chair</uri><pose>1 2 0.5 0 0 0.25</pose></include></model>")));
  ASSERT_EQ(world.models.size(), 2U);
  EXPECT_EQ(world.models[0].model, "sun");
  EXPECT_EQ(world.models[1].name, "chair_7");
  EXPECT_EQ(world.models[1].model, "Chair");
  const auto& T = world.models[1].T_world_model;
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(8.0, 1.0, 0.5), 1e-6)) << T.translation().transpose();
  EXPECT_NEAR(geometry::yaw(T), 1.5707963 + 0.25, 1e-6);
}

TEST(GazeboWorld, AModelDescribedInPlaceIsARemark) {
  const test::TemporaryFolder folder;
  const auto world =
      readGazeboWorld(folder.write("w.world", test::worldText("<model name=\"box\"><link name=\"l\"/></model>")));
  EXPECT_TRUE(world.models.empty());
  ASSERT_EQ(world.remarks.size(), 1U);
  EXPECT_THAT(world.remarks[0], HasSubstr("\"box\""));
}

TEST(GazeboWorld, IsToldByItsContent) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(isGazeboWorld(folder.write("a.txt", test::worldText(""))));
  EXPECT_FALSE(isGazeboWorld(folder.write("b.world", "<sdf><model name='m'/></sdf>")));
  EXPECT_FALSE(isGazeboWorld(folder.write("c.world", "a: 1")));
  EXPECT_FALSE(isGazeboWorld(folder.path() / "gone.world"));
}

TEST(GazeboWorld, FaultsNameFileAndModel) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(faultOf(folder.write("a.world", "no xml at all")), HasSubstr("a.world: expected a Gazebo world"));
  EXPECT_THAT(faultOf(folder.write("b.world", "<building/>")), HasSubstr("found <building>"));
  EXPECT_THAT(faultOf(folder.path() / "gone.world"), HasSubstr("gone.world: expected"));
  EXPECT_THAT(faultOf(folder.write("c.world", test::worldText(test::included("Chair", "1 2 3")))),
              HasSubstr("c.world: model \"Chair_1\": expected a <pose> of six numbers, found \"1 2 3\""));
  EXPECT_THAT(faultOf(folder.write("d.world", test::worldText(test::included("Chair", "1 2 3 0 0 x")))),
              HasSubstr("found \"1 2 3 0 0 x\""));
}

}  // namespace
}  // namespace prodomos::simulation
