// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/image.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Value types of one reading. Frames: `body` is the robot (x ahead, y left, z up, origin on the floor below it);
/// `sensor` is a laser or lidar with the same axes; `camera` has the axes of an image (x right, y down, z ahead).
namespace prodomos::sensors {

/// A fan of ranges in the sensor's x-y-plane. Beam i points to angle firstAngle + i * angleStep.
struct LaserScan {
  geometry::Pose3 T_body_sensor = geometry::Pose3::Identity();
  double firstAngle = 0.0;    ///< radians, counter-clockwise from the sensor's x-axis
  double angleStep = 0.0;     ///< radians, may be negative
  double maxRange = 0.0;      ///< metres
  double sweepTime = 0.0;     ///< seconds from the first beam, at the reading's time, to the last; 0 = not known
  std::vector<float> ranges;  ///< metres; kNoReturn: nothing within maxRange; kInvalid: the beam says nothing

  static constexpr float kNoReturn = std::numeric_limits<float>::infinity();
  static constexpr float kInvalid = -1.0F;
};

/// Where wheel odometry believes the body to be, in a frame of its own that drifts.
struct Odometry {
  geometry::Pose3 T_odom_body = geometry::Pose3::Identity();
};

/// A pose that the log carries from elsewhere (motion capture, another SLAM system).
struct RecordedPose {
  geometry::Pose3 T_world_body = geometry::Pose3::Identity();
};

/// Pinhole camera with the radial-tangential distortion of OpenCV, pixels.
struct CameraIntrinsics {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3

  bool operator==(const CameraIntrinsics&) const = default;
};

/// Class ids and their names; id 0 is "unlabeled".
using ClassTable = std::map<int, std::string>;

/// One class id per pixel, and where known how sure (0 … 1) and which instance.
struct LabelImage {
  Image<std::uint16_t> classes;
  Image<float> confidence;         ///< may be empty
  Image<std::uint16_t> instances;  ///< may be empty; 0 = no instance
};

/// Depth registered to colour: one pixel grid, one camera. Either image may be empty, not both.
struct RgbdFrame {
  geometry::Pose3 T_body_camera = geometry::Pose3::Identity();
  CameraIntrinsics camera;
  Image<float> depth;  ///< metres along the camera's z; 0 = not known
  Image<Rgb> color;
  std::optional<LabelImage> labels;
};

/// Points of one sweep. The optional parts are empty or as long as `points`.
struct PointCloud {
  geometry::Pose3 T_body_sensor = geometry::Pose3::Identity();
  std::vector<Eigen::Vector3f> points_in_sensor;  ///< metres
  std::vector<float> intensity;                   ///< 0 … 1
  std::vector<Rgb> color;
  std::vector<std::uint16_t> labels;  ///< class ids
};

/// Boxes of a 2D detector in the pixels of the camera named by the reading's sensor label.
struct Detection {
  int classId = 0;
  double score = 1.0;
  double x = 0.0;  ///< left
  double y = 0.0;  ///< top
  double width = 0.0;
  double height = 0.0;
};
struct Detections {
  std::vector<Detection> boxes;
};

/// Joints of the persons in an image, in pixels; a joint with score 0 was not seen.
struct KeyPoint {
  double x = 0.0;
  double y = 0.0;
  double score = 0.0;
};
struct PersonKeyPoints {
  int person = 0;  ///< identity where the source tracks, else the running number in the frame
  std::vector<KeyPoint> joints;
};
struct KeyPoints {
  std::vector<PersonKeyPoints> persons;
};

using ReadingData = std::variant<LaserScan, Odometry, RecordedPose, RgbdFrame, PointCloud, Detections, KeyPoints>;

/// One reading of one sensor.
struct Reading {
  base::Time time;
  std::string sensor;  ///< the label of the sensor in its log, for `--sensor`
  ReadingData data;
  std::string fault{};  ///< where part of it was damaged and left out: one line with file and place; else empty
};

/// The kind's name in reports: "laser_scan", "odometry", "recorded_pose", "rgbd_frame", "point_cloud", "detections",
/// "key_points".
std::string_view kindName(const ReadingData& data);

/// True where the pixel or the point is one of something that moves. Empty: nothing moves.
using Mask = Image<std::uint8_t>;

/// Body axes of a camera that looks ahead: maps camera coordinates (x right, y down, z ahead) into x ahead, y left, z
/// up.
geometry::Pose3 cameraAxesInBody();

}  // namespace prodomos::sensors
