// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "localization/pose_problem.hpp"

#include <memory>
#include <vector>

namespace prodomos::localization {

/// A start for refinement that does not depend on the present poses, apart from the fixed ones: first all rotations by
/// least squares over matrices, each then brought to the nearest rotation (chordal relaxation), and with these all
/// positions by least squares (Carlone et al., ICRA 2015). Two linear systems, of blocks of 2 or 3.
template <typename Pose>
std::vector<typename PoseProblem<Pose>::State> statesByRotations(const PoseProblem<Pose>& problem,
                                                                 const std::shared_ptr<const Elimination>& elimination);

}  // namespace prodomos::localization
