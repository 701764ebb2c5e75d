// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/pose_track.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace prodomos::mapper {
namespace {

base::Time at(double seconds) {
  return base::Time(base::fromSeconds(1e9 + seconds));
}

geometry::Pose3 atX(double x) {
  return geometry::toPose3({x, 0.0, 0.0});
}

std::vector<std::byte> saved(const PoseTrack& track) {
  base::ByteWriter out;
  track.save(out);
  return out.take();
}

TEST(PoseTrack, KnowsNothingWhileItIsEmpty) {
  const PoseTrack track;
  EXPECT_TRUE(track.empty());
  EXPECT_FALSE(track.reaches(at(0)));
  EXPECT_EQ(track.distanceTo(at(0)), std::nullopt);
  EXPECT_TRUE(track.at(at(0)).isApprox(geometry::Pose3::Identity()));
}

TEST(PoseTrack, InterpolatesBetweenAndStaysAtTheEnds) {
  PoseTrack track;
  track.add(at(1), geometry::toPose3({1.0, 0.0, 0.0}));
  track.add(at(3), geometry::toPose3({2.0, 4.0, 1.0}));
  EXPECT_TRUE(track.at(at(1.5)).isApprox(geometry::toPose3({1.25, 1.0, 0.25}), 1e-12));
  EXPECT_TRUE(track.at(at(0)).isApprox(track.at(at(1))));
  EXPECT_TRUE(track.at(at(9)).isApprox(track.at(at(3))));
  EXPECT_TRUE(track.reaches(at(3)));
  EXPECT_FALSE(track.reaches(at(3.001)));
}

TEST(PoseTrack, TellsTheGapToTheNearestPoseToEitherSide) {
  PoseTrack track;
  track.add(at(1), atX(0));
  track.add(at(4), atX(1));
  EXPECT_EQ(track.distanceTo(at(0)), base::fromSeconds(1));
  EXPECT_EQ(track.distanceTo(at(1)), base::fromSeconds(0));
  EXPECT_EQ(track.distanceTo(at(2)), base::fromSeconds(1));
  EXPECT_EQ(track.distanceTo(at(3)), base::fromSeconds(1));
  EXPECT_EQ(track.distanceTo(at(6)), base::fromSeconds(2));
}

TEST(PoseTrack, SortsWhatComesLateAndLetsTheLaterOfTwoEqualStampsCount) {
  PoseTrack track;
  track.add(at(2), atX(2));
  track.add(at(0), atX(0));
  track.add(at(1), atX(5));
  track.add(at(1), atX(1));
  EXPECT_TRUE(track.at(at(0.5)).isApprox(atX(0.5), 1e-12));
  EXPECT_TRUE(track.at(at(1.5)).isApprox(atX(1.5), 1e-12));
}

TEST(PoseTrack, ForgetsThePastButForAMargin) {
  PoseTrack track;
  for (int second = 0; second <= 100; ++second) track.add(at(second), atX(second));
  track.forgetBefore(at(90));
  EXPECT_TRUE(track.at(at(88.5)).isApprox(atX(88.5), 1e-12)) << "readings may come two seconds late";
  EXPECT_TRUE(track.at(at(95.5)).isApprox(atX(95.5), 1e-12));
  EXPECT_GT(track.at(at(10)).translation().x(), 80.0);
  EXPECT_LT(saved(track).size(), 20 * sizeof(geometry::Pose3));
}

TEST(PoseTrack, KeepsTheLastOfASparseTrack) {
  PoseTrack track;
  track.add(at(0), atX(0));
  track.add(at(1000), atX(10));
  track.forgetBefore(at(500));
  EXPECT_TRUE(track.at(at(500)).isApprox(atX(5), 1e-12));
}

TEST(PoseTrack, KeepsTheLatestWhereOnlySoManyAreWanted) {
  PoseTrack track;
  for (int second = 0; second < 10; ++second) track.add(at(second), atX(second));
  track.forgetAllBut(3);
  EXPECT_TRUE(track.at(at(0)).isApprox(atX(7), 1e-12));
  EXPECT_TRUE(track.at(at(9)).isApprox(atX(9), 1e-12));
}

TEST(PoseTrack, ComesBackBitByBit) {
  base::Random random(7);
  PoseTrack track;
  for (int i = 0; i < 50; ++i) {
    track.add(at(random.uniform(0, 10)), geometry::fromYawPitchRoll({random.normal(0, 100), random.normal(0, 1), 0.1},
                                                                    random.uniform(-3, 3), random.uniform(-1, 1), 0.3));
  }
  const auto bytes = saved(track);
  PoseTrack again;
  again.add(at(5), atX(1));
  base::ByteReader in(bytes);
  again.load(in);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_EQ(saved(again), bytes);
  EXPECT_EQ(again.at(at(4.321)).matrix(), track.at(at(4.321)).matrix());
}

/// The slow, obviously right way.
geometry::Pose3 slowAt(const std::map<base::Time, geometry::Pose3>& poses, base::Time time) {
  const auto after = poses.lower_bound(time);
  if (after == poses.end()) return poses.rbegin()->second;
  if (after == poses.begin() || after->first == time) return after->second;
  const auto before = std::prev(after);
  const double part = base::seconds(time - before->first) / base::seconds(after->first - before->first);
  geometry::Pose3 pose = geometry::Pose3::Identity();
  pose.translation() = (1 - part) * before->second.translation() + part * after->second.translation();
  pose.linear() = Eigen::Quaterniond(before->second.linear())
                      .slerp(part, Eigen::Quaterniond(after->second.linear()))
                      .toRotationMatrix();
  return pose;
}

TEST(PoseTrack, AgreesWithASlowOracleOnRandomTracks) {
  base::Random random(3);
  for (int round = 0; round < 50; ++round) {
    PoseTrack track;
    std::map<base::Time, geometry::Pose3> oracle;
    for (int i = random.integer(1, 30); i > 0; --i) {
      const auto time = at(0.1 * random.integer(0, 60));
      const auto pose = geometry::fromYawPitchRoll({random.normal(0, 5), random.normal(0, 5), random.normal(0, 5)},
                                                   random.uniform(-3, 3), random.uniform(-1, 1), random.uniform(-1, 1));
      track.add(time, pose);
      oracle[time] = pose;
    }
    for (int i = 0; i < 40; ++i) {
      const auto time = at(random.uniform(-1, 7));
      EXPECT_TRUE(track.at(time).isApprox(slowAt(oracle, time), 1e-9));
      auto gap = base::Duration::max();
      for (const auto& [known, pose] : oracle) gap = std::min(gap, known > time ? known - time : time - known);
      EXPECT_EQ(track.distanceTo(time), gap);
      EXPECT_EQ(track.reaches(time), oracle.rbegin()->first >= time);
    }
  }
}

}  // namespace
}  // namespace prodomos::mapper
