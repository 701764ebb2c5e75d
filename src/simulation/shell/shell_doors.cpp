// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/shell.hpp"

#include "simulation/shell/openings.hpp"
#include "simulation/shell/shell_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kLeafThickness = 0.04;

/// A door's opening as a body: where its jambs (0: y = -width/2, 1: +width/2) end in the faces of its two rooms.
struct Tunnel {
  geometry::Pose3 T_world_door = geometry::Pose3::Identity();
  double width = 0.0;
  double height = 0.0;
  std::array<std::array<double, 2>, 2> faces{};  ///< x by side and jamb

  Eigen::Vector3d corner(std::size_t side, std::size_t jamb, double z) const {
    return T_world_door * Eigen::Vector3d(faces[side][jamb], (jamb == 0 ? -0.5 : 0.5) * width, z);
  }
};

Tunnel tunnelOf(const Building& building, const Door& door) {
  const auto& storey = building.storeys[static_cast<std::size_t>(door.storey)];
  return {.T_world_door = geometry::toPose3(door.pose, storey.floor_z),
          .width = door.width,
          .height = std::min(door.height, storey.ceilingHeight),
          .faces = {faceOf(building, door, 0), faceOf(building, door, 1)}};
}

const Room* roomOf(const Building& building, const Door& door, std::size_t side) {
  return door.rooms[side] == kOutside ? nullptr : &building.rooms[static_cast<std::size_t>(door.rooms[side])];
}

void addQuad(Surface& surface, const std::array<Eigen::Vector3d, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const auto& corner : corners) {
    surface.vertices.push_back(corner.cast<float>());
    surface.textureCoordinates.push_back(corner.head<2>().cast<float>());
  }
  surface.triangles.push_back({first, first + 1, first + 2});
  surface.triangles.push_back({first, first + 2, first + 3});
}

/// The side from which people mostly see the door: the corridor's, else that of the greater room.
std::size_t corridorSide(const Building& building, const Door& door) {
  const auto weight = [&](std::size_t side) {
    const Room* room = roomOf(building, door, side);
    if (room == nullptr) return 0.0;
    return signedArea(room->outline) + (room->use == RoomUse::kCorridor ? 1e6 : 0.0);
  };
  return weight(1) > weight(0) ? 1 : 0;
}

/// The x in the door's frame of the plane in which the leaf turns: its surface on the side that it opens to.
double hingePlane(const Building& building, const Door& door, const DoorLook& look) {
  const auto tunnel = tunnelOf(building, door);
  // Both jambs must hold the leaf, also where a face is not quite parallel to it.
  const double least = std::max(tunnel.faces[0][0], tunnel.faces[0][1]);
  const double most = std::min(tunnel.faces[1][0], tunnel.faces[1][1]);
  const bool seenFromSecond = corridorSide(building, door) == 1;
  const double seen = seenFromSecond ? most - look.recess : least + look.recess;
  const double behind = seenFromSecond ? seen - kLeafThickness : seen + kLeafThickness;
  double plane = door.opensAlongNormal ? std::max(seen, behind) : std::min(seen, behind);
  // A leaf that opens beyond the right angle would cut into its jamb if it hung deeper than the face.
  constexpr double kNearlyRight = 89.0 * std::numbers::pi / 180.0;
  const auto opensWide = [](const Swing& swing) { return swing.angle > kNearlyRight; };
  if (std::ranges::any_of(door.swings, opensWide)) plane = door.opensAlongNormal ? most : least;
  return door.opensAlongNormal ? std::clamp(plane, std::min(least + kLeafThickness, most), most)
                               : std::clamp(plane, least, std::max(most - kLeafThickness, least));
}

/// Boxes of one leaf in its own frame: x along the leaf from its hinge, y out of the side that it opens to, z up from
/// the floor.
class LeafBuilder {
 public:
  LeafBuilder(const Door& door, double height, const DoorLook& look, std::uint16_t classId, std::uint16_t instance)
      : width_(leafWidthOf(door)),
        height_(height),
        isDouble_(door.leaves == 2),
        look_(look),
        classId_(classId),
        instance_(instance) {}

  std::vector<Surface> build(const HouseLook& house, bool isSlidingDoor) const {
    std::vector<Surface> parts{
        box({width_ / 2.0, -kLeafThickness / 2.0, height_ / 2.0}, {width_, kLeafThickness, height_}, look_.leaf)};
    if (isSlidingDoor) return parts;
    Surface metal = made(house.metal());
    for (const double side : {1.0, -1.0}) addHandle(side, metal);
    // Two leaves meet on a strip: else they would look like one.
    if (isDouble_) addOverlay(metal, {width_ - 0.015, width_}, {0.0, height_});
    if (look_.hasKickPlate) addOverlay(metal, {0.03, width_ - 0.03}, {0.03, 0.28});
    parts.push_back(std::move(metal));
    if (look_.hasWindow) {
      Surface glass = made(house.glass());
      const double left = 0.55 * width_;
      addOverlay(glass, {left, std::min(left + 0.18, width_ - 0.16)}, {1.0, height_ - 0.25});
      parts.push_back(std::move(glass));
    }
    return parts;
  }

 private:
  Surface made(const Material& material) const {
    return {.material = material, .classId = classId_, .instance = instance_};
  }

  Surface box(const Eigen::Vector3d& middle, const Eigen::Vector3d& size, const Material& material) const {
    geometry::Pose3 T_leaf_box = geometry::Pose3::Identity();
    T_leaf_box.translation() = middle;
    return boxSurface(T_leaf_box, size, material, classId_, instance_);
  }

  void addBox(Surface& surface, const Eigen::Vector3d& middle, const Eigen::Vector3d& size) const {
    append(surface, box(middle, size, surface.material));
  }

  /// The middle of a thing that lies on one of the leaf's two sides, its depth known.
  static double onSide(double side, double depth) { return side > 0.0 ? depth / 2.0 : -kLeafThickness - depth / 2.0; }

  /// A lever on a plate, near the edge away from the hinge.
  void addHandle(double side, Surface& metal) const {
    constexpr double kHeight = 1.05;
    constexpr double kFromEdge = 0.065;
    constexpr double kPlateDepth = 0.008;
    constexpr double kNeck = 0.05;
    const double x = width_ - kFromEdge;
    addBox(metal, {x, onSide(side, kPlateDepth), kHeight - 0.04}, {0.04, kPlateDepth, 0.22});
    addBox(metal, {x, onSide(side, kNeck), kHeight}, {0.018, kNeck, 0.018});
    const double leverOffset = side > 0.0 ? kNeck : -kLeafThickness - kNeck;
    addBox(metal, {x + 0.009 - look_.leverLength / 2.0, leverOffset, kHeight}, {look_.leverLength, 0.016, 0.02});
  }

  /// A sheet on both sides of the leaf.
  void addOverlay(Surface& surface, std::array<double, 2> along, std::array<double, 2> heights) const {
    constexpr double kDepth = 0.003;
    for (const double side : {1.0, -1.0}) {
      addBox(surface, {(along[0] + along[1]) / 2.0, onSide(side, kDepth), (heights[0] + heights[1]) / 2.0},
             {along[1] - along[0], kDepth, heights[1] - heights[0]});
    }
  }

  double width_;
  double height_;
  bool isDouble_;
  const DoorLook& look_;
  std::uint16_t classId_;
  std::uint16_t instance_;
};

/// Maps a leaf's own frame into the world; a leaf that hangs the other way round is its mirror image.
geometry::Pose3 leafPose(const Tunnel& tunnel, const Hinge& hinge, double plane, double angle) {
  const double closed = hinge.y_in_door > 0.0 ? -std::numbers::pi / 2.0 : std::numbers::pi / 2.0;
  return tunnel.T_world_door * geometry::toPose3({plane, hinge.y_in_door, closed + hinge.turn * angle});
}

Surface mirrored(Surface surface) {
  for (auto& vertex : surface.vertices) vertex.y() = -vertex.y();
  for (auto& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  return surface;
}

}  // namespace

bool hasFrame(const Building& building, const Door& door) {
  constexpr double kWidestDoorway = 1.3;
  const double ceiling = building.storeys[static_cast<std::size_t>(door.storey)].ceilingHeight;
  return door.leaves > 0 || (door.width <= kWidestDoorway && door.height < ceiling - 0.1);
}

void addTunnel(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces) {
  const Door& door = building.doors[index];
  const Tunnel tunnel = tunnelOf(building, door);
  const Room* room = roomOf(building, door, corridorSide(building, door));
  const Room nowhere;
  Surface threshold{.material = look.floor(room == nullptr ? nowhere : *room), .classId = classId("floor")};
  addQuad(threshold,
          {tunnel.corner(0, 0, 0.0), tunnel.corner(1, 0, 0.0), tunnel.corner(1, 1, 0.0), tunnel.corner(0, 1, 0.0)});
  const bool framed = hasFrame(building, door);
  Surface lining{.material = framed ? look.frame() : look.wall(room == nullptr ? nowhere : *room),
                 .classId = classId(framed ? "door_frame" : "wall"),
                 .instance = framed ? doorInstance(index) : std::uint16_t{0}};
  addQuad(lining, {tunnel.corner(0, 1, tunnel.height), tunnel.corner(1, 1, tunnel.height),
                   tunnel.corner(1, 0, tunnel.height), tunnel.corner(0, 0, tunnel.height)});
  const Eigen::Vector3d up(0.0, 0.0, tunnel.height);
  addRectangle(lining, tunnel.corner(1, 0, 0.0), tunnel.corner(0, 0, 0.0) - tunnel.corner(1, 0, 0.0), up);
  addRectangle(lining, tunnel.corner(0, 1, 0.0), tunnel.corner(1, 1, 0.0) - tunnel.corner(0, 1, 0.0), up);
  surfaces.insert(surfaces.end(), {std::move(threshold), std::move(lining)});
}

void addFrame(const Building& building, std::size_t index, const HouseLook& look, std::vector<Surface>& surfaces) {
  const Door& door = building.doors[index];
  if (!hasFrame(building, door)) return;
  const Tunnel tunnel = tunnelOf(building, door);
  const DoorLook doorLook = look.door(index);
  const double board = doorLook.frameWidth;
  Surface frame{.material = look.frame(), .classId = classId("door_frame"), .instance = doorInstance(index)};
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const Eigen::Vector3d foot = tunnel.corner(side, 0, 0.0);
    const Eigen::Vector3d span = tunnel.corner(side, 1, 0.0) - foot;
    const double width = span.norm();
    // Frame of the boards: x along the wall from one jamb to the other, z up.
    geometry::Pose3 T_world_boards = geometry::Pose3::Identity();
    T_world_boards.linear() = Eigen::AngleAxisd(std::atan2(span.y(), span.x()), Eigen::Vector3d::UnitZ()).matrix();
    T_world_boards.translation() = foot;
    const double out = (side == 0 ? 0.5 : -0.5) * doorLook.frameDepth;
    const auto addBoard = [&](double x, double z, double sizeX, double sizeZ) {
      geometry::Pose3 T_boards_board = geometry::Pose3::Identity();
      T_boards_board.translation() = Eigen::Vector3d(x, out, z);
      append(frame, boxSurface(T_world_boards * T_boards_board, {sizeX, doorLook.frameDepth, sizeZ}, frame.material,
                               frame.classId, frame.instance));
    };
    addBoard(-board / 2.0, tunnel.height / 2.0, board, tunnel.height);
    addBoard(width + board / 2.0, tunnel.height / 2.0, board, tunnel.height);
    addBoard(width / 2.0, tunnel.height + board / 2.0, width + 2.0 * board, board);
  }
  surfaces.push_back(std::move(frame));
}

double leafOffset(const Building& building, std::size_t door, std::uint64_t seed) {
  const Door& hung = building.doors[door];
  if (hung.leaves == 0) return 0.0;
  const double behind = hung.opensAlongNormal ? -kLeafThickness / 2.0 : kLeafThickness / 2.0;
  return hingePlane(building, hung, HouseLook(building, seed).door(door)) + behind;
}

std::vector<Surface> leavesAt(const Building& building, std::size_t door, double time, std::uint64_t seed) {
  const Door& hung = building.doors[door];
  const HouseLook house(building, seed);
  const DoorLook look = house.door(door);
  const bool isLift = isLiftDoor(building, hung);
  const Tunnel tunnel = tunnelOf(building, hung);
  const double plane = hingePlane(building, hung, look);
  const double angle = isLift ? 0.0 : openingAngle(hung, time);
  const LeafBuilder builder(hung, tunnel.height, look, classId(isLift ? "lift_door" : "door"), doorInstance(door));
  std::vector<Surface> leaves;
  for (const Hinge& hinge : hingesOf(hung)) {
    const auto T_world_leaf = leafPose(tunnel, hinge, plane, angle);
    for (auto& part : builder.build(house, isLift)) {
      leaves.push_back(transformed(T_world_leaf, hinge.turn > 0.0 ? std::move(part) : mirrored(std::move(part))));
    }
  }
  return leaves;
}

}  // namespace prodomos::simulation
