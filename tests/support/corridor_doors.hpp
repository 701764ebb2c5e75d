// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/plane.hpp"
#include "prodomos/perception/rgbd_view.hpp"
#include "prodomos/perception/sightings.hpp"
#include "prodomos/sensors/camera.hpp"
#include "prodomos/sensors/depth_grid.hpp"

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// `rgbd/icsl_corridor`: doors marked by eye, and single frames brought level without poses.
namespace prodomos::test {

/// Top left, top right, bottom right, bottom left, pixels.
using Quad = std::array<Eigen::Vector2d, 4>;

/// What was marked in some frames; between them, and before and after, it moves evenly.
struct MarkedDoor {
  std::string id;
  std::array<int, 2> whole{1, 0};   ///< first and last frame that show all of it
  std::array<int, 2> partly{1, 0};  ///< some of it
  bool counts = false;              ///< a closed door that one can walk through; else neither right nor wrong
  std::map<int, Quad> marks;

  bool isWhole(int frame) const { return frame >= whole[0] && frame <= whole[1]; }
  bool isSeen(int frame) const { return isWhole(frame) || (frame >= partly[0] && frame <= partly[1]); }
  Quad at(int frame) const {
    auto next = marks.lower_bound(frame);
    if (marks.size() == 1) return marks.begin()->second;
    if (next == marks.end()) --next;
    if (next == marks.begin()) ++next;
    const auto last = std::prev(next);
    const double t = static_cast<double>(frame - last->first) / (next->first - last->first);
    Quad quad;
    for (std::size_t i = 0; i < quad.size(); ++i) quad[i] = (1.0 - t) * last->second[i] + t * next->second[i];
    return quad;
  }
};

inline std::vector<MarkedDoor> readMarkedDoors(const std::filesystem::path& file) {
  std::ifstream in(file);
  const auto marked = nlohmann::json::parse(in);
  std::vector<MarkedDoor> doors;
  for (const auto& entry : marked.at("doors")) {
    MarkedDoor door;
    door.id = entry.at("id");
    const auto frames = [&](const char* key) {
      const auto& list = entry.at(key);
      return list.size() == 2 ? std::array<int, 2>{list[0], list[1]} : std::array<int, 2>{1, 0};
    };
    door.whole = frames("frames_whole");
    door.partly = frames("frames_partly");
    // The thin doors of shafts, one that stands open and one that is never whole.
    door.counts = door.id != "D2" && door.id != "D3" && door.id != "D4" && door.id != "D7";
    for (const auto& [frame, corners] : entry.at("corners").items()) {
      Quad quad;
      for (std::size_t i = 0; i < quad.size(); ++i) quad[i] << corners[i][0].get<double>(), corners[i][1].get<double>();
      door.marks[std::stoi(frame)] = quad;
    }
    doors.push_back(door);
  }
  return doors;
}

/// The camera over the floor that it sees, which a hand holds 0.7 to 1.9 m above: z up, origin on the floor below it, x
/// ahead.
inline std::optional<geometry::Pose3> levelByFloor(const sensors::RgbdFrame& frame) {
  const sensors::Camera camera(frame.camera, frame.depth.width(), frame.depth.height());
  const sensors::DepthGrid depth(camera, frame.depth, nullptr, 6.0, nullptr);
  std::vector<Eigen::Vector3d> points;
  for (int y = depth.height() / 2; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); x += 2) {
      if (depth.at(x, y).depth > 0.0F) points.push_back(pointOf(depth.at(x, y)));
    }
  }
  constexpr double kSlant = 0.9;  // cosine, of the camera's y from the vertical
  geometry::PlaneSearch search;
  search.tolerance = [](const Eigen::Vector3d& point) { return 0.02 + 0.004 * point.z(); };
  search.facing = -Eigen::Vector3d::UnitY();
  search.accepts = [&](const geometry::Plane& plane) {
    const double height = std::abs(plane.offset);
    return std::abs(plane.normal.y()) > kSlant && height > 0.7 && height < 1.9;
  };
  base::Random random(1, "floor of a frame");
  const auto floor = geometry::findPlane(points, search, random);
  if (!floor || floor->inliers.size() < 150) return std::nullopt;
  const Eigen::Vector3d up = floor->plane.normal;
  const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitZ() - up.z() * up).normalized();
  geometry::Pose3 T_level_camera = geometry::Pose3::Identity();
  T_level_camera.linear().row(0) = ahead;
  T_level_camera.linear().row(1) = up.cross(ahead);
  T_level_camera.linear().row(2) = up;
  T_level_camera.translation().z() = floor->plane.signedDistance(Eigen::Vector3d::Zero());
  return T_level_camera;
}

/// A door's leaf as the view shows it; none where a corner lies behind the camera.
inline std::optional<Quad> quadOf(const perception::DoorSighting& sighting, const perception::RgbdView& view) {
  const sensors::Camera camera(view.frame.camera, view.frame.color.width(), view.frame.color.height());
  const geometry::Pose3 T_camera_door = view.T_submap_camera.inverse() * sighting.T_submap_door;
  const double half = 0.5 * sighting.door.width;
  const double height = sighting.door.height > 0.0 ? sighting.door.height : 2.0;
  const std::array<Eigen::Vector3d, 4> corners{
      {{0.0, half, height}, {0.0, -half, height}, {0.0, -half, 0.0}, {0.0, half, 0.0}}};
  Quad quad;
  for (std::size_t i = 0; i < quad.size(); ++i) {
    const Eigen::Vector3d point = T_camera_door * corners[i];
    if (point.z() < 0.05) return std::nullopt;
    quad[i] = camera.pixel(point.head<2>() / point.z());
  }
  return quad;
}

/// Areas, square pixels.
struct QuadOverlap {
  double common = 0.0;
  double first = 0.0;
  double second = 0.0;

  double iou() const { return common / std::max(1.0, first + second - common); }
  double ofSmaller() const { return common / std::max(1.0, std::min(first, second)); }
};

inline QuadOverlap overlapOf(const Quad& a, const Quad& b) {
  const auto polygon = [](const Quad& quad) {
    std::vector<cv::Point2f> points;
    for (const auto& corner : quad) points.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    return points;
  };
  const auto first = polygon(a);
  const auto second = polygon(b);
  std::vector<cv::Point2f> common;
  QuadOverlap overlap;
  overlap.first = cv::contourArea(first);
  overlap.second = cv::contourArea(second);
  overlap.common = static_cast<double>(cv::intersectConvexConvex(first, second, common));
  return overlap;
}

/// The marked door that a sighting shows; "" where it touches one, or one that was marked some frames off; none: there
/// is no door.
inline std::optional<std::string> nameOf(const perception::DoorSighting& sighting, const perception::RgbdView& view,
                                         int frame, const std::vector<MarkedDoor>& doors) {
  constexpr int kNear = 12;  // frames
  const auto quad = quadOf(sighting, view);
  if (!quad) return std::nullopt;
  bool touches = false;
  for (const auto& door : doors) {
    const bool isNear = frame >= door.marks.begin()->first - kNear && frame <= door.marks.rbegin()->first + kNear;
    if (!door.isSeen(frame) && !isNear) continue;
    const QuadOverlap overlap = overlapOf(*quad, door.at(frame));
    if (overlap.iou() > 0.5) return door.id;
    touches = touches || overlap.ofSmaller() > 0.5;
  }
  return touches ? std::optional<std::string>("") : std::nullopt;
}

}  // namespace prodomos::test
