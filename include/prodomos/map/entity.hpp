// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace prodomos::map {

enum class Mobility { kStatic, kQuasiStatic, kDynamic };

/// 002 §II-C. The entity's x-axis points uphill, its position is the centroid of the flight.
struct Staircase {
  double height = 0.0;      ///< of the new floor above this one, metres; negative: the flight descends
  double stepWidth = 0.0;   ///< metres
  double stepHeight = 0.0;  ///< metres, 0 = not measured
  double stepDepth = 0.0;   ///< metres, 0 = not measured
  int stepCount = 0;        ///< 0 = not counted
};

enum class HingeSide { kUnknown, kLeft, kRight };
enum class DoorState { kUnknown, kClosed, kAjar, kOpen };

/// 002 §II-D. The entity's x-axis is the normal, pointing to the far side; its position is the centre of the leaf.
struct Door {
  double width = 0.0;                         ///< metres
  double height = 0.0;                        ///< metres, 0 = not measured
  bool hasLeaf = true;                        ///< false: an open doorway
  HingeSide hingeSide = HingeSide::kUnknown;  ///< as seen along the x-axis
  DoorState state = DoorState::kUnknown;
};

/// 002 §II-E. The entity's x-axis is the direction of the torso.
struct Human {
  int dominantSide = 0;                                ///< -1 left, +1 right, 0 not known
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< in the sub-map, m/s
};

/// A thing that moves, as an oriented box (000, 001). The entity's position is the centre.
struct ObjectBox {
  int classId = 0;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< in the sub-map, m/s
};

/// A thing that stands, as an oriented box (000).
struct Cuboid {
  int classId = 0;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// A piece of a plane (000). The entity's z-axis is the normal, its position the centroid.
struct PlanePatch {
  double area = 0.0;                              ///< m²
  std::vector<Eigen::Vector2d> outline_in_patch;  ///< in the patch's x-y-plane
};

/// All classes of entities. A closed set, so that a new one must be handled everywhere.
using EntityAttributes = std::variant<Staircase, Door, Human, ObjectBox, Cuboid, PlanePatch>;

/// A labelled group of points with a pose and attributes: a_r = (t, o, c) of 002 §II-A.
struct Entity {
  base::EntityId id;
  base::SubMapId submap;
  geometry::Pose3 T_submap_entity = geometry::Pose3::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< of (t, rotation vector)
  double confidence = 0.0;                                                       ///< 0 … 1
  int observations = 0;
  base::Time firstSeen{};
  base::Time lastSeen{};
  EntityAttributes attributes;
  std::vector<Eigen::Vector3f> points_in_submap;  ///< may be empty
};

/// Metres that a staircase covers on the ground; none where neither its steps nor its points tell, nor of what is none.
std::optional<double> runOf(const Entity& entity);

/// "staircase", "door", "human", "object_box", "cuboid", "plane_patch".
std::string_view className(const EntityAttributes& attributes);
Mobility mobility(const EntityAttributes& attributes);
std::string_view toString(Mobility mobility);
std::string_view toString(HingeSide side);
std::string_view toString(DoorState state);

/// One JSON object with the attributes of the class, and back. Throws base::Error on what toJson() would not write.
std::string toJson(const EntityAttributes& attributes);
EntityAttributes entityAttributesFromJson(std::string_view className, std::string_view json);

}  // namespace prodomos::map
