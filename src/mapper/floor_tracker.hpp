// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/map/records.hpp"

#include <vector>

namespace prodomos::mapper {

/// Tells on which floor the robot is, from its height along the way. A new floor is entered once the robot has gone
/// level for a metre at another height: while it climbs, it still belongs to the floor it comes from.
class FloorTracker {
 public:
  static constexpr double kLevelTolerance = 0.25;  ///< metres; thresholds, wheelchair ramps, a camera carried by hand

  explicit FloorTracker(double leastHeight) : leastHeight_(leastHeight) {}

  /// True where the robot has just come to another floor. `height` in metres above the first floor; `distance`
  /// travelled.
  bool update(double height, double distance);

  const map::Floor& current() const { return floors_[current_]; }
  const std::vector<map::Floor>& floors() const { return floors_; }

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  double leastHeight_;
  std::vector<map::Floor> floors_{map::Floor{}};
  std::size_t current_ = 0;
  double levelHeight_ = 0.0;  // since levelFrom_ (metres travelled), the robot has kept to this height
  double levelFrom_ = 0.0;
};

}  // namespace prodomos::mapper
