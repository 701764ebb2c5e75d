// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/sensors/reading.hpp"

#include <gtest/gtest.h>

namespace prodomos::sensors {
namespace {

TEST(KindName, NamesEveryKindAsItsOwn) {
  EXPECT_EQ(kindName(LaserScan{}), "laser_scan");
  EXPECT_EQ(kindName(Odometry{}), "odometry");
  EXPECT_EQ(kindName(RecordedPose{}), "recorded_pose");
  EXPECT_EQ(kindName(RgbdFrame{}), "rgbd_frame");
  EXPECT_EQ(kindName(PointCloud{}), "point_cloud");
  EXPECT_EQ(kindName(Detections{}), "detections");
  EXPECT_EQ(kindName(KeyPoints{}), "key_points");
}

TEST(CameraAxes, PointAheadLeftAndUp) {
  const auto T_body_camera = cameraAxesInBody();
  EXPECT_TRUE((T_body_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_TRUE((T_body_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, -1, 0)));
  EXPECT_TRUE((T_body_camera * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(0, 0, -1)));
}

TEST(Image, SharesItsPixelsWithCopiesButNotWithClones) {
  Image<int> image(3, 2, 7);
  const Image<int> copy = image;
  const Image<int> clone = image.clone();
  image(2, 1) = 9;
  EXPECT_EQ(copy(2, 1), 9);
  EXPECT_EQ(clone(2, 1), 7);
}

TEST(Image, LaysItsRowsOneAfterTheOther) {
  Image<int> image(3, 2);
  image(0, 1) = 5;
  EXPECT_EQ(image.size(), 6U);
  EXPECT_EQ(image.pixels()[3], 5);
  EXPECT_EQ(image.row(1), image.data() + 3);
  EXPECT_FALSE(image.empty());
  EXPECT_TRUE(Image<int>().empty());
}

}  // namespace
}  // namespace prodomos::sensors
