// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/predictor.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/prediction/room_guess.hpp"
#include "prodomos/prediction/viewpoint.hpp"

#include "prediction/ledger.hpp"
#include "prediction/space_behind.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::prediction {

namespace {

using geometry::Pose3;
using map::PredictionState;

constexpr double kLeastSpace = 2.0;    // m²; what is smaller is no room
constexpr double kMostlyUnseen = 0.5;  // m² not seen for one that was: less, and the room is known
constexpr double kLeastMove = 1e-3;    // metres, radians; what moves less need not be told
constexpr double kStairsLead = 0.97;   // that a true flight leads somewhere
constexpr double kFirstStep = 0.8;     // metres behind a door: where one is in the room
constexpr double kPlacedAt = 0.1;      // metres, radians: how well a door's sub-map is known to lie behind it

bool opensSpace(const map::Entity& entity) {
  return std::holds_alternative<map::Door>(entity.attributes) ||
         std::holds_alternative<map::Staircase>(entity.attributes);
}

double openingWidth(const map::Entity& entity) {
  if (const auto* door = std::get_if<map::Door>(&entity.attributes)) return door->width;
  return std::get<map::Staircase>(entity.attributes).stepWidth;
}

bool isSame(const Pose3& a, const Pose3& b) {
  const Pose3 between = a.inverse() * b;
  return between.translation().norm() < kLeastMove && geometry::rotationAngle(between) < kLeastMove;
}

map::Matrix6 informationOf(const map::Entity& entity) {
  const map::Matrix6 covariance = entity.covariance + kPlacedAt * kPlacedAt * map::Matrix6::Identity();
  return covariance.inverse();
}

/// An observed sub-map that began in the space.
std::optional<base::SubMapId> submapWithin(const SpaceBehind& space, const Pose3& T_map_here,
                                           std::span<const map::Node> nodes) {
  for (const auto& node : nodes) {
    const Eigen::Vector3d origin_in_here = T_map_here.inverse() * node.T_map_submap.translation();
    const auto cell = geometry::cellAt(origin_in_here.x(), origin_in_here.y(), Surroundings::kCell);
    if (std::abs(origin_in_here.z()) < Surroundings::kSameFloor && space.cells.at(cell) != 0) return node.id;
  }
  return std::nullopt;
}

/// How likely it is that there is a space of 2 m² which nobody has seen.
double probabilityOf(const map::Entity& entity, const RoomGuess* guess) {
  return entity.confidence * (guess == nullptr ? kStairsLead : guess->spaceProbability);
}

}  // namespace

void describe(base::ConfigVisitor& visitor, PredictionConfig& config) {
  visitor.section("bets", "on what lies beyond doors and stairs");
  visitor.key("enabled", config.enabled, "whether anything is predicted");
  visitor.key("least_probability", config.leastProbability, "", {0.0, 1.0}, "bets that are less likely are not made");
  visitor.key("robot_radius", config.robotRadius, "m", {0.0, 2.0}, "room that a robot needs where it stands to enter");
  visitor.endSection();
  describe(visitor, config.extrapolation);
}

Predictor::Predictor(const PredictionConfig& config, const map::MapView& before)
    : config_(config), walks_(config, before), refusals_(before) {
  for (const auto& prediction : before.predictions()) {
    nextId_.value = std::max(nextId_.value, prediction.id.value + 1);
    if (prediction.isConditional()) continue;
    Bet bet{.prediction = prediction, .node = {}, .ways = {}, .isTold = true};
    if (const auto* node = before.graph().findNode(prediction.node)) {
      bet.node = *node;
      for (const auto id : before.graph().edgesOf(node->id)) bet.ways.push_back(before.graph().getEdge(id));
    }
    bets_.push_back(std::move(bet));
  }
}

void Predictor::update(const World& world, std::optional<base::SubMapId> seen) {
  if (!config_.enabled) return;
  lookThroughOpenings(world, seen);
  forgetWhatNobodyHeard(world);
  walks_.update(
      world, seen, [this] { return newId(); }, refusals_);
}

void Predictor::glance(const World& world, base::SubMapId seen) {
  if (config_.enabled) lookThroughOpenings(world, seen);
}

void Predictor::lookThroughOpenings(const World& world, std::optional<base::SubMapId> seen) {
  review(world);
  const auto* const news = seen ? findById(world.nodes, *seen) : nullptr;
  for (const auto& entity : world.entities) {
    const auto* const submap = findById(world.nodes, entity.submap);
    if (const auto fault = faultOf(entity); !fault.empty()) refusals_.add(entity.id, fault, world);
    if (!opensSpace(entity) || submap == nullptr || !faultOf(entity).empty()) continue;
    const Eigen::Vector3d spot_in_map = submap->T_map_submap * entity.T_submap_entity.translation();
    if (news != nullptr && (news->T_map_submap.translation() - spot_in_map).norm() > kReach) continue;
    const auto known = std::ranges::find(bets_, entity.id, [](const Bet& bet) { return bet.prediction.cause; });
    if (known != bets_.end()) {
      if (known->prediction.state == PredictionState::kOpen) follow(world, entity, *submap, *known);
      continue;
    }
    auto* const room = roomBehind(entity, *submap);
    leave(entity.id, room);
    if (room != nullptr) {
      share(world, entity, *submap, *room);
    } else {
      bet(world, entity, *submap);
    }
  }
}

template <typename Predicate>
void Predictor::removeWays(Bet& bet, const Predicate& isGone) {
  std::erase_if(bet.ways, [&](const map::Edge& way) {
    if (!isGone(way)) return false;
    removedWays_.push_back(way.id);
    return true;
  });
}

/// Predicted sub-maps follow those that their doors were seen from; a bet on what is believed no more is lost. Entities
/// of earlier sessions are not among those that are believed, and stay.
void Predictor::review(const World& world) {
  for (auto& bet : bets_) {
    const auto* const submap = findById(world.nodes, bet.prediction.submap);
    if (bet.prediction.state != PredictionState::kOpen || submap == nullptr) continue;
    const auto* const cause = findById(world.entities, bet.prediction.cause);
    const bool isGone = cause == nullptr || !faultOf(*cause).empty();
    if (isGone && submap->session == world.session) {
      settle(bet, PredictionState::kRefuted, world.session, world.now);
      continue;
    }
    removeWays(bet, [&](const map::Edge& way) {
      const auto* const from = findById(world.nodes, way.from);
      const bool isOurs = from != nullptr && from->session == world.session;
      return isOurs && way.cause != bet.prediction.cause && findById(world.entities, *way.cause) == nullptr;
    });
    place(world, bet, *submap);
  }
}

/// Bets on doors that were given up again before anybody was told of either: the map does not know such doors.
void Predictor::forgetWhatNobodyHeard(const World& world) {
  std::erase_if(bets_, [&](const Bet& bet) {
    if (bet.isTold || findById(world.entities, bet.prediction.cause) != nullptr) return false;
    std::erase_if(events_, [&](const map::Event& event) { return event.subject == toString(bet.prediction.id); });
    return true;
  });
}

/// Where another door leads into a room that is bet on already: that bet.
Predictor::Bet* Predictor::roomBehind(const map::Entity& entity, const map::Node& submap) {
  if (!std::holds_alternative<map::Door>(entity.attributes)) return nullptr;
  const Pose3 T_map_here = submap.T_map_submap * T_submap_here(entity);
  const Eigen::Vector3d inside_in_map = T_map_here * Eigen::Vector3d(kFirstStep, 0.0, 0.0);
  const auto found = std::ranges::find_if(bets_, [&](const Bet& bet) {
    const Eigen::Vector3d inside_in_node = bet.node.T_map_submap.inverse() * inside_in_map;
    return bet.prediction.state == PredictionState::kOpen && std::abs(inside_in_node.z()) < Surroundings::kSameFloor &&
           geometry::contains(bet.prediction.room_in_node, inside_in_node.head<2>());
  });
  return found == bets_.end() ? nullptr : &*found;
}

void Predictor::share(const World& world, const map::Entity& entity, const map::Node& submap, Bet& room) {
  if (std::ranges::count(room.ways, std::optional(entity.id), &map::Edge::cause) == 0) {
    map::Edge way;
    way.id = world.newEdgeId();
    way.kind = map::EdgeKind::kDoor;
    way.cause = entity.id;
    way.information = informationOf(entity);
    way.from = submap.id;
    room.ways.push_back(way);
    room.isNews = true;
  }
  if (const auto* const first = findById(world.nodes, room.prediction.submap)) place(world, room, *first);
}

/// Rooms that are thought smaller now are no longer behind the door.
void Predictor::leave(base::EntityId entity, const Bet* except) {
  for (auto& bet : bets_) {
    if (&bet == except || bet.prediction.state != PredictionState::kOpen) continue;
    removeWays(bet, [entity](const map::Edge& way) { return way.cause == entity; });
  }
}

/// Told in the frame in which the entity is extrapolated.
Surroundings Predictor::surroundingsOf(const World& world, const map::Entity& entity, const map::Node& submap) const {
  const Pose3 T_map_here = submap.T_map_submap * T_submap_here(entity);
  const Pose3 T_here_map = T_map_here.inverse();
  Surroundings around(T_map_here, world.gridsNear(T_map_here.translation()));
  for (const auto& other : world.entities) {
    const auto* const door = std::get_if<map::Door>(&other.attributes);
    const auto* const itsSubmap = findById(world.nodes, other.submap);
    if (door == nullptr || itsSubmap == nullptr || other.id == entity.id) continue;
    const Pose3 T_here_other = T_here_map * itsSubmap->T_map_submap * other.T_submap_entity;
    if (std::abs(T_here_other.translation().z()) > Surroundings::kSameFloor ||
        T_here_other.translation().head<2>().norm() > kReach) {
      continue;
    }
    around.openings.push_back({other.id, geometry::toPose2(T_here_other), door->width, door->hasLeaf});
  }
  for (const auto& bet : bets_) {
    if (bet.prediction.cause == entity.id || bet.prediction.state != PredictionState::kOpen) continue;
    const Pose3 T_here_node = T_here_map * bet.node.T_map_submap;
    if (std::abs(T_here_node.translation().z()) > Surroundings::kSameFloor || bet.prediction.room_in_node.empty()) {
      continue;
    }
    around.taken_here.push_back(geometry::transformed(T_here_node, bet.prediction.room_in_node));
  }
  return around;
}

/// Tells what M(S) makes of the entity now, and how likely it is; none where it is refused.
std::optional<double> Predictor::shape(const World& world, const map::Entity& entity, const Surroundings& around,
                                       map::Prediction& prediction) {
  std::optional<RoomGuess> guess;
  if (const auto* door = std::get_if<map::Door>(&entity.attributes)) guess = guessRoom(around, door->width);
  const auto beyond = extrapolate(entity, around, guess ? &*guess : nullptr, config_.extrapolation);
  if (const auto* refusal = std::get_if<Refusal>(&beyond)) refusals_.add(entity.id, refusal->reason, world);
  const auto* const predicted = std::get_if<PredictedSubMap>(&beyond);
  if (predicted == nullptr) return std::nullopt;
  prediction.submap = entity.submap;
  prediction.expectedArea = predicted->expectedArea;
  prediction.T_submap_node = predicted->T_i_j;
  prediction.areas = predicted->areas;
  prediction.room_in_node = predicted->room_in_j;
  return probabilityOf(entity, guess ? &*guess : nullptr);
}

/// Where to stand to go through, in the entity's sub-map.
std::optional<geometry::Pose2> Predictor::viewpointOf(const World& world, const map::Entity& entity,
                                                      const map::Node& submap, const Surroundings& around) const {
  const Pose3 T_submap_near = prediction::T_submap_near(entity);
  const Pose3 T_map_near = submap.T_map_submap * T_submap_near;
  const bool isTheSame = isSame(T_map_near, around.T_map_here());
  const auto viewpoint_in_near = viewpointBefore(
      isTheSame ? around : Surroundings(T_map_near, world.gridsNear(T_map_near.translation())), config_.robotRadius);
  if (!viewpoint_in_near) return std::nullopt;
  return geometry::toPose2(T_submap_near) * *viewpoint_in_near;
}

void Predictor::bet(const World& world, const map::Entity& entity, const map::Node& submap) {
  const auto around = surroundingsOf(world, entity, submap);
  const auto space = spaceBehind(around, openingWidth(entity));
  if (space.unseen < std::max(kLeastSpace, kMostlyUnseen * space.seen)) return;
  if (submapWithin(space, around.T_map_here(), world.nodes)) return;
  Bet bet;
  const auto probability = shape(world, entity, around, bet.prediction);
  if (!probability || *probability < config_.leastProbability) return;
  bet.prediction.probability = *probability;
  bet.prediction.id = newId();
  bet.prediction.cause = entity.id;
  bet.prediction.made = world.now;
  bet.prediction.viewpoint_in_submap = viewpointOf(world, entity, submap, around);
  bet.node.id = bet.prediction.node = world.newNodeId();
  bet.node.kind = map::SubMapKind::kPredicted;
  bet.node.begin = bet.node.end = world.now;
  map::Edge way;
  way.id = world.newEdgeId();
  way.kind = std::holds_alternative<map::Door>(entity.attributes) ? map::EdgeKind::kDoor : map::EdgeKind::kStairs;
  way.cause = entity.id;
  way.information = informationOf(entity);
  bet.ways = {way};
  bet.isNews = true;
  place(world, bet, submap);
  events_.push_back(eventOf(bet.prediction, world.session, world.now));
  bets_.push_back(std::move(bet));
}

/// Sees whether the bet on the entity is settled; else it is told anew, with all that is known by now. Its odds stay
/// those at which it was made: what is seen of the room does not make it less likely that there was one.
void Predictor::follow(const World& world, const map::Entity& entity, const map::Node& submap, Bet& bet) {
  const auto around = surroundingsOf(world, entity, submap);
  const auto space = spaceBehind(around, openingWidth(entity));
  if (const auto within = submapWithin(space, around.T_map_here(), world.nodes)) {
    return settle(bet, PredictionState::kMerged, world.session, world.now, within);
  }
  if (space.seen >= kLeastSpace && space.unseen < kMostlyUnseen * space.seen)
    return settle(bet, PredictionState::kConfirmed, world.session, world.now);
  if (space.seen + space.unseen < kLeastSpace) return settle(bet, PredictionState::kRefuted, world.session, world.now);
  if (!shape(world, entity, around, bet.prediction))
    return settle(bet, PredictionState::kRefuted, world.session, world.now);
  bet.prediction.viewpoint_in_submap = viewpointOf(world, entity, submap, around);
  bet.ways.front().information = informationOf(entity);
  bet.isNews = true;
  place(world, bet, submap);
}

/// Where the predicted sub-map lies, as its observed one does.
void Predictor::place(const World& world, Bet& bet, const map::Node& submap) {
  auto& node = bet.node;
  const Pose3& T_submap_node = bet.prediction.T_submap_node;
  const Pose3 T_map_node = submap.T_map_submap * T_submap_node;
  bet.isNews |= !isSame(node.T_map_submap, T_map_node);
  node.session = submap.session;
  if (bet.ways.front().kind == map::EdgeKind::kDoor) node.floor = submap.floor;
  node.T_map_submap = T_map_node;
  node.T_travel_submap = submap.T_travel_submap * T_submap_node;
  bet.ways.front().from = submap.id;
  for (auto& way : bet.ways) {
    way.to = node.id;
    const auto* const from = findById(world.nodes, way.from);
    if (from != nullptr) way.T_from_to = from->T_map_submap.inverse() * T_map_node;
  }
}

void Predictor::settle(Bet& bet, PredictionState state, base::SessionId session, base::Time now,
                       std::optional<base::SubMapId> mergedInto) {
  bet.prediction.state = state;
  bet.prediction.settled = now;
  bet.prediction.mergedInto = mergedInto;
  bet.isNews = true;
  events_.push_back(eventOf(bet.prediction, session, now));
}

void Predictor::tell(base::PredictionId id, map::Finding finding, base::SessionId session, base::Time now) {
  const auto bet = std::ranges::find(bets_, id, [](const Bet& each) { return each.prediction.id; });
  if (bet == bets_.end()) throw base::Error("there is no predicted room " + toString(id));
  if (bet->prediction.state != PredictionState::kOpen) {
    throw base::Error("prediction " + toString(id) + " is settled: it was " +
                      std::string(toString(bet->prediction.state)));
  }
  if (finding == map::Finding::kRefuted) return settle(*bet, PredictionState::kRefuted, session, now);
  bet->prediction.blocked = now;
  bet->isNews = true;
  events_.push_back({now, session, "prediction_blocked", toString(id), "{}"});
}

void Predictor::addTo(map::MapChange& change) {
  for (auto& bet : bets_) {
    if (!std::exchange(bet.isNews, false)) continue;
    bet.isTold = true;
    change.predictions.push_back(bet.prediction);
    if (bet.prediction.state == PredictionState::kOpen) {
      change.nodes.push_back(bet.node);
      change.edges.insert(change.edges.end(), bet.ways.begin(), bet.ways.end());
    } else {
      change.removedNodes.push_back(bet.node.id);
    }
  }
  for (const auto way : std::exchange(removedWays_, {})) change.removedEdges.push_back(way);
  for (auto& event : std::exchange(events_, {})) change.events.push_back(std::move(event));
  walks_.addTo(change);
  refusals_.addTo(change);
}

}  // namespace prodomos::prediction
