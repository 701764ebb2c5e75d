// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/from_mrpt.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstring>

namespace prodomos::io {
namespace {

using namespace mrpt::obs;
using sensors::LaserScan;
using sensors::Reading;
using sensors::Skipped;
using testing::HasSubstr;
using testing::SizeIs;

Reading reading(const CObservation& observation) {
  const auto item = fromMrpt(observation);
  if (const auto* skipped = std::get_if<Skipped>(&item)) ADD_FAILURE() << skipped->reason << ": " << skipped->fault;
  return std::get<Reading>(item);
}

TEST(FromMrpt, TellsNoReturnFromInvalid) {
  CObservation2DRangeScan scan;
  scan.maxRange = 8.0F;
  scan.aperture = 1.0F;
  scan.rightToLeft = false;
  const std::vector<float> ranges = {1.0F, 8.0F, 8.0F, 3.0F, 0.0F, INFINITY};
  const std::vector<char> valid = {1, 1, 0, 0, 0, 1};
  scan.loadFromVectors(ranges.size(), ranges.data(), valid.data());
  const auto result = reading(scan);
  EXPECT_EQ(result.sensor, "laser");
  EXPECT_EQ(result.fault, "");
  constexpr float kNone = LaserScan::kNoReturn;
  constexpr float kInvalid = LaserScan::kInvalid;
  EXPECT_EQ(as<LaserScan>(result).ranges, (std::vector<float>{1.0F, kNone, kNone, kInvalid, kInvalid, kNone}));
  EXPECT_DOUBLE_EQ(as<LaserScan>(result).firstAngle, 0.5);
  EXPECT_DOUBLE_EQ(as<LaserScan>(result).angleStep, -0.2);
}

TEST(FromMrpt, NamesTheClassThatItDoesNotRead) {
  const auto item = fromMrpt(CObservationGPS());
  EXPECT_EQ(std::get<Skipped>(item).reason, "unsupported CObservationGPS");
  EXPECT_EQ(std::get<Skipped>(item).fault, "");
}

TEST(FromMrpt, SkipsAnObservationWithoutTime) {
  CObservation2DRangeScan scan;
  scan.timestamp = INVALID_TIMESTAMP;
  EXPECT_EQ(std::get<Skipped>(fromMrpt(scan)).reason, "no time stamp");
}

TEST(FromMrpt, SkipsAScanWithoutAPlace) {
  CObservation2DRangeScan scan;
  scan.aperture = NAN;
  scan.resizeScanAndAssign(3, 1.0F, true);
  const auto item = fromMrpt(scan);
  EXPECT_EQ(std::get<Skipped>(item).reason, "damaged scan");
  EXPECT_THAT(std::get<Skipped>(item).fault, HasSubstr("expected a finite pose"));
}

CObservation3DRangeScan rangeImage(int width, int height, double focal) {
  CObservation3DRangeScan image;
  image.hasRangeImage = true;
  image.rangeImage_setSize(height, width);
  image.rangeImage.fill(2000);
  image.cameraParams.ncols = static_cast<unsigned>(width);
  image.cameraParams.nrows = static_cast<unsigned>(height);
  image.cameraParams.setIntrinsicParamsFromValues(focal, focal, (width - 1) / 2.0, (height - 1) / 2.0);
  image.cameraParamsIntensity = image.cameraParams;
  return image;
}

TEST(FromMrpt, TurnsRangesIntoDepth) {
  auto image = rangeImage(41, 31, 20.0);
  image.range_is_depth = false;
  const auto result = reading(image);
  const auto& depth = as<sensors::RgbdFrame>(result).depth;
  EXPECT_NEAR(depth(20, 15), 2.0F, 1e-6);
  EXPECT_NEAR(depth(0, 15), 2.0 / std::sqrt(2.0), 1e-5);  // 45 degrees aside
}

TEST(FromMrpt, RegistersColourOfAnotherCamera) {
  auto image = rangeImage(41, 31, 20.0);
  // The same view with twice the pixels, 0.1 m to the right of the depth camera: at 2 m that is 2 of its pixels.
  cv::Mat picture(62, 82, CV_8UC3, cv::Scalar(0, 0, 0));
  picture(cv::Rect(40, 0, 42, 62)).setTo(cv::Scalar(0, 0, 255));
  image.hasIntensityImage = true;
  image.intensityImage = mrpt::img::CImage(picture, mrpt::img::DEEP_COPY);
  image.cameraParamsIntensity.ncols = 82;
  image.cameraParamsIntensity.nrows = 62;
  image.cameraParamsIntensity.setIntrinsicParamsFromValues(40.0, 40.0, 40.0, 30.0);
  image.relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0.0, -0.1, 0.0, -M_PI / 2, 0.0, -M_PI / 2);
  const auto result = reading(image);
  const auto& frame = as<sensors::RgbdFrame>(result);
  ASSERT_EQ(frame.color.width(), 41);
  EXPECT_EQ(frame.color(20, 15), (sensors::Rgb{0, 0, 0}));
  EXPECT_EQ(frame.color(21, 15), (sensors::Rgb{255, 0, 0}));
}

TEST(FromMrpt, MeasuresDepthInAStereoPair) {
  constexpr int kDisparity = 20;
  cv::Mat left(240, 320, CV_8UC1);
  base::Random random(3);
  for (int y = 0; y < left.rows; ++y) {
    for (int x = 0; x < left.cols; ++x)
      left.at<unsigned char>(y, x) = static_cast<unsigned char>(random.integer(0, 255));
  }
  cv::Mat right(left.size(), CV_8UC1, cv::Scalar(0));
  left.colRange(kDisparity, left.cols).copyTo(right.colRange(0, left.cols - kDisparity));

  CObservationStereoImages pair;
  pair.imageLeft = mrpt::img::CImage(left, mrpt::img::DEEP_COPY);
  pair.imageRight = mrpt::img::CImage(right, mrpt::img::DEEP_COPY);
  pair.hasImageRight = true;
  pair.leftCamera.ncols = 320;
  pair.leftCamera.nrows = 240;
  pair.leftCamera.setIntrinsicParamsFromValues(200.0, 200.0, 160.0, 120.0);
  pair.rightCamera = pair.leftCamera;
  pair.rightCameraPose = mrpt::poses::CPose3DQuat(mrpt::poses::CPose3D(0.2, 0.0, 0.0, 0.0, 0.0, 0.0));
  const auto result = reading(pair);
  const auto& frame = as<sensors::RgbdFrame>(result);
  EXPECT_NEAR(frame.depth(200, 120), 200.0 * 0.2 / kDisparity, 0.02);
  EXPECT_EQ(frame.color.width(), 320);

  // The same pair, said to be seen through lenses that bend nothing worth the name: it is rectified first.
  pair.leftCamera.setDistortionPlumbBob(1e-6, 0.0, 0.0, 0.0);
  pair.rightCamera = pair.leftCamera;
  const auto rectified = reading(pair);
  EXPECT_NEAR(as<sensors::RgbdFrame>(rectified).depth(200, 120), 200.0 * 0.2 / kDisparity, 0.05);
}

TEST(FromMrpt, UnfoldsVelodynePackets) {
  CObservationVelodyneScan sweep;
  sweep.calibration = VelodyneCalibration::LoadDefaultCalibration("VLP16");
  CObservationVelodyneScan::TVelodyneRawPacket packet;
  std::memset(&packet, 0, sizeof packet);
  constexpr std::uint16_t kTenMetres = 5000;  // of 2 mm
  auto* bytes = reinterpret_cast<unsigned char*>(&packet);
  for (int block = 0; block < CObservationVelodyneScan::BLOCKS_PER_PACKET; ++block) {
    auto* at = bytes + block * CObservationVelodyneScan::SIZE_BLOCK;
    const std::uint16_t header = CObservationVelodyneScan::UPPER_BANK;
    const auto rotation = static_cast<std::uint16_t>(block * 40);
    std::memcpy(at, &header, sizeof header);
    std::memcpy(at + 2, &rotation, sizeof rotation);
    for (int shot = 0; shot < CObservationVelodyneScan::SCANS_PER_BLOCK; ++shot) {
      std::memcpy(at + 4 + 3 * shot, &kTenMetres, sizeof kTenMetres);
      at[4 + 3 * shot + 2] = 51;
    }
  }
  packet.laser_return_mode = CObservationVelodyneScan::RETMODE_STRONGEST;
  packet.velodyne_model_ID = 0x22;
  sweep.scan_packets = {packet};
  const auto result = reading(sweep);
  EXPECT_EQ(result.sensor, "lidar");
  const auto& cloud = as<sensors::PointCloud>(result);
  ASSERT_GT(cloud.points_in_sensor.size(), 150U);
  ASSERT_EQ(cloud.intensity.size(), cloud.points_in_sensor.size());
  for (const auto& point : cloud.points_in_sensor) EXPECT_NEAR(point.norm(), 10.0F, 0.2F);
  EXPECT_FLOAT_EQ(cloud.intensity[0], 0.2F);
}

/// Written by MRPT itself.
template <typename... Objects>
void writeLog(const std::filesystem::path& path, const Objects&... objects) {
  mrpt::io::CFileGZOutputStream stream(path.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  (archive << ... << objects);
}

TEST(RawlogReader, LendsAnActionWithoutTimeThatOfItsSensoryFrame) {
  CActionRobotMovement2D planar;
  planar.computeFromOdometry(mrpt::poses::CPose2D(1.0, 0.0, M_PI / 2), {});
  CActionRobotMovement3D spatial;
  spatial.poseChange.mean = mrpt::poses::CPose3D(1.0, 0.0, 0.5, 0.0, 0.0, 0.0);
  CActionCollection first;
  first.insert(planar);
  CActionCollection second;
  second.insert(spatial);
  second.insert(planar);
  auto scan = CObservation2DRangeScan::Create();
  scan->timestamp = mrpt::Clock::fromDouble(12.5);
  CSensoryFrame frame;
  frame.insert(scan);
  frame.insert(CObservationGPS::Create());
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "log.rawlog";
  writeLog(path, first, frame, second);

  const auto log = readAll(*openSource(path));
  ASSERT_THAT(log.readings, SizeIs(3));
  ASSERT_THAT(log.skipped, SizeIs(2));
  EXPECT_EQ(base::toString(log.readings[0].time), "12.5");
  EXPECT_TRUE(std::holds_alternative<LaserScan>(log.readings[1].data));
  // 1 m ahead and a quarter to the left, then 1 m ahead and 0.5 m up.
  const auto& pose = as<sensors::Odometry>(log.readings[2]).T_odom_body;
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1.0, 1.0, 0.5), 1e-9)) << pose.matrix();
  EXPECT_EQ(log.skipped[0].reason, "unsupported CObservationGPS");
  EXPECT_EQ(log.skipped[1].reason, "second estimate of a movement");
}

TEST(ExternalImages, AreFoundBesideTheLogOrToldMissing) {
  const test::TemporaryFolder folder;
  const auto log = folder.path() / "walk.rawlog";
  auto image = rangeImage(8, 6, 20.0);
  image.hasIntensityImage = true;
  const cv::Mat picture(6, 8, CV_8UC3, cv::Scalar(3, 2, 1));
  std::filesystem::create_directory(folder.path() / "walk_Images");
  const auto file = folder.path() / "walk_Images" / "picture.png";
  ASSERT_TRUE(mrpt::img::CImage(picture, mrpt::img::DEEP_COPY).saveToFile(file.string()));
  image.intensityImage.setExternalStorage("picture.png");
  writeLog(log, image);
  const auto found = readAll(*openSource(log));
  ASSERT_THAT(found.readings, SizeIs(1));
  EXPECT_EQ(as<sensors::RgbdFrame>(found.readings[0]).color(3, 3), (sensors::Rgb{1, 2, 3}));

  std::filesystem::remove(file);
  testing::internal::CaptureStderr();
  const auto missing = readAll(*openSource(log));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_THAT(missing.skipped, SizeIs(1));
  EXPECT_EQ(missing.skipped[0].reason, "missing image");
  EXPECT_THAT(missing.skipped[0].fault, HasSubstr("walk.rawlog: object 0: expected its external image in "));
  EXPECT_EQ(missing.skipped[0].fault.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace prodomos::io
