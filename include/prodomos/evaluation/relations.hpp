// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/timed_poses.hpp"

#include <filesystem>
#include <vector>

/// Relations between poses, after Kümmerle et al. 2009, "On measuring the accuracy of SLAM algorithms". They need no
/// common frame, and a bend in one place counts only there.
namespace prodomos::evaluation {

/// Where the robot truly was at one time, seen from where it was at another.
struct Relation {
  base::Time first{};
  base::Time second{};
  geometry::Pose3 T_first_second = geometry::Pose3::Identity();
};

/// `t1 t2 x y z roll pitch yaw` a line (seconds, metres, radians), `#` comments. Throws base::FileError naming the line
/// that is malformed or not finite, or the file where it holds no relation.
std::vector<Relation> readRelations(const std::filesystem::path& path);

struct RelationError {
  base::Time first{};
  base::Time second{};
  double translation = 0.0;  ///< metres
  double rotation = 0.0;     ///< radians, not negative
};

/// Of each relation both of whose times are those of a pose (to kStampTolerance), in their order.
std::vector<RelationError> relationErrors(const std::vector<TimedPose>& poses, const std::vector<Relation>& relations);

/// Times are told in microseconds, which may be rounded or cut.
inline constexpr base::Duration kStampTolerance = std::chrono::microseconds(2);

struct RelationScore {
  Statistics translation;                   ///< metres
  Statistics rotation;                      ///< degrees
  std::vector<RelationError> worstShifted;  ///< the greatest errors first
  std::vector<RelationError> worstTurned;
};

RelationScore scoreOf(const std::vector<RelationError>& errors, std::size_t worst = 5);

}  // namespace prodomos::evaluation
