// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"

#include <Eigen/Core>

#include <optional>
#include <string_view>
#include <vector>

namespace prodomos::map {

/// What a planner found where it went for a predicted room: nothing there, or a way that cannot be gone.
enum class Finding { kRefuted, kBlocked };

enum class PredictionState { kOpen, kConfirmed, kRefuted, kMerged };

/// {u | f(u) / max f > threshold}: the free floor that is expected at one relative threshold (002 eq. (2), (3), (5)).
struct PredictedArea {
  double threshold = 0.5;
  std::vector<Eigen::Vector2d> outline_in_node;  ///< in the frame of the prediction's node
};

/// An entry of the ledger: a bet that gets settled.
struct Prediction {
  base::PredictionId id;
  base::EntityId cause;   ///< the door, the staircase, the human
  base::SubMapId submap;  ///< the observed one that its cause lies in
  base::SubMapId node;    ///< the predicted one, in the graph until it is settled; of a human: `submap`
  geometry::Pose3 T_submap_node = geometry::Pose3::Identity();
  double probability = 0.0;   ///< that an unseen space lies behind
  double expectedArea = 0.0;  ///< m²
  std::vector<PredictedArea> areas;
  std::vector<Eigen::Vector2d> room_in_node;  ///< outline of the room that is likely there; empty: not guessed
  /// Where to stand to go there, on free floor and facing the way; none where no such floor is known.
  std::optional<geometry::Pose2> viewpoint_in_submap;
  base::Time made{};
  PredictionState state = PredictionState::kOpen;
  std::optional<base::Time> settled;
  std::optional<base::SubMapId> mergedInto;
  std::optional<base::Time> blocked{};  ///< when a planner last found that the way there cannot be gone

  /// Floor that is free if a person leaves, in the sub-map where it was seen: no sub-map of its own.
  bool isConditional() const { return node == submap; }
};

/// "open", "confirmed", "refuted", "merged".
std::string_view toString(PredictionState state);

}  // namespace prodomos::map
