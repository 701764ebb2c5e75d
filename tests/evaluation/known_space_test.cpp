// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/known_space.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::freeRectangle;
using test::kQuarter;

std::shared_ptr<const map::OccupancyGrid> drawn(const std::vector<std::string_view>& lines) {
  return std::make_shared<map::OccupancyGrid>(test::gridFromText(lines, kCell));
}

TEST(KnownSpace, IsWhatAGridHasSeen) {
  const KnownSpace known({{0,
                           at(0),
                           {},
                           drawn({"# .",  //
                                  "..."})}});
  EXPECT_TRUE(known.isKnown(0, {0, 1}));
  EXPECT_FALSE(known.isFree(0, {0, 1}));
  EXPECT_FALSE(known.isKnown(0, {1, 1}));
  EXPECT_TRUE(known.isFree(0, {2, 1}));
  EXPECT_TRUE(known.isFree(0, {1, 0}));
  EXPECT_FALSE(known.isKnown(0, {3, 0}));
  EXPECT_FALSE(known.isKnown(1, {0, 0}));
  EXPECT_NEAR(known.freeArea(), 4 * kCell * kCell, 1e-12);
}

TEST(KnownSpace, LiesWhereTheGridLies) {
  // Turned left about the origin: what lay ahead lies to the left.
  const KnownSpace known({{0, at(0), {0, 0, kQuarter}, drawn({"#..."})}});
  EXPECT_TRUE(known.isKnown(0, {-1, 0}));
  EXPECT_FALSE(known.isFree(0, {-1, 0}));
  EXPECT_TRUE(known.isFree(0, {-1, 3}));
  EXPECT_FALSE(known.isKnown(0, {1, 0}));
}

TEST(KnownSpace, IsKnownSinceTheFirstSubMapThatKnowsItBegan) {
  const KnownSpace known({freeRectangle(0, 0, 1, 1, at(20)), freeRectangle(0, 0, 0.5, 1, at(10))});
  EXPECT_FALSE(known.isKnown(0, {5, 5}, at(9)));
  EXPECT_TRUE(known.isKnown(0, {5, 5}, at(10)));
  EXPECT_FALSE(known.isKnown(0, {15, 5}, at(10)));
  EXPECT_TRUE(known.isKnown(0, {15, 5}, at(20)));
  EXPECT_NEAR(known.freeArea(), 1.0, 1e-9);
}

TEST(KnownSpace, IsFreeByAllGridsTogether) {
  const auto wall = drawn({"#"});
  const auto floor = drawn({"."});
  EXPECT_TRUE(KnownSpace({{0, at(0), {}, wall}, {0, at(1), {}, floor}, {0, at(2), {}, floor}, {0, at(3), {}, floor}})
                  .isFree(0, {0, 0}));
  EXPECT_FALSE(KnownSpace({{0, at(0), {}, wall}, {0, at(1), {}, wall}, {0, at(2), {}, floor}}).isFree(0, {0, 0}));
}

TEST(KnownSpace, KeepsStoreysApart) {
  const KnownSpace known({freeRectangle(0, 0, 1, 1), freeRectangle(0, 0, 2, 1, at(0), 1)});
  EXPECT_FALSE(known.isKnown(0, {30, 5}));
  EXPECT_TRUE(known.isKnown(1, {30, 5}));
  EXPECT_NEAR(known.freeArea(), 3.0, 1e-9);
}

TEST(KnownSpace, HasNoHolesWhereAGridIsAskew) {
  auto grid = freeRectangle(0, 0, 3, 2);
  grid.T_world_grid = {1.234, -0.567, 0.3};
  EXPECT_NEAR(KnownSpace({grid}).freeArea(), 6.0, 0.1);
}

TEST(KnownSpace, OfNoGridIsEmpty) {
  EXPECT_FALSE(KnownSpace().isKnown(0, {0, 0}));
  EXPECT_EQ(KnownSpace({{0, at(0), {}, drawn({" "})}}).freeArea(), 0.0);
}

}  // namespace
}  // namespace prodomos::evaluation
