// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/trajectory_file.hpp"

#include "log.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::io {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string errorFor(std::string_view text) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("poses.txt", text);
  return errorOf([&] { readTrajectory(file); });
}

TEST(TrajectoryFile, ReadsPosesExactly) {
  const test::TemporaryFolder folder;
  const auto poses =
      readTrajectory(folder.write("poses.txt",
                                  "# time x y z qx qy qz qw\n\n1305031102.175304 1 2 3 0 0 0.7071068 0.7071068\r\n"
                                  "1305031102.175304 4 5 6 0 0 0 2\n"));
  ASSERT_THAT(poses, SizeIs(2));
  EXPECT_EQ(base::toString(poses[0].time), "1305031102.175304");
  EXPECT_TRUE(poses[0].T_world_body.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_NEAR(geometry::yaw(poses[0].T_world_body), 1.5707963, 1e-6);
  EXPECT_TRUE(poses[1].T_world_body.linear().isIdentity(1e-12));
  EXPECT_THAT(readTrajectory(folder.write("none.txt", "# nothing\n")), IsEmpty());
}

TEST(TrajectoryFile, NamesTheLineThatIsWrong) {
  EXPECT_THAT(errorFor("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n"),
              HasSubstr("poses.txt:2: expected `time x y z qx qy qz qw`"));
  EXPECT_THAT(errorFor("1 0 0 zero 0 0 0 1\n"), HasSubstr("poses.txt:1:"));
  EXPECT_THAT(errorFor("1 0 0 nan 0 0 0 1\n"), HasSubstr("poses.txt:1:"));
  EXPECT_THAT(errorFor("1 0 0 0 0 0 0 0\n"), HasSubstr("poses.txt:1:"));
  EXPECT_THAT(errorFor("# a\n2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr("poses.txt:3: expected a time not before 2.0, found 1.0"));
  EXPECT_THAT(errorOf([] { readTrajectory("/nowhere.txt"); }), HasSubstr("/nowhere.txt: expected a readable file"));
}

}  // namespace
}  // namespace prodomos::io
