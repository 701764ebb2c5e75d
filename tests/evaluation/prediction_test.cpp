// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/prediction.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/map/map_store.hpp"

#include "evaluation/small_building.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace prodomos::evaluation {
namespace {

using test::at;
using test::kQuarter;

/// A map of the small building: a robot walks the corridor once, in two sub-maps, and sees both doors and the stairs.
/// `T_map_world` is where the map's frame lies; the second sub-map has drifted by `drift` from the first.
class SmallMap {
 public:
  explicit SmallMap(const geometry::Pose3& T_map_world = geometry::Pose3::Identity(),
                    const geometry::Pose3& drift = geometry::Pose3::Identity(), bool turnedRound = false)
      : T_map_world_(T_map_world), drift_(drift) {
    change_.sessions.push_back({.id = {1}, .log = "small.rawlog", .state = map::SessionState::kComplete});
    change_.floors = {{.number = 0, .height = 0.0}};
    addSubMap(1, {1, 1, 0}, 0.0, 10.0);
    addSubMap(2, {5, 1, 0}, 10.0, 20.0);
    addEntity(1, 1, {2, 2.1, kQuarter}, 1.0, map::Door{.width = 0.9, .height = 2.0, .state = map::DoorState::kClosed});
    addEntity(2, 2, {7, 2.1, kQuarter}, 1.0, map::Door{.width = 0.9, .hasLeaf = false, .state = map::DoorState::kOpen});
    addEntity(3, 1, {-2.75, 1, std::numbers::pi}, 1.5,
              map::Staircase{.height = 3.0, .stepWidth = 1.2, .stepHeight = 0.2, .stepDepth = 0.3});
    addPrediction(1, {2, 2.1, kQuarter}, 0.0, test::rectangle(0.1, -2, 4.1, 2));
    addPrediction(2, {7, 2.1, kQuarter}, 0.0, test::rectangle(0.1, -2, 2.1, 2));
    addPrediction(3, {-5, 1, std::numbers::pi}, 3.0, test::rectangle(0, -1, 2, 1));
    if (turnedRound) {
      std::ranges::reverse(change_.entities);
      std::ranges::reverse(change_.predictions);
      std::ranges::reverse(change_.nodes);
    }
  }

  map::MapChange& change() { return change_; }
  map::MapView view() {
    store_.commit(change_);
    return store_.view();
  }

 private:
  geometry::Pose3 mapOf(int submap) const { return submap == 1 ? T_map_world_ : T_map_world_ * drift_; }
  geometry::Pose3 originOf(int submap) const {
    return geometry::toPose3(submap == 1 ? geometry::Pose2{1, 1, 0} : geometry::Pose2{5, 1, 0});
  }

  void addSubMap(int id, const geometry::Pose2& T_world_submap, double begin, double end) {
    const auto T_map_submap = mapOf(id) * geometry::toPose3(T_world_submap);
    change_.nodes.push_back({.id = {id},
                             .session = {1},
                             .floor = 0,
                             .place = std::nullopt,
                             .T_map_submap = T_map_submap,
                             .T_travel_submap = T_map_submap,
                             .begin = at(begin),
                             .end = at(end)});
    for (int i = 0; i <= 8; ++i) {
      const auto T_world_body = geometry::toPose3({T_world_submap.x + 0.5 * i, T_world_submap.y + 0.05 * i, 0.02 * i});
      change_.trajectory.push_back({.session = {1},
                                    .time = at(begin + i),
                                    .submap = {id},
                                    .T_travel_body = mapOf(id) * T_world_body,
                                    .T_map_body = {}});
    }
    auto grid = std::make_unique<map::OccupancyGrid>(*test::freeRectangle(0, 0, 1, 1).grid);
    const auto corridor = test::rectangle(-T_world_submap.x, -T_world_submap.y, 10 - T_world_submap.x, 1);
    for (const auto cell : cellsIn(corridor)) {
      const map::OccupancyGrid::Beam beam{.end = centreOf(cell), .hit = false};
      grid->insert(beam.end, {&beam, 1});
    }
    change_.layers.emplace_back(base::SubMapId{id}, grid.get());
    grids_.push_back(std::move(grid));
  }

  void addEntity(int id, int submap, const geometry::Pose2& T_world_entity, double z,
                 const map::EntityAttributes& attributes) {
    change_.entities.push_back({.id = {id},
                                .submap = {submap},
                                .T_submap_entity = originOf(submap).inverse() * geometry::toPose3(T_world_entity, z),
                                .confidence = 0.9,
                                .observations = 5,
                                .firstSeen = at(1),
                                .lastSeen = at(9),
                                .attributes = attributes,
                                .points_in_submap = {}});
  }

  /// Of the entity of that number, with a predicted node 10 + id.
  void addPrediction(int id, const geometry::Pose2& T_world_node, double z, const Polygon& area) {
    const int submap = id == 2 ? 2 : 1;
    const auto T_map_node = mapOf(submap) * geometry::toPose3(T_world_node, z);
    change_.nodes.push_back({.id = {10 + id},
                             .session = {1},
                             .kind = map::SubMapKind::kPredicted,
                             .floor = std::nullopt,
                             .place = std::nullopt,
                             .T_map_submap = T_map_node,
                             .T_travel_submap = T_map_node});
    change_.predictions.push_back({.id = {id},
                                   .cause = {id},
                                   .submap = {submap},
                                   .node = {10 + id},
                                   .T_submap_node = originOf(submap).inverse() * geometry::toPose3(T_world_node, z),
                                   .probability = 0.9,
                                   .expectedArea = 10,
                                   .areas = {{.threshold = 0.5, .outline_in_node = area}},
                                   .room_in_node = {},
                                   .made = at(5),
                                   .settled = std::nullopt,
                                   .mergedInto = std::nullopt});
  }

  geometry::Pose3 T_map_world_;
  geometry::Pose3 drift_;
  map::MapChange change_;
  std::vector<std::unique_ptr<map::OccupancyGrid>> grids_;
  map::MapStore store_ = map::MapStore::inMemory();
};

Truth truthOfSmallMap() {
  auto truth = test::smallBuilding();
  const auto walk = [&truth](double x, double begin) {
    for (int i = 0; i <= 8; ++i) {
      truth.trajectory.push_back({at(begin + i), geometry::toPose3({x + 0.5 * i, 1 + 0.05 * i, 0.02 * i})});
    }
  };
  walk(1, 0);
  walk(5, 10);
  return truth;
}

/// All that is compared of two scores.
std::vector<std::optional<double>> figuresOf(const PredictionScore& score) {
  return {score.doors.counts.all.recall(),  score.doors.counts.precision(),  score.doorways.counts.all.recall(),
          score.stairs.counts.all.recall(), score.nodes.precision(),         score.nodes.behindVisible.recall(),
          score.nodes.adjacent.recall(),    calibrationOf(score.bets)->brier};
}

/// Those that are measured on cells of the world, which lie elsewhere on a thing that is moved.
std::vector<double> figuresOfCells(const PredictionScore& score) {
  const auto& level = score.freeSpace.levels[0];
  return {*level.overall().precision(),
          *level.byMobility[0].precision(),
          *level.byMobility[1].precision(),
          *score.freeSpace.areaGainPercent(0) / 100,
          *score.rooms.all(),
          *score.rooms.clippedBox(),
          *score.rooms.oracleBox()};
}

void expectAlike(const PredictionScore& a, const PredictionScore& b, double tolerance) {
  EXPECT_EQ(figuresOf(a), figuresOf(b));
  const auto cells = figuresOfCells(a);
  const auto others = figuresOfCells(b);
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_NEAR(cells[i], others[i], tolerance) << i;
  EXPECT_NEAR(a.doors.centre.at(0), b.doors.centre.at(0), 1e-6);
  EXPECT_NEAR(a.stairs.foot.at(0), b.stairs.foot.at(0), 1e-6);
}

TEST(PredictionScore, OfAPerfectMapIsPerfect) {
  const auto score = scorePrediction(SmallMap().view(), truthOfSmallMap());
  EXPECT_EQ(score.doors.counts.all.recall(), 1.0);
  EXPECT_EQ(score.doors.counts.precision(), 1.0);
  EXPECT_FALSE(score.doors.counts.images);
  EXPECT_NEAR(score.doors.centre.at(0), 0.0, 1e-6);
  EXPECT_EQ(score.doorways.counts.all.recall(), 1.0);
  EXPECT_EQ(score.stairs.counts.precision(), 1.0);
  EXPECT_NEAR(score.stairs.foot.at(0), 0.0, 1e-6);
  EXPECT_EQ(score.nodes.precision(), 1.0);
  EXPECT_EQ(score.nodes.behindVisible.recall(), 1.0);
  EXPECT_EQ(score.freeSpace.levels[0].overall().precision(), 1.0);
  EXPECT_NEAR(*score.freeSpace.areaGainPercent(0), 100.0 * 28.0 / 20.0, 0.5);
  EXPECT_NEAR(*score.rooms.all(), 1.0, 1e-6);
  EXPECT_NEAR(calibrationOf(score.bets)->brier, 0.01, 1e-9);
}

TEST(PredictionScore, IsTheSameWhereverTheMapsFrameLies) {
  const auto truth = truthOfSmallMap();
  const auto there = geometry::toPose3({100, -30, 2.1}, 7.0);
  expectAlike(scorePrediction(SmallMap(there).view(), truth), scorePrediction(SmallMap().view(), truth), 1e-6);
}

TEST(PredictionScore, DoesNotChargeDriftToDetectors) {
  const auto truth = truthOfSmallMap();
  const auto drift = geometry::toPose3({1.0, -0.6, 0.1});
  const auto score = scorePrediction(SmallMap(geometry::Pose3::Identity(), drift).view(), truth);
  EXPECT_NEAR(score.doorways.centre.at(0), 0.0, 1e-6);
  expectAlike(score, scorePrediction(SmallMap().view(), truth), 1e-6);
}

TEST(PredictionScore, DoesNotDependOnAnOrder) {
  auto truth = truthOfSmallMap();
  const auto before = scorePrediction(SmallMap().view(), truth);
  std::ranges::reverse(truth.doors);
  std::ranges::reverse(truth.rooms);
  const auto nothing = geometry::Pose3::Identity();
  expectAlike(scorePrediction(SmallMap(nothing, nothing, true).view(), truth), before, 1e-9);
}

TEST(PredictionScore, OfAnEmptyMapHasNoPrecisionAndFindsNothing) {
  SmallMap small;
  small.change().entities.clear();
  small.change().predictions.clear();
  small.change().layers.clear();
  std::erase_if(small.change().nodes, [](const map::Node& node) { return node.kind == map::SubMapKind::kPredicted; });
  const auto score = scorePrediction(small.view(), truthOfSmallMap());
  EXPECT_EQ(score.doors.counts.all.recall(), 0.0);
  EXPECT_FALSE(score.doors.counts.precision());
  EXPECT_FALSE(score.nodes.precision());
  EXPECT_FALSE(score.freeSpace.levels[0].overall().precision());
  EXPECT_FALSE(score.freeSpace.areaGainPercent(0));
  EXPECT_FALSE(score.rooms.all());
  EXPECT_FALSE(calibrationOf(score.bets));
}

TEST(PredictionScore, OfAnotherTimeIsRefused) {
  auto truth = truthOfSmallMap();
  for (auto& pose : truth.trajectory) pose.time += base::fromSeconds(1000);
  EXPECT_THROW(scorePrediction(SmallMap().view(), truth), base::Error);
}

TEST(PredictionScore, CountsImagesOfDetectionEvents) {
  SmallMap small;
  small.change().events = {{.time = at(2), .session = {1}, .kind = "detected", .subject = "o1", .payload = "{}"},
                           {.time = at(2), .session = {1}, .kind = "detected", .subject = "nobody", .payload = "{}"}};
  const auto score = scorePrediction(small.view(), truthOfSmallMap());
  ASSERT_TRUE(score.doors.counts.images);
  EXPECT_EQ(score.doors.counts.images->recall(), 0.5);  // of the images at 1 and 2
}

TEST(PredictionScore, OfStairsWithoutStepsTakesTheFootFromThePoints) {
  SmallMap small;
  auto& stairs = small.change().entities[2];
  stairs.attributes = map::Staircase{.height = 3.0, .stepWidth = 1.2};
  const auto foots = [&] { return scorePrediction(small.view(), truthOfSmallMap()).stairs.foot; };
  EXPECT_TRUE(foots().empty());
  for (const float x : {-0.4F, -3.0F, -4.9F}) {
    stairs.points_in_submap.push_back(
        (geometry::toPose3({1, 1, 0}).inverse() * Eigen::Vector3d(x, 1.2, 0.5)).cast<float>());
  }
  EXPECT_NEAR(foots().at(0), 0.0, 1e-3);  // half of the 4.5 m that they cover downhill from the middle
}

TEST(PredictionScore, OfSeveralMapsIsPooled) {
  const auto truth = truthOfSmallMap();
  auto sum = scorePrediction(SmallMap().view(), truth);
  SmallMap empty;
  empty.change().entities.clear();
  empty.change().predictions.clear();
  sum += scorePrediction(empty.view(), truth);
  EXPECT_EQ(sum.doors.counts.all.recall(), 0.5);
  EXPECT_EQ(sum.doors.counts.precision(), 1.0);
  EXPECT_EQ(sum.nodes.precision(), 1.0);
  EXPECT_EQ(sum.nodes.behindVisible.recall(), 0.5);
  EXPECT_EQ(sum.rooms.doors.recall(), 0.5);
}

TEST(ComparedMeasures, HaveNamesOfTheirOwn) {
  std::vector<std::string> names;
  for (const auto& measure : comparedMeasures()) {
    names.emplace_back(measure.name);
    EXPECT_FALSE(measure.value({})) << measure.name;
  }
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace prodomos::evaluation
