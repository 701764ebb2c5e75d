// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/person_sighting.hpp"

#include "perception/person_body.hpp"

#include <optional>

namespace prodomos::perception {

/// Which way a torso looks, as the camera sees it.
struct Facing {
  double angle = 0.0;  ///< of the torso's axis from the direction to the camera, within a quarter turn, radians
  double sigma = 0.0;
  double across = 0.0;    ///< 1: its shoulders lie across the view, 0: behind each other
  double toCamera = 0.0;  ///< log-odds of its front against its back
};

/// From the shoulders, and from the hips where the network sees shoulders too close to each other; `joints_in_submap`
/// are the person's. A network's right and left are not believed: it exchanges them on backs. None where it sees no
/// shoulders.
std::optional<Facing> facingOf(const UprightView& view, const Body& body, const PicturedPerson& person,
                               const std::array<std::optional<Eigen::Vector3d>, kJointCount>& joints_in_submap);

}  // namespace prodomos::perception
