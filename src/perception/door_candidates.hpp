// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_handle.hpp"
#include "perception/door_segments.hpp"
#include "perception/rectified_wall.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace prodomos::perception {

/// What speaks for or against a door between two upright lines; 0 where the view does not tell.
enum class Cue : std::uint8_t {
  kWeakerJamb,     ///< share of the worse jamb's visible rows that have an edge
  kStrongerJamb,   ///< of the better one's
  kTop,            ///< share of a level edge between the jambs at a door's height
  kTopBeyond,      ///< share of it that goes on outside of the jambs: a dado, a row of lockers, a ledge
  kTopBeyondBoth,  ///< on both sides
  kNoTop,          ///< 1: its height is seen, and there is no level edge
  kSkirting,       ///< an edge as that of a skirting runs through below
  kSkirtingAlike,  ///< what is below looks like the foot of the wall outside
  kReachesFloor,   ///< down to the floor it has its own colour
  kUniform,        ///< share of the leaf that has its colour
  kClutter,        ///< density of edges in it
  kEdgeOfLeaf,     ///< share of the strips beside the jambs that has the leaf's colour
  kFlat,           ///< share of known depths that lie in its plane
  kDepthless,      ///< its depth is not known, that of the wall around it is: one sees through
  kTurned,         ///< how much more of it lies in a plane that is turned, as an ajar leaf is
  kStandsOut,      ///< it lies before the wall around it: a panel, a poster, a board
  kRecessed,       ///< it lies behind it
  kNothingAround,  ///< share of its surroundings that lie far behind it: a cupboard
  kApart,          ///< share of its surroundings that lie before or behind its wall: a leaf that stands open
  kTurnedAbove,    ///< how much more of what is above it lies in a plane that is turned: likewise
  kHandle,         ///< something with corners where a handle must be
  kNarrow,         ///< less wide than doors are
  kWide,           ///< wider
  kLow,            ///< its top is lower than doors are
  kHigh,           ///< higher
  kCut,            ///< share of its outline that is not seen
  kLineInside,     ///< share of a further line just inside of the jambs: these may be the frame's outer edges
  kLineOutside,    ///< share of one just outside of both: as of a frame
  kHidden,         ///< of its sides, how many are where something hides the wall
  kFar,            ///< from 4 m on all else is seen less well, also of a door
  kOblique,        ///< tangent of the angle from the normal
  kCount,
};
using Cues = std::array<double, static_cast<std::size_t>(Cue::kCount)>;

/// A door that may be in a wall, between two upright lines of its image. x, y, z are those of the wall's frame.
struct DoorCandidate {
  UprightLine leftLine;
  UprightLine rightLine;
  double left_x = 0.0;  ///< of the opening, where the jambs truly are
  double right_x = 0.0;
  double leaf_y = 0.0;  ///< of the leaf's plane
  double leafSigma = 0.0;
  double top_z = 0.0;  ///< 0: not seen
  bool bottomIsSeen = false;
  int leaves = 1;
  Handle handle;
  Cues cues{};

  double width() const { return right_x - left_x; }
  double& cue(Cue which) { return cues[static_cast<std::size_t>(which)]; }
  double cue(Cue which) const { return cues[static_cast<std::size_t>(which)]; }
};

/// Pairs of lines as far apart as jambs are, each with its cues.
std::vector<DoorCandidate> pairLines(const RectifiedWall& wall, const WallEdges& edges,
                                     const std::vector<UprightLine>& lines);

}  // namespace prodomos::perception
