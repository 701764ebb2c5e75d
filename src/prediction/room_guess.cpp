// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/room_guess.hpp"

#include "prediction/outline.hpp"
#include "prediction/reachable_floor.hpp"
#include "prediction/room_boxes.hpp"
#include "prediction/room_features.hpp"
#include "prediction/room_prior.hpp"
#include "prediction/wall_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace prodomos::prediction {

namespace {

constexpr double kCell = Surroundings::kCell;
constexpr std::size_t kSideDraws = 5;  // of the places where each side's wall may be
constexpr std::size_t kEndDraws = 6;
constexpr std::size_t kWidths = 3;  // classes of the room's width, each with an end of its own

/// A door's surroundings from left and from right.
struct BothWays {
  RoomFeatures left;
  RoomFeatures right;

  BothWays(const Surroundings& around, double doorWidth)
      : left(around, doorWidth, false), right(around, doorWidth, true) {}
};

double probabilityOf(float logitSum) {
  return 1.0 / (1.0 + std::exp(-0.5 * static_cast<double>(logitSum)));
}

WallPlace sideWall(RoomFeatures& features, const RoomPrior& prior, double other = RoomFeatures::kFar) {
  return {kBin, kSideBins, [&](std::size_t bin) {
            return prior.side.probability(features.ofSide(kBin * static_cast<double>(bin), other));
          }};
}

WallPlace endWall(BothWays& ways, double width, const RoomPrior& prior) {
  return {kBin, kEndBins, [&](std::size_t bin) {
            const double ahead = kBin * static_cast<double>(bin);
            return probabilityOf(prior.end.logit(ways.left.ofEnd(ahead, width)) +
                                 prior.end.logit(ways.right.ofEnd(ahead, width)));
          }};
}

/// What the room may be like: its walls, and boxes that are all alike likely.
struct Belief {
  WallPlace left;
  WallPlace right;
  std::array<WallPlace, kWidths> ends;  ///< by classes of the width, the narrow ones first
  std::vector<RoomBox> boxes;

  double reachingAhead(double distance) const {
    double sum = 0.0;
    for (const auto& end : ends) sum += end.reaching(distance);
    return sum / kWidths;
  }
};

Belief believe(BothWays& ways, const RoomPrior& prior) {
  const auto left = sideWall(ways.left, prior);
  const auto right = sideWall(ways.right, prior);
  std::vector<RoomBox> floors;
  for (const double l : left.draws(kSideDraws)) {
    for (const double r : sideWall(ways.right, prior, l).draws(kSideDraws))
      floors.push_back({inCells(l), inCells(r), 0});
  }
  for (const double r : right.draws(kSideDraws)) {
    for (const double l : sideWall(ways.left, prior, r).draws(kSideDraws))
      floors.push_back({inCells(l), inCells(r), 0});
  }
  const auto width = [](const RoomBox& box) { return kCell * (box.left + box.right); };
  std::ranges::stable_sort(floors, {}, width);
  const auto classOf = [&](std::size_t i) { return i * kWidths / floors.size(); };
  const auto endOfClass = [&](std::size_t i) {
    const std::size_t middle = (2 * i + 1) * floors.size() / (2 * kWidths);
    return endWall(ways, std::max(kLeastWidth, width(floors[middle])), prior);
  };
  Belief belief{left, right, {endOfClass(0), endOfClass(1), endOfClass(2)}, {}};
  std::array<std::vector<double>, kWidths> ends;
  for (std::size_t i = 0; i < kWidths; ++i) ends[i] = belief.ends[i].draws(kEndDraws);
  for (std::size_t i = 0; i < floors.size(); ++i) {
    for (const double end : ends[classOf(i)]) belief.boxes.push_back({floors[i].left, floors[i].right, inCells(end)});
  }
  return belief;
}

void tellWalls(const Belief& belief, RoomGuess& guess) {
  guess.trueLeft = belief.left.length();
  guess.trueRight = belief.right.length();
  double mean = 0.0;
  double square = 0.0;
  for (const auto& end : belief.ends) {
    const auto length = end.length();
    mean += length.mean / kWidths;
    square += (length.mean * length.mean + length.deviation * length.deviation) / kWidths;
  }
  guess.trueDepth = {mean, std::sqrt(std::max(0.0, square - mean * mean))};
}

/// Of cells that one may reach; the mean area with them.
void tellCells(const Belief& belief, const CellSet& reachable, RoomGuess& guess) {
  std::vector<double> ahead;
  for (int x = kBehind.first.x; x <= kBehind.last.x; ++x) {
    ahead.push_back(belief.reachingAhead(geometry::cellCentre(x, kCell)));
  }
  double sum = 0.0;
  for (int y = kBehind.first.y; y <= kBehind.last.y; ++y) {
    const double across = geometry::cellCentre(y, kCell);
    const double side = across > 0.0 ? belief.left.reaching(across) : belief.right.reaching(-across);
    for (int x = kBehind.first.x; x <= kBehind.last.x; ++x) {
      if (reachable.at({x, y}) == 0) continue;
      const double probability = side * ahead[static_cast<std::size_t>(x - kBehind.first.x)];
      *guess.probability.find({x, y}) = static_cast<float>(probability);
      sum += probability;
    }
  }
  guess.expectedArea = kCell * kCell * sum;
}

double deviationOfAreas(const std::vector<RoomBox>& boxes, const UnknownArea& unknown) {
  double mean = 0.0;
  double square = 0.0;
  for (const auto& box : boxes) {
    const double area = kCell * kCell * unknown.cellsOf(box);
    mean += area / static_cast<double>(boxes.size());
    square += area * area / static_cast<double>(boxes.size());
  }
  return std::sqrt(std::max(0.0, square - mean * mean));
}

}  // namespace

RoomGuess guessRoom(const Surroundings& around, double doorWidth, const RoomPrior& prior) {
  RoomGuess guess{.probability = geometry::CellMap<float>(Surroundings::kBox, 0.0F)};
  if (!std::isfinite(doorWidth) || doorWidth <= 0.0) return guess;
  const auto reachable = reachableFloor(around, kBehind);
  BothWays ways(around, doorWidth);
  const ReachableArea area = areaOf(reachable);
  guess.spaceProbability =
      probabilityOf(prior.space.logit(ways.left.ofSpace(area)) + prior.space.logit(ways.right.ofSpace(area)));

  const Belief belief = believe(ways, prior);
  tellWalls(belief, guess);
  tellCells(belief, reachable, guess);
  const UnknownArea unknown(reachable);
  guess.areaDeviation = prior.areaSpread * deviationOfAreas(belief.boxes, unknown);

  const RoomBox middle{inCells(belief.left.quantile(0.5)), inCells(belief.right.quantile(0.5)),
                       inCells(belief.ends[kWidths / 2].quantile(0.5))};
  const ExpectedIou expected(belief.boxes, unknown);
  const RoomBox best = bestBox(expected, middle);
  guess.left = kCell * best.left;
  guess.right = kCell * best.right;
  guess.depth = kCell * best.end;
  const auto pieces = piecesOf(reachableFloor(around, best.cells()));
  if (!pieces.empty()) guess.outline_here = outlineOf(withoutHoles(pieces.front()), kCell);
  if (!guess.outline_here.empty()) {
    guess.expectedIou = std::clamp(prior.iouOffset + prior.iouSlope * expected.of(best), 0.0, 1.0);
  }
  return guess;
}

RoomGuess guessRoom(const Surroundings& around, double doorWidth) {
  return guessRoom(around, doorWidth, trainedRoomPrior());
}

}  // namespace prodomos::prediction
