// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/time.hpp"
#include "prodomos/evaluation/timed_poses.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/sensors/reading.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// All that can be known of a simulated log: `LOG.truth.json` (docs/truth.md). Frame `world`, metres, radians, times of
/// the log. Where a thing is named, it is by its id; `instance` is its number in instance images, 0 for none.
namespace prodomos::evaluation {

struct TrueStorey {
  double floor_z = 0.0;
  double ceilingHeight = 0.0;
};

struct TrueRoom {
  std::string id;
  int storey = 0;
  std::string label;
  std::string use;  ///< "room", "corridor", "stairs", "lift"
  std::vector<Eigen::Vector2d> outline;
  std::optional<base::Time> entered;  ///< when the robot first stood in it
};

struct TrueDoorState {
  base::Time time{};
  double angle = 0.0;  ///< radians from closed
  map::DoorState state = map::DoorState::kClosed;
};

/// How far a door or a flight came to be seen.
struct Sighting {
  double share = 0.0;               ///< of the leaf (of a flight: steps), all frames together, as docs/truth.md has it
  bool visible = false;             ///< share ≥ 0.8; of a flight: 3 steps
  std::optional<base::Time> since;  ///< when it became visible
  bool passed = false;              ///< the path came within 3 m of it, on its storey and on a side it can be seen from
  std::vector<base::Time> images;   ///< in which it is wholly seen: what 002's recall per image counts
};

struct TrueDoor {
  std::string id;
  std::uint16_t instance = 0;
  int storey = 0;
  std::array<std::string, 2> rooms;  ///< ids; empty: outside. The x-axis points from the first into the second
  geometry::Pose3 T_world_door = geometry::Pose3::Identity();  ///< middle of the opening on the floor
  double width = 0.0;
  double height = 0.0;
  double wallThickness = 0.0;
  double leafOffset = 0.0;                              ///< of the closed leaf from the wall's middle, along the x-axis
  int leaves = 1;                                       ///< 0: a doorway
  map::HingeSide hingeSide = map::HingeSide::kUnknown;  ///< seen along the x-axis; unknown: none or two leaves
  std::vector<TrueDoorState> states;                    ///< at each change of state, the first at the log's begin
  Sighting sighting;
};

struct TrueStaircase {
  std::string id;
  std::uint16_t instance = 0;
  std::array<int, 2> storeys{0, 1};  ///< lower, upper
  std::array<std::string, 2> rooms;  ///< of foot and head
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();
  Eigen::Vector3d head = Eigen::Vector3d::Zero();
  double direction = 0.0;  ///< uphill
  double width = 0.0;
  double stepDepth = 0.0;
  double stepHeight = 0.0;
  int stepCount = 0;
  Sighting sighting;
};

struct TrueObjectPose {
  base::Time time{};
  geometry::Pose3 T_world_object = geometry::Pose3::Identity();  ///< middle of the box
};

struct TrueObject {
  std::string id;
  std::uint16_t instance = 0;
  int classId = 0;
  int storey = 0;
  map::Mobility mobility = map::Mobility::kStatic;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::vector<TrueObjectPose> poses;  ///< one, or one a frame of what moves
  double seen = 0.0;                  ///< m² of its surface that the camera saw; 0: never
};

inline constexpr int kJointCount = 14;

struct TruePersonState {
  base::Time time{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the floor
  double heading = 0.0;                                ///< of the torso
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, kJointCount> joints{};  ///< in the order of docs/truth.md
  int pixels = 0;                                     ///< that the camera saw of it
};

struct TruePerson {
  std::string id;
  std::uint16_t instance = 0;
  std::vector<TruePersonState> states;  ///< one a camera frame
};

/// A flat piece of wall, floor or furniture.
struct TruePlane {
  std::string id;
  int classId = 0;
  int storey = 0;
  geometry::Pose3 T_world_plane = geometry::Pose3::Identity();  ///< z-axis: normal, towards the free side
  std::vector<Eigen::Vector2d> outline_in_plane;
  double seen = 0.0;  ///< m² that the camera saw
};

struct TrueLift {
  std::string id;
  std::vector<std::string> rooms;  ///< ids, by storey
  std::vector<Eigen::Vector2d> outline;
};

struct Truth {
  std::string building;
  std::uint64_t seed = 0;
  std::string labels;  ///< "none", "true", "degraded"
  sensors::ClassTable classes;
  std::vector<TrueStorey> storeys;
  std::vector<TrueRoom> rooms;
  std::vector<TrueDoor> doors;
  std::vector<TrueStaircase> stairs;
  std::vector<TrueObject> objects;
  std::vector<TruePerson> people;
  std::vector<TruePlane> planes;
  std::vector<TrueLift> lifts;
  std::vector<TimedPose> trajectory;  ///< T_world_body at each reading of camera or laser
};

/// "LOG.truth.json" beside "LOG.rawlog".
std::filesystem::path truthPath(const std::filesystem::path& log);

/// Throw base::FileError naming file, key, expected and found.
Truth readTruth(const std::filesystem::path& path);
void writeTruth(const Truth& truth, const std::filesystem::path& path);

}  // namespace prodomos::evaluation
