// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_candidates.hpp"

#include <string_view>
#include <vector>

namespace prodomos::perception {

/// Log-odds that there is a closed door, as the cues tell.
double evidenceOf(const DoorCandidate& candidate);

/// The cue that speaks most against it, in a word: "skirting", "no top".
std::string_view weakestPoint(const DoorCandidate& candidate);

std::string_view nameOf(Cue cue);

}  // namespace prodomos::perception
