// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <vector>

namespace prodomos::geometry {

/// The cost of a pair that must not be.
inline constexpr double kForbidden = std::numeric_limits<double>::infinity();

/// Pairs rows with columns, each at most once: as many pairs as can be without a forbidden one, and of all such ways
/// the one of the least sum of costs. By row its column, or none. Costs are finite, not NaN, or kForbidden.
///
/// The Hungarian method by shortest augmenting paths (Jonker and Volgenant 1987), O(rows² columns).
std::vector<std::optional<int>> assign(const Eigen::MatrixXd& costs);

}  // namespace prodomos::geometry
