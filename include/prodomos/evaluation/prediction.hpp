// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/calibration.hpp"
#include "prodomos/evaluation/detections.hpp"
#include "prodomos/evaluation/free_space.hpp"
#include "prodomos/evaluation/predicted_nodes.hpp"
#include "prodomos/evaluation/room_shapes.hpp"
#include "prodomos/evaluation/scene.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// What a map tells of doors, stairs and what lies behind them, against the truth of its log: all that 002 reports and
/// more. docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

struct PredictionScore {
  DoorScore doors;
  DoorScore doorways;
  StairsScore stairs;
  NodeScore nodes;
  FreeSpaceScore freeSpace;
  RoomScore rooms;
  std::vector<Bet> bets;

  /// For scores over several maps.
  PredictionScore& operator+=(const PredictionScore& other);
};

PredictionScore scorePrediction(const Scene& scene);
/// Throws base::Error where map and truth have no time in common.
PredictionScore scorePrediction(const map::MapView& view, const Truth& truth);

/// One figure of a score, for comparisons of buildings.
struct Measure {
  const char* name;  ///< as in the JSON: "doors.recall_visible"
  std::function<std::optional<double>(const PredictionScore&)> value;
};

/// Those of which the worst building is named; of all, more is better.
const std::vector<Measure>& comparedMeasures();

}  // namespace prodomos::evaluation
