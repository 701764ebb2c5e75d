// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/images.hpp"
#include "io/mrpt_readings.hpp"
#include "io/mrpt_values.hpp"

#include <mrpt/obs/CObservationStereoImages.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include <array>

namespace prodomos::io {

namespace {

/// Two pictures of one size whose rows match, seen by two cameras alike, the right one `baseline` along x.
struct RectifiedPair {
  cv::Mat left;
  cv::Mat right;
  sensors::CameraIntrinsics camera;
  double baseline = 0.0;  ///< metres
  Eigen::Matrix3d R_camera_rectified = Eigen::Matrix3d::Identity();
};

cv::Matx33d cameraMatrix(const sensors::CameraIntrinsics& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

cv::Mat grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat result;
  cv::cvtColor(image, result, cv::COLOR_BGR2GRAY);
  return result;
}

RectifiedPair rectified(const cv::Mat& left, const cv::Mat& right,
                        const std::array<sensors::CameraIntrinsics, 2>& cameras, const geometry::Pose3& T_left_right) {
  const geometry::Pose3 T_right_left = T_left_right.inverse();
  cv::Matx33d rotation;
  cv::Vec3d translation;
  cv::eigen2cv(Eigen::Matrix3d(T_right_left.linear()), rotation);
  cv::eigen2cv(Eigen::Vector3d(T_right_left.translation()), translation);
  std::array<cv::Mat, 2> rotations;
  std::array<cv::Mat, 2> projections;
  cv::Mat disparityToDepth;
  cv::stereoRectify(cameraMatrix(cameras[0]), cameras[0].distortion, cameraMatrix(cameras[1]), cameras[1].distortion,
                    left.size(), rotation, translation, rotations[0], rotations[1], projections[0], projections[1],
                    disparityToDepth, cv::CALIB_ZERO_DISPARITY, 0.0);

  std::array<cv::Mat, 2> images = {left, right};
  for (std::size_t i = 0; i < images.size(); ++i) {
    cv::Mat mapX;
    cv::Mat mapY;
    cv::initUndistortRectifyMap(cameraMatrix(cameras[i]), cameras[i].distortion, rotations[i], projections[i],
                                left.size(), CV_32FC1, mapX, mapY);
    cv::Mat straight;
    cv::remap(images[i], straight, mapX, mapY, cv::INTER_LINEAR);
    images[i] = straight;
  }
  RectifiedPair pair{images[0], images[1], {}, T_left_right.translation().norm(), {}};
  const cv::Matx34d projection = projections[0];
  pair.camera = {projection(0, 0), projection(1, 1), projection(0, 2), projection(1, 2), {}};
  Eigen::Matrix3d R_rectified_camera;
  cv::cv2eigen(cv::Mat(rotations[0]), R_rectified_camera);
  pair.R_camera_rectified = R_rectified_camera.transpose();
  return pair;
}

sensors::Image<float> depthBySgbm(const RectifiedPair& pair) {
  constexpr int kBlock = 5;
  constexpr int kDisparitiesPerWidth = 5;  // sees as near as fx * baseline / (width / 5)
  const int disparities = std::max(16, pair.left.cols / kDisparitiesPerWidth / 16 * 16);
  constexpr int kSmallStep = 8 * kBlock * kBlock;
  constexpr int kLargeStep = 32 * kBlock * kBlock;
  const auto matcher = cv::StereoSGBM::create(0, disparities, kBlock, kSmallStep, kLargeStep, 1, 31, 10, 100, 2,
                                              cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat disparity;
  matcher->compute(grey(pair.left), grey(pair.right), disparity);

  sensors::Image<float> depth(disparity.cols, disparity.rows);
  constexpr int kSubpixels = cv::StereoMatcher::DISP_SCALE;
  const double scaledFocal = pair.camera.fx * pair.baseline * kSubpixels;
  for (int y = 0; y < depth.height(); ++y) {
    const auto* from = disparity.ptr<std::int16_t>(y);
    auto* to = depth.row(y);
    for (int x = 0; x < depth.width(); ++x) {
      if (from[x] > 0) to[x] = static_cast<float>(scaledFocal / from[x]);
    }
  }
  return depth;
}

}  // namespace

Conversion convertStereo(const mrpt::obs::CObservationStereoImages& observation) {
  const auto left = toIntrinsics(observation.leftCamera);
  const auto right = toIntrinsics(observation.rightCamera);
  if (!left || !right) return NotConverted{"unsupported camera model"};
  if (observation.imageLeft.isEmpty()) return NotConverted{"empty CObservationStereoImages"};

  sensors::RgbdFrame frame;
  frame.T_body_camera = toPose3(mrpt::poses::CPose3D(observation.cameraPose));
  frame.camera = *left;
  const cv::Mat leftImage = observation.imageLeft.asCvMatRef();
  if (!observation.hasImageRight || observation.imageRight.isEmpty()) {
    frame.color = toColor(leftImage);
    return Converted{std::move(frame)};
  }

  const cv::Mat rightImage = observation.imageRight.asCvMatRef();
  const auto T_left_right = toPose3(mrpt::poses::CPose3D(observation.rightCameraPose));
  if (leftImage.size() != rightImage.size() || T_left_right.translation().x() <= 0.0) {
    return NotConverted{"damaged stereo pair",
                        "expected two images of one size and a baseline, found different sizes or no baseline"};
  }
  const RectifiedPair pair = observation.areImagesRectified()
                                 ? RectifiedPair{leftImage, rightImage, *left, T_left_right.translation().x()}
                                 : rectified(leftImage, rightImage, {*left, *right}, T_left_right);
  frame.camera = pair.camera;
  frame.T_body_camera.linear() = frame.T_body_camera.linear() * pair.R_camera_rectified;
  frame.color = toColor(pair.left);
  frame.depth = depthBySgbm(pair);
  return Converted{std::move(frame)};
}

}  // namespace prodomos::io
