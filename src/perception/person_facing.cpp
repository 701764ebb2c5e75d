// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/person_facing.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::perception {

namespace {

using Eigen::Vector2d;
using Joints = std::array<std::optional<Eigen::Vector3d>, kJointCount>;

constexpr std::size_t kRightShoulder = 2;
constexpr std::size_t kLeftShoulder = 5;
constexpr std::size_t kRightHip = 8;
constexpr std::size_t kLeftHip = 11;

constexpr double kHeadTopEnd = 0.03;  ///< metres below the top
constexpr double kHeadEnd = 0.24;
constexpr double kHalfHead = 0.2;
constexpr double kShoulders = 0.34;   ///< metres between the joints
constexpr double kHips = 0.16;        ///< metres between the joints, as networks see them
constexpr double kSureOfSides = 2.0;  ///< log-odds

/// Metres from the right joint to the left one, across the view (to the camera's left) and away from it.
struct Span {
  double left = 0.0;
  std::optional<double> away;  ///< none where depth does not tell
};

std::optional<Span> spanOf(const UprightView& view, const Body& body, const PicturedPerson& person,
                           const Joints& joints_in_submap, std::size_t right, std::size_t left) {
  const ImageJoint& from = (*person.joints)[right];
  const ImageJoint& to = (*person.joints)[left];
  if (from.score < kLeastJointScore || to.score < kLeastJointScore) return std::nullopt;
  const Vector2d camera = view.camera_in_submap().head<2>();
  const double range = (body.middle - camera).norm();
  const auto acrossOf = [&](const ImageJoint& joint) {
    const Vector2d ray = view.pointAt(joint.pixel, 1.0).head<2>() - camera;
    return body.left.dot(ray) * range / body.away.dot(ray);
  };
  Span span{acrossOf(to) - acrossOf(from), std::nullopt};
  const auto& fromPoint = joints_in_submap[right];
  const auto& toPoint = joints_in_submap[left];
  if (fromPoint && toPoint) span.away = body.away.dot((*toPoint - *fromPoint).head<2>());
  return span;
}

/// Share of the head's pixels that have a colour of skin (Chai and Ngan 1999); none where too little of it is seen.
std::optional<double> skinOfHead(const UprightView& view, const Body& body) {
  if (!body.topIsSeen) return std::nullopt;
  int head = 0;
  int skin = 0;
  for (const BodySample& sample : body.samples) {
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

}  // namespace

std::optional<Facing> facingOf(const UprightView& view, const Body& body, const PicturedPerson& person,
                               const std::array<std::optional<Eigen::Vector3d>, kJointCount>& joints_in_submap) {
  const auto shoulders = spanOf(view, body, person, joints_in_submap, kRightShoulder, kLeftShoulder);
  if (!shoulders) return std::nullopt;
  const auto hips = spanOf(view, body, person, joints_in_submap, kRightHip, kLeftHip);
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

}  // namespace prodomos::perception
