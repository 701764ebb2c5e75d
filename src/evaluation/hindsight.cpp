// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/hindsight.hpp"

#include "evaluation/retrospect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace prodomos::evaluation {

namespace {

using map::PredictionState;

constexpr double kMostlyEnclosed = 0.75;  // share of a room's border that was seen: less, and nobody knows its shape
constexpr double kLeastRoom = 2.0;        // m²; what is smaller is no room

// --- free floor

/// None of a cell that was known when the bet was told last.
std::optional<CellFate> fateOf(const Retrospect& past, const ClaimedSpace& bet, base::Time told,
                               geometry::CellIndex cell) {
  if (past.known.isKnown(*bet.storey, cell, told)) return std::nullopt;
  switch (past.known.state(*bet.storey, cell)) {
    case map::CellState::kFree:
      return CellFate::kRight;
    case map::CellState::kOccupied:
      return CellFate::kWrong;
    case map::CellState::kUnknown:
      break;
  }
  return CellFate::kNobodyKnows;
}

HindsightLevel scoreLevel(const Retrospect& past, double threshold) {
  HindsightLevel level;
  for (const auto& bet : past.claims.spaces) {
    const auto* const outline = findArea(bet, threshold);
    const auto told = past.toldAt(bet);
    if (outline == nullptr || !told || !bet.storey || !bet.mobility) continue;
    auto& cells = level.byMobility[static_cast<std::size_t>(*bet.mobility)];
    for (const auto cell : cellsIn(*outline)) {
      const auto fate = fateOf(past, bet, *told, cell);
      if (fate == CellFate::kRight) ++cells.free;
      if (fate == CellFate::kWrong) ++cells.occupied;
      if (fate == CellFate::kNobodyKnows) ++cells.unknown;
    }
    if (const auto* const door = past.findDoor(bet.cause)) {
      level.halfDiscs.addBehind(door->T_world_door,
                                [&](geometry::CellIndex cell) { return fateOf(past, bet, *told, cell); });
    }
  }
  return level;
}

// --- shapes of rooms

/// Of bets that came true: a room of its own behind the door, not the space before it.
void scoreRooms(const Retrospect& past, HindsightScore& score) {
  for (const auto& bet : past.claims.spaces) {
    const auto* const door = past.findDoor(bet.cause);
    if (door == nullptr || !bet.storey || !cameTrue(bet)) continue;
    const auto place = past.places.behind(*door);
    const bool isApart = place && place != past.places.before(*door);
    const auto room = isApart ? std::optional(past.places.room(*place)) : std::nullopt;
    if (!room || room->enclosed < kMostlyEnclosed) {
      ++score.roomsNotSeen;
      continue;
    }
    const auto told = *past.toldAt(bet);
    const DoorView seen(door->T_world_door, room->cells, [&](const Eigen::Vector2d& spot) {
      return past.known.isKnown(*bet.storey, geometry::cellAt(spot.x(), spot.y(), kCell), told);
    });
    score.rooms.shapes.push_back(judgeShape(likelyRoom(bet), seen, true));
  }
}

// --- rooms that were predicted in time

/// How the robot first came into a place.
struct Arrival {
  base::Time time{};
  std::optional<std::size_t> from;  ///< none: its way began there
  Eigen::Vector2d spot_in_world = Eigen::Vector2d::Zero();
};

std::map<std::size_t, Arrival> arrivalsOf(const map::MapView& view, const Retrospect& past) {
  std::map<std::size_t, Arrival> arrivals;
  std::optional<std::size_t> last;
  std::optional<base::SessionId> session;
  for (const auto& point : view.trajectory()) {
    if (session != point.session) last.reset();
    session = point.session;
    const Eigen::Vector3d spot = point.T_map_body.translation();
    const auto place = past.places.at(past.placement.storeyAt(spot.z()), spot.head<2>());
    if (!place) continue;
    arrivals.try_emplace(*place, Arrival{point.time, last, spot.head<2>()});
    last = place;
  }
  return arrivals;
}

/// An opening between two places: the nearest to the spot, if there are several.
const ClaimedDoor* findOpening(const Retrospect& past, std::size_t from, std::size_t to, const Eigen::Vector2d& spot) {
  const ClaimedDoor* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& door : past.claims.doors) {
    const auto before = past.places.before(door);
    const auto behind = past.places.behind(door);
    if (!(before == from && behind == to) && !(before == to && behind == from)) continue;
    const double distance = std::hypot(door.T_world_door.x - spot.x(), door.T_world_door.y - spot.y());
    if (distance >= least) continue;
    least = distance;
    nearest = &door;
  }
  return nearest;
}

/// A bet on the place stood then.
bool isPredicted(const Retrospect& past, std::size_t place, base::Time at) {
  return std::ranges::any_of(past.claims.spaces, [&](const ClaimedSpace& bet) {
    const auto* const door = past.findDoor(bet.cause);
    const bool wasRefuted = bet.state == PredictionState::kRefuted && bet.settled && *bet.settled <= at;
    return door != nullptr && bet.made <= at && !wasRefuted && past.places.behind(*door) == place;
  });
}

bool wasDetected(const Retrospect& past, const ClaimedDoor& door, base::Time before) {
  if (!past.claims.images) return door.firstSeen <= before;
  const auto [first, last] = past.claims.images->equal_range(door.id);
  return std::any_of(first, last, [&](const auto& detection) { return detection.second <= before; });
}

RoomRecall recallOf(const Retrospect& past, const std::map<std::size_t, Arrival>& arrivals) {
  RoomRecall recall;
  for (const auto& [place, arrival] : arrivals) {
    if (!arrival.from || past.places.area(place) < kLeastRoom) continue;
    const auto* const opening = findOpening(past, *arrival.from, place, arrival.spot_in_world);
    if (opening == nullptr) continue;
    const FoundCount one{1, isPredicted(past, place, arrival.time) ? 1U : 0U};
    recall.entered += one;
    if (wasDetected(past, *opening, arrival.time)) recall.inTime += one;
  }
  std::map<std::size_t, FoundCount> lookedInto;
  for (const auto& door : past.claims.doors) {
    const auto before = past.places.before(door);
    const auto behind = past.places.behind(door);
    if (!before || !behind) continue;
    for (const auto& [from, to] : {std::pair(*before, *behind), std::pair(*behind, *before)}) {
      if (!arrivals.contains(from) || arrivals.contains(to) || past.places.area(to) < kLeastRoom) continue;
      lookedInto[to] = {1, isPredicted(past, to, base::Time::max()) ? 1U : 0U};
    }
  }
  for (const auto& [place, one] : lookedInto) recall.lookedInto += one;
  return recall;
}

}  // namespace

SeenCells& SeenCells::operator+=(const SeenCells& other) {
  free += other.free;
  occupied += other.occupied;
  unknown += other.unknown;
  return *this;
}

SeenCells HindsightLevel::overall() const {
  SeenCells sum;
  for (const auto& cells : byMobility) sum += cells;
  return sum;
}

std::optional<double> HindsightLevel::halfDiscPrecision() const {
  const auto& cells = byMobility[static_cast<std::size_t>(map::Mobility::kQuasiStatic)];
  return halfDiscs.precisionAt(static_cast<double>(cells.all()));
}

HindsightLevel& HindsightLevel::operator+=(const HindsightLevel& other) {
  for (std::size_t i = 0; i < byMobility.size(); ++i) byMobility[i] += other.byMobility[i];
  halfDiscs += other.halfDiscs;
  return *this;
}

RoomRecall& RoomRecall::operator+=(const RoomRecall& other) {
  entered += other.entered;
  inTime += other.inTime;
  lookedInto += other.lookedInto;
  return *this;
}

std::size_t HindsightScore::made() const {
  std::size_t sum = 0;
  for (const auto count : byState) sum += count;
  return sum;
}

std::optional<double> HindsightScore::precision() const {
  return shareOf(count(PredictionState::kConfirmed) + count(PredictionState::kMerged), bets.size());
}

HindsightScore& HindsightScore::operator+=(const HindsightScore& other) {
  for (std::size_t i = 0; i < byState.size(); ++i) byState[i] += other.byState[i];
  bets.insert(bets.end(), other.bets.begin(), other.bets.end());
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] += other.levels[i];
  rooms.shapes.insert(rooms.shapes.end(), other.rooms.shapes.begin(), other.rooms.shapes.end());
  roomsNotSeen += other.roomsNotSeen;
  recall += other.recall;
  return *this;
}

HindsightScore scoreHindsight(const map::MapView& view) {
  const Retrospect past(view);
  HindsightScore score;
  for (const auto& bet : past.claims.spaces) {
    if (bet.mobility == map::Mobility::kDynamic) continue;
    ++score.byState[static_cast<std::size_t>(bet.state)];
    if (bet.settled) score.bets.push_back({bet.probability, cameTrue(bet)});
  }
  for (std::size_t i = 0; i < kThresholds.size(); ++i) score.levels[i] = scoreLevel(past, kThresholds[i]);
  scoreRooms(past, score);
  score.recall = recallOf(past, arrivalsOf(view, past));
  return score;
}

}  // namespace prodomos::evaluation
