// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/images.hpp"
#include "io/mrpt_readings.hpp"
#include "io/mrpt_values.hpp"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace prodomos::io {

namespace {

using mrpt::obs::CObservation3DRangeScan;

cv::Matx33d cameraMatrix(const sensors::CameraIntrinsics& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

/// Where the pixels of an image look: x and y at z = 1, row by row.
std::vector<cv::Point2f> pixelRays(const sensors::CameraIntrinsics& camera, int width, int height) {
  std::vector<cv::Point2f> pixels;
  pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) pixels.emplace_back(static_cast<float>(x), static_cast<float>(y));
  }
  std::vector<cv::Point2f> rays;
  cv::undistortPoints(pixels, rays, cameraMatrix(camera), camera.distortion);
  return rays;
}

sensors::Image<float> depthImage(const CObservation3DRangeScan& observation, const sensors::CameraIntrinsics& camera) {
  const auto& ranges = observation.rangeImage;
  sensors::Image<float> depth(static_cast<int>(ranges.cols()), static_cast<int>(ranges.rows()));
  for (int y = 0; y < depth.height(); ++y) {
    auto* row = depth.row(y);
    for (int x = 0; x < depth.width(); ++x) row[x] = static_cast<float>(ranges(y, x)) * observation.rangeUnits;
  }
  if (observation.range_is_depth || depth.empty()) return depth;

  const auto rays = pixelRays(camera, depth.width(), depth.height());
  std::transform(depth.data(), depth.data() + depth.size(), rays.begin(), depth.data(),
                 [](float range, const cv::Point2f& ray) { return range / std::hypot(ray.x, ray.y, 1.0F); });
  return depth;
}

/// The colour that each pixel with depth has in the picture of another camera; black where it has none there. What the
/// other camera cannot see because something nearer hides it is coloured like that nearer thing.
sensors::Image<sensors::Rgb> registeredColor(const sensors::Image<float>& depth,
                                             const sensors::CameraIntrinsics& depthCamera,
                                             const sensors::Image<sensors::Rgb>& color,
                                             const sensors::CameraIntrinsics& colorCamera,
                                             const geometry::Pose3& T_color_depth) {
  sensors::Image<sensors::Rgb> registered(depth.width(), depth.height());
  const auto rays = pixelRays(depthCamera, depth.width(), depth.height());
  std::vector<std::size_t> indices;
  std::vector<cv::Point3f> points_in_color;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double z = depth.data()[i];
    const Eigen::Vector3d p_in_color = T_color_depth * Eigen::Vector3d(rays[i].x * z, rays[i].y * z, z);
    if (z <= 0.0 || p_in_color.z() <= 0.0) continue;
    indices.push_back(i);
    points_in_color.emplace_back(static_cast<float>(p_in_color.x()), static_cast<float>(p_in_color.y()),
                                 static_cast<float>(p_in_color.z()));
  }
  if (indices.empty()) return registered;

  std::vector<cv::Point2f> pixels;
  cv::projectPoints(points_in_color, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), cameraMatrix(colorCamera),
                    colorCamera.distortion, pixels);
  const cv::Rect2f inside(-0.5F, -0.5F, static_cast<float>(color.width()), static_cast<float>(color.height()));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (!inside.contains(pixels[i])) continue;
    const int x = std::clamp(static_cast<int>(std::lround(pixels[i].x)), 0, color.width() - 1);
    const int y = std::clamp(static_cast<int>(std::lround(pixels[i].y)), 0, color.height() - 1);
    registered.data()[indices[i]] = color(x, y);
  }
  return registered;
}

/// MRPT keeps a set of labels a pixel, label k as bit k; of several the lowest counts. Our id is k + 1, as 0 says none.
template <unsigned kBytes>
bool readLabels(const mrpt::obs::TPixelLabelInfoBase& labels, sensors::Image<std::uint16_t>& classes) {
  const auto* typed = dynamic_cast<const mrpt::obs::TPixelLabelInfo<kBytes>*>(&labels);
  if (typed == nullptr) return false;
  const auto& bits = typed->pixelLabels;
  classes = sensors::Image<std::uint16_t>(static_cast<int>(bits.cols()), static_cast<int>(bits.rows()));
  for (int y = 0; y < classes.height(); ++y) {
    auto* row = classes.row(y);
    for (int x = 0; x < classes.width(); ++x) {
      const std::uint64_t set = bits(y, x);
      row[x] = set == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(std::countr_zero(set) + 1);
    }
  }
  return true;
}

std::optional<sensors::LabelImage> labelImage(const CObservation3DRangeScan& observation) {
  if (!observation.pixelLabels) return std::nullopt;
  sensors::LabelImage labels;
  const auto& source = *observation.pixelLabels;
  const bool known = readLabels<1>(source, labels.classes) || readLabels<2>(source, labels.classes) ||
                     readLabels<4>(source, labels.classes) || readLabels<8>(source, labels.classes);
  return known && !labels.classes.empty() ? std::optional(labels) : std::nullopt;
}

sensors::Image<sensors::Rgb> colorImage(const mrpt::img::CImage& image) {
  if (image.isEmpty()) return {};
  auto color = toColor(image.asCvMatRef());
  if (image.isColor() && image.getChannelsOrder() == "RGB") {
    for (std::size_t i = 0; i < color.size(); ++i) std::swap(color.data()[i].r, color.data()[i].b);
  }
  return color;
}

template <typename A, typename B>
bool sameSize(const sensors::Image<A>& a, const sensors::Image<B>& b) {
  return a.width() == b.width() && a.height() == b.height();
}

/// Points that the log carries instead of a range image.
Conversion organisedPoints(const CObservation3DRangeScan& observation) {
  sensors::PointCloud cloud;
  cloud.T_body_sensor = toPose3(observation.sensorPose);
  for (std::size_t i = 0; i < observation.points3D_x.size(); ++i) {
    const Eigen::Vector3f point(observation.points3D_x[i], observation.points3D_y[i], observation.points3D_z[i]);
    if (point.allFinite() && !point.isZero()) cloud.points_in_sensor.push_back(point);
  }
  return Converted{std::move(cloud)};
}

/// A picture without depth, seen by the camera that took it.
Conversion colorAlone(const CObservation3DRangeScan& observation, sensors::RgbdFrame frame) {
  const auto camera = toIntrinsics(observation.cameraParamsIntensity);
  if (!camera) return NotConverted{"unsupported camera model"};
  frame.camera = *camera;
  frame.T_body_camera = toPose3(observation.sensorPose) * toPose3(observation.relativePoseIntensityWRTDepth);
  return Converted{std::move(frame)};
}

}  // namespace

sensors::ClassTable classTable(const mrpt::obs::CObservation& observation) {
  const auto* image = dynamic_cast<const CObservation3DRangeScan*>(&observation);
  if (image == nullptr || !image->pixelLabels) return {};
  sensors::ClassTable classes = {{0, "unlabeled"}};
  for (const auto& [label, name] : image->pixelLabels->pixelLabelNames) classes[static_cast<int>(label) + 1] = name;
  return classes;
}

Conversion convertRangeImage(const CObservation3DRangeScan& observation) {
  sensors::RgbdFrame frame;
  if (observation.hasIntensityImage) frame.color = colorImage(observation.intensityImage);
  if (!observation.hasRangeImage) {
    if (observation.hasPoints3D) return organisedPoints(observation);
    if (frame.color.empty()) return NotConverted{"empty CObservation3DRangeScan"};
    return colorAlone(observation, std::move(frame));
  }

  const auto camera = toIntrinsics(observation.cameraParams);
  if (!camera) return NotConverted{"unsupported camera model"};
  frame.camera = *camera;
  frame.T_body_camera = toPose3(observation.sensorPose) * sensors::cameraAxesInBody();
  frame.depth = depthImage(observation, frame.camera);
  if (frame.depth.empty()) return NotConverted{"empty CObservation3DRangeScan"};

  const bool oneCamera = observation.doDepthAndIntensityCamerasCoincide() && sameSize(frame.color, frame.depth);
  if (!frame.color.empty() && !oneCamera) {
    const auto colorCamera = toIntrinsics(observation.cameraParamsIntensity);
    if (!colorCamera) return NotConverted{"unsupported camera model"};
    const geometry::Pose3 T_color_depth =
        toPose3(observation.relativePoseIntensityWRTDepth).inverse() * sensors::cameraAxesInBody();
    frame.color = registeredColor(frame.depth, frame.camera, frame.color, *colorCamera, T_color_depth);
  }
  Converted result{std::move(frame)};
  if (auto labels = labelImage(observation)) {
    auto& labelled = std::get<sensors::RgbdFrame>(result.data);
    if (sameSize(labels->classes, labelled.depth)) {
      labelled.labels = std::move(labels);
    } else {
      result.damage = "expected labels of the size of the range image, found another size";
    }
  }
  return result;
}

}  // namespace prodomos::io
