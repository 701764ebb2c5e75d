// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/prediction/surroundings.hpp"

#include "prediction/outline.hpp"

namespace prodomos::prediction {

/// Unknown cells of the box that one may come to from the door without leaving it, and without entering what is known
/// or taken. A door that stands open shows some floor behind: one comes through that as well, but it is not told of.
CellSet reachableFloor(const Surroundings& around, const geometry::CellBox& box);

}  // namespace prodomos::prediction
