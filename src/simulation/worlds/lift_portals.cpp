// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/lift_portals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prodomos::simulation {
namespace {

constexpr double kSliceHeight = 1.2;
constexpr double kBand = 0.3;    ///< in which a wall lies off its door's model
constexpr double kWidest = 2.0;  ///< from the model to a jamb
constexpr double kDepth = 1.5;   ///< of a cabin: its mesh is not there

Eigen::Vector2d inPose(const geometry::Pose2& pose, const Eigen::Vector2d& point) {
  return Eigen::Rotation2Dd(-pose.theta) * (point - Eigen::Vector2d(pose.x, pose.y));
}

Eigen::Vector2d outOfPose(const geometry::Pose2& pose, const Eigen::Vector2d& point) {
  return Eigen::Rotation2Dd(pose.theta) * point + Eigen::Vector2d(pose.x, pose.y);
}

double lintelOver(const StoreyMesh& mesh, const geometry::Pose2& pose, double width) {
  constexpr double kLowest = 1.5;
  double lintel = mesh.storey.ceilingHeight;
  for (const auto& surface : mesh.surfaces) {
    if (surface.classId != classId("wall")) continue;
    for (const auto& vertex : surface.vertices) {
      const Eigen::Vector2d p = inPose(pose, vertex.head<2>().cast<double>());
      const double z = static_cast<double>(vertex.z()) - mesh.floor();
      if (std::abs(p.x()) < kBand && std::abs(p.y()) < width / 2.0 + 0.01 && z > kLowest) lintel = std::min(lintel, z);
    }
  }
  return lintel;
}

}  // namespace

std::optional<LiftPortal> portalAt(const StoreyMesh& mesh, const geometry::Pose2& door) {
  const auto walls = sliceOf(mesh, "wall", kSliceHeight);
  for (const double turn : {std::numbers::pi / 2.0, 0.0}) {
    const geometry::Pose2 pose{door.x, door.y, door.theta + turn};
    // The jambs' corners left and right, and how deep the wall is there.
    double left = kWidest;
    double right = -kWidest;
    Eigen::AlignedBox1d depth;
    for (const auto& wall : walls) {
      for (const auto& corner : {inPose(pose, wall.a), inPose(pose, wall.b)}) {
        if (std::abs(corner.x()) > kBand || std::abs(corner.y()) > kWidest) continue;
        if (corner.y() > 0.0) left = std::min(left, corner.y());
        if (corner.y() < 0.0) right = std::max(right, corner.y());
        depth.extend(Eigen::Matrix<double, 1, 1>(corner.x()));
      }
    }
    if (left >= kWidest || right <= -kWidest || depth.isEmpty()) continue;
    const Eigen::Vector2d middle = outOfPose(pose, {depth.center().x(), (left + right) / 2.0});
    LiftPortal portal{
        .pose = {middle.x(), middle.y(), pose.theta}, .width = left - right, .wallThickness = depth.sizes().x()};
    if (hasFloorAt(mesh, outOfPose(portal.pose, {1.0, 0.0}))) portal.pose.theta += std::numbers::pi;
    portal.pose.theta = geometry::normalizeAngle(portal.pose.theta);
    portal.height = lintelOver(mesh, portal.pose, portal.width);
    return portal;
  }
  return std::nullopt;
}

Polygon cabinOf(const LiftPortal& portal) {
  const double front = portal.wallThickness / 2.0;
  Polygon outline;
  for (const auto& corner :
       cornersOf({Eigen::Vector2d(front, -portal.width / 2.0), Eigen::Vector2d(front + kDepth, portal.width / 2.0)})) {
    outline.push_back(outOfPose(portal.pose, corner));
  }
  return outline;
}

void addCabin(StoreyMesh& mesh, const LiftPortal& portal) {
  const Polygon outline = cabinOf(portal);
  const auto at = [](const Eigen::Vector2d& p, double z) { return Eigen::Vector3d(p.x(), p.y(), z); };
  const double top = mesh.floor() + portal.height;
  Surface walls{.material = {.color = {186, 190, 193}, .gloss = 0.5F}, .classId = classId("wall")};
  // All sides but the front, which runs from the last corner to the first; seen from inside.
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    addRectangle(walls, at(outline[i + 1], mesh.floor()), at(outline[i] - outline[i + 1], 0.0),
                 {0.0, 0.0, portal.height});
  }
  const Eigen::Vector3d x = at(outline[1] - outline[0], 0.0);
  const Eigen::Vector3d y = at(outline[3] - outline[0], 0.0);
  const Eigen::Vector3d threshold = -x.normalized() * portal.wallThickness;
  Surface floor{.material = {.color = {92, 94, 98}}, .classId = classId("floor")};
  addRectangle(floor, at(outline[0], mesh.floor()) + threshold, x - threshold, y);
  Surface ceiling{.material = {.color = {230, 230, 228}}, .classId = classId("ceiling")};
  addRectangle(ceiling, at(outline[0], top), y, x);
  mesh.surfaces.insert(mesh.surfaces.end(), {std::move(walls), std::move(floor), std::move(ceiling)});

  // Two jambs and a lintel on the wall before the cabin.
  constexpr double kBoard = 0.1;
  constexpr double kThickness = 0.02;
  const geometry::Pose3 T_world_portal = geometry::toPose3(portal.pose, mesh.floor());
  const Material steel{.color = {150, 154, 158}, .gloss = 0.4F};
  const double face = -portal.wallThickness / 2.0 - kThickness / 2.0;
  const auto board = [&](double y_in_portal, double z, const Eigen::Vector3d& size) {
    geometry::Pose3 T_world_board = T_world_portal;
    T_world_board.translate(Eigen::Vector3d(face, y_in_portal, z));
    mesh.surfaces.push_back(boxSurface(T_world_board, size, steel, classId("door_frame"), 0));
  };
  for (const double side : {1.0, -1.0}) {
    board(side * (portal.width + kBoard) / 2.0, portal.height / 2.0, {kThickness, kBoard, portal.height});
  }
  board(0.0, portal.height + kBoard / 2.0, {kThickness, portal.width + 2.0 * kBoard, kBoard});
}

}  // namespace prodomos::simulation
