// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/rectified_wall.hpp"

#include <optional>
#include <vector>

namespace prodomos::perception::open_doors {

/// What a strip of wall from the floor to the height of a door shows.
enum class Strip : std::uint8_t {
  kUnknown,
  kWall,    ///< surface in the wall's plane, from wherever up
  kOpen,    ///< what lies behind the plane, down to near the floor
  kHidden,  ///< something before the plane
};

/// Columns from `left` to `right`, both included.
struct Gap {
  int left = 0;
  int right = 0;
};

/// A wall as seen along the floor: its strips, and where they let one see through it.
class WallProfile {
 public:
  static constexpr double kStep = 0.025;  ///< metres a strip

  WallProfile(const RgbdView& view, const Surfaces& surfaces, const Wall& wall);

  const Wall& wall() const { return wall_; }
  int count() const { return static_cast<int>(strips_.size()); }
  Strip strip(int column) const {
    return column < 0 || column >= count() ? Strip::kUnknown : strips_[static_cast<std::size_t>(column)];
  }
  /// Middle of a strip in the wall's frame, metres.
  double xOf(int column) const { return least_x_ + column * kStep; }

  /// Runs of strips that are no wall between strips that are, those of which a part is open.
  std::vector<Gap> gaps(double leastWidth, double mostWidth) const;
  /// Of the gap's spots those that lie so far behind the wall, or too far to be known, 0 … 1.
  double shareBehind(const Gap& gap, double depth) const;
  /// Height of the lower edge of the wall above the gap, metres; none: none seen.
  std::optional<double> lintel(const Gap& gap) const;
  /// Whether lintels of doors would be in the image there.
  bool showsTop(const Gap& gap) const;
  /// y of what is seen in the direction of the wall's point, metres; NaN: not known. None: outside of the image.
  std::optional<double> depthBehind(double x, double z) const;
  /// Metres that what is seen of the wall may lie off its plane.
  double toleranceAt(double x, double z) const;

 private:
  Strip stripAt(double x) const;

  const sensors::DepthGrid& depth_;
  Wall wall_;
  geometry::Pose3 T_camera_wall_;
  double least_x_ = 0.0;
  std::vector<Strip> strips_;
};

}  // namespace prodomos::perception::open_doors
