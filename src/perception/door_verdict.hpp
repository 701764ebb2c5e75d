// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_candidates.hpp"

#include <string_view>
#include <vector>

namespace prodomos::perception {

/// Log-odds that there is a closed door, as the cues tell: logistic regression over simulated buildings
/// (docs/doors.md).
double evidenceOf(const DoorCandidate& candidate);

/// How well its lines are the leaf's own edges, against other lines beside them: of two for the same door the one with
/// more is the better.
double fitOf(const DoorCandidate& candidate);

/// Log-odds that the hinge is on the left: it is on the other side of the handle (002 §II-D). Both sides were seen.
double hingeEvidenceOf(const Handle& handle);

/// A cue in a word: "skirting", "no top".
std::string_view nameOf(Cue cue);

/// The cue that speaks most against it, in a word.
std::string_view weakestPoint(const DoorCandidate& candidate);

}  // namespace prodomos::perception
