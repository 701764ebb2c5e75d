// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_store.hpp"
#include "prodomos/prediction/config.hpp"
#include "prodomos/prediction/surroundings.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace prodomos::prediction {

/// Bets on what lies beyond doors and stairs, and settles them when the place is seen. All that it knows of the past
/// stands in the map, so that one that goes on with a map bets as one that never stopped.
class Predictor {
 public:
  /// Goes on with the ledger of the map.
  Predictor(const PredictionConfig& config, const map::MapView& before);

  /// What is known now.
  struct World {
    base::Time now{};
    base::SessionId session;
    std::span<const map::Entity> entities;  ///< all that are believed
    std::span<const map::Node> nodes;       ///< observed sub-maps, where they lie now
    /// Grids that may know something about a spot.
    std::function<std::vector<PlacedGrid>(const Eigen::Vector3d& spot_in_map)> gridsNear;
    std::function<base::SubMapId()> newNodeId;
    std::function<base::EdgeId()> newEdgeId;
  };
  /// Makes bets, shapes open ones anew and settles them: those of entities no farther than `reach` from the sub-map, in
  /// which something new was seen; of all, where none is named.
  void update(const World& world, std::optional<base::SubMapId> seen);

  /// What has changed since the last call.
  void addTo(map::MapChange& change);

 private:
  struct Bet {
    map::Prediction prediction;
    map::Node node;
    map::Edge edge;
    bool isNews = false;
  };

  void review(const World& world);
  void bet(const World& world, const map::Entity& entity, const map::Node& submap);
  void follow(const World& world, const map::Entity& entity, const map::Node& submap, Bet& bet);
  void settle(Bet& bet, map::PredictionState state, const World& world, std::optional<base::SubMapId> mergedInto = {});
  std::optional<double> shape(const map::Entity& entity, const Surroundings& around, map::Prediction& prediction) const;
  void place(Bet& bet, const map::Node& submap);
  Surroundings surroundingsOf(const World& world, const map::Entity& entity, const map::Node& submap) const;

  PredictionConfig config_;
  std::vector<Bet> bets_;  // by id
  std::vector<map::Event> events_;
};

}  // namespace prodomos::prediction
