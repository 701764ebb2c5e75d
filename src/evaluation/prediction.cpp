// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/prediction.hpp"

namespace prodomos::evaluation {

PredictionScore& PredictionScore::operator+=(const PredictionScore& other) {
  doors += other.doors;
  doorways += other.doorways;
  stairs += other.stairs;
  nodes += other.nodes;
  freeSpace += other.freeSpace;
  rooms += other.rooms;
  bets.insert(bets.end(), other.bets.begin(), other.bets.end());
  return *this;
}

PredictionScore scorePrediction(const Scene& scene) {
  return {.doors = scoreDoors(scene.claims, scene.doorMatches, scene.truth, true),
          .doorways = scoreDoors(scene.claims, scene.doorMatches, scene.truth, false),
          .stairs = scoreStairs(scene.claims, scene.stairsMatches, scene.truth),
          .nodes = scoreNodes(scene),
          .freeSpace = scoreFreeSpace(scene),
          .rooms = scoreRooms(scene),
          .bets = betsOf(scene)};
}

PredictionScore scorePrediction(const map::MapView& view, const Truth& truth) {
  return scorePrediction(makeScene(view, truth));
}

const std::vector<Measure>& comparedMeasures() {
  using Score = PredictionScore;
  static const std::vector<Measure> kMeasures = {
      {"doors.recall_visible", [](const Score& s) { return s.doors.counts.visible.recall(); }},
      {"doors.precision", [](const Score& s) { return s.doors.counts.precision(); }},
      {"stairs.recall_visible", [](const Score& s) { return s.stairs.counts.visible.recall(); }},
      {"stairs.precision", [](const Score& s) { return s.stairs.counts.precision(); }},
      {"nodes.precision", [](const Score& s) { return s.nodes.precision(); }},
      {"nodes.recall", [](const Score& s) { return s.nodes.behindVisible.recall(); }},
      {"free_space.0.5.overall", [](const Score& s) { return s.freeSpace.levels[0].overall().precision(); }},
      {"free_space.0.7.overall", [](const Score& s) { return s.freeSpace.levels[2].overall().precision(); }},
      {"room_iou.up_to_60_m2", [](const Score& s) { return s.rooms.ordinary(); }},
  };
  return kMeasures;
}

}  // namespace prodomos::evaluation
