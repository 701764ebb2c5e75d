// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/known_space.hpp"
#include "prodomos/geometry/pieces.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace prodomos::evaluation {

/// The floor that a map has seen, by places: what hangs together when the openings that it knows are drawn as walls
/// (002 §II-A). With no truth at hand, this is what there is behind an opening. Unlike map::PlaceMap it does not ask
/// the graph what belongs together, and holes in walls that nobody can walk through join nothing.
class ObservedPlaces {
 public:
  ObservedPlaces(const KnownSpace& known, const std::vector<ClaimedDoor>& openings);

  /// Index of the place; none where nobody saw free floor, in openings, and in gaps that nobody can walk through.
  std::optional<std::size_t> at(int storey, const Eigen::Vector2d& spot_in_world) const;
  /// The place on the far side of an opening (that its x-axis points to), and on the near one; none where nothing was
  /// seen there.
  std::optional<std::size_t> behind(const ClaimedDoor& opening) const { return beside(opening, 1.0); }
  std::optional<std::size_t> before(const ClaimedDoor& opening) const { return beside(opening, -1.0); }

  std::size_t count() const { return places_.size(); }
  double area(std::size_t place) const;  ///< m² of free floor

  /// A place as a room.
  struct Room {
    geometry::CellSet cells;  ///< not 0: its floor, and what stands on it
    double enclosed = 0.0;    ///< share of its border that walls and openings make; else it goes on unseen
  };
  Room room(std::size_t place) const;

 private:
  struct Place {
    int storey = 0;
    geometry::CellBox box;
    std::size_t cells = 0;
  };
  using Labels = CellMap<std::int32_t>;

  static Labels drawn(const KnownSpace& known, int storey, const std::vector<ClaimedDoor>& openings);
  void label(int storey, Labels& labels);
  std::optional<std::size_t> beside(const ClaimedDoor& opening, double side) const;

  std::vector<Place> places_;
  std::map<int, Labels> labelsOfStorey_;  ///< of each cell its place, or why it has none
};

}  // namespace prodomos::evaluation
