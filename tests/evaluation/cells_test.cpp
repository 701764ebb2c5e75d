// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/cells.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::evaluation {
namespace {

TEST(Cells, OfABoxBehindADoorLieAheadOfIt) {
  // The door looks along +y: ahead is up, left is -x.
  const auto box = boxBehind({2.0, 1.0, std::numbers::pi / 2.0}, 1.0, -0.5, 0.1, 3.0);
  const auto cells = cellsIn(box);
  EXPECT_EQ(cells.size(), 30U * 58U);
  EXPECT_TRUE(centreOf(cells.front()).isApprox(Eigen::Vector2d(1.025, 1.125)));
  EXPECT_TRUE(centreOf(cells.back()).isApprox(Eigen::Vector2d(2.475, 3.975)));
}

}  // namespace
}  // namespace prodomos::evaluation
