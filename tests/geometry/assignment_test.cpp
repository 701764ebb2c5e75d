// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/assignment.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::geometry {
namespace {

/// How many pairs, and what they cost.
using Worth = std::pair<int, double>;

Worth worthOf(const Eigen::MatrixXd& costs, const std::vector<std::optional<int>>& columnOf) {
  Worth worth{0, 0.0};
  std::vector<int> taken;
  for (std::size_t row = 0; row < columnOf.size(); ++row) {
    if (!columnOf[row]) continue;
    EXPECT_EQ(std::ranges::count(taken, *columnOf[row]), 0) << "a column is used twice";
    taken.push_back(*columnOf[row]);
    ++worth.first;
    worth.second += costs(static_cast<int>(row), *columnOf[row]);
  }
  return worth;
}

bool isBetter(const Worth& a, const Worth& b) {
  return a.first > b.first || (a.first == b.first && a.second < b.second);
}

/// All ways, one after the other.
Worth bestWorth(const Eigen::MatrixXd& costs, int row, std::vector<bool>& taken) {
  if (row == costs.rows()) return {0, 0.0};
  Worth best = bestWorth(costs, row + 1, taken);
  for (int column = 0; column < costs.cols(); ++column) {
    const auto c = static_cast<std::size_t>(column);
    if (taken[c] || std::isinf(costs(row, column))) continue;
    taken[c] = true;
    Worth with = bestWorth(costs, row + 1, taken);
    taken[c] = false;
    with.first += 1;
    with.second += costs(row, column);
    if (isBetter(with, best)) best = with;
  }
  return best;
}

TEST(Assignment, IsTheBestOfAllWays) {
  base::Random random(1, "assignment_test");
  for (int trial = 0; trial < 400; ++trial) {
    Eigen::MatrixXd costs(random.integer(1, 6), random.integer(1, 6));
    const double forbidden = random.uniform(0.0, 0.9);
    for (double& cost : costs.reshaped()) {
      cost = random.uniform() < forbidden ? kForbidden : random.integer(-3, 20);
    }
    std::vector<bool> taken(static_cast<std::size_t>(costs.cols()), false);
    EXPECT_EQ(worthOf(costs, assign(costs)), bestWorth(costs, 0, taken)) << costs;
  }
}

TEST(Assignment, GivesUpTheNearestForTheLeastSum) {
  Eigen::Matrix2d costs;
  costs << 1, 2, 2, 100;
  EXPECT_EQ(assign(costs), (std::vector<std::optional<int>>{1, 0}));
}

TEST(Assignment, PrefersTwoDearPairsToOneThatCostsNothing) {
  Eigen::Matrix2d costs;
  costs << 0, 9, 9, kForbidden;
  EXPECT_EQ(assign(costs), (std::vector<std::optional<int>>{1, 0}));
}

TEST(Assignment, LeavesAloneWhatMayNotBePaired) {
  EXPECT_EQ(assign(Eigen::MatrixXd::Constant(2, 3, kForbidden)), (std::vector<std::optional<int>>(2)));
}

TEST(Assignment, OfNothingIsEmpty) {
  EXPECT_TRUE(assign(Eigen::MatrixXd(0, 3)).empty());
  EXPECT_EQ(assign(Eigen::MatrixXd(2, 0)), (std::vector<std::optional<int>>(2)));
}

TEST(Assignment, OfHundredsIsFast) {
  base::Random random(2, "assignment_test");
  Eigen::MatrixXd costs(300, 400);
  for (double& cost : costs.reshaped()) cost = random.uniform();
  const auto columnOf = assign(costs);
  const auto worth = worthOf(costs, columnOf);
  EXPECT_EQ(worth.first, 300);
  EXPECT_LT(worth.second, 300 * 0.01);
}

}  // namespace
}  // namespace prodomos::geometry
