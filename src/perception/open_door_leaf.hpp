// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/rgbd_view.hpp"

#include "perception/rectified_wall.hpp"

#include <optional>
#include <vector>

namespace prodomos::perception::open_doors {

/// Where a leaf would hang, in the wall's frame.
struct Hinge {
  double x = 0.0;          ///< of the jamb, metres
  double closing = 1.0;    ///< 1, -1: from the hinge into the opening, along x
  double leafWidth = 0.9;  ///< metres
};

/// A leaf that stands open.
struct Leaf {
  double angle = 0.0;    ///< radians from closed; positive: to the far side
  double y = 0.0;        ///< of its axis, behind the wall's plane, metres
  double covered = 0.0;  ///< of its width and height what is seen, 0 … 1
};

/// A spot of a surface in the wall's frame.
struct Spot {
  Eigen::Vector3d point_in_wall;
  Eigen::Vector3d normal_in_wall;  ///< zero: not known
  double sigma = 0.0;              ///< of its depth, metres
};

/// Spots within `radius` metres of a point of the wall, at the heights of doors and somewhat above.
std::vector<Spot> spotsNear(const RgbdView& view, const Surfaces& surfaces, const Wall& wall, double x, double radius);

/// An upright plane through the hinge's axis that ends as a leaf does: at its width and at its height.
std::optional<Leaf> findLeaf(const std::vector<Spot>& spots, const Hinge& hinge);

}  // namespace prodomos::perception::open_doors
