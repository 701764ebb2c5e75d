// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <Eigen/Core>

#include <memory>
#include <optional>

/// What moving things leave behind in a map: cells and voxels that are occupied where, when all was over, nothing
/// stood (000 §IV-A, table I). docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

/// What truth has at a spot.
enum class Matter {
  kStructure,   ///< walls, furniture, stairs, leaves where they ended; within the tolerance of them; outside of rooms
  kLastPerson,  ///< a person where it was last: no noise, by 000
  kPerson,      ///< free at the end; a person was there before
  kMovedThing,  ///< free at the end; a thing was there before
  kDoorLeaf,    ///< free at the end; a leaf turned through it
  kFree         ///< nothing was there ever
};

/// Free and occupied space of a building at the end of its log.
class TrueSpace {
 public:
  /// Metres by which shapes are grown: errors of map and sensor make no noise.
  explicit TrueSpace(const Truth& truth, double tolerance = 0.1);
  ~TrueSpace();
  TrueSpace(const TrueSpace&) = delete;
  TrueSpace& operator=(const TrueSpace&) = delete;

  /// Of a column of space over the spot: heights above the world's zero, metres; both alike: a point.
  Matter at(int storey, const Eigen::Vector2d& spot, double lowest, double highest) const;
  /// Inside a wall-less solid (furniture that stood still throughout, stairs) deeper than the tolerance.
  bool isSolid(int storey, const Eigen::Vector2d& spot, double lowest, double highest) const;

 private:
  struct Shapes;
  std::unique_ptr<Shapes> shapes_;
};

struct NoiseCounts {
  std::size_t occupied = 0;     ///< all that the map holds for occupied
  std::size_t lastPersons = 0;  ///< on persons where they were last
  std::size_t persons = 0;      ///< noise by its causes
  std::size_t movedThings = 0;
  std::size_t doorLeaves = 0;
  std::size_t others = 0;

  std::size_t noise() const { return persons + movedThings + doorLeaves + others; }
  void add(Matter matter);
  NoiseCounts& operator+=(const NoiseCounts& other);
};

struct NoiseOptions {
  double tolerance = 0.1;  ///< metres, of TrueSpace
};

struct NoiseScore {
  bool hasPersons = false;  ///< in the truth; without them there is nothing to be measured
  bool hasMovedThings = false;
  bool hasTurnedLeaves = false;
  std::optional<NoiseCounts> cells;   ///< of the occupancy grids; none where the map has none
  std::size_t freeFloorKnown = 0;     ///< cells of free floor that the map knows: what noise is a share of
  std::size_t solidKnown = 0;         ///< cells of solids that the map knows
  std::size_t solidErased = 0;        ///< of them, those it holds for free
  std::optional<NoiseCounts> points;  ///< of the point layers

  std::optional<double> noiseShare() const;
  std::optional<double> erasedShare() const { return shareOf(solidErased, solidKnown); }
  /// For scores over several maps.
  NoiseScore& operator+=(const NoiseScore& other);
};

NoiseScore scoreNoise(const map::MapView& view, const Truth& truth, const NoiseOptions& options = {});

/// The sub-maps' grids of one storey, each where its robot truly stood, merged in the order of their ids; none where
/// there is none.
std::optional<map::OccupancyGrid> gridInWorld(const map::MapView& view, const Truth& truth, int storey);

}  // namespace prodomos::evaluation
