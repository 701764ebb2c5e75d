// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/walk_bets.hpp"

#include "prodomos/prediction/extrapolation.hpp"

#include "prediction/free_floor.hpp"
#include "prediction/ledger.hpp"
#include "prediction/outline.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace prodomos::prediction {

namespace {

using geometry::Pose2;
using geometry::Pose3;
using map::CellState;
using map::PredictionState;

constexpr double kCell = Surroundings::kCell;
constexpr double kFloorIsFree = 0.97;  // that what is told of a true person's way comes true
constexpr double kMostWrong = 0.2;     // of a bet that is confirmed

const geometry::Polygon& wholeOf(const map::Prediction& prediction) {
  return prediction.areas.front().outline_in_node;
}

/// A frame in whose cells the outline, which goes along edges of cells, is a set of whole cells, in the middle of what
/// Surroundings look at.
Pose2 T_submap_cells(const geometry::Polygon& outline) {
  const Eigen::Vector2d edge = outline[1] - outline[0];
  const Pose2 T_submap_corner{outline[0].x(), outline[0].y(), std::atan2(edge.y(), edge.x())};
  Eigen::AlignedBox2d extent;
  for (const auto& corner : geometry::transformed(geometry::inverse(T_submap_corner), outline)) extent.extend(corner);
  const auto& window = Surroundings::kBox;
  const Eigen::Vector2d middle =
      kCell / 2.0 * Eigen::Vector2d(window.first.x + window.last.x + 1, window.first.y + window.last.y + 1);
  const Eigen::Vector2d shift = (extent.center() - middle) / kCell;
  return T_submap_corner * Pose2{kCell * std::round(shift.x()), kCell * std::round(shift.y()), 0.0};
}

/// Whether one of the grids knows any of the floor; that of one sub-map alone, where it is named.
bool isAnySeen(const geometry::Polygon& outline_in_map, const std::vector<PlacedGrid>& grids,
               std::optional<base::SubMapId> submap) {
  return std::ranges::any_of(grids, [&](const PlacedGrid& placed) {
    if ((submap && placed.submap != *submap) || placed.grid == nullptr) return false;
    const auto outline_in_grid = geometry::transformed(Pose3(placed.T_map_submap.inverse()), outline_in_map);
    const auto cells = geometry::cellsIn(outline_in_grid, kCell);
    return std::ranges::any_of(cells, [&](geometry::CellIndex cell) {
      return placed.grid->state(placed.grid->cellAt(geometry::centreOf(cell, kCell))) != CellState::kUnknown;
    });
  });
}

/// What has become of a bet's floor.
struct Outcome {
  std::size_t free = 0;   ///< cells
  std::size_t wrong = 0;  ///< with something on them, or cut off from where the person was seen
  Piece open;
};

/// The person was seen over the floor that is seen: what hangs together with most of that is where it went.
Outcome outcomeOf(const geometry::Polygon& outline_in_here, const Surroundings& around) {
  Outcome outcome;
  CellSet passable(Surroundings::kBox, 0);
  for (const auto cell : geometry::cellsIn(outline_in_here, kCell)) {
    if (auto* passed = passable.find(cell); passed == nullptr || around.state(cell) == CellState::kOccupied) {
      ++outcome.wrong;
    } else {
      *passed = 1;
    }
  }
  const auto freeIn = [&around](const Piece& piece) {
    return std::ranges::count(piece, CellState::kFree, [&around](auto cell) { return around.state(cell); });
  };
  const auto pieces = piecesOf(passable);
  const auto main = std::ranges::max_element(pieces, {}, freeIn);  // of equal ones the greatest
  for (auto piece = pieces.begin(); piece != pieces.end(); ++piece) {
    const auto free = static_cast<std::size_t>(freeIn(*piece));
    outcome.free += free;
    if (piece != main) outcome.wrong += piece->size() - free;
  }
  if (main == pieces.end()) return outcome;
  std::ranges::copy_if(*main, std::back_inserter(outcome.open),
                       [&around](auto cell) { return around.state(cell) == CellState::kUnknown; });
  return outcome;
}

/// The part of areas that consists of these cells; empty where it is not worth telling.
std::vector<map::PredictedArea> areasWithin(const std::vector<map::PredictedArea>& areas, const Pose2& T_here_node,
                                            const Piece& cells, double leastArea) {
  constexpr float kAbove = 0.01F;
  Claims all(Surroundings::kBox, 0.0F);
  for (const auto& area : areas) {
    all.fill(geometry::transformed(T_here_node, area.outline_in_node), static_cast<float>(area.threshold) + kAbove,
             kCell);
  }
  Claims left(Surroundings::kBox, 0.0F);
  for (const auto cell : cells) *left.find(cell) = all.at(cell);
  auto strips = areasOf(left, leastArea);
  if (strips.empty()) return {};
  for (auto& area : strips.front()) {
    area.outline_in_node = geometry::transformed(geometry::inverse(T_here_node), area.outline_in_node);
  }
  return std::move(strips.front());
}

}  // namespace

WalkBets::WalkBets(const PredictionConfig& config, const map::MapView& before) : config_(config) {
  for (const auto& prediction : before.predictions()) {
    if (prediction.isConditional()) bets_.push_back({prediction});
  }
  if (before.sessions().empty() || before.sessions().back().state != map::SessionState::kRunning) return;
  for (auto& track : before.tracks()) {
    if (track.states.empty() || before.sessions().back().end - track.states.back().time >= kBreak) continue;
    auto& followed = followed_[track.id];
    followed.person = track.entity;
    followed.states = std::move(track.states);
    takeWalks(followed, 0, Sight::kKept);  // of these, it was bet on all but the last
  }
}

void WalkBets::update(const World& world, std::optional<base::SubMapId> seen,
                      const std::function<base::PredictionId()>& newId, Refusals& refusals) {
  for (auto& bet : bets_) {
    const auto* const submap = findById(world.nodes, bet.prediction.submap);
    const bool isOpen = bet.prediction.state == PredictionState::kOpen && !bet.prediction.areas.empty();
    if (isOpen && submap != nullptr) follow(world, seen, *submap, bet);
  }
  for (const auto& track : world.tracks) {
    auto& followed = followed_[track.id];
    followed.person = track.entity;
    followed.states.insert(followed.states.end(), track.states.begin(), track.states.end());
  }
  for (auto& [id, followed] : followed_) {
    const auto* const person = followed.person ? findById(world.entities, *followed.person) : nullptr;
    const auto* const human = person == nullptr ? nullptr : std::get_if<map::Human>(&person->attributes);
    const bool isLost = followed.states.empty() || world.now - followed.states.back().time >= kBreak;
    const auto sight = isLost ? Sight::kLost : !seen ? Sight::kEndOfLog : Sight::kKept;
    for (const auto& [submapId, walk] : takeWalks(followed, human == nullptr ? 0 : human->dominantSide, sight)) {
      const auto* const submap = findById(world.nodes, submapId);
      if (human == nullptr || submap == nullptr || !faultOf(*person).empty()) continue;
      for (auto& prediction : told(world, *person, *submap, walk, refusals)) {
        prediction.id = newId();
        events_.push_back(eventOf(prediction, world.session, world.now));
        bets_.push_back({std::move(prediction), true});
      }
    }
  }
  std::erase_if(followed_, [](const auto& each) { return each.second.states.empty(); });
}

/// Cuts what is followed into walks, and keeps the last one if it may go on.
std::vector<std::pair<base::SubMapId, Walk>> WalkBets::takeWalks(Followed& followed, int dominantSide, Sight sight) {
  map::Track track;
  if (followed.before) track.states.push_back(*followed.before);
  track.states.insert(track.states.end(), followed.states.begin(), followed.states.end());
  std::vector<base::SubMapId> submaps;
  for (const auto& state : followed.states) {
    if (std::ranges::find(submaps, state.submap) == submaps.end()) submaps.push_back(state.submap);
  }
  std::vector<std::pair<base::SubMapId, Walk>> walks;
  for (const auto submap : submaps) {
    for (auto& walk : walksOf(track, submap, dominantSide, sight == Sight::kLost)) {
      if (followed.before && walk.states.front().time == followed.before->time) {
        walk.states.erase(walk.states.begin());
        walk.entered = false;
      }
      if (!walk.states.empty()) walks.emplace_back(submap, std::move(walk));
    }
  }
  auto rest = followed.states.end();
  if (sight == Sight::kKept && !walks.empty()) {
    rest = std::ranges::find(followed.states, walks.back().second.states.front().time, &map::TrackState::time);
    walks.pop_back();
  }
  if (rest != followed.states.begin()) followed.before = *std::prev(rest);
  followed.states.erase(followed.states.begin(), rest);
  return walks;
}

/// What M(S) tells of a walk, without floor that is told already.
std::vector<map::Prediction> WalkBets::told(const World& world, const map::Entity& person, const map::Node& submap,
                                            const Walk& walk, Refusals& refusals) const {
  std::vector<map::Prediction> predictions;
  const double probability = person.confidence * kFloorIsFree;
  if (probability < config_.leastProbability) return predictions;
  const Pose3 T_map_here = submap.T_map_submap * T_submap_here(walk);
  Surroundings around(T_map_here, world.gridsNear(T_map_here.translation()));
  for (const auto& other : bets_) {
    const auto* const its = findById(world.nodes, other.prediction.submap);
    if (other.prediction.state != PredictionState::kOpen || its == nullptr || other.prediction.areas.empty()) continue;
    const Pose3 T_here_its = T_map_here.inverse() * its->T_map_submap;
    if (std::abs(T_here_its.translation().z()) > Surroundings::kSameFloor) continue;
    for (const auto cell : geometry::cellsIn(geometry::transformed(T_here_its, wholeOf(other.prediction)), kCell)) {
      around.set(cell, CellState::kFree);
    }
  }
  const auto beyond = extrapolate(walk, around, config_.extrapolation);
  if (const auto* refusal = std::get_if<Refusal>(&beyond)) {
    refusals.add(person.id, refusal->reason, world);
    return predictions;
  }
  for (const auto& strip : std::get<ConditionalFloor>(beyond).strips) {
    map::Prediction prediction;
    prediction.cause = person.id;
    prediction.submap = prediction.node = submap.id;
    prediction.probability = probability;
    prediction.expectedArea = std::abs(geometry::signedArea(strip.front().outline_in_node));
    prediction.areas = strip;
    prediction.made = world.now;
    predictions.push_back(std::move(prediction));
  }
  return predictions;
}

/// Where more is settled than open, the bet is; else what is known is left out.
void WalkBets::follow(const World& world, std::optional<base::SubMapId> seen, const map::Node& submap, Bet& bet) {
  auto& prediction = bet.prediction;
  const Pose2 T_submap_here = T_submap_cells(wholeOf(prediction));
  const Pose3 T_map_here = submap.T_map_submap * geometry::toPose3(T_submap_here);
  const auto grids = world.gridsNear(T_map_here.translation());
  if (!isAnySeen(geometry::transformed(submap.T_map_submap, wholeOf(prediction)), grids, seen)) return;
  const Pose2 T_here_submap = geometry::inverse(T_submap_here);
  const auto outcome =
      outcomeOf(geometry::transformed(T_here_submap, wholeOf(prediction)), Surroundings(T_map_here, grids));
  const auto decided = outcome.free + outcome.wrong;
  if (decided == 0) return;
  auto left = areasWithin(prediction.areas, T_here_submap, outcome.open, config_.extrapolation.leastArea);
  bet.isNews = true;
  if (decided > outcome.open.size() || left.empty()) {
    const bool isRight = static_cast<double>(outcome.wrong) <= kMostWrong * static_cast<double>(decided);
    prediction.state = isRight ? PredictionState::kConfirmed : PredictionState::kRefuted;
    prediction.settled = world.now;
    events_.push_back(eventOf(prediction, world.session, world.now));
  } else {
    prediction.areas = std::move(left);
    prediction.expectedArea = std::abs(geometry::signedArea(wholeOf(prediction)));
  }
}

void WalkBets::addTo(map::MapChange& change) {
  for (auto& bet : bets_) {
    if (std::exchange(bet.isNews, false)) change.predictions.push_back(bet.prediction);
  }
  for (auto& event : std::exchange(events_, {})) change.events.push_back(std::move(event));
}

}  // namespace prodomos::prediction
