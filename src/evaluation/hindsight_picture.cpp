// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/hindsight.hpp"
#include "prodomos/evaluation/timed_poses.hpp"

#include "evaluation/retrospect.hpp"
#include "evaluation/svg.hpp"

#include <algorithm>
#include <iterator>

namespace prodomos::evaluation {

namespace {

using geometry::CellIndex;
using Points = Svg::Points;

constexpr double kWidth = 1150.0;  // pixels
constexpr int kCoarse = 2;         // cells of the floor that are drawn as one

std::string_view markOf(const ClaimedSpace& bet) {
  if (!bet.settled) return "outline bet";
  return cameTrue(bet) ? "outline claim right" : "outline claim wrong";
}

/// What a map has seen of one storey in the end, and what it had told of it before.
class HindsightDrawer {
 public:
  HindsightDrawer(const Retrospect& past, const std::vector<TimedPose>& way, int storey)
      : past_(past), way_(way), storey_(storey), box_(past.known.box(storey)) {
    scale_ = std::clamp(kWidth / (box_.width() * kCell), 6.0, 45.0);
  }

  ScorePicture draw() {
    drawFloor();
    drawWay();
    for (const auto& bet : past_.claims.spaces) drawBet(bet);
    for (const auto& opening : past_.claims.doors) drawOpening(opening);
    return {.title = "floor " + std::to_string(storey_) + ", what was told and what was seen",
            .svg = svg_.str(scale_ * kCell * box_.width(), scale_ * kCell * box_.height(),
                            "floor " + std::to_string(storey_)),
            .legend = {{"seen", "floor that was seen to be free"},
                       {"seen-wall", "what stands there"},
                       {"claim right", "likely room behind an opening, which came true"},
                       {"claim wrong", "likely room, refuted"},
                       {"bet", "likely room, open to the end"},
                       {"door", "opening", true},
                       {"mapped-way", "way of the robot", true}}};
  }

 private:
  Eigen::Vector2d pixel(const Eigen::Vector2d& spot) const {
    return scale_ * Eigen::Vector2d(spot.x() - box_.first.x * kCell, (box_.last.y + 1) * kCell - spot.y());
  }
  Points pixels(const Polygon& spots) const {
    Points points;
    std::ranges::transform(spots, std::back_inserter(points), [&](const auto& spot) { return pixel(spot); });
    return points;
  }

  /// Walls are a cell thick, and must not be lost.
  map::CellState stateOf(CellIndex first) const {
    auto state = map::CellState::kUnknown;
    visitCells({first, {first.x + kCoarse - 1, first.y + kCoarse - 1}},
               [&](CellIndex cell) { state = std::max(state, past_.known.state(storey_, cell)); });
    return state;
  }

  /// In rows, each stretch of one kind as one rectangle.
  void drawFloor() {
    for (int y = box_.first.y; y <= box_.last.y; y += kCoarse) {
      int begin = box_.first.x;
      auto state = map::CellState::kUnknown;
      for (int x = box_.first.x; x <= box_.last.x + kCoarse; x += kCoarse) {
        const auto next = x <= box_.last.x ? stateOf({x, y}) : map::CellState::kUnknown;
        if (next == state) continue;
        if (state != map::CellState::kUnknown) {
          const Polygon stretch = {Eigen::Vector2d(begin, y) * kCell, Eigen::Vector2d(x, y) * kCell,
                                   Eigen::Vector2d(x, y + kCoarse) * kCell,
                                   Eigen::Vector2d(begin, y + kCoarse) * kCell};
          svg_.polygon(pixels(stretch), state == map::CellState::kFree ? "seen" : "seen-wall");
        }
        begin = x;
        state = next;
      }
    }
  }

  void drawWay() {
    Points points;
    for (const auto& pose : way_) {
      if (past_.placement.storeyAt(pose.pose.translation().z()) != storey_) continue;
      const auto point = pixel(pose.pose.translation().head<2>());
      if (points.empty() || (point - points.back()).norm() >= 2.0) points.push_back(point);
    }
    if (points.size() > 1) svg_.polyline(points, "mapped-way");
  }

  void drawBet(const ClaimedSpace& bet) {
    const auto room = likelyRoom(bet);
    if (bet.storey != storey_ || room.empty()) return;
    svg_.polygon(
        pixels(room), markOf(bet),
        toString(bet.id) + ": probability " + fixed(bet.probability, 2) + ", " + std::string(toString(bet.state)));
  }

  void drawOpening(const ClaimedDoor& opening) {
    if (opening.storey != storey_) return;
    const double half = opening.door.width / 2.0;
    const Points ends =
        pixels({opening.T_world_door * Eigen::Vector2d(0, half), opening.T_world_door * Eigen::Vector2d(0, -half)});
    svg_.polyline(ends, "door", "opening " + toString(opening.id));
  }

  const Retrospect& past_;
  const std::vector<TimedPose>& way_;
  int storey_;
  geometry::CellBox box_;
  double scale_ = 1.0;  // pixels a metre
  Svg svg_;
};

}  // namespace

std::vector<ScorePicture> hindsightPictures(const map::MapView& view) {
  const Retrospect past(view);
  const auto way = bodyPoses(view.trajectory(), Poses::kRefined);
  std::vector<ScorePicture> pictures;
  for (const int storey : past.known.storeys()) pictures.push_back(HindsightDrawer(past, way, storey).draw());
  return pictures;
}

}  // namespace prodomos::evaluation
