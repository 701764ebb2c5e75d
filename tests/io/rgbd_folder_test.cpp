// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/datasets.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace prodomos::io {
namespace {

using sensors::RecordedPose;
using sensors::RgbdFrame;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Four by three pixels, `units` deep.
void writeImages(const test::TemporaryFolder& folder, const std::string& color, const std::string& depth,
                 int units = 5000) {
  folder.write(color, "");
  folder.write(depth, "");
  cv::imwrite((folder.path() / color).string(), cv::Mat(3, 4, CV_8UC3, cv::Scalar(30, 20, 10)));
  cv::imwrite((folder.path() / depth).string(), cv::Mat(3, 4, CV_16UC1, cv::Scalar(units)));
}

Log readQuietly(sensors::SensorSource& source) {
  testing::internal::CaptureStderr();
  auto log = readAll(source);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  return log;
}

class TumFolder : public testing::Test {
 protected:
  TumFolder() {
    for (const auto* name : {"1.00", "2.00", "3.00"}) {
      writeImages(folder_, "rgb/" + std::string(name) + ".png", "depth/" + std::string(name) + ".png");
    }
  }

  void associate(const std::string& lines) { folder_.write("associations.txt", lines); }
  void associateAll() {
    associate(
        "1.00 rgb/1.00.png 1.01 depth/1.00.png\n2.00 rgb/2.00.png 2.01 depth/2.00.png\n"
        "3.00 rgb/3.00.png 3.01 depth/3.00.png\n");
  }
  std::unique_ptr<sensors::SensorSource> open(const SourceOptions& options = {}) {
    return openSource(folder_.path(), options);
  }
  std::vector<std::string> frameTimes() {
    std::vector<std::string> times;
    for (const auto& frame : readAll(*open()).of<RgbdFrame>()) times.push_back(base::toString(frame.time));
    return times;
  }

  test::TemporaryFolder folder_;
};

TEST_F(TumFolder, GivesMetresAndColours) {
  associateAll();
  const auto log = readAll(*open());
  ASSERT_THAT(log.readings, SizeIs(3));
  EXPECT_EQ(log.readings[0].sensor, "camera");
  const auto& frame = as<RgbdFrame>(log.readings[0]);
  EXPECT_EQ(frame.depth.width(), 4);
  EXPECT_EQ(frame.depth.height(), 3);
  EXPECT_FLOAT_EQ(frame.depth(3, 2), 1.0F);
  EXPECT_EQ(frame.color(0, 0), (sensors::Rgb{10, 20, 30}));
  EXPECT_TRUE(frame.T_body_camera.isApprox(sensors::cameraAxesInBody()));
}

TEST_F(TumFolder, TellsWhichOfTheAssociatedFilesIsTheDepth) {
  associate("1.01 depth/1.00.png 1.00 rgb/1.00.png\n");
  EXPECT_THAT(frameTimes(), ElementsAre("1.0"));
}

TEST_F(TumFolder, AssociatesListsByNearestTimeAndUsesEachImageOnce) {
  folder_.write("rgb.txt", "# colour\n1.000 rgb/1.00.png\n1.012 rgb/2.00.png\n3.00 rgb/3.00.png\n");
  folder_.write("depth.txt", "# depth\n1.010 depth/1.00.png\n1.030 depth/2.00.png\n3.5 depth/3.00.png\n");
  EXPECT_THAT(frameTimes(), ElementsAre("1.012"));  // 1.030 is too far from 1.000, 3.5 from 3.0
}

TEST_F(TumFolder, AssumesAKinectAndSaysSo) {
  associateAll();
  const auto source = open();
  EXPECT_THAT(source->info().remarks, ElementsAre(HasSubstr("assumed the intrinsics of a Kinect")));
  const auto frame = readAll(*source).of<RgbdFrame>().front();
  EXPECT_EQ(as<RgbdFrame>(frame).camera, (sensors::CameraIntrinsics{525, 525, 319.5, 239.5, {}}));
}

TEST_F(TumFolder, TakesIntrinsicsFromItsFileAndOptionsOverThat) {
  associateAll();
  folder_.write("camera.yaml", "fx: 500\nfy: 501\ncx: 2\ncy: 1.5\nk1: 0.1\np2: -0.01\ndepth_scale: 2500\n");
  const auto source = open();
  EXPECT_THAT(source->info().remarks, IsEmpty());
  const auto reading = readAll(*source).of<RgbdFrame>().front();
  EXPECT_EQ(as<RgbdFrame>(reading).camera, (sensors::CameraIntrinsics{500, 501, 2, 1.5, {0.1, 0, 0, -0.01, 0}}));
  EXPECT_FLOAT_EQ(as<RgbdFrame>(reading).depth(0, 0), 2.0F);

  SourceOptions options;
  options.camera = sensors::CameraIntrinsics{400, 400, 2, 1, {}};
  options.depthScale = 1000.0;
  const auto chosen = readAll(*open(options)).of<RgbdFrame>().front();
  EXPECT_EQ(as<RgbdFrame>(chosen).camera, *options.camera);
  EXPECT_FLOAT_EQ(as<RgbdFrame>(chosen).depth(0, 0), 5.0F);
}

TEST_F(TumFolder, MergesRecordedPosesInTheOrderOfTime) {
  associateAll();
  // The camera two metres up, looking along the world's x-axis.
  folder_.write("groundtruth.txt",
                "# time x y z qx qy qz qw\n0.5 0 0 2 -0.5 0.5 -0.5 0.5\n2.0 1 0 2 -0.5 0.5 -0.5 0.5\n"
                "9.0 2 0 2 -0.5 0.5 -0.5 0.5\n");
  const auto source = open();
  EXPECT_TRUE(source->info().hasRecordedPoses);
  const auto log = readAll(*source);
  std::vector<std::string> order;
  for (const auto& reading : log.readings) {
    order.push_back(std::string(sensors::kindName(reading.data)) + " " + base::toString(reading.time));
  }
  EXPECT_THAT(order, ElementsAre("recorded_pose 0.5", "rgbd_frame 1.0", "recorded_pose 2.0", "rgbd_frame 2.0",
                                 "rgbd_frame 3.0", "recorded_pose 9.0"));
  const auto& pose = as<RecordedPose>(log.readings[0]).T_world_body;
  EXPECT_TRUE(pose.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-9)) << pose.matrix();
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0, 0, 2)));
}

TEST_F(TumFolder, SkipsToAPlaceWithoutOpeningImages) {
  associateAll();
  folder_.write("groundtruth.txt", "0.5 0 0 2 0 0 0 1\n2.0 1 0 2 0 0 0 1\n");
  std::filesystem::remove(folder_.path() / "rgb/1.00.png");
  const auto source = open();
  source->skip(2);
  const auto log = readAll(*source);
  EXPECT_THAT(log.skipped, IsEmpty());
  ASSERT_THAT(log.readings, SizeIs(3));
  EXPECT_EQ(base::toString(log.readings[0].time), "2.0");
  source->skip(100);
  EXPECT_TRUE(std::holds_alternative<sensors::EndOfLog>(source->next()));
}

TEST_F(TumFolder, PassesOverMissingAndUnreadableImages) {
  associateAll();
  std::filesystem::remove(folder_.path() / "rgb/1.00.png");
  auto png = test::readFile(folder_.path() / "depth/2.00.png");
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 1);
  folder_.write("depth/2.00.png", png);
  const auto log = readQuietly(*open());
  EXPECT_THAT(log.readings, SizeIs(1));
  ASSERT_THAT(log.skipped, SizeIs(2));
  EXPECT_EQ(log.skipped[0].reason, "missing image");
  EXPECT_THAT(log.skipped[0].fault, HasSubstr("rgb/1.00.png: expected an image, found none"));
  EXPECT_EQ(log.skipped[1].reason, "unreadable image");
  EXPECT_THAT(log.skipped[1].fault, HasSubstr("depth/2.00.png: expected a whole image"));
}

TEST_F(TumFolder, PassesOverCutImagesWithoutAWord) {
  associateAll();
  const auto jpeg = folder_.path() / "rgb/1.jpg";
  cv::imwrite(jpeg.string(), cv::Mat(64, 64, CV_8UC3, cv::Scalar(1, 200, 3)));
  const auto whole = test::readFile(jpeg);
  folder_.write("rgb/1.00.png", std::string_view(whole).substr(0, whole.size() - 40));  // content decides, not names
  const auto png = test::readFile(folder_.path() / "depth/2.00.png");
  folder_.write("depth/2.00.png", std::string_view(png).substr(0, png.size() - 20));
  folder_.write("rgb/3.00.png", "not an image");
  const auto log = readQuietly(*open());
  EXPECT_THAT(log.skipped, SizeIs(3));
  for (const auto& skipped : log.skipped) EXPECT_EQ(skipped.reason, "unreadable image") << skipped.fault;
}

TEST_F(TumFolder, PassesOverDepthOfAnotherKind) {
  associate("1.00 rgb/1.00.png 1.01 depth/8bit.png\n2.00 rgb/2.00.png 2.01 depth/large.png\n");
  cv::imwrite((folder_.path() / "depth/8bit.png").string(), cv::Mat(3, 4, CV_8UC1, cv::Scalar(5)));
  cv::imwrite((folder_.path() / "depth/large.png").string(), cv::Mat(6, 8, CV_16UC1, cv::Scalar(5)));
  const auto log = readQuietly(*open());
  ASSERT_THAT(log.skipped, SizeIs(2));
  EXPECT_THAT(log.skipped[0].fault, HasSubstr("expected a depth image of one channel of 16 bits"));
  EXPECT_THAT(log.skipped[1].fault, HasSubstr("expected the 4x3 pixels of its colour image, found 8x6"));
}

TEST_F(TumFolder, RefusesListsWithTimesThatGoBack) {
  associate(
      "1.00 rgb/1.00.png 1.01 depth/1.00.png\n3.00 rgb/3.00.png 3.01 depth/3.00.png\n"
      "2.00 rgb/2.00.png 2.01 depth/2.00.png\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("associations.txt:3: expected a time not before 3.0, found 2.0"));
  associateAll();
  folder_.write("groundtruth.txt", "2.0 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 1\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("groundtruth.txt:2: expected a time not before 2.0"));
}

TEST_F(TumFolder, NamesTheMalformedLineOfAList) {
  associate("1.00 rgb/1.00.png 1.01\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("associations.txt:1: expected `time rgb-file time depth-file`"));
  associateAll();
  folder_.write("camera.yaml", "fx: 500\nfy: abc\ncx: 1\ncy: 1\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("camera.yaml:2: expected"));
  folder_.write("camera.yaml", "fx: 500\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("camera.yaml: expected the key fy, found none"));
}

TEST(PlainFolder, PairsByNumberAndCountsTimeInFrames) {
  const test::TemporaryFolder folder;
  for (const auto* number : {"0010", "0011", "0012"}) {
    writeImages(folder, "rgb/color_" + std::string(number) + ".png", "depth/d" + std::string(number) + ".png", 1000);
  }
  std::filesystem::remove(folder.path() / "depth/d0011.png");
  folder.write("camera.txt", "fx 537 fy 539, cx 3.5 cy: 2.5 (MATLAB 1-based) depth mm/1000; k1 .035 k3 -.2\n");
  SourceOptions options;
  options.framesPerSecond = 10.0;
  const auto source = openSource(folder.path(), options);
  EXPECT_EQ(source->info().kind, "RGB-D folder");
  EXPECT_THAT(source->info().remarks,
              ElementsAre(HasSubstr("one taken off cx and cy"), HasSubstr("assumed 10 frames")));
  const auto log = readAll(*source);
  ASSERT_THAT(log.readings, SizeIs(2));
  ASSERT_THAT(log.skipped, SizeIs(1));
  EXPECT_EQ(log.skipped[0].reason, "missing image");
  EXPECT_EQ(base::toString(log.readings[0].time), "0.0");
  EXPECT_EQ(base::toString(log.readings[1].time), "0.2");
  const auto& frame = as<RgbdFrame>(log.readings[0]);
  EXPECT_EQ(frame.camera, (sensors::CameraIntrinsics{537, 539, 2.5, 1.5, {0.035, 0, 0, 0, -0.2}}));
  EXPECT_FLOAT_EQ(frame.depth(0, 0), 1.0F);
}

TEST(PlainFolder, PairsByOrderWhereNamesDoNotMatch) {
  const test::TemporaryFolder folder;
  writeImages(folder, "rgb/a.png", "depth/x.png", 1000);
  writeImages(folder, "rgb/b.png", "depth/y.png", 2000);
  folder.write("camera.txt", "fx 1 fy 1 cx 0 cy 0");
  const auto log = readAll(*openSource(folder.path()));
  ASSERT_THAT(log.readings, SizeIs(2));
  EXPECT_FLOAT_EQ(as<RgbdFrame>(log.readings[1]).depth(0, 0), 2.0F);
}

TEST(PlainFolder, NeedsIntrinsics) {
  const test::TemporaryFolder folder;
  writeImages(folder, "rgb/0.png", "depth/0.png");
  EXPECT_THAT(errorOf([&] { openSource(folder.path()); }), HasSubstr("expected a camera.txt"));
  folder.write("camera.txt", "fx 1 cx 0 cy 0");
  EXPECT_THAT(errorOf([&] { openSource(folder.path()); }), HasSubstr("camera.txt: expected `fx"));
}

struct RealFolder {
  const char* name;
  const char* kind;
  std::size_t frames;
  bool hasPoses;
};

class RealRgbdFolder : public testing::TestWithParam<RealFolder> {};

TEST_P(RealRgbdFolder, GivesEveryFrame) {
  const auto path = test::dataset(GetParam().name);
  if (!path) GTEST_SKIP() << "needs " << GetParam().name;
  const auto source = openSource(*path);
  EXPECT_EQ(source->info().kind, GetParam().kind);
  EXPECT_EQ(source->info().hasRecordedPoses, GetParam().hasPoses);
  EXPECT_THAT(source->info().remarks, testing::Not(IsEmpty()));
  std::size_t frames = 0;
  for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
    ASSERT_TRUE(std::holds_alternative<sensors::Reading>(item)) << std::get<sensors::Skipped>(item).fault;
    const auto* frame = std::get_if<RgbdFrame>(&std::get<sensors::Reading>(item).data);
    if (frame == nullptr) continue;
    ++frames;
    EXPECT_EQ(frame->depth.width(), 640);
    EXPECT_EQ(frame->color.height(), 480);
  }
  EXPECT_EQ(frames, GetParam().frames);
}

INSTANTIATE_TEST_SUITE_P(Sets, RealRgbdFolder,
                         testing::Values(RealFolder{"rgbd/tum_fr1_rpy", "TUM RGB-D folder", 232, true},
                                         RealFolder{"rgbd/tum_fr3_structure", "TUM RGB-D folder", 30, true},
                                         RealFolder{"rgbd/icsl_corridor", "RGB-D folder", 220, false}));

}  // namespace
}  // namespace prodomos::io
