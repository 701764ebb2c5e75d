// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/baselines.hpp"
#include "prodomos/evaluation/calibration.hpp"

#include "bench/room_cases.hpp"
#include "prediction/room_prior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

/// What predictors of rooms reach (docs/rooms.md).
namespace prodomos::bench {

/// A box by rules of thumb: half way to the next doors of the wall, up to known walls beside; as deep as the next room
/// that was seen, up to what is known ahead.
inline evaluation::DoorBox boxByRules(const prediction::Surroundings& around) {
  constexpr double kHalfWidth = 4.0;  // metres
  constexpr double kDepth = 5.6;
  constexpr double kStretch = 1.3;
  constexpr double kWall = 0.3;
  const auto firstKnown = [&](double ahead, double across, double stepAhead, double stepAcross, bool free) {
    for (double way = 0.3; way < 12.0; way += 0.1) {
      const auto state = around.state(Eigen::Vector2d(ahead + way * stepAhead, across + way * stepAcross));
      if (free ? state == map::CellState::kFree : state != map::CellState::kUnknown) return way;
    }
    return 1e3;
  };
  std::array<double, 2> halves{};
  double nearest = 12.0;
  double depth = kDepth;
  for (const std::size_t side : {0U, 1U}) {
    const double sign = side == 0 ? 1.0 : -1.0;
    double half = kHalfWidth;
    for (const auto& opening : around.openings) {
      const double across = sign * opening.T_here_opening.y;
      if (std::abs(opening.T_here_opening.x) < 0.7 && across > 0.3) half = std::min(half, 0.5 * across);
    }
    const double wall = firstKnown(1.5, 0.0, 0.0, sign, false);
    halves[side] = wall < kStretch * half ? wall : half;
    const double room = firstKnown(1.5, 0.0, 0.0, sign, true);
    if (room >= nearest) continue;
    nearest = room;
    double end = 1.5;
    while (around.state(Eigen::Vector2d(end, sign * (room + 0.5))) == map::CellState::kFree) end += 0.1;
    depth = std::max(end, 1.0);
  }
  const double ahead = firstKnown(0.3, 0.0, 1.0, 0.0, false) + 0.3;
  if (ahead < kStretch * depth) depth = ahead - kWall;
  return {halves[0], halves[1], depth};
}

/// Sums over the ordinary rooms of cases.
class RoomScores {
 public:
  void add(const RoomCase& of, const prediction::RoomPrior& prior) {
    const auto before = std::clock();
    const auto guess = prediction::guessRoom(of.around, of.door->width, prior);
    seconds_ += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    ++guesses_;
    spaces_.push_back({guess.spaceProbability, of.isUnseen});
    if (!of.isOrdinary()) return;
    const auto view = of.view();
    const auto& sizes = evaluation::trainedBaselines();
    const auto radius = static_cast<std::size_t>(std::lround(sizes.halfDiscRadius / evaluation::kRadiusStep)) - 1;
    const double iou = view.iou(geometry::transformed(of.T_world_here, guess.outline_here));
    const std::array<double, kPredictors> ious = {view.iousOfHalfDiscs()[radius],
                                                  view.iou(sizes.fixedBox),
                                                  view.iouClipped(sizes.clippedBox),
                                                  view.iouClipped(boxByRules(of.around)),
                                                  addCells(of, guess),
                                                  iou,
                                                  view.iou(of.bestBox)};
    for (std::size_t i = 0; i < kPredictors; ++i) sums_[i] += ious[i];
    expected_.push_back({guess.expectedIou, iou});
    areas_.push_back({guess.expectedArea, guess.areaDeviation, of.area});
  }

  static void printHead(std::FILE* out) {
    std::fprintf(out, "%-34s %6s %9s %6s %8s %6s %6s %8s %7s | %5s %9s %6s | %5s %5s %5s | %4s\n", "cases", "rooms",
                 "half-disc", "fixed", "clipped", "rules", "p>=.5", "outline", "oracle", "ECE", "expected", "area z",
                 "Brier", "ECE", "AUC", "ms");
  }
  void print(std::FILE* out, const std::string& name) const {
    const auto count = static_cast<double>(expected_.size());
    const auto mean = [&](std::size_t i) { return sums_[i] / count; };
    const auto cells = evaluation::calibrationOf(cells_);
    const auto spaces = evaluation::calibrationOf(spaces_);
    std::fprintf(
        out, "%-34s %6zu %9.3f %6.3f %8.3f %6.3f %6.3f %8.3f %7.3f | %5.3f %9.3f %6.2f | %5.2f %5.3f %5.3f | %4.2f\n",
        name.c_str(), expected_.size(), mean(0), mean(1), mean(2), mean(3), mean(4), mean(5), mean(6),
        cells ? cells->expectedError : 0.0, meanExpected(), areaSpread(),
        spaces && spaces->brierSkill ? *spaces->brierSkill : 0.0, spaces ? spaces->expectedError : 0.0,
        areaUnderCurve(), 1e3 * seconds_ / static_cast<double>(guesses_));
  }
  /// Mean expected and mean true IoU by quarters of the expected one.
  void printQuarters(std::FILE* out) const {
    auto sorted = expected_;
    std::ranges::sort(sorted, {}, &Expected::expected);
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      Expected sum;
      const std::size_t begin = quarter * sorted.size() / 4;
      const std::size_t end = (quarter + 1) * sorted.size() / 4;
      for (std::size_t i = begin; i < end; ++i) {
        sum.expected += sorted[i].expected / static_cast<double>(end - begin);
        sum.iou += sorted[i].iou / static_cast<double>(end - begin);
      }
      std::fprintf(out, "  quarter %zu: IoU expected %.3f, reached %.3f\n", quarter + 1, sum.expected, sum.iou);
    }
  }

  /// Of cells by their least probability: the share that is the room's floor, and m² a door.
  void printPrecisions(std::FILE* out) const {
    constexpr double kAreaOfBet = kEveryCell * prediction::Surroundings::kCell * prediction::Surroundings::kCell;
    for (const double least : {0.5, 0.6, 0.7, 0.8, 0.9, 0.95}) {
      double right = 0.0;
      double all = 0.0;
      for (const auto& bet : cells_) {
        if (bet.probability < least) continue;
        all += 1.0;
        if (bet.cameTrue) right += 1.0;
      }
      std::fprintf(out, "  P >= %.2f: precision %.3f, %.1f m2 a door\n", least, right / all,
                   kAreaOfBet * all / static_cast<double>(rooms()));
    }
  }

  std::size_t rooms() const { return expected_.size(); }
  double clippedBox() const { return sums_[2] / static_cast<double>(rooms()); }  ///< mean IoU
  double outline() const { return sums_[5] / static_cast<double>(rooms()); }

  /// Corrects the prior's own expectations to what was reached; of cases that it was not trained on.
  void calibrate(prediction::RoomPrior& prior) const {
    double meanX = 0.0;
    double meanY = 0.0;
    for (const auto& [x, y] : expected_) {
      meanX += x / static_cast<double>(expected_.size());
      meanY += y / static_cast<double>(expected_.size());
    }
    double xx = 0.0;
    double xy = 0.0;
    for (const auto& [x, y] : expected_) {
      xx += (x - meanX) * (x - meanX);
      xy += (x - meanX) * (y - meanY);
    }
    prior.iouSlope = xx > 0.0 ? xy / xx : 1.0;
    prior.iouOffset = meanY - prior.iouSlope * meanX;
    prior.areaSpread = areaSpread();
  }

 private:
  static constexpr std::size_t kPredictors = 7;
  static constexpr int kEveryCell = 5;  // that bets are counted of

  struct Expected {
    double expected = 0.0;
    double iou = 0.0;
  };
  struct Area {
    double expected = 0.0;
    double deviation = 0.0;
    double real = 0.0;
  };

  double addCells(const RoomCase& of, const prediction::RoomGuess& guess) {
    constexpr double kCell = prediction::Surroundings::kCell;
    const auto room = geometry::transformed(geometry::inverse(of.T_world_here), of.room->outline);
    geometry::CellMap<std::uint8_t> inRoom(guess.probability.box(), 0);
    inRoom.fill(room, 1, kCell);
    double both = 0.0;
    double guessed = 0.0;
    const auto& box = guess.probability.box();
    for (int y = box.first.y; y <= box.last.y; ++y) {
      for (int x = box.first.x; x <= box.last.x; ++x) {
        const float probability = guess.probability.at({x, y});
        const bool isRoom = inRoom.at({x, y}) != 0;
        if (probability >= 0.1F && (x + 2 * y) % kEveryCell == 0) cells_.push_back({probability, isRoom});
        if (probability < 0.5F) continue;
        guessed += 1.0;
        if (isRoom) both += 1.0;
      }
    }
    return both / (guessed + of.area / (kCell * kCell) - both);
  }

  double meanExpected() const {
    double sum = 0.0;
    for (const auto& each : expected_) sum += each.expected;
    return sum / static_cast<double>(expected_.size());
  }
  /// Of what is between expected and true areas, in deviations: the root of the mean square, without the worst
  /// twentieth.
  double areaSpread() const {
    std::vector<double> squares;
    for (const auto& area : areas_) {
      squares.push_back(std::pow((area.real - area.expected) / std::max(1.0, area.deviation), 2));
    }
    std::ranges::sort(squares);
    squares.resize(squares.size() - squares.size() / 20);
    double sum = 0.0;
    for (const double square : squares) sum += square;
    return std::sqrt(sum / static_cast<double>(squares.size()));
  }
  double areaUnderCurve() const {
    auto bets = spaces_;
    std::ranges::stable_sort(bets, {}, &evaluation::Bet::probability);
    double negatives = 0.0;
    double positives = 0.0;
    double inOrder = 0.0;
    for (const auto& bet : bets) {
      if (bet.cameTrue) {
        inOrder += negatives;
        positives += 1.0;
      } else {
        negatives += 1.0;
      }
    }
    return inOrder / std::max(1.0, positives * negatives);
  }

  std::array<double, kPredictors> sums_{};
  std::vector<Expected> expected_;
  std::vector<Area> areas_;
  std::vector<evaluation::Bet> cells_;
  std::vector<evaluation::Bet> spaces_;
  double seconds_ = 0.0;
  std::size_t guesses_ = 0;
};

}  // namespace prodomos::bench
