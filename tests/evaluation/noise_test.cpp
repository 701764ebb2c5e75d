// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/noise.hpp"

#include "prodomos/map/point_layer.hpp"

#include "evaluation/flat.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace prodomos::evaluation {
namespace {

using test::FlatMap;
using test::flat::at;
using test::flat::kFloor;

constexpr double kLow = 0.15;
constexpr double kHigh = 1.8;

TruePerson walker(const std::vector<Eigen::Vector2d>& way) {
  TruePerson person{.id = "ada"};
  for (std::size_t i = 0; i < way.size(); ++i) {
    person.states.push_back(
        {.time = at(static_cast<double>(i)), .position = {way[i].x(), way[i].y(), kFloor}, .pixels = 500});
  }
  return person;
}

/// Someone walked from the one corner of room a to the other; a chair was pushed from (1, 1) to (2, 1); a table stands
/// at (3, 3); the door, now a real one, was opened and closed.
Truth livedIn() {
  auto truth = test::flat::truth();
  truth.people = {walker({{1, 3.2}, {1.6, 3.2}, {2.2, 3.2}})};
  const auto place = [](double x, double y, double height) {
    return geometry::toPose3({x, y, 0.0}, kFloor + 0.5 * height);
  };
  truth.objects = {{.id = "chair",
                    .storey = 1,
                    .mobility = map::Mobility::kQuasiStatic,
                    .size = {0.5, 0.5, 0.9},
                    .poses = {{at(0), place(1, 1, 0.9)}, {at(5), place(2, 1, 0.9)}}},
                   {.id = "table", .storey = 1, .size = {0.8, 0.8, 0.75}, .poses = {{at(0), place(3.4, 3.4, 0.75)}}}};
  truth.doors[0].leaves = 1;
  truth.doors[0].hingeSide = map::HingeSide::kLeft;
  truth.doors[0].states = {{at(0), 0.0, map::DoorState::kClosed},
                           {at(3), 1.5, map::DoorState::kOpen},
                           {at(6), 0.0, map::DoorState::kClosed}};
  return truth;
}

// --- what truth has at a spot

class LivedInSpace : public testing::Test {
 protected:
  Matter at(double x, double y) const { return space_.at(1, {x, y}, kLow, kHigh); }

  const TrueSpace space_{livedIn(), 0.1};
};

TEST_F(LivedInSpace, HasWallsAroundItsRooms) {
  EXPECT_EQ(at(-1.0, 2.0), Matter::kStructure);
  EXPECT_EQ(at(0.05, 2.0), Matter::kStructure);
  EXPECT_EQ(at(4.1, 0.5), Matter::kStructure);
  EXPECT_EQ(at(0.2, 2.0), Matter::kFree);
  EXPECT_EQ(at(6.0, 2.0), Matter::kFree);
}

TEST_F(LivedInSpace, KnowsWhereThePersonWasAndWhereItEnded) {
  EXPECT_EQ(at(1.0, 3.2), Matter::kPerson);
  EXPECT_EQ(at(1.5, 3.2), Matter::kPerson);
  EXPECT_EQ(at(2.2, 3.2), Matter::kLastPerson);
  EXPECT_EQ(at(2.7, 3.2), Matter::kLastPerson);
}

TEST_F(LivedInSpace, KnowsWhereThingsWereAndWhereTheyAre) {
  EXPECT_EQ(at(1.0, 1.0), Matter::kMovedThing);
  EXPECT_EQ(at(2.0, 1.0), Matter::kStructure);
  EXPECT_EQ(at(3.4, 3.4), Matter::kStructure);
  EXPECT_EQ(at(3.05, 2.95), Matter::kStructure);  // within the tolerance
  EXPECT_EQ(at(3.05, 2.85), Matter::kFree);
}

TEST_F(LivedInSpace, KnowsWhereTheLeafTurned) {
  EXPECT_EQ(at(3.6, 2.4), Matter::kDoorLeaf);
  EXPECT_EQ(at(4.6, 2.4), Matter::kDoorLeaf);
  EXPECT_EQ(at(3.6, 1.2), Matter::kFree);
}

TEST_F(LivedInSpace, HasHeights) {
  EXPECT_EQ(space_.at(1, {3.4, 3.4}, 0.5, 0.5), Matter::kStructure);
  EXPECT_EQ(space_.at(1, {3.4, 3.4}, 1.2, 1.2), Matter::kFree);         // above the table
  EXPECT_EQ(space_.at(1, {6.0, 2.0}, 0.05, 0.05), Matter::kStructure);  // the floor
  EXPECT_EQ(space_.at(1, {6.0, 2.0}, 2.75, 2.75), Matter::kStructure);  // the ceiling
  EXPECT_EQ(space_.at(1, {1.0, 3.2}, 2.4, 2.4), Matter::kFree);         // over the person's head
  EXPECT_EQ(space_.at(0, {6.0, 2.0}, 1.0, 1.0), Matter::kStructure);    // no room there
  EXPECT_EQ(space_.at(7, {6.0, 2.0}, 1.0, 1.0), Matter::kStructure);
}

TEST(TrueSpace, LeavesThePersonOfAnotherStoreyThere) {
  auto truth = test::flat::truth();
  truth.people = {walker({{1, 3}, {2, 3}})};
  for (auto& state : truth.people[0].states) state.position.z() -= 3.0;
  EXPECT_EQ(TrueSpace(truth, 0.1).at(1, {1, 3}, kLow, kHigh), Matter::kFree);
}

TEST(TrueSpace, TakesThePlaceWhereThePersonWasLastSeenForItsLast) {
  auto truth = test::flat::truth();
  truth.people = {walker({{1, 3}, {2.5, 3}})};
  truth.people[0].states[1].pixels = 0;
  const TrueSpace space(truth, 0.1);
  EXPECT_EQ(space.at(1, {1, 3}, kLow, kHigh), Matter::kLastPerson);
  EXPECT_EQ(space.at(1, {2.5, 3}, kLow, kHigh), Matter::kPerson);
}

// --- maps

/// A grid in the frame of the sub-map, a cell occupied where the function of the world says so.
map::OccupancyGrid gridOf(const geometry::Pose3& T_submap_world, const std::function<char(double x, double y)>& drawn) {
  map::OccupancyGridConfig config;
  config.resolution = 0.1;
  map::OccupancyGrid grid(config);
  const auto T_world_submap = T_submap_world.inverse();
  for (int y = -60; y < 60; ++y) {
    for (int x = -60; x < 100; ++x) {
      const Eigen::Vector2d centre(geometry::cellCentre(x, 0.1), geometry::cellCentre(y, 0.1));
      const Eigen::Vector3d in_world = T_world_submap * Eigen::Vector3d(centre.x(), centre.y(), 0.0);
      const char cell = drawn(in_world.x(), in_world.y());
      if (cell == ' ') continue;
      const map::OccupancyGrid::Beam beam{.end = centre, .hit = cell == '#'};
      grid.insert(centre, {&beam, 1});
    }
  }
  return grid;
}

/// The flat as it is: walls, free floor, nothing more.
char bare(double x, double y) {
  const bool inA = x > 0.0 && x < 4.0 && y > 0.0 && y < 4.0;
  const bool inB = x > 4.2 && x < 8.2 && y > 0.0 && y < 4.0;
  const bool near = x > -0.15 && x < 8.35 && y > -0.15 && y < 4.15;
  return inA || inB ? '.' : near ? '#' : ' ';
}

TEST(Noise, OfAMapOfTheBareFlatIsNone) {
  FlatMap map;
  const auto grid = gridOf(map.T_submap_world(1), bare);
  map.add(1, grid);
  const auto score = scoreNoise(map.view(), livedIn());
  ASSERT_TRUE(score.cells.has_value());
  EXPECT_EQ(score.cells->noise(), 0U);
  EXPECT_EQ(score.cells->others, 0U);
  EXPECT_GT(score.cells->occupied, 200U);
  EXPECT_EQ(score.noiseShare(), 0.0);
  EXPECT_GT(score.walls, 200U);
  EXPECT_GT(score.wallsKeptShare().value(), 0.99);
  EXPECT_TRUE(score.hasPersons);
  EXPECT_TRUE(score.hasMovedThings);
  EXPECT_TRUE(score.hasTurnedLeaves);
  EXPECT_FALSE(score.points.has_value());
}

/// A few cells about each of these spots are occupied.
char littered(double x, double y) {
  for (const auto& [spotX, spotY] : {std::pair{1.0, 3.2}, {2.2, 3.2}, {1.0, 1.0}, {3.6, 2.4}, {6.0, 1.0}}) {
    if (std::abs(x - spotX) < 0.12 && std::abs(y - spotY) < 0.12) return '#';
  }
  return bare(x, y);
}

TEST(Noise, IsCountedByWhatHasLeftIt) {
  FlatMap map(geometry::Pose3::Identity());
  const auto grid = gridOf(map.T_submap_world(1), littered);
  map.add(1, grid);
  const auto score = scoreNoise(map.view(), livedIn());
  for (const auto count : {score.cells->persons, score.cells->lastPersons, score.cells->movedThings,
                           score.cells->doorLeaves, score.cells->others}) {
    EXPECT_GE(count, 4U);
    EXPECT_LE(count, 9U);
  }
  EXPECT_EQ(score.cells->noise(), score.cells->persons + score.cells->movedThings + score.cells->doorLeaves);
  EXPECT_NEAR(score.noiseShare().value(),
              static_cast<double>(score.cells->noise()) / static_cast<double>(score.freeFloor), 1e-12);
}

TEST(Noise, IsTheSameWhereverTheMapLiesAndHoweverItDrifts) {
  FlatMap still(geometry::Pose3::Identity());
  FlatMap moved;
  moved.driftBy(geometry::fromYawPitchRoll({0.7, -0.4, 0.1}, 0.2, 0.0, 0.0));
  std::vector<map::OccupancyGrid> grids;
  grids.reserve(2);
  std::vector<NoiseScore> scores;
  for (auto* map : {&still, &moved}) {
    grids.push_back(gridOf(map->T_submap_world(2), littered));
    map->add(2, grids.back());
    scores.push_back(scoreNoise(map->view(), livedIn()));
  }
  EXPECT_EQ(scores[0].cells->occupied, scores[1].cells->occupied);
  EXPECT_EQ(scores[0].cells->noise(), scores[1].cells->noise());
  EXPECT_EQ(scores[0].freeFloor, scores[1].freeFloor);
  EXPECT_EQ(scores[0].wallsKept, scores[1].wallsKept);
}

TEST(Noise, WhoFiltersWallsTooKeepsFewOfThem) {
  FlatMap map;
  const auto grid = gridOf(map.T_submap_world(1), [](double x, double y) { return x < -0.01 ? ' ' : bare(x, y); });
  map.add(1, grid);
  const auto score = scoreNoise(map.view(), livedIn());
  EXPECT_LT(score.wallsKeptShare().value(), 0.9);
  EXPECT_GT(score.wallsKeptShare().value(), 0.7);
}

TEST(Noise, OfPointsIsCountedByVoxels) {
  FlatMap map;
  map::PointLayer points;
  const auto add = [&](double x, double y, double height) {
    points.insert((map.T_submap_world(1) * Eigen::Vector3d(x, y, kFloor + height)).cast<float>(), {});
  };
  add(1.0, 3.2, 1.2);  // the person
  add(1.0, 3.4, 1.2);
  add(1.0, 3.2, 2.4);   // above it
  add(1.0, 1.0, 0.5);   // the chair
  add(0.0, 2.0, 1.0);   // the wall
  add(6.0, 2.0, 0.01);  // the floor
  map.add(1, points);
  const auto score = scoreNoise(map.view(), livedIn());
  ASSERT_TRUE(score.points.has_value());
  EXPECT_EQ(score.points->occupied, 6U);
  EXPECT_EQ(score.points->persons, 2U);
  EXPECT_EQ(score.points->movedThings, 1U);
  EXPECT_EQ(score.points->others, 1U);
  EXPECT_FALSE(score.cells.has_value());
  EXPECT_FALSE(score.noiseShare().has_value());
  EXPECT_FALSE(score.wallsKeptShare().has_value());
}

TEST(Noise, WhereNothingMovedCannotBeMeasured) {
  FlatMap map;
  const auto score = scoreNoise(map.view(), test::flat::truth());
  EXPECT_FALSE(score.hasPersons);
  EXPECT_FALSE(score.hasMovedThings);
  EXPECT_FALSE(score.hasTurnedLeaves);
  EXPECT_FALSE(score.cells.has_value());
}

TEST(Noise, OfSeveralMapsIsAddedUp) {
  FlatMap map;
  const auto grid = gridOf(map.T_submap_world(1), littered);
  map.add(1, grid);
  const auto one = scoreNoise(map.view(), livedIn());
  NoiseScore sum;
  sum += one;
  sum += one;
  EXPECT_EQ(sum.cells->noise(), 2 * one.cells->noise());
  EXPECT_EQ(sum.noiseShare(), one.noiseShare());
  EXPECT_TRUE(sum.hasPersons);
}

}  // namespace
}  // namespace prodomos::evaluation
