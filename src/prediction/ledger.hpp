// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"

#include <algorithm>

/// What those who make bets have in common.
namespace prodomos::prediction {

/// Metres from a sub-map's origin to what its readings may tell something about.
inline constexpr double kReach = 15.0;

/// Null where there is none.
template <typename Things, typename Id>
auto findById(Things& things, Id id) {
  const auto found = std::ranges::find(things, id, [](const auto& thing) { return thing.id; });
  return found == things.end() ? nullptr : &*found;
}

/// The bet was made, with what it tells then (docs/map-file.md), or settled.
map::Event eventOf(const map::Prediction& prediction, base::SessionId session, base::Time time);

}  // namespace prodomos::prediction
