// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/drawing.hpp"

#include <optional>
#include <string>

/// The colours of all pictures of maps, so that a place looks alike on paper and on screen.
namespace prodomos::exporter {

constexpr map::Rgba kUnknownColor{236, 232, 225, 255};  // warm grey
constexpr map::Rgba kFreeColor{255, 255, 255, 255};
constexpr map::Rgba kOccupiedColor{47, 59, 72, 255};  // slate
constexpr map::Rgba kInkColor{31, 41, 55, 255};
constexpr map::Rgba kMutedColor{107, 114, 128, 255};
constexpr map::Rgba kTrajectoryColor{59, 130, 200, 255};
constexpr map::Rgba kDoorColor{217, 119, 11, 255};
constexpr map::Rgba kStairsColor{124, 58, 237, 255};
constexpr map::Rgba kLoopColor{37, 99, 235, 255};
constexpr map::Rgba kOverlapColor{37, 99, 235, 90};
constexpr map::Rgba kHumanColor{219, 39, 119, 255};
constexpr map::Rgba kObjectColor{146, 64, 14, 255};
constexpr map::Rgba kPredictedColor{22, 163, 74, 255};

/// Of a topological place; neighbours in number differ, and after twelve they repeat.
map::Rgba placeColor(std::optional<int> place);
map::Rgba withAlpha(map::Rgba color, double opacity);
/// "#22a0ff"; the opacity is dropped.
std::string hex(map::Rgba color);

}  // namespace prodomos::exporter
