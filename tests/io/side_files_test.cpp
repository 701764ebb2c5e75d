// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"

#include "log.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace prodomos::io {
namespace {

using sensors::Detections;
using sensors::KeyPoints;
using sensors::RgbdFrame;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A plain folder of three frames at 0, 1 and 2 s, and what is laid beside it.
class SideFiles : public testing::Test {
 protected:
  SideFiles() {
    log_.write("camera.txt", "fx 1 fy 1 cx 0 cy 0");
    for (const auto* name : {"0.png", "1.png", "2.png"}) {
      writeImage("rgb", name, cv::Mat(3, 4, CV_8UC3, cv::Scalar(1, 2, 3)));
      writeImage("depth", name, cv::Mat(3, 4, CV_16UC1, cv::Scalar(1000)));
    }
    options_.framesPerSecond = 1.0;
  }

  void writeImage(const std::string& folder, const std::string& name, const cv::Mat& image) {
    std::filesystem::create_directories(log_.path() / folder);
    cv::imwrite((log_.path() / folder / name).string(), image);
  }
  void useLabels() { options_.labels = log_.path() / "labels"; }

  std::unique_ptr<sensors::SensorSource> open() { return openSource(log_.path(), options_); }

  test::TemporaryFolder log_;
  SourceOptions options_;
};

TEST_F(SideFiles, LabelImagesJoinTheirFrames) {
  writeImage("labels", "0.png", cv::Mat(3, 4, CV_8UC1, cv::Scalar(7)));
  writeImage("labels", "2.0.png", cv::Mat(3, 4, CV_16UC1, cv::Scalar(300)));
  log_.write("labels/classes.yaml", "7: door\n300: stairs\n");
  useLabels();
  const auto source = open();
  EXPECT_EQ(source->info().classes, (sensors::ClassTable{{0, "unlabeled"}, {7, "door"}, {300, "stairs"}}));
  const auto frames = readAll(*source).of<RgbdFrame>();
  ASSERT_THAT(frames, SizeIs(3));
  ASSERT_TRUE(as<RgbdFrame>(frames[0]).labels);
  EXPECT_EQ(as<RgbdFrame>(frames[0]).labels->classes(3, 2), 7);
  EXPECT_FALSE(as<RgbdFrame>(frames[1]).labels);
  ASSERT_TRUE(as<RgbdFrame>(frames[2]).labels);
  EXPECT_EQ(as<RgbdFrame>(frames[2]).labels->classes(0, 0), 300);
}

TEST_F(SideFiles, LabelImagesThatDoNotFitAreLeftOutAndTold) {
  writeImage("labels", "0.png", cv::Mat(5, 4, CV_8UC1, cv::Scalar(7)));
  log_.write("labels/1.png", "junk");
  log_.write("labels/classes.yaml", "7: door\n");
  useLabels();
  const auto frames = readAll(*open()).of<RgbdFrame>();
  EXPECT_FALSE(as<RgbdFrame>(frames[0]).labels);
  EXPECT_THAT(frames[0].fault, HasSubstr("labels/0.png: expected 4x3 pixels like the frame, found 4x5"));
  EXPECT_THAT(frames[1].fault, HasSubstr("labels/1.png: expected an image"));
  EXPECT_EQ(frames[2].fault, "");
}

TEST_F(SideFiles, LabelFoldersNeedAClassTableAndImages) {
  writeImage("labels", "0.png", cv::Mat(3, 4, CV_8UC1, cv::Scalar(7)));
  useLabels();
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("classes.yaml: expected a file of `id: name` lines, found none"));
  log_.write("labels/classes.yaml", "seven: door\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("classes.yaml:1: expected `id: name` lines"));
  log_.write("labels/classes.yaml", "7: door\n");
  std::filesystem::remove(log_.path() / "labels/0.png");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("labels: expected label images"));
}

TEST_F(SideFiles, DetectionsFollowTheReadingOfTheirTime) {
  options_.detections = log_.write("boxes.csv",
                                   "time,class,score,x,y,width,height\n"
                                   "0.0,1,0.9,10,20,30,40\n"
                                   "0.0,2,0.5,1,2,3,4\n"
                                   "# a remark\n"
                                   "1.5,1,1,0,0,5,5,rear\n"
                                   "7.0,1,1,0,0,5,5\n");
  const auto log = readAll(*open());
  std::vector<std::string> order;
  for (const auto& reading : log.readings) {
    order.push_back(std::string(sensors::kindName(reading.data)) + " " + base::toString(reading.time) + " " +
                    reading.sensor);
  }
  EXPECT_THAT(order, ElementsAre("rgbd_frame 0.0 camera", "detections 0.0 camera", "rgbd_frame 1.0 camera",
                                 "detections 1.5 rear", "rgbd_frame 2.0 camera", "detections 7.0 camera"));
  const auto& boxes = as<Detections>(log.readings[1]).boxes;
  ASSERT_THAT(boxes, SizeIs(2));
  EXPECT_EQ(boxes[0].classId, 1);
  EXPECT_EQ(boxes[0].score, 0.9);
  EXPECT_EQ(boxes[0].height, 40.0);
}

TEST_F(SideFiles, KeyPointsAreGatheredByPersonAndJoint) {
  options_.keyPoints = log_.write("joints.csv",
                                  "time,person,joint,x,y,score\n"
                                  "1.0,4,2,10,20,0.5\n"
                                  "1.0,4,0,11,21,0.6\n"
                                  "1.0,5,0,12,22,0.7\n");
  const auto found = readAll(*open()).of<KeyPoints>();
  ASSERT_THAT(found, SizeIs(1));
  const auto& persons = as<KeyPoints>(found[0]).persons;
  ASSERT_THAT(persons, SizeIs(2));
  EXPECT_EQ(persons[0].person, 4);
  ASSERT_THAT(persons[0].joints, SizeIs(3));
  EXPECT_EQ(persons[0].joints[1].score, 0.0);
  EXPECT_EQ(persons[0].joints[2].y, 20.0);
  EXPECT_EQ(persons[1].joints[0].x, 12.0);
}

TEST_F(SideFiles, MalformedLinesAreLeftOutAndTold) {
  options_.detections = log_.write("boxes.csv",
                                   "time,class,score,x,y,width,height\n"
                                   "1.0,1,0.9,10,20,30,40\n"
                                   "1.0,dog,0.9,10,20,30,40\n"
                                   "0.5,1,0.9,10,20,30,40\n"
                                   "1.0,1,nan,10,20,30,40\n");
  const auto found = readAll(*open()).of<Detections>();
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(as<Detections>(found[0]).boxes, SizeIs(1));
  EXPECT_THAT(found[0].fault, HasSubstr("boxes.csv:3: expected `time,class,score"));
}

TEST_F(SideFiles, NeedTheirHeader) {
  options_.detections = log_.write("boxes.csv", "1.0,1,0.9,10,20,30,40\n");
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("boxes.csv:1: expected the header time,class,score"));
  options_.detections = log_.path() / "none.csv";
  EXPECT_THAT(errorOf([&] { open(); }), HasSubstr("none.csv: expected a readable file, found none"));
}

}  // namespace
}  // namespace prodomos::io
