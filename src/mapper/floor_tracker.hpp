// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/map/topological_graph.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace prodomos::mapper {

/// Tells on which floor the robot is, from its height along the way. A new floor is entered once the robot has gone
/// level at another height for a while: as long as it climbs, it still belongs to the floor it comes from.
class FloorTracker {
 public:
  static constexpr double kLevelTolerance = 0.25;  ///< metres; thresholds, wheelchair ramps, a camera carried by hand

  explicit FloorTracker(double leastHeight) : leastHeight_(leastHeight) {}

  /// Where the robot has just come to another floor: how, by stairs (or a ramp) or by a lift. `height` in metres above
  /// the first floor; `distance` travelled, climbing included.
  std::optional<map::EdgeKind> update(double height, double distance);

  const map::Floor& current() const { return floors_[current_]; }
  const std::vector<map::Floor>& floors() const { return floors_; }

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  struct Sample {
    double distance = 0.0;
    double height = 0.0;
  };

  void remember(const Sample& sample);
  std::optional<double> findOtherLevel() const;
  map::EdgeKind wayUpOrDown() const;
  std::size_t floorAt(double height);

  double leastHeight_;
  std::vector<map::Floor> floors_{map::Floor{}};
  std::size_t current_ = 0;
  Sample left_;                // the last one at the height of the current floor
  std::deque<Sample> recent_;  // the way just behind the robot, thinned out
};

}  // namespace prodomos::mapper
