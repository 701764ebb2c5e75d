// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_location.hpp"

#include "prodomos/geometry/plane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace prodomos::perception {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kHeadTop = 0;
constexpr int kNeck = 1;
constexpr int kRightShoulder = 2;
constexpr int kLeftShoulder = 5;
constexpr int kRightHip = 8;
constexpr int kLeftHip = 11;

constexpr double kLeastHeight = 0.9;  ///< metres, of who may sit
constexpr double kMostHeight = 2.3;
constexpr double kReach = 0.45;     ///< metres from the torso, of arms and legs
constexpr double kTorsoTop = 0.30;  ///< metres below the top of the head
constexpr double kTorsoEnd = 0.80;
constexpr double kHeadEnd = 0.24;
constexpr double kShoulders = 0.36;      ///< metres between the joints
constexpr double kHalfThickness = 0.10;  ///< of a torso: the middle lies so far behind the surface that is seen
constexpr double kFlesh = 0.06;          ///< before a joint
constexpr double kLeastJointScore = 0.15;
constexpr std::size_t kLeastSamples = 40;

struct Sample {
  cv::Point pixel;
  Vector3d point_in_submap;
};

/// What is seen of a body, and how it lies before the camera: `away` from it and `left` as the camera sees it, both
/// level.
struct Body {
  std::vector<Sample> samples;
  std::vector<Sample> torso;
  double top_z = 0.0;                  ///< of what is seen
  bool topIsSeen = false;              ///< not cut by the picture's edge
  Vector2d middle = Vector2d::Zero();  ///< of the torso's surface, in the sub-map
  Vector2d away = Vector2d::UnitX();
  Vector2d left = Vector2d::UnitY();
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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
  const cv::Rect2d wanted(box.x + part.x * box.width, box.y + part.y * box.height, part.width * box.width,
                          part.height * box.height);
  const cv::Rect area = cv::Rect(wanted) & cv::Rect(cv::Point(0, 0), view.size());
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

/// The depth about which most of the chest lies: neither a hole nor what stands before it or behind it.
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
  body.topIsSeen = person.box.box.y > 3.0;
  for (const Sample& sample : body.samples) {
    const double below = body.top_z - sample.point_in_submap.z();
    if (below < kTorsoEnd && (below > kTorsoTop || !body.topIsSeen)) body.torso.push_back(sample);
  }
  if (body.torso.size() < kLeastSamples / 2) return std::nullopt;
  std::vector<double> xs;
  std::vector<double> ys;
  for (const Sample& sample : body.torso) {
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

/// A human's size: a head at a human's height, as wide as humans are.
bool isOfHumanSize(const Body& body, double floor_z) {
  const double height = body.top_z - floor_z;
  if (height > kMostHeight || height < (body.topIsSeen ? kLeastHeight : 0.4)) return false;
  std::vector<double> across;
  for (const Sample& sample : body.torso) across.push_back(body.left.dot(sample.point_in_submap.head<2>()));
  const double width = quantile(across, 0.95) - quantile(across, 0.05);
  return width > 0.12 && width < 1.0;
}

/// Whether the torso is a piece of a plane that goes on beside it: a poster, a screen.
bool isFlat(const UprightView& view, const PicturedPerson& person, const Body& body) {
  std::vector<Vector3d> points;
  for (const Sample& sample : body.torso) points.push_back(sample.point_in_submap);
  const auto plane = geometry::fitPlane(points);
  if (!plane) return false;
  int beside = 0;
  int inPlane = 0;
  for (const double x : {-0.35, 1.05}) {
    for (const auto& [pixel, depth] : depthsIn(view, person, {x, 0.1, 0.3, 0.6})) {
      ++beside;
      const double tolerance = 0.03 + 2.0 * sensors::depthSigma(depth);
      if (std::abs(plane->signedDistance(view.pointAt(pixel, depth))) < tolerance) ++inPlane;
    }
  }
  return beside > 20 && inPlane > beside / 2;
}

bool isSeen(const ImageJoint& joint) {
  return joint.score >= kLeastJointScore;
}

/// The joint's depth is that of the body's surface about it; none where something else is seen there.
std::optional<Vector3d> jointIn(const UprightView& view, const Body& body, const ImageJoint& joint) {
  if (!isSeen(joint)) return std::nullopt;
  constexpr double kNear = 0.06;
  std::vector<double> depths;
  const double range = (body.middle - view.camera_in_submap().head<2>()).norm();
  const double pixels = cv::norm(view.pixelOf({body.middle.x(), body.middle.y(), body.top_z}) -
                                 view.pixelOf({body.middle.x(), body.middle.y(), body.top_z - 0.5}));
  const int reach = std::max(1, static_cast<int>(kNear * pixels / 0.5));
  const cv::Point at(joint.pixel);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const double depth = view.depthAt(at + cv::Point(x, y));
      if (depth <= 0.0) continue;
      const Vector3d point = view.pointAt(at + cv::Point(x, y), depth);
      const double away = (point.head<2>() - view.camera_in_submap().head<2>()).norm();
      if (std::abs(away - range) < kReach) depths.push_back(depth);
    }
  }
  if (depths.size() < 3) return std::nullopt;
  return view.pointAt(joint.pixel, median(depths) + kFlesh);
}

}  // namespace

std::optional<PersonSighting> locate(const UprightView& view, const PicturedPerson& person, double floor_z) {
  const auto body = bodyOf(view, person, floor_z);
  if (!body || !isOfHumanSize(*body, floor_z) || isFlat(view, person, *body)) return std::nullopt;
  PersonSighting sighting;
  sighting.score = person.box.score;
  const Vector2d position = body->middle + kHalfThickness * body->away;
  sighting.position_in_submap = {position.x(), position.y(), floor_z};
  sighting.positionSigma = 0.05 + 0.01 * (position - view.camera_in_submap().head<2>()).norm();
  if (person.joints) {
    for (std::size_t i = 0; i < person.joints->size(); ++i) {
      sighting.joints_in_submap[i] = jointIn(view, *body, (*person.joints)[i]);
    }
  }
  return sighting;
}

}  // namespace prodomos::perception
