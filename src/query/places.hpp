// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/query/query.hpp"

namespace prodomos::query {

Eigen::Vector2d spotIn(const map::Node& node, const Position& position);

/// The observed sub-map that knows the spot best, else the predicted one that it lies in.
std::optional<base::SubMapId> submapKnowing(const map::MapView& view, const Position& position);

}  // namespace prodomos::query
