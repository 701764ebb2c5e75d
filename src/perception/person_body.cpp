// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_body.hpp"

#include "prodomos/geometry/plane.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::perception {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLeastHeight = 0.9;  ///< metres, of who may sit
constexpr double kMostHeight = 2.3;
constexpr double kLeastWidth = 0.12;
constexpr double kMostWidth = 1.0;
constexpr double kReach = 0.45;     ///< metres from the torso, of arms and legs
constexpr double kTorsoTop = 0.30;  ///< metres below the top of the head
constexpr double kTorsoEnd = 0.80;
constexpr double kEdge = 3.0;  ///< pixels; what comes nearer to the picture's edge is cut by it
constexpr std::size_t kLeastSamples = 40;

/// The value that the given share of all lies below.
double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Pixels of a part of the box (shares of its sides) where depth is known, no more than some 2000 of the whole box.
std::vector<std::pair<cv::Point, double>> depthsIn(const UprightView& view, const PicturedPerson& person,
                                                   const cv::Rect2d& part) {
  const cv::Rect2d& box = person.box.box;
  const bool isSane = std::isfinite(box.x + box.y) && box.area() > 0.0 &&
                      box.width + box.height < 10.0 * (view.size().width + view.size().height);
  if (!isSane) return {};
  const cv::Rect2d wanted(box.x + part.x * box.width, box.y + part.y * box.height, part.width * box.width,
                          part.height * box.height);
  const cv::Rect area = wanted & cv::Rect2d(cv::Point2d(0.0, 0.0), cv::Size2d(view.size()));
  const int step = std::max(1, static_cast<int>(std::sqrt(box.area() / 2000.0)));
  std::vector<std::pair<cv::Point, double>> depths;
  for (int y = area.y; y < area.y + area.height; y += step) {
    for (int x = area.x; x < area.x + area.width; x += step) {
      if (person.mask != nullptr && person.mask->at<std::uint8_t>(y, x) == 0) continue;
      const double depth = view.depthAt({x, y});
      if (depth > 0.0) depths.emplace_back(cv::Point(x, y), depth);
    }
  }
  return depths;
}

}  // namespace

std::optional<double> torsoDepth(const UprightView& view, const PicturedPerson& person) {
  std::vector<double> depths;
  for (const auto& [pixel, depth] : depthsIn(view, person, {0.25, 0.1, 0.5, 0.5})) depths.push_back(depth);
  if (depths.size() < kLeastSamples / 2) return std::nullopt;
  std::ranges::sort(depths);
  constexpr double kThickness = 0.35;
  std::size_t most = 0;
  std::size_t first = 0;
  for (std::size_t begin = 0, end = 0; begin < depths.size(); ++begin) {
    while (end < depths.size() && depths[end] <= depths[begin] + kThickness) ++end;
    if (end - begin > most) {
      most = end - begin;
      first = begin;
    }
  }
  if (most < depths.size() / 4) return std::nullopt;
  return depths[first + most / 2];
}

std::optional<Body> bodyOf(const UprightView& view, const PicturedPerson& person, double floor_z) {
  const auto depth = torsoDepth(view, person);
  if (!depth) return std::nullopt;
  Body body;
  std::vector<double> heights;
  for (const auto& [pixel, d] : depthsIn(view, person, {0.0, 0.0, 1.0, 1.0})) {
    if (std::abs(d - *depth) > kReach) continue;
    const Vector3d point = view.pointAt(pixel, d);
    if (point.z() < floor_z + 0.05) continue;
    body.samples.push_back({pixel, point});
    heights.push_back(point.z());
  }
  if (body.samples.size() < kLeastSamples) return std::nullopt;
  body.top_z = quantile(heights, 0.99);
  body.topIsSeen = person.box.box.y > kEdge;
  body.footIsInPicture = person.box.box.br().y < view.size().height - kEdge;
  for (const BodySample& sample : body.samples) {
    const double below = body.top_z - sample.point_in_submap.z();
    if (below < kTorsoEnd && (below > kTorsoTop || !body.topIsSeen)) body.torso.push_back(sample);
  }
  if (body.torso.size() < kLeastSamples / 2) return std::nullopt;
  std::vector<double> xs;
  std::vector<double> ys;
  for (const BodySample& sample : body.torso) {
    xs.push_back(sample.point_in_submap.x());
    ys.push_back(sample.point_in_submap.y());
  }
  body.middle = {median(xs), median(ys)};
  const Vector2d way = body.middle - view.camera_in_submap().head<2>();
  if (way.norm() < 0.1) return std::nullopt;
  body.away = way.normalized();
  body.left = {-body.away.y(), body.away.x()};
  return body;
}

double widthOf(const Body& body) {
  std::vector<double> across;
  for (const BodySample& sample : body.torso) across.push_back(body.left.dot(sample.point_in_submap.head<2>()));
  return quantile(across, 0.95) - quantile(across, 0.05);
}

bool isOfHumanSize(const Body& body, double floor_z) {
  const double height = body.top_z - floor_z;
  if (height > kMostHeight || height < (body.topIsSeen ? kLeastHeight : 0.4)) return false;
  const double width = widthOf(body);
  return width > kLeastWidth && width < kMostWidth;
}

bool isFlat(const UprightView& view, const PicturedPerson& person, const Body& body) {
  std::vector<Vector3d> points;
  for (const BodySample& sample : body.torso) points.push_back(sample.point_in_submap);
  const auto plane = geometry::fitPlane(points);
  if (!plane) return false;
  std::size_t beside = 0;
  std::size_t inPlane = 0;
  for (const double x : {-0.35, 1.05}) {
    for (const auto& [pixel, depth] : depthsIn(view, person, {x, 0.1, 0.3, 0.6})) {
      ++beside;
      const double tolerance = 0.03 + 2.0 * sensors::depthSigma(depth);
      if (std::abs(plane->signedDistance(view.pointAt(pixel, depth))) < tolerance) ++inPlane;
    }
  }
  // Where nothing is known beside it, what is may be an arm.
  return beside > body.torso.size() / 3 && inPlane > beside / 2;
}

}  // namespace prodomos::perception
