// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_drawing.hpp"

#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace prodomos::perception {

namespace {

// In the order of channels of the pictures that networks see: blue, green, red.
const cv::Scalar kBelieved(60, 200, 60);
const cv::Scalar kRefused(60, 60, 230);
const cv::Scalar kBone(230, 160, 40);
const cv::Scalar kHeading(0, 220, 255);

/// Pairs of joints with a bone between them.
constexpr std::array<std::pair<int, int>, 13> kBones{
    {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {1, 5}, {5, 6}, {6, 7}, {1, 8}, {8, 9}, {9, 10}, {1, 11}, {11, 12}, {12, 13}}};

}  // namespace

PeopleDrawing::PeopleDrawing(const UprightView& view, DebugImages* debug)
    : view_(view), debug_(debug != nullptr && debug->isWanted() && !view.picture().empty() ? debug : nullptr) {
  if (debug_ != nullptr) picture_ = view.picture().clone();
}

void PeopleDrawing::add(const PicturedPerson& person, const std::optional<PersonSighting>& sighting) {
  if (debug_ == nullptr) return;
  const cv::Scalar color = sighting ? kBelieved : kRefused;
  cv::rectangle(picture_, person.box.box, color, 2);
  cv::putText(picture_, cv::format("%.2f", person.box.score), person.box.box.tl() + cv::Point2d(3.0, 15.0),
              cv::FONT_HERSHEY_PLAIN, 1.2, color, 2);
  if (person.joints) drawSkeleton(*person.joints, sighting);
  if (sighting) drawHeading(*sighting);
}

/// Joints that lie on something else are not drawn: the network guesses where hidden ones are.
void PeopleDrawing::drawSkeleton(const ImageJoints& joints, const std::optional<PersonSighting>& sighting) {
  const auto isSeen = [&](int i) {
    const auto joint = static_cast<std::size_t>(i);
    return joints[joint].score >= kLeastJointScore && (!sighting || sighting->joints_in_submap[joint]);
  };
  const auto at = [&](int i) { return joints[static_cast<std::size_t>(i)].pixel; };
  for (const auto& [from, to] : kBones) {
    if (isSeen(from) && isSeen(to)) cv::line(picture_, at(from), at(to), kBone, 2);
  }
  for (int i = 0; i < kJointCount; ++i) {
    if (isSeen(i)) cv::circle(picture_, at(i), 3, kBone, cv::FILLED);
  }
}

void PeopleDrawing::drawHeading(const PersonSighting& sighting) {
  const Eigen::Vector3d middle = sighting.position_in_submap + 1.0 * Eigen::Vector3d::UnitZ();
  cv::circle(picture_, view_.pixelOf(middle), 4, kHeading, cv::FILLED);
  if (!sighting.heading) return;
  const Eigen::Vector3d ahead(std::cos(*sighting.heading), std::sin(*sighting.heading), 0.0);
  cv::arrowedLine(picture_, view_.pixelOf(middle), view_.pixelOf(middle + 0.4 * ahead), kHeading, 2);
}

void PeopleDrawing::finish() {
  if (debug_ == nullptr) return;
  cv::Mat rgb;
  cv::cvtColor(picture_, rgb, cv::COLOR_BGR2RGB);
  sensors::Image<sensors::Rgb> image(rgb.cols, rgb.rows);
  std::memcpy(image.data(), rgb.data, image.size() * sizeof(sensors::Rgb));
  debug_->add("people", image);
}

}  // namespace prodomos::perception
