// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/calibration.hpp"
#include "prodomos/evaluation/scene.hpp"

#include <vector>

/// Predicted sub-maps against the rooms that nobody has seen. docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

struct NodeScore {
  std::size_t right = 0;  ///< predicted nodes, each once however many predictions lead to it
  std::size_t wrong = 0;
  FoundCount behindVisible;  ///< unseen rooms behind a door, doorway or flight that was visible from a seen one
  FoundCount adjacent;       ///< unseen rooms next to a seen one

  std::optional<double> precision() const { return shareOf(right, right + wrong); }
  NodeScore& operator+=(const NodeScore& other);
};

NodeScore scoreNodes(const Scene& scene);

/// That an unseen space lies behind a door or up a flight, of each prediction that says so.
std::vector<Bet> betsOf(const Scene& scene);

}  // namespace prodomos::evaluation
