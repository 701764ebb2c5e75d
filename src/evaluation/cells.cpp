// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/cells.hpp"

namespace prodomos::evaluation {

Polygon boxBehind(const geometry::Pose2& T_world_door, double left, double right, double least, double most) {
  return transformed(T_world_door, {{least, right}, {most, right}, {most, left}, {least, left}});
}

}  // namespace prodomos::evaluation
