// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_location.hpp"

#include "perception/numeric.hpp"
#include "perception/person_facing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace prodomos::perception {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUsualHeight = 1.75;    ///< metres
constexpr double kReach = 0.45;          ///< metres from the torso, of arms and legs
constexpr double kHalfThickness = 0.10;  ///< of a torso seen from front or back: its middle lies so far behind
constexpr double kHalfWidthMore = 0.05;  ///< the same seen from the side, more than that
constexpr double kFlesh = 0.06;          ///< before a joint

/// The joint's depth is that of the body's surface about it; none where something else is seen there.
std::optional<Vector3d> jointIn(const UprightView& view, const Body& body, const ImageJoint& joint) {
  const cv::Rect2d picture(cv::Point2d(0.0, 0.0), cv::Size2d(view.size()));
  if (joint.score < kLeastJointScore || !picture.contains(joint.pixel)) return std::nullopt;
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

void setHeading(const Facing& facing, const Body& body, PersonSighting& sighting) {
  const double toCamera = std::atan2(-body.away.y(), -body.away.x());
  const double turn = facing.toCamera < 0.0 ? std::numbers::pi : 0.0;
  sighting.heading = geometry::normalizeAngle(toCamera + facing.angle + turn);
  sighting.headingSigma = facing.sigma;
  sighting.facing = std::abs(facing.toCamera);
}

/// In sixths of a circle, of a colour that has one.
double hueOf(const cv::Vec3b& bgr, int most, int chroma) {
  const auto share = [&](int a, int b) { return static_cast<double>(bgr[a] - bgr[b]) / chroma; };
  if (most == bgr[2]) return std::fmod(6.0 + share(1, 0), 6.0);
  if (most == bgr[1]) return 2.0 + share(0, 2);
  return 4.0 + share(2, 1);
}

/// Shares of 16 hues, and of 8 greys for pixels without any.
Appearance appearanceOf(const UprightView& view, const Body& body) {
  Appearance shares{};
  for (const BodySample& sample : body.torso) {
    const auto& bgr = view.picture().at<cv::Vec3b>(sample.pixel);
    const int most = std::max({bgr[0], bgr[1], bgr[2]});
    const int chroma = most - std::min({bgr[0], bgr[1], bgr[2]});
    const bool isGrey = chroma <= 40 && (most <= 40 || 4 * chroma <= most);
    const auto bin = isGrey ? 16 + static_cast<std::size_t>(most) / 32
                            : static_cast<std::size_t>(hueOf(bgr, most, chroma) / 6.0 * 16.0) % 16;
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
    if (const auto facing = facingOf(view, *body, person, sighting.joints_in_submap)) {
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
