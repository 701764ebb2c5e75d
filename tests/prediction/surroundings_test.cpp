// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/surroundings.hpp"

#include "prodomos/base/random.hpp"

#include "prediction/space_behind.hpp"
#include "support/sample_map.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::prediction {
namespace {

using geometry::CellIndex;
using map::CellState;

PlacedGrid placed(const std::vector<std::string_view>& lines, const geometry::Pose3& T_map_submap,
                  CellIndex lowerLeft = {}, double resolution = 0.1) {
  return {{1}, T_map_submap, std::make_shared<map::OccupancyGrid>(test::gridFromText(lines, resolution, lowerLeft))};
}

TEST(Surroundings, OfNothingAreUnknown) {
  const Surroundings around;
  EXPECT_EQ(around.state(CellIndex{0, 0}), CellState::kUnknown);
  EXPECT_EQ(around.state(Eigen::Vector2d(500.0, 0.0)), CellState::kUnknown);
}

TEST(Surroundings, AreToldInTheFrameOfTheEntity) {
  // The door stands at (2, 1) in the map and looks up.
  const geometry::Pose3 T_map_here = geometry::toPose3({2.0, 1.0, std::numbers::pi / 2.0});
  const auto grid = placed({"#.", ".."}, geometry::toPose3({1.0, 1.0, 0.0}), {0, 0}, 1.0);
  const Surroundings around(T_map_here, {{grid}});
  EXPECT_EQ(around.state(Eigen::Vector2d(1.5, 0.5)), CellState::kOccupied);  // (1.5, 2.5) in the map
  EXPECT_EQ(around.state(Eigen::Vector2d(0.5, 0.5)), CellState::kFree);
  EXPECT_EQ(around.state(Eigen::Vector2d(-0.5, 0.5)), CellState::kUnknown);
}

TEST(Surroundings, KeepWallsThatAreThinnerThanACell) {
  const auto grid = placed({"....", ".###", "....", "...."}, geometry::Pose3::Identity(), {0, 0}, 0.05);
  const Surroundings around(geometry::Pose3::Identity(), {{grid}});
  EXPECT_EQ(around.state(CellIndex{0, 1}), CellState::kOccupied);
  EXPECT_EQ(around.state(CellIndex{1, 1}), CellState::kOccupied);
  EXPECT_EQ(around.state(CellIndex{0, 0}), CellState::kFree);
}

TEST(Surroundings, LeaveOutOtherFloors) {
  const auto grid = placed({"..", ".."}, geometry::toPose3({0, 0, 0}, 3.0));
  EXPECT_EQ(Surroundings(geometry::Pose3::Identity(), {{grid}}).state(CellIndex{0, 0}), CellState::kUnknown);
  EXPECT_EQ(Surroundings(geometry::toPose3({0, 0, 0}, 2.9), {{grid}}).state(CellIndex{0, 0}), CellState::kFree);
}

TEST(Surroundings, TakeTheSumOfTheEvidence) {
  const auto wall = placed({"#"}, geometry::Pose3::Identity());
  const auto free = placed({"."}, geometry::Pose3::Identity());
  const Surroundings around(geometry::Pose3::Identity(), {{wall, free, wall}});
  EXPECT_EQ(around.state(CellIndex{0, 0}), CellState::kOccupied);
}

TEST(Surroundings, TurnWithTheWorld) {
  base::Random random(4, "surroundings");
  const auto grid =
      placed({"######", "#....#", "#.. .#", "#....#", "######"}, geometry::toPose3({1, 2, 0.3}), {0, 0}, 0.5);
  for (int trial = 0; trial < 5; ++trial) {
    const auto T_map_here = geometry::toPose3({random.uniform(0, 3), random.uniform(0, 3), random.uniform(-3, 3)});
    const auto T_turned_map = geometry::toPose3({random.uniform(-9, 9), 4, random.uniform(-3, 3)}, 1.0);
    auto turned = grid;
    turned.T_map_submap = T_turned_map * grid.T_map_submap;
    const Surroundings before(T_map_here, {{grid}});
    const Surroundings after(T_turned_map * T_map_here, {{turned}});
    int differing = 0;
    for (int y = -40; y < 40; ++y) {
      for (int x = -40; x < 40; ++x) differing += before.state(CellIndex{x, y}) != after.state(CellIndex{x, y}) ? 1 : 0;
    }
    EXPECT_LE(differing, 2);  // centres that lie on the border of two cells
  }
}

/// A door at the origin, `behind` what is known ahead of it: a column is 0.1 m ahead, the middle line goes through it.
Surroundings behindADoor(const std::vector<std::string_view>& behind) {
  Surroundings around;
  for (std::size_t line = 0; line < behind.size(); ++line) {
    for (std::size_t column = 0; column < behind[line].size(); ++column) {
      const char drawn = behind[line][column];
      const auto state = drawn == '#' ? CellState::kOccupied : drawn == '.' ? CellState::kFree : CellState::kUnknown;
      around.set({static_cast<int>(column), static_cast<int>(behind.size() / 2) - 1 - static_cast<int>(line)}, state);
    }
  }
  return around;
}

TEST(SpaceBehind, AClosedDoorIsUnseenAsFarAsOneLooks) {
  const auto space = spaceBehind(Surroundings(), 0.9);
  EXPECT_EQ(space.seen, 0.0);
  EXPECT_GT(space.unseen, 35.0);
  EXPECT_NE(space.cells.at({20, 0}), 0);
  EXPECT_EQ(space.cells.at({-1, 0}), 0);
}

TEST(SpaceBehind, EndsAtKnownWalls) {
  const auto space = spaceBehind(behindADoor({
                                     "  ##########",
                                     "           #",
                                     "      .....#",
                                     "      .....#",
                                     "           #",
                                     "  ##########",
                                 }),
                                 0.4);
  EXPECT_NEAR(space.seen, 0.10, 1e-9);
  EXPECT_NEAR(space.unseen, 2 * 0.10 + 2 * 0.05 - 0.02, 0.05);
}

TEST(SpaceBehind, EndsAtRoomsThatAreTaken) {
  Surroundings around;
  around.taken_here = {{{1.0, -9.0}, {9.0, -9.0}, {9.0, 9.0}, {1.0, 9.0}}};
  const auto space = spaceBehind(around, 0.9);
  EXPECT_LT(space.unseen, 8.1);
  EXPECT_EQ(space.cells.at({20, 0}), 0);
}

TEST(SpaceBehind, ALeafThatStandsOpenIsInNobodysWay) {
  Surroundings around;
  for (int x = 1; x < 10; ++x) around.set({x, 4}, CellState::kOccupied);
  EXPECT_GT(spaceBehind(around, 0.9).unseen, 30.0);
}

}  // namespace
}  // namespace prodomos::prediction
