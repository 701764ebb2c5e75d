// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/cells.hpp"
#include "prodomos/evaluation/truth.hpp"

#include <optional>
#include <string>
#include <vector>

namespace prodomos::evaluation {

/// The true floor of one storey in cells: rooms, the openings of doors between them, and what stands there. All else is
/// wall or outside.
class GroundPlan {
 public:
  GroundPlan(const Truth& truth, int storey);

  /// Index into Truth::rooms; none in walls, openings and outside.
  std::optional<std::size_t> roomAt(geometry::CellIndex cell) const;
  /// In a room or an opening, but not where the leaf of a door stands that is closed then.
  bool isFloor(geometry::CellIndex cell, base::Time at) const;
  /// Below a thing that stands on the floor and does not move.
  bool isFurnished(geometry::CellIndex cell) const { return things_.at(cell) != 0; }

 private:
  std::vector<TrueDoor> doors_;
  CellMap<std::int32_t> rooms_;     ///< index, or -1
  CellMap<std::int32_t> openings_;  ///< of doors, index or -1
  CellMap<std::int32_t> leaves_;    ///< where they stand closed: index of the door, or -1
  CellMap<std::uint8_t> things_;
};

/// Of all storeys; index is the storey.
std::vector<GroundPlan> groundPlansOf(const Truth& truth);

/// Index into Truth::rooms; none where no room has that id.
std::optional<std::size_t> findRoom(const Truth& truth, const std::string& id);

}  // namespace prodomos::evaluation
