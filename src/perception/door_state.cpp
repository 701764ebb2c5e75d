// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_state.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prodomos::perception {

namespace {

constexpr std::array<map::DoorState, 3> kStates = {map::DoorState::kClosed, map::DoorState::kAjar,
                                                   map::DoorState::kOpen};
/// However often it was told: so many wrong readings in a row flip any belief.
constexpr double kLeastBelief = 0.01;

}  // namespace

DoorStateFilter::Likelihoods DoorStateFilter::told(map::DoorState state, double trust) {
  Likelihoods likelihoods{};
  for (std::size_t i = 0; i < kStates.size(); ++i) likelihoods[i] = kStates[i] == state ? trust : (1.0 - trust) / 2.0;
  return likelihoods;
}

void DoorStateFilter::update(base::Time time, const Likelihoods& likelihoods, double memory) {
  const double elapsed = isTold_ ? std::max(0.0, base::seconds(time - time_)) : 0.0;
  const double kept = std::exp(-elapsed / memory);
  for (std::size_t i = 0; i < kStates.size(); ++i) {
    beliefs_[i] = (kept * beliefs_[i] + (1.0 - kept) / 3.0) * likelihoods[i];
  }
  const double sum = std::accumulate(beliefs_.begin(), beliefs_.end(), 0.0);
  for (double& belief : beliefs_) belief = std::max(kLeastBelief, belief / sum);
  isTold_ = true;
  time_ = std::max(time_, time);
}

map::DoorState DoorStateFilter::state() const {
  if (!isTold_) return map::DoorState::kUnknown;
  return kStates[static_cast<std::size_t>(std::ranges::max_element(beliefs_) - beliefs_.begin())];
}

}  // namespace prodomos::perception
