// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"

#include <algorithm>
#include <string>

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

/// The bet was made, or settled.
inline map::Event eventOf(const map::Prediction& prediction, base::SessionId session, base::Time time) {
  const bool isOpen = prediction.state == map::PredictionState::kOpen;
  return {time, session, isOpen ? "prediction_made" : "prediction_settled", toString(prediction.id),
          R"({"state":")" + std::string(toString(prediction.state)) + R"("})"};
}

}  // namespace prodomos::prediction
