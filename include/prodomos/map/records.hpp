// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/reading.hpp"

#include <optional>
#include <string>
#include <vector>

/// The plain rows of a map file that are neither graph nor layers.
namespace prodomos::map {

enum class SessionState { kRunning, kComplete };

/// One log's run.
struct Session {
  base::SessionId id;
  std::string log;      ///< path as given
  std::string logKind;  ///< "MRPT rawlog"
  std::string config;   ///< YAML, every key
  std::string poses;    ///< "odometry", "recorded", a file's path
  std::string version;  ///< of prodomos
  sensors::ClassTable classes;
  geometry::Pose3 T_map_travel =
      geometry::Pose3::Identity();  ///< where the frame of its odometry or recorded poses lies
  base::Time begin{};               ///< of the first reading placed
  base::Time end{};
  SessionState state = SessionState::kRunning;
  double distance = 0.0;  ///< metres
};

/// Places at one height.
struct Floor {
  int number = 0;
  double height = 0.0;  ///< metres, in the map frame
};

/// Where the robot stood at one placed reading.
struct TrajectoryPoint {
  base::SessionId session;
  base::Time time{};
  base::SubMapId submap;
  geometry::Pose3 T_travel_body = geometry::Pose3::Identity();  ///< as travelled
  geometry::Pose3 T_map_body = geometry::Pose3::Identity();     ///< as refined; derived on reading
};

/// Something that changed: a door opens, a prediction is settled, a node moves.
struct Event {
  base::Time time{};
  base::SessionId session;
  std::string kind;     ///< "submap_begun", "submap_finished", "session_finished", …
  std::string subject;  ///< id of what changed: "s12"
  std::string payload;  ///< JSON object
};

/// Where something that moves was at one time.
struct TrackState {
  base::Time time{};
  base::SubMapId submap;
  geometry::Pose3 T_submap_thing = geometry::Pose3::Identity();
  std::optional<Eigen::Vector3d> velocity_in_submap;  ///< m/s
  std::string attributes = "{}";                      ///< JSON object, by class
};

/// One thing that moves, for as long as it was followed.
struct Track {
  base::TrackId id;
  base::SessionId session;
  std::string className;                   ///< "human", "object_box"
  std::string attributes = "{}";           ///< JSON object, by class
  std::vector<TrackState> states;          ///< ascending in time
  std::optional<base::EntityId> entity{};  ///< the same thing where it was seen last
};

/// All running state at a sub-map's end, for `--resume`.
struct Checkpoint {
  base::SessionId session;
  std::vector<std::byte> state;
};

std::string_view toString(SessionState state);

}  // namespace prodomos::map
