// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/prediction/config.hpp"
#include "prodomos/prediction/refusals.hpp"
#include "prodomos/prediction/walk.hpp"
#include "prodomos/prediction/world.hpp"

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace prodomos::prediction {

/// Bets on floor along the ways of people (002 §II-E), which is free if they leave: the part of the ledger that makes
/// no sub-maps. As Predictor, it knows of the past what stands in the map.
class WalkBets {
 public:
  WalkBets(const PredictionConfig& config, const map::MapView& before);

  /// Settles open bets or leaves out of them what is known by now: those on floor that was seen in that sub-map; on any
  /// floor, where none is named, at the end of the log. Then bets on walks that are over.
  void update(const World& world, std::optional<base::SubMapId> seen, const std::function<base::PredictionId()>& newId,
              Refusals& refusals);

  /// What has changed since the last call.
  void addTo(map::MapChange& change);

 private:
  struct Bet {
    map::Prediction prediction;
    bool isNews = false;
  };

  /// What was not bet on yet of somebody who may still be in sight: the last walk, after the state that went before.
  struct Followed {
    std::optional<base::EntityId> person;
    std::optional<map::TrackState> before;
    std::vector<map::TrackState> states;
  };
  enum class Sight { kLost, kKept, kEndOfLog };

  void follow(const World& world, std::optional<base::SubMapId> seen, const map::Node& submap, Bet& bet);
  static std::vector<std::pair<base::SubMapId, Walk>> takeWalks(Followed& followed, int dominantSide, Sight sight);
  std::vector<map::Prediction> told(const World& world, const map::Entity& person, const map::Node& submap,
                                    const Walk& walk, Refusals& refusals) const;

  PredictionConfig config_;
  std::vector<Bet> bets_;  // by id
  std::map<base::TrackId, Followed> followed_;
  std::vector<map::Event> events_;
};

}  // namespace prodomos::prediction
