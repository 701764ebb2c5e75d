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

constexpr std::size_t kRightShoulder = 2;
constexpr std::size_t kLeftShoulder = 5;
constexpr std::size_t kRightHip = 8;
constexpr std::size_t kLeftHip = 11;

constexpr double kLeastHeight = 0.9;  ///< metres, of who may sit
constexpr double kMostHeight = 2.3;
constexpr double kUsualHeight = 1.75;
constexpr double kReach = 0.45;     ///< metres from the torso, of arms and legs
constexpr double kTorsoTop = 0.30;  ///< metres below the top of the head
constexpr double kTorsoEnd = 0.80;
constexpr double kHeadTopEnd = 0.03;
constexpr double kHeadEnd = 0.24;
constexpr double kHalfHead = 0.2;
constexpr double kShoulders = 0.34;      ///< metres between the joints
constexpr double kHips = 0.16;           ///< metres between the joints, as networks see them
constexpr double kHalfThickness = 0.10;  ///< of a torso seen from front or back: its middle lies so far behind
constexpr double kHalfWidthMore = 0.05;  ///< the same seen from the side, more than that
constexpr double kFlesh = 0.06;          ///< before a joint
constexpr double kLeastJointScore = 0.1;
constexpr double kSureOfSides = 2.0;  ///< log-odds
constexpr double kEdge = 3.0;         ///< pixels; what comes nearer to the picture's edge is cut by it
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
  double top_z = 0.0;      ///< of what is seen
  bool topIsSeen = false;  ///< not cut by the picture's edge
  bool footIsInPicture = false;
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
  body.topIsSeen = person.box.box.y > kEdge;
  body.footIsInPicture = person.box.box.br().y < view.size().height - kEdge;
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

/// Metres across the view, of all but a little at both sides.
double widthOf(const Body& body) {
  std::vector<double> across;
  for (const Sample& sample : body.torso) across.push_back(body.left.dot(sample.point_in_submap.head<2>()));
  return quantile(across, 0.95) - quantile(across, 0.05);
}

/// A human's size: a head at a human's height, as wide as humans are.
bool isOfHumanSize(const Body& body, double floor_z) {
  const double height = body.top_z - floor_z;
  if (height > kMostHeight || height < (body.topIsSeen ? kLeastHeight : 0.4)) return false;
  const double width = widthOf(body);
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

/// Which way a torso looks, as the camera sees it.
struct Facing {
  double angle = 0.0;  ///< of the torso's axis from the direction to the camera, within a quarter turn, radians
  double sigma = 0.0;
  double across = 0.0;    ///< 1: its shoulders lie across the view, 0: behind each other
  double toCamera = 0.0;  ///< log-odds of its front against its back
};

/// Metres from the right joint to the left one, across the view (to the camera's left) and away from it.
struct Span {
  double left = 0.0;
  std::optional<double> away;  ///< none where depth does not tell
};

std::optional<Span> spanOf(const UprightView& view, const Body& body, const PicturedPerson& person,
                           const PersonSighting& sighting, std::size_t right, std::size_t left) {
  const ImageJoint& from = (*person.joints)[right];
  const ImageJoint& to = (*person.joints)[left];
  if (!isSeen(from) || !isSeen(to)) return std::nullopt;
  const Vector2d camera = view.camera_in_submap().head<2>();
  const double range = (body.middle - camera).norm();
  const auto acrossOf = [&](const ImageJoint& joint) {
    const Vector2d ray = view.pointAt(joint.pixel, 1.0).head<2>() - camera;
    return body.left.dot(ray) * range / body.away.dot(ray);
  };
  Span span{acrossOf(to) - acrossOf(from), std::nullopt};
  const auto& fromPoint = sighting.joints_in_submap[right];
  const auto& toPoint = sighting.joints_in_submap[left];
  if (fromPoint && toPoint) span.away = body.away.dot((*toPoint - *fromPoint).head<2>());
  return span;
}

/// Share of the head's pixels that have a colour of skin (Chai and Ngan 1999); none where too little of it is seen.
std::optional<double> skinOfHead(const UprightView& view, const Body& body) {
  if (!body.topIsSeen) return std::nullopt;
  int head = 0;
  int skin = 0;
  for (const Sample& sample : body.samples) {
    const double below = body.top_z - sample.point_in_submap.z();
    const double beside = body.left.dot(sample.point_in_submap.head<2>() - body.middle);
    if (below < kHeadTopEnd || below > kHeadEnd || std::abs(beside) > kHalfHead) continue;
    const auto& bgr = view.picture().at<cv::Vec3b>(sample.pixel);
    const double luma = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
    const double cr = 128.0 + 0.713 * (bgr[2] - luma);
    const double cb = 128.0 + 0.564 * (bgr[0] - luma);
    ++head;
    if (cr > 133.0 && cr < 180.0 && cb > 77.0 && cb < 127.0) ++skin;
  }
  if (head < 15) return std::nullopt;
  return static_cast<double>(skin) / head;
}

/// The network knows fronts better than backs: of these, it is less sure of the shoulders. Heads without any skin are
/// seen from behind; brown hair may look like skin, so that much of it says little.
double frontEvidence(const UprightView& view, const Body& body, const ImageJoints& joints, const Span& shoulders) {
  constexpr double kEven = 0.265;  // mean score of shoulders that speaks for neither
  constexpr double kSteep = 40.0;
  const double score = 0.5 * (joints[kRightShoulder].score + joints[kLeftShoulder].score);
  double evidence = std::clamp(kSteep * (score - kEven), -2.5, 2.5);
  // Shoulders that lie as those of who faces the camera may be a back's all the same, others hardly a front's.
  evidence += std::clamp(8.0 * (-shoulders.left - 0.24), -1.5, 1.0);
  // What the network makes of someone cut by the picture's edge tells less.
  if (!body.topIsSeen || !body.footIsInPicture) evidence *= 0.3;
  const auto skin = skinOfHead(view, body);
  if (skin && *skin < 0.2) evidence -= 1.5;
  if (skin && *skin > 0.5) evidence += 0.3;
  return evidence;
}

/// From the shoulders, and from the hips where the network sees shoulders too close to each other. Its right and left
/// are not believed: it exchanges them on backs.
std::optional<Facing> facingOf(const UprightView& view, const Body& body, const PicturedPerson& person,
                               const PersonSighting& sighting) {
  const auto shoulders = spanOf(view, body, person, sighting, kRightShoulder, kLeftShoulder);
  if (!shoulders) return std::nullopt;
  const auto hips = spanOf(view, body, person, sighting, kRightHip, kLeftHip);
  Facing facing;
  facing.across = std::abs(shoulders->left) / kShoulders;
  if (hips) facing.across = std::max(facing.across, std::abs(hips->left) / kHips);
  // The network may see the shoulders of a back too close to each other; a torso seen from the side is narrow.
  constexpr double kNarrow = 0.24;
  constexpr double kWide = 0.40;
  facing.across = std::max(facing.across, (widthOf(body) - kNarrow) / (kWide - kNarrow));
  facing.across = std::min(facing.across, 1.0);
  // Who faces the camera has the left shoulder at its right.
  const double away = shoulders->away.value_or(0.0) * (shoulders->left > 0.0 ? -1.0 : 1.0);
  constexpr double kWellAcross = 0.75;
  constexpr double kTold = 0.03;  // metres of depth between shoulders
  if (facing.across > kWellAcross) {
    facing.angle = std::atan2(away, facing.across * kShoulders);
    facing.sigma = 0.25;
  } else {
    facing.angle = std::copysign(std::acos(facing.across), away);
    facing.sigma = std::abs(away) > kTold ? 0.5 : 0.9;
  }
  const double evidence = person.knowsSides ? std::copysign(kSureOfSides, -shoulders->left)
                                            : frontEvidence(view, body, *person.joints, *shoulders);
  facing.toCamera = facing.across * evidence;
  return facing;
}

void setHeading(const Facing& facing, const Body& body, PersonSighting& sighting) {
  const double toCamera = std::atan2(-body.away.y(), -body.away.x());
  const double turn = facing.toCamera < 0.0 ? std::numbers::pi : 0.0;
  sighting.heading = geometry::normalizeAngle(toCamera + facing.angle + turn);
  sighting.headingSigma = facing.sigma;
  sighting.facing = std::abs(facing.toCamera);
}

/// Shares of 16 hues, and of 8 greys for pixels without any.
Appearance appearanceOf(const UprightView& view, const Body& body) {
  Appearance shares{};
  for (const Sample& sample : body.torso) {
    const auto& bgr = view.picture().at<cv::Vec3b>(sample.pixel);
    const auto [least, most] = std::minmax({bgr[0], bgr[1], bgr[2]});
    const int chroma = most - least;
    std::size_t bin = 16 + static_cast<std::size_t>(most) / 32;
    if (chroma > 40 || (most > 40 && 4 * chroma > most)) {
      double hue = 0.0;  // in sixths of a circle
      if (most == bgr[2])
        hue = static_cast<double>(bgr[1] - bgr[0]) / chroma;
      else if (most == bgr[1])
        hue = 2.0 + static_cast<double>(bgr[0] - bgr[2]) / chroma;
      else
        hue = 4.0 + static_cast<double>(bgr[2] - bgr[1]) / chroma;
      bin = static_cast<std::size_t>(std::fmod(hue + 6.0, 6.0) / 6.0 * 16.0) % 16;
    }
    shares[bin] += 1.0F / static_cast<float>(body.torso.size());
  }
  return shares;
}

}  // namespace

std::optional<cv::Rect2d> wholeBodyBox(const UprightView& view, const PersonBox& box) {
  const auto depth = torsoDepth(view, {.box = box});
  if (!depth) return std::nullopt;
  const cv::Point2d middle = (box.box.tl() + box.box.br()) / 2.0;
  constexpr double kStep = 10.0;  // pixels
  const double metres =
      (view.pointAt(middle + cv::Point2d(0.0, kStep), *depth) - view.pointAt(middle, *depth)).norm() / kStep;
  const double height = std::max(box.box.height, kUsualHeight / metres);
  return cv::Rect2d(box.box.tl(), cv::Size2d(box.box.width, height));
}

std::optional<PersonSighting> locate(const UprightView& view, const PicturedPerson& person, double floor_z) {
  const auto body = bodyOf(view, person, floor_z);
  if (!body || !isOfHumanSize(*body, floor_z) || isFlat(view, person, *body)) return std::nullopt;
  PersonSighting sighting;
  sighting.score = person.box.score;
  double behind = kHalfThickness;
  if (person.joints) {
    for (std::size_t i = 0; i < person.joints->size(); ++i) {
      sighting.joints_in_submap[i] = jointIn(view, *body, (*person.joints)[i]);
    }
    if (const auto facing = facingOf(view, *body, person, sighting)) {
      setHeading(*facing, *body, sighting);
      behind += kHalfWidthMore * std::sqrt(1.0 - facing->across * facing->across);
    }
  }
  const Vector2d position = body->middle + behind * body->away;
  sighting.position_in_submap = {position.x(), position.y(), floor_z};
  sighting.positionSigma = 0.03 + 0.005 * (position - view.camera_in_submap().head<2>()).norm();
  if (!view.picture().empty()) sighting.appearance = appearanceOf(view, *body);
  return sighting;
}

}  // namespace prodomos::perception
