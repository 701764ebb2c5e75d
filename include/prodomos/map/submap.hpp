// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/entity.hpp"
#include "prodomos/map/layer.hpp"
#include "prodomos/map/topological_graph.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace prodomos::map {

/// S = {P; R; U} (002 §II-A): an ego-centric map of a stretch of the way. Its frame lies on the floor below the robot
/// where it began, z up, x its heading. It never moves internally: refinement moves its frame.
struct SubMap {
  Node node;
  std::vector<std::unique_ptr<MapLayer>> layers;
  std::vector<Entity> entities;

  /// Null where the sub-map has no such layer.
  const MapLayer* findLayer(std::string_view typeId) const;
  /// The same as its own class: `submap.findLayer<OccupancyGrid>()`.
  template <typename Layer>
  const Layer* findLayer() const {
    return dynamic_cast<const Layer*>(findLayer(Layer::kTypeId));
  }
};

/// An empty sub-map with one layer of each type.
SubMap makeSubMap(Node node, const LayersConfig& config);

}  // namespace prodomos::map
