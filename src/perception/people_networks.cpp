// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/people_networks.hpp"

#include "prodomos/base/error.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <functional>

namespace prodomos::perception {

namespace {

constexpr float kLeastScore = 0.1F;

/// OpenCV's own messages name neither the file nor always the fault.
cv::dnn::Net loaded(const std::vector<std::filesystem::path>& files, const std::function<cv::dnn::Net()>& load) {
  for (const auto& file : files) {
    if (!std::filesystem::is_regular_file(file)) {
      throw base::FileError(base::expectedFound(file.string(), "a network", "no file"));
    }
  }
  try {
    cv::dnn::Net net = load();
    if (!net.empty()) return net;
  } catch (const cv::Exception&) {
    // Told below.
  }
  throw base::FileError(base::expectedFound(files.back().string(), "a network", "something else, or a damaged one"));
}

cv::dnn::Net darknet(const std::filesystem::path& folder, const std::string& name) {
  const auto layers = folder / (name + ".cfg");
  const auto weights = folder / (name + ".weights");
  return loaded({layers, weights}, [&] { return cv::dnn::readNetFromDarknet(layers.string(), weights.string()); });
}

}  // namespace

double overlap(const cv::Rect2d& a, const cv::Rect2d& b) {
  const double common = (a & b).area();
  return common / (a.area() + b.area() - common);
}

std::vector<PersonBox> withoutDoubles(std::vector<PersonBox> boxes, double most) {
  std::ranges::stable_sort(boxes, std::greater{}, &PersonBox::score);
  std::vector<PersonBox> kept;
  for (const PersonBox& box : boxes) {
    const auto isSame = [&](const PersonBox& other) { return overlap(box.box, other.box) > most; };
    if (std::ranges::none_of(kept, isSame)) kept.push_back(box);
  }
  return kept;
}

PersonBoxes::PersonBoxes(const std::filesystem::path& folder)
    : body_(darknet(folder, "yolo-fastest-1.1_body")), classes_(darknet(folder, "yolo-fastest-1.1")) {}

std::vector<PersonBox> PersonBoxes::detect(cv::dnn::Net& net, const cv::Mat& picture) {
  net.setInput(cv::dnn::blobFromImage(picture, 1.0 / 255.0, {320, 320}, {}, true));
  std::vector<cv::Mat> outputs;
  net.forward(outputs, net.getUnconnectedOutLayersNames());
  std::vector<PersonBox> boxes;
  for (const cv::Mat& output : outputs) {
    for (int i = 0; i < output.rows; ++i) {
      // Middle and size as shares of the picture, objectness, scores by class: persons are class 0 of both networks.
      const float* row = output.ptr<float>(i);
      const float score = row[5];
      if (!(score >= kLeastScore)) continue;
      const cv::Size2d size(double{row[2]} * picture.cols, double{row[3]} * picture.rows);
      const cv::Point2d middle(double{row[0]} * picture.cols, double{row[1]} * picture.rows);
      boxes.push_back({{middle - cv::Point2d(size) / 2.0, size}, double{score}});
    }
  }
  return withoutDoubles(std::move(boxes), 0.45);
}

JointFinder::JointFinder(const std::filesystem::path& folder) {
  const auto file = folder / "hourglass_pose14.pb";
  net_ = loaded({file}, [&] { return cv::dnn::readNetFromTensorflow(file.string()); });
}

ImageJoints JointFinder::find(const cv::Mat& picture, const cv::Rect2d& box) {
  // The network sees a square around the box, a quarter larger, black beyond the picture.
  constexpr int kInput = 192;
  const double size = 1.25 * std::max(box.width, box.height);
  const cv::Point2d corner = (box.tl() + box.br()) / 2.0 - cv::Point2d(size, size) / 2.0;
  const double scale = kInput / size;
  const cv::Matx23d toInput(scale, 0.0, -corner.x * scale, 0.0, scale, -corner.y * scale);
  cv::Mat input;
  cv::warpAffine(picture, input, toInput, {kInput, kInput}, cv::INTER_LINEAR);
  net_.setInput(cv::dnn::blobFromImage(input));
  const cv::Mat heat = net_.forward("hourglass_out_3");  // 1 x joints x rows x columns
  const int rows = heat.size[2];
  const int columns = heat.size[3];
  ImageJoints joints;
  for (int j = 0; j < kJointCount; ++j) {
    const cv::Mat map(rows, columns, CV_32F, const_cast<float*>(heat.ptr<float>(0, j)));  // only read
    cv::Mat smooth;
    cv::GaussianBlur(map, smooth, {5, 5}, 0.0);
    cv::Point peak;
    double height = 0.0;
    cv::minMaxLoc(smooth, nullptr, &height, nullptr, &peak);
    const cv::Point2d pixel = corner + (cv::Point2d(peak) + cv::Point2d(0.5, 0.5)) * (size / columns);
    joints[static_cast<std::size_t>(j)] = {pixel, std::clamp(height, 0.0, 1.0)};
  }
  return joints;
}

}  // namespace prodomos::perception
