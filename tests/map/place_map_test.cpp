// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/place_map.hpp"

#include "support/sample_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace prodomos::map {
namespace {

using base::SubMapId;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kResolution = 0.25;

// A corridor with a room to either side, seen through doors that stand open: cells of 0.25 m, the corridor's middle is
// the origin.
const std::vector<std::string_view> kThreeRooms = {
    "####################",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "########....########",  // a doorway 1 m wide at x = 0, y = 1.125
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "########....########",  // … and at y = -0.625
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "#..................#",  //
    "####################",
};
constexpr geometry::CellIndex kLowerLeft{-10, -8};

class World {
 public:
  World() { change_.sessions.push_back({.id = {1}, .log = "log", .config = ""}); }

  void addSubMap(int id, const geometry::Pose2& T_map_submap, const std::vector<std::string_view>& lines,
                 geometry::CellIndex lowerLeft, std::optional<int> floor = std::nullopt) {
    Node node;
    node.id = {id};
    node.session = {1};
    node.floor = floor;
    node.T_map_submap = node.T_travel_submap = geometry::toPose3(T_map_submap);
    change_.nodes.push_back(node);
    grids_.push_back(std::make_unique<OccupancyGrid>(test::gridFromText(lines, kResolution, lowerLeft)));
    change_.layers.emplace_back(node.id, grids_.back().get());
  }
  void addFloor(int number) { change_.floors.push_back({number, 3.0 * number}); }
  void addDoor(int submap, const geometry::Pose2& T_submap_door, double width, double confidence = 0.9) {
    Entity door;
    door.id = {static_cast<std::int64_t>(change_.entities.size())};
    door.submap = {submap};
    door.T_submap_entity = geometry::toPose3(T_submap_door);
    door.confidence = confidence;
    door.attributes = Door{.width = width, .hasLeaf = false};
    change_.entities.push_back(door);
  }
  void addEdge(int from, int to, EdgeKind kind) {
    Edge edge;
    edge.id = {static_cast<std::int64_t>(change_.edges.size())};
    edge.from = {from};
    edge.to = {to};
    edge.kind = kind;
    change_.edges.push_back(edge);
  }
  PlaceMap places() {
    auto store = MapStore::inMemory();
    store.commit(change_);
    return PlaceMap(store.view());
  }

 private:
  MapChange change_;
  std::vector<std::unique_ptr<OccupancyGrid>> grids_;
};

World threeRooms() {
  World world;
  world.addSubMap(1, {}, kThreeRooms, kLowerLeft);
  world.addDoor(1, {0.0, 1.125, std::numbers::pi / 2.0}, 1.0);
  world.addDoor(1, {0.0, -0.625, -std::numbers::pi / 2.0}, 1.0);
  return world;
}

TEST(PlaceMap, KnowsThreePlacesInOneSubMapThatSeesThreeRoomsThroughOpenDoors) {
  const auto map = threeRooms().places();
  ASSERT_THAT(map.places(), SizeIs(3));
  const auto corridor = map.placeAt({0.1, 0.1}, {});
  const auto above = map.placeAt({0.1, 2.0}, {});
  const auto below = map.placeAt({0.1, -1.5}, {});
  EXPECT_EQ(corridor, 0) << "where the sub-map began";
  ASSERT_TRUE(above && below);
  EXPECT_NE(*above, *below);
  EXPECT_NE(*above, 0);
  EXPECT_NE(*below, 0);
  EXPECT_EQ(map.placeAt({-2.0, 2.0}, {}), above);
  EXPECT_THAT(map.places()[0].submaps, ElementsAre(SubMapId{1}));
  EXPECT_THAT(map.places()[1].submaps, IsEmpty()) << "nobody has been there";
  EXPECT_NEAR(map.places()[0].area, 18 * 6 * kResolution * kResolution, 0.5);
}

TEST(PlaceMap, IsOnePlaceWithoutDoors) {
  World world;
  world.addSubMap(1, {}, kThreeRooms, kLowerLeft);
  world.addDoor(1, {0.0, 1.125, std::numbers::pi / 2.0}, 1.0, 0.0);  // given up
  const auto map = world.places();
  EXPECT_THAT(map.places(), SizeIs(1));
  EXPECT_EQ(map.placeAt({0.1, 2.0}, {}), 0);
}

TEST(PlaceMap, HoldsWhereverTheSubMapLies) {
  const geometry::Pose2 T_map_submap{12.3, -4.7, 0.0};
  World world;
  world.addSubMap(1, T_map_submap, kThreeRooms, kLowerLeft);
  world.addDoor(1, {0.0, 1.125, std::numbers::pi / 2.0}, 1.0);
  world.addDoor(1, {0.0, -0.625, -std::numbers::pi / 2.0}, 1.0);
  const auto map = world.places();
  EXPECT_THAT(map.places(), SizeIs(3));
  EXPECT_EQ(map.placeAt(T_map_submap * Eigen::Vector2d(0.1, 0.1), {}), 0);
}

TEST(PlaceMap, GivesSubMapsTheirNumbersOfTheGraph) {
  auto world = threeRooms();
  world.addSubMap(2, {0.0, 2.0, 0.0}, {"..", ".."}, {-1, -1});
  world.addEdge(1, 2, EdgeKind::kDoor);
  const auto map = world.places();
  ASSERT_THAT(map.places(), SizeIs(3));
  EXPECT_EQ(map.placeAt({0.1, 0.1}, {}), 0);
  EXPECT_EQ(map.placeAt({-2.0, 2.0}, {}), 1);
  EXPECT_THAT(map.places()[1].submaps, ElementsAre(SubMapId{2}));
}

TEST(PlaceMap, KnowsFloorsApart) {
  World world;
  world.addFloor(0);
  world.addFloor(1);
  world.addSubMap(1, {}, {"....", "....", "...."}, {-2, -1}, 0);
  world.addSubMap(2, {}, {"....", "....", "...."}, {-2, -1}, 1);
  world.addEdge(1, 2, EdgeKind::kStairs);
  const auto map = world.places();
  EXPECT_EQ(map.placeAt({0.1, 0.1}, 0), 0);
  EXPECT_EQ(map.placeAt({0.1, 0.1}, 1), 1);
}

TEST(PlaceMap, TellsNothingOfWallsAndOfTheUnknown) {
  const auto map = threeRooms().places();
  EXPECT_EQ(map.placeAt({2.0, 1.125}, {}), std::nullopt);
  EXPECT_EQ(map.placeAt({50.0, 0.0}, {}), std::nullopt);
  EXPECT_EQ(map.placeAt({std::numeric_limits<double>::quiet_NaN(), 0.0}, {}), std::nullopt);
  EXPECT_EQ(map.placeAt({1e300, 0.0}, {}), std::nullopt);
  const auto nothing = World().places();
  EXPECT_THAT(nothing.places(), IsEmpty());
  EXPECT_EQ(nothing.placeAt({0.0, 0.0}, {}), std::nullopt);
}

TEST(PlaceMap, LeavesOutWhatIsTooSmallForAPlace) {
  World world;
  world.addSubMap(1, {}, {"#########", "#......#.", "#......#.", "#......#.", "#########"}, {-4, -2});
  EXPECT_THAT(world.places().places(), SizeIs(1));
}

}  // namespace
}  // namespace prodomos::map
