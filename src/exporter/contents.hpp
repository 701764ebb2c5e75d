// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"

#include <optional>
#include <string>
#include <vector>

/// Questions that several formats ask of a map.
namespace prodomos::exporter {

/// The floors that a format with one plan a floor writes, ascending; a single "none" where the map knows no floors.
std::vector<std::optional<int>> floorsOf(const map::MapView& view);
/// Whether something with this floor is drawn on that plan: what has no floor is drawn on all.
bool onFloor(std::optional<int> floorOfThing, std::optional<int> plan);

/// The names of the logs, "fr079.rawlog + intel.rawlog"; "prodomos map" where there are no sessions.
std::string logNames(const map::MapView& view);

/// Of the two that turn alike, the one with w >= 0.
Eigen::Quaterniond quaternionOf(const geometry::Pose3& pose);
geometry::Pose3 poseInMap(const map::MapView& view, const map::Entity& entity);

/// The way of somebody who was followed, as far as it lies on one floor.
struct Trail {
  base::TrackId track;
  std::optional<int> floor;
  base::SubMapId submap;  ///< where it begins
  std::vector<Eigen::Vector3d> points_in_map;
};
/// Of all tracks of people; in pieces of two points or more.
std::vector<Trail> trailsOf(const map::MapView& view);

/// The bet that a predicted node stands for; null where there is none.
const map::Prediction* predictionOf(const map::MapView& view, base::SubMapId node);

/// Of its node; of a settled one, of the sub-map that its cause lies in.
std::optional<int> floorOf(const map::MapView& view, const map::Prediction& prediction);

/// The graph's observed nodes, and the edges between them, ascending.
std::vector<map::Node> observedNodes(const map::MapView& view);
std::vector<map::Edge> observedEdges(const map::MapView& view);

}  // namespace prodomos::exporter
