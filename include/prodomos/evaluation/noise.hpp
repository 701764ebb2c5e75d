// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

/// What moving things leave behind in a map: cells and voxels that are occupied where, when all was over, nothing
/// stood (000 §IV-A, table I). docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

/// What truth has at a spot; where there are several, the first of these.
enum class Matter {
  kStructure,   ///< walls, furniture, stairs, leaves where they ended; outside of rooms; within the tolerance of these
  kLastPerson,  ///< a person where it was last: no noise, by 000
  kPerson,      ///< free at the end; a person was there before
  kMovedThing,  ///< free at the end; a thing was there before
  kDoorLeaf,    ///< free at the end; a leaf turned through it
  kFree         ///< nothing was there ever
};

/// Free and occupied space of a building at the end of its log.
class TrueSpace {
 public:
  /// Shapes are grown by so many metres: errors of map and sensor make no noise.
  TrueSpace(const Truth& truth, double tolerance);
  ~TrueSpace();
  TrueSpace(const TrueSpace&) = delete;
  TrueSpace& operator=(const TrueSpace&) = delete;

  /// What a column over the spot meets between two heights above the floor, metres; of a point both are alike.
  Matter at(int storey, const Eigen::Vector2d& spot_in_world, double lowest, double highest) const;

 private:
  class Storey;
  std::vector<Storey> storeys_;
};

struct NoiseCounts {
  std::size_t occupied = 0;     ///< all that the map holds for occupied
  std::size_t lastPersons = 0;  ///< of it, on persons where they were last
  std::size_t persons = 0;      ///< of it, noise by what has left it
  std::size_t movedThings = 0;
  std::size_t doorLeaves = 0;
  std::size_t others = 0;  ///< where nothing ever was: errors of sensor and poses

  /// Of all that moves: the figures of 000's table I.
  std::size_t noise() const { return persons + movedThings + doorLeaves; }
  void add(Matter matter);
  NoiseCounts& operator+=(const NoiseCounts& other);
};

struct NoiseOptions {
  double tolerance = 0.1;  ///< metres, of TrueSpace
};

struct NoiseScore {
  bool hasPersons = false;  ///< in the truth; without them theirs cannot be measured
  bool hasMovedThings = false;
  bool hasTurnedLeaves = false;
  std::optional<NoiseCounts> cells;   ///< of the occupancy grids; none where the map has none
  std::size_t freeFloor = 0;          ///< known cells where in the end nothing stands: what noise is a share of
  std::size_t walls = 0;              ///< stretches of wall, a cell long, that the map shows free floor before
  std::size_t wallsKept = 0;          ///< of them, those that the map has; who filters all has no noise and no walls
  std::optional<NoiseCounts> points;  ///< of the point layers, one a voxel

  std::optional<double> noiseShare() const;
  std::optional<double> wallsKeptShare() const { return shareOf(wallsKept, walls); }
  /// For scores over several maps.
  NoiseScore& operator+=(const NoiseScore& other);
};

NoiseScore scoreNoise(const map::MapView& view, const Truth& truth, const NoiseOptions& options = {});

/// The sub-maps' grids of one storey, each where its robot truly stood, merged in the order of their ids; none where
/// there is none.
std::optional<map::OccupancyGrid> gridInWorld(const map::MapView& view, const Truth& truth, int storey);

}  // namespace prodomos::evaluation
