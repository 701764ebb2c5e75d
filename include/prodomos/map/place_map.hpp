// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/cells.hpp"
#include "prodomos/map/map_view.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace prodomos::map {

/// A topological place by its floor: what hangs together when doors are closed.
struct SeenPlace {
  int number = 0;
  std::optional<int> floor;
  std::vector<base::SubMapId> submaps;  ///< that began there, ascending; none where nobody has been
  double area = 0.0;                    ///< m² of free floor that was seen
};

/// Which place each free cell belongs to (002 §II-A): connectivity of free floor, with doors drawn as walls, so that
/// one sub-map which sees three rooms through open doors knows three places. Those where sub-maps began have the
/// numbers of TopologicalGraph::places(), others the numbers after these.
class PlaceMap {
 public:
  /// Of all floors. Reads every grid: keep it where many spots are asked for.
  explicit PlaceMap(const MapView& view);

  /// By number; predicted ones, of which nobody has seen any floor, are left out.
  const std::vector<SeenPlace>& places() const { return places_; }
  /// The place of a spot of the map frame; none where it is not free, or too little hangs together with it.
  std::optional<int> placeAt(const Eigen::Vector2d& point_in_map, std::optional<int> floor) const;

 private:
  using Numbers = geometry::CellMap<std::int32_t>;
  void addFloor(const MapView& view, std::optional<int> floor);

  std::map<std::optional<int>, Numbers> floors_;
  double resolution_ = 0.05;
  std::vector<SeenPlace> places_;
};

}  // namespace prodomos::map
