// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/prediction/config.hpp"
#include "prodomos/prediction/refusals.hpp"
#include "prodomos/prediction/surroundings.hpp"
#include "prodomos/prediction/walk_bets.hpp"
#include "prodomos/prediction/world.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::prediction {

/// Bets on what lies beyond doors and stairs and along people's ways, and settles them when the place is seen. All that
/// it knows of the past stands in the map, so that one that goes on with a map bets as one that never stopped.
class Predictor {
 public:
  /// Goes on with the ledger of the map.
  Predictor(const PredictionConfig& config, const map::MapView& before);

  /// Makes bets, shapes open ones anew and settles them: those of entities no farther than `reach` from the sub-map, in
  /// which something new was seen; of all, where none is named.
  void update(const World& world, std::optional<base::SubMapId> seen);
  /// The same while the robot is still in the sub-map, of doors and stairs alone: people are on their ways still.
  void glance(const World& world, base::SubMapId seen);

  /// A planner went there: what it found is evidence. Refuted bets are settled; blocked ones stay open, and say so.
  /// Throws base::Error where the prediction is none of a room, or settled.
  void tell(base::PredictionId id, map::Finding finding, base::SessionId session, base::Time now);
  /// Entities that M(S) refused in this session, by reason.
  std::map<std::string, std::int64_t> refused() const { return refusals_.byReason(); }
  /// What has changed since the last call.
  void addTo(map::MapChange& change);

 private:
  struct Bet {
    map::Prediction prediction;
    map::Node node;
    std::vector<map::Edge> ways;  ///< the first through its cause, others through further doors of the same room
    bool isNews = false;
    bool isTold = false;
  };

  base::PredictionId newId() { return std::exchange(nextId_, base::PredictionId{nextId_.value + 1}); }
  void lookThroughOpenings(const World& world, std::optional<base::SubMapId> seen);
  void review(const World& world);
  void forgetWhatNobodyHeard(const World& world);
  Bet* roomBehind(const map::Entity& entity, const map::Node& submap);
  void share(const World& world, const map::Entity& entity, const map::Node& submap, Bet& room);
  void leave(base::EntityId entity, const Bet* except);
  template <typename Predicate>
  void removeWays(Bet& bet, const Predicate& isGone);
  void bet(const World& world, const map::Entity& entity, const map::Node& submap);
  void follow(const World& world, const map::Entity& entity, const map::Node& submap, Bet& bet);
  void settle(Bet& bet, map::PredictionState state, base::SessionId session, base::Time now,
              std::optional<base::SubMapId> mergedInto = {});
  std::optional<double> shape(const World& world, const map::Entity& entity, const Surroundings& around,
                              map::Prediction& prediction);
  void place(const World& world, Bet& bet, const map::Node& submap);
  std::optional<geometry::Pose2> viewpointOf(const World& world, const map::Entity& entity, const map::Node& submap,
                                             const Surroundings& around) const;
  Surroundings surroundingsOf(const World& world, const map::Entity& entity, const map::Node& submap) const;

  PredictionConfig config_;
  std::vector<Bet> bets_;  // by id
  WalkBets walks_;
  Refusals refusals_;
  base::PredictionId nextId_{0};
  std::vector<map::Event> events_;
  std::vector<base::EdgeId> removedWays_;
};

}  // namespace prodomos::prediction
