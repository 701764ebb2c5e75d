// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/mapper.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include "mapper/drive.hpp"
#include "support/temporary_folder.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::mapper {
namespace {

using geometry::Pose3;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

base::Time at(double seconds) {
  return base::Time(base::fromSeconds(1000.0 + seconds));
}

sensors::Reading odometry(double seconds, const Pose3& T_odom_body) {
  return {at(seconds), "odometry", sensors::Odometry{T_odom_body}, ""};
}
sensors::Reading recorded(double seconds, const Pose3& T_world_body) {
  return {at(seconds), "pose", sensors::RecordedPose{T_world_body}, ""};
}
/// A full turn of beams that all end at `range`.
sensors::Reading scan(double seconds, float range = 3.0F) {
  sensors::LaserScan scan;
  scan.firstAngle = -3.0;
  scan.angleStep = 0.05;
  scan.maxRange = 10.0;
  scan.ranges.assign(120, range);
  return {at(seconds), "laser", scan, ""};
}

/// A mapper on a map in memory. It follows the wheels, so that poses are exact.
struct Drive {
  explicit Drive(const MapperConfig& config = byWheels(), bool hasRecordedPoses = false)
      : mapper(store, config, liveInfo(hasRecordedPoses)) {}

  Drive& feed(const std::vector<sensors::Reading>& readings) {
    for (const auto& reading : readings) mapper.process(reading);
    return *this;
  }
  /// Each reading is accounted for, whatever has been fed.
  map::MapView finish() {
    mapper.finish();
    const auto& report = mapper.report();
    EXPECT_EQ(report.read, report.used + skippedOf(report));
    return mapper.view();
  }

  map::MapStore store = map::MapStore::inMemory();
  Mapper mapper;
};

/// Not by overlap.
MapperConfig byDistance(double metres, const std::string& poses = "odometry") {
  MapperConfig config;
  config.input.poses = poses;
  config.submap.maxDistance = metres;
  config.submap.leastOverlap = 0.0;
  return config;
}

/// Straight on, in steps of 0.1 m and 0.1 s, under a start pose; with `rise` along the way.
std::vector<sensors::Reading> straight(double way, const Pose3& T_odom_start = Pose3::Identity()) {
  std::vector<sensors::Reading> log;
  for (int i = 0; i <= static_cast<int>(std::round(way / 0.1)); ++i) {
    log.push_back(odometry(0.1 * i, T_odom_start * geometry::toPose3({0.1 * i, 0, 0})));
    log.push_back(scan(0.1 * i));
  }
  return log;
}

std::vector<sensors::Reading> movedBy(const Pose3& T_new_odom, std::vector<sensors::Reading> log) {
  for (auto& reading : log) {
    if (auto* at = std::get_if<sensors::Odometry>(&reading.data)) at->T_odom_body = T_new_odom * at->T_odom_body;
  }
  return log;
}

/// Of the cells that a map calls occupied or free, those that are not.
struct WrongCells {
  int occupied = 0;  ///< … that are
  int farFromWalls = 0;
  int free = 0;  ///< … that are
  int deepInWalls = 0;
};

WrongCells compare(const map::MapView& view, const testing::LaserWorld& world, const Pose3& T_world_map,
                   double margin) {
  WrongCells cells;
  for (const auto id : view.graph().nodes()) {
    const auto grid = view.findLayer<map::OccupancyGrid>(id);
    if (grid == nullptr) continue;  // predicted
    const Pose3 T_world_submap = T_world_map * view.graph().getNode(id).T_map_submap;
    const auto box = grid->knownBox();
    for (int y = box.first.y; y <= box.last.y; ++y) {
      for (int x = box.first.x; x <= box.last.x; ++x) {
        const double resolution = grid->resolution();
        const Eigen::Vector3d centre(geometry::cellCentre(x, resolution), geometry::cellCentre(y, resolution), 0.0);
        const Eigen::Vector3d point = T_world_submap * centre;
        const auto isWallAt = [&](double dx, double dy) { return world.isWall(point.x() + dx, point.y() + dy); };
        bool isNearWall = false;
        bool isWallAround = true;
        for (const double dx : {-margin, 0.0, margin}) {
          for (const double dy : {-margin, 0.0, margin}) {
            isNearWall |= isWallAt(dx, dy);
            isWallAround &= isWallAt(dx, dy);
          }
        }
        const auto state = grid->state({x, y});
        cells.occupied += state == map::CellState::kOccupied && isNearWall ? 1 : 0;
        cells.farFromWalls += state == map::CellState::kOccupied && !isNearWall ? 1 : 0;
        cells.free += state == map::CellState::kFree && !isWallAround ? 1 : 0;
        cells.deepInWalls += state == map::CellState::kFree && isWallAround ? 1 : 0;
      }
    }
  }
  return cells;
}

TEST(Mapper, DrawsWallsWhereTheWorldHasThem) {
  Drive run;
  const auto view = run.feed(shortDrive()).finish();
  const Pose3 T_world_map = geometry::toPose3({1.0, 1.0, 0.0});  // the drive begins there, looking along x
  const auto cells = compare(view, testing::fourRooms(), T_world_map, 0.06);
  EXPECT_GT(cells.occupied, 500);
  EXPECT_GT(cells.free, 5000);
  EXPECT_EQ(cells.farFromWalls, 0);
  EXPECT_EQ(cells.deepInWalls, 0);
}

TEST(Mapper, DrawsWallsWhereTheWorldHasThemThoughWheelsSlip) {
  const Pose3 T_world_map = geometry::toPose3({1.0, 1.0, 0.0});
  const auto wrongOf = [&](const MapperConfig& config) {
    Drive run(config);
    const auto cells = compare(run.feed(slippingTour()).finish(), testing::fourRooms(), T_world_map, 0.1);
    EXPECT_GT(cells.occupied + cells.farFromWalls, 2000);
    return static_cast<double>(cells.farFromWalls) / (cells.occupied + cells.farFromWalls);
  };
  EXPECT_GT(wrongOf(byWheels()), 0.1);
  EXPECT_LT(wrongOf({}), 0.01);
}

TEST(Mapper, EstimatesPosesWithinCentimetresThoughWheelsSlip) {
  Drive run(MapperConfig{});
  const auto trajectory = run.feed(slippingTour()).finish().trajectory();
  const auto truth = truthOf(testing::tourOfFourRooms());
  ASSERT_EQ(trajectory.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto off = geometry::inverse(truth[i]) * geometry::toPose2(trajectory[i].T_map_body);
    EXPECT_LT(std::hypot(off.x, off.y), 0.08) << "scan " << i;
    EXPECT_LT(std::abs(off.theta), 0.02) << "scan " << i;
  }
}

TEST(Mapper, EstimatesPosesOfALogWithoutWheels) {
  Drive run(MapperConfig{});
  for (const auto& reading : slippingTour()) {
    if (reading.sensor == "laser") run.feed({reading});
  }
  const auto view = run.finish();
  const auto truth = truthOf(testing::tourOfFourRooms());
  EXPECT_LE(run.mapper.report().lost, 2) << "where it turns by 17° from one scan to the next";
  const auto off = geometry::inverse(truth.back()) * geometry::toPose2(view.trajectory().back().T_map_body);
  EXPECT_LT(std::hypot(off.x, off.y), 0.1);
}

TEST(Mapper, TiesSubMapsThatShowTheSamePlaceAndSaysHowWellEachIsKnown) {
  Drive run(MapperConfig{});
  const auto view = run.feed(slippingTour()).finish();
  const auto& graph = view.graph();
  EXPECT_GT(graph.edges().size(), graph.nodes().size()) << "the tour comes back along the corridor";
  EXPECT_EQ(view.sessions().back().poses, "estimated");
  for (const auto id : graph.nodes()) {
    const auto& covariance = graph.getNode(id).covariance;
    ASSERT_TRUE(covariance.has_value()) << id;
    EXPECT_EQ(covariance->isZero(), id.value == 0) << "relative to the first";
    EXPECT_LT(covariance->diagonal().head<2>().maxCoeff(), 0.1 * 0.1);
  }
  for (const auto id : graph.edges()) {
    const auto& edge = graph.getEdge(id);
    const Pose3 T_to_told =
        graph.getNode(edge.to).T_map_submap.inverse() * graph.getNode(edge.from).T_map_submap * edge.T_from_to;
    // Along a corridor that is all they have in common a tie knows little, and says so.
    const Eigen::Vector3d off = T_to_told.translation();
    EXPECT_LT(off.norm(), 0.5) << id;
    EXPECT_LT(off.dot(edge.information.topLeftCorner<3, 3>() * off), 25.0) << id;
  }
}

TEST(Mapper, KeepsTheWayThatWasTravelledBesideTheRefinedOne) {
  Drive run(MapperConfig{});
  const auto view = run.feed(slippingTour()).finish();
  for (const auto& point : view.trajectory()) {
    const auto& node = view.graph().getNode(point.submap);
    const Pose3 T_map_body = node.T_map_submap * node.T_travel_submap.inverse() * point.T_travel_body;
    EXPECT_TRUE(T_map_body.isApprox(point.T_map_body, 1e-9));
  }
}

TEST(Mapper, PutsTheFirstSubMapAtTheOriginAndTheOthersBelowTheRobot) {
  Drive run(byDistance(6.0));
  const auto view = run.feed(straight(20.0)).finish();
  ASSERT_THAT(view.graph().nodes(), SizeIs(4));
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    EXPECT_NEAR(node.T_map_submap.translation().x(), 6.0 * static_cast<double>(id.value), 0.11);
    EXPECT_NEAR(node.T_map_submap.translation().tail<2>().norm(), 0.0, 1e-9);
    EXPECT_TRUE(node.T_map_submap.linear().isIdentity(1e-9));
  }
  EXPECT_EQ(view.graph().componentCount(), 1);
  EXPECT_EQ(view.graph().places().size(), 1U);
  EXPECT_NEAR(view.sessions().back().distance, 20.0, 1e-9);
  EXPECT_EQ(view.sessions().back().begin, at(0));
  EXPECT_EQ(view.sessions().back().end, at(20));
}

TEST(Mapper, GivesTheSameMapWhereverOdometryBeginsAndHoweverItIsTurned) {
  Drive near(byDistance(6.0));
  Drive far(byDistance(6.0));
  const Pose3 T_far_near = geometry::toPose3({576.0, -12.0, 2.1});  // as mit-csail
  const auto nearView = near.feed(shortDrive()).finish();
  const auto farView = far.feed(movedBy(T_far_near, shortDrive())).finish();
  EXPECT_TRUE((farView.sessions().back().T_map_travel * T_far_near).isApprox(Pose3::Identity(), 1e-9));
  ASSERT_EQ(farView.graph().nodes(), nearView.graph().nodes());
  for (const auto id : nearView.graph().nodes()) {
    const auto& node = nearView.graph().getNode(id);
    const auto& same = farView.graph().getNode(id);
    EXPECT_TRUE(same.T_map_submap.isApprox(node.T_map_submap, 1e-9));
    EXPECT_TRUE(same.T_travel_submap.isApprox(T_far_near * node.T_travel_submap, 1e-9));
  }
}

TEST(Mapper, LevelsSubMapsWhereTheRobotTilts) {
  Drive run(byDistance(2.0));
  std::vector<sensors::Reading> log;
  for (int i = 0; i <= 50; ++i) {
    log.push_back(odometry(0.1 * i, geometry::fromYawPitchRoll({0.1 * i, 0.0, 0.0}, 0.5, 0.1, -0.2)));
    log.push_back(scan(0.1 * i));
  }
  const auto view = run.feed(log).finish();
  ASSERT_GT(view.graph().nodes().size(), 1U);
  for (const auto id : view.graph().nodes()) {
    EXPECT_TRUE(view.graph().getNode(id).T_map_submap.linear().isIdentity(1e-9)) << "x is the heading, z is up";
  }
}

TEST(Mapper, BeginsASubMapWhereLittleIsSeenOfWhatWasSeenFirst) {
  auto config = byWheels();
  config.submap.maxDistance = 1000.0;
  std::vector<sensors::Reading> log;
  for (int i = 0; i <= 65; ++i) {  // near walls around the robot at first, then a hall
    log.push_back(odometry(0.1 * i, geometry::toPose3({0.05 * i, 0.0, 0.01 * i})));
    log.push_back(scan(0.1 * i, i < 50 ? 4.0F : 9.0F));
  }
  Drive run(config);
  const auto view = run.feed(log).finish();
  ASSERT_THAT(view.graph().nodes(), SizeIs(2));
  const auto& second = view.graph().getNode({1});
  EXPECT_GE(second.begin, at(5.0));
  EXPECT_LE(second.begin, at(6.0)) << "at the next look";
  EXPECT_TRUE(second.T_map_submap.isApprox(
      view.trajectory()[static_cast<std::size_t>(view.graph().getNode({0}).readings)].T_map_body, 1e-9));
}

TEST(Mapper, LetsACameraLookAroundOnTheSpot) {
  Drive run;
  for (int i = 0; i < 60; ++i) {
    auto ahead = scan(0.1 * i);
    std::get<sensors::LaserScan>(ahead.data).ranges.resize(20);
    run.feed({odometry(0.1 * i, geometry::toPose3({0.0, 0.0, 0.1 * i})), ahead});
  }
  EXPECT_THAT(run.finish().graph().nodes(), SizeIs(1));
}

TEST(Mapper, BeginsASubMapAndAPlaceOnEachFloor) {
  std::vector<sensors::Reading> log;
  double height = 0.0;
  double x = 0.0;
  double seconds = 0.0;
  const auto go = [&](int steps, double rise) {
    for (int i = 0; i < steps; ++i) {
      x += 0.1;
      height += rise;
      seconds += 0.1;
      log.push_back(recorded(seconds, geometry::toPose3({x, 0.0, 0.0}, height + 1.2)));  // carried by hand
      log.push_back(scan(seconds));
    }
  };
  go(50, 0.0);
  go(50, 0.06);
  go(50, 0.0);
  Drive run(byDistance(6.0, "recorded"), true);
  const auto view = run.feed(log).finish();

  ASSERT_THAT(view.floors(), SizeIs(2));
  EXPECT_NEAR(view.floors()[1].height, 3.0, 0.05);
  const auto& last = view.graph().getNode(view.graph().nodes().back());
  EXPECT_EQ(last.floor, 1);
  EXPECT_EQ(last.T_map_submap.translation().z(), view.floors()[1].height);
  EXPECT_EQ(view.graph().getNode({0}).floor, 0);
  EXPECT_EQ(view.graph().getNode({0}).T_map_submap.translation().z(), 0.0) << "on the floor, below the hand";
  EXPECT_EQ(view.graph().getEdge(view.graph().edges().back()).kind, map::EdgeKind::kStairs);
  EXPECT_EQ(view.graph().getEdge(view.graph().edges().front()).kind, map::EdgeKind::kTravelled);
  EXPECT_EQ(view.graph().places().size(), 2U);
  EXPECT_EQ(view.graph().componentCount(), 1);
}

TEST(Mapper, TakesPosesFarAboveZeroForThoseOfTheGround) {  // a world whose floor is not z = 0
  Drive run({}, true);
  const auto view = run.feed({recorded(0, geometry::toPose3({1, 2, 3}, 40.0)), scan(0)}).finish();
  EXPECT_TRUE(view.graph().getNode({0}).T_map_submap.isApprox(Pose3::Identity(), 1e-9));
  EXPECT_TRUE(view.graph().getNode({0}).T_travel_submap.isApprox(geometry::toPose3({1, 2, 3}, 40.0), 1e-9));
}

TEST(Mapper, JoinsSubMapsByTheWayBetweenThem) {
  auto config = byWheels();
  config.prediction.enabled = false;  // sub-maps that were travelled alone
  Drive run(config);
  const auto view = run.feed(shortDrive()).finish();
  const auto& graph = view.graph();
  ASSERT_EQ(graph.edges().size(), graph.nodes().size() - 1);
  for (const auto id : graph.edges()) {
    const auto& edge = graph.getEdge(id);
    EXPECT_EQ(edge.to.value, edge.from.value + 1);
    const Pose3 T_map_to = graph.getNode(edge.from).T_map_submap * edge.T_from_to;
    EXPECT_TRUE(T_map_to.isApprox(graph.getNode(edge.to).T_map_submap, 1e-9));
    EXPECT_TRUE(edge.information.isApprox(edge.information.transpose()));
    EXPECT_GT(edge.information.diagonal().minCoeff(), 0.0);
  }
}

TEST(Mapper, SaysWhichWaysLeadThroughDoors) {
  Drive run;
  const auto view = run.feed(driveThrough(testing::fourRooms(), testing::tourOfFourRooms())).finish();
  const auto& graph = view.graph();
  const double wall_y = 8.5 * 0.25 - 1.0;  // the middle of that between the corridor and the four rooms, in the map
  int through = 0;
  for (const auto id : graph.edges()) {
    const auto& edge = graph.getEdge(id);
    if (graph.getNode(edge.to).kind == map::SubMapKind::kPredicted || edge.kind == map::EdgeKind::kLoop) continue;
    const auto isInRoom = [&](base::SubMapId submap) {
      return graph.getNode(submap).T_map_submap.translation().y() > wall_y;
    };
    EXPECT_EQ(edge.kind == map::EdgeKind::kDoor, edge.cause.has_value()) << id;
    if (edge.kind != map::EdgeKind::kDoor) continue;
    ++through;
    // The doors are those between rooms and the corridor. One that is found late may leave two on one way.
    const Eigen::Vector3d way =
        graph.getNode(edge.to).T_map_submap.translation() - graph.getNode(edge.from).T_map_submap.translation();
    EXPECT_TRUE(isInRoom(edge.from) != isInRoom(edge.to) || std::abs(way.x()) > 3.0)
        << id << " from " << graph.getNode(edge.from).T_map_submap.translation().transpose() << " along "
        << way.transpose();
    const auto door = std::ranges::find(view.entities(), *edge.cause, &map::Entity::id);
    ASSERT_NE(door, view.entities().end());
    EXPECT_TRUE(std::holds_alternative<map::Door>(door->attributes));
  }
  EXPECT_GE(through, 4);
}

TEST(Mapper, TrustsAnEdgeLessTheLongerTheWayAndTheMoreTurns) {
  const auto firstEdge = [](double distance, double turnPerStep) {
    Drive run(byDistance(distance));
    Pose3 T_odom_body = Pose3::Identity();
    for (int i = 0; i < 100; ++i) {
      run.feed({odometry(0.1 * i, T_odom_body), scan(0.1 * i)});
      T_odom_body = T_odom_body * geometry::toPose3({0.1, 0.0, i % 2 == 0 ? turnPerStep : -turnPerStep});
    }
    const auto view = run.finish();
    return view.graph().getEdge({0}).information;
  };
  const auto nearEdge = firstEdge(2.0, 0.0);
  const auto farEdge = firstEdge(6.0, 0.0);
  const auto wobbling = firstEdge(2.0, 0.2);
  EXPECT_GT(nearEdge(0, 0), farEdge(0, 0));
  EXPECT_GT(nearEdge(5, 5), farEdge(5, 5));
  EXPECT_GT(nearEdge(5, 5), wobbling(5, 5));
  // Errors of stretches are independent: their variances add up.
  const map::Matrix6 nearCovariance = nearEdge.inverse();
  const map::Matrix6 farCovariance = farEdge.inverse();
  EXPECT_NEAR(std::sqrt(nearCovariance(0, 0)), 0.05 * std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(std::sqrt(nearCovariance(5, 5)), 0.01 * std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(farCovariance(0, 0) / nearCovariance(0, 0), 3.0, 0.05);
  EXPECT_GT(farCovariance(1, 1), farCovariance(0, 0)) << "what the heading is off leads aside";
}

TEST(Mapper, RecordsWhereTheRobotWasAtEachReading) {
  Drive run;
  const auto log = shortDrive();
  const auto view = run.feed(log).finish();
  const auto trajectory = view.trajectory();
  ASSERT_EQ(trajectory.size(), log.size() / 2);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto& T_odom_body = std::get<sensors::Odometry>(log[2 * i].data).T_odom_body;
    EXPECT_EQ(trajectory[i].time, log[2 * i].time);
    EXPECT_TRUE(trajectory[i].T_travel_body.isApprox(T_odom_body, 1e-9));
    EXPECT_TRUE(trajectory[i].T_map_body.isApprox(T_odom_body, 1e-9)) << "odometry begins where the map does";
  }
}

TEST(Mapper, FollowsTheChosenPosesAlone) {
  test::TemporaryFolder folder;
  const auto file = folder.write("poses.txt", "# time x y z qx qy qz qw\n1000 0 7 0 0 0 0 1\n1010 10 7 0 0 0 0 1\n");
  const std::vector<sensors::Reading> log = {odometry(0, geometry::toPose3({1, 0, 0})),
                                             recorded(0, geometry::toPose3({2, 0, 0})), scan(0)};
  const auto run = [&](const std::string& poses) {
    MapperConfig config;
    config.input.poses = poses;
    Drive run(config, true);
    const auto view = run.feed(log).finish();
    EXPECT_EQ(run.mapper.report().used, poses == file ? 1 : 2);
    EXPECT_EQ(view.sessions().back().poses, poses == "auto" ? "recorded" : poses);
    return Eigen::Vector3d(view.trajectory().at(0).T_travel_body.translation());
  };
  EXPECT_EQ(run("odometry").x(), 1.0);
  EXPECT_EQ(run("recorded").x(), 2.0);
  EXPECT_EQ(run("auto").x(), 2.0) << "the log has poses worth following";
  EXPECT_EQ(run(file.string()).y(), 7.0);
}

TEST(Mapper, RefusesATrajectoryFileThatIsNotThereBeforeItWritesAnything) {
  auto store = map::MapStore::inMemory();
  MapperConfig config;
  config.input.poses = "/no/such/poses.txt";
  EXPECT_THROW(Mapper(store, config, liveInfo()), base::FileError);
  EXPECT_THAT(store.view().sessions(), IsEmpty());
}

TEST(Mapper, WaitsForTheOdometryAfterAReading) {
  Drive run;
  run.feed({odometry(0, Pose3::Identity()), scan(0.5)});
  EXPECT_THAT(run.mapper.view().graph().nodes(), IsEmpty());
  run.feed({odometry(1, geometry::toPose3({1, 0, 0}))});
  EXPECT_THAT(run.mapper.view().graph().nodes(), SizeIs(1));
  EXPECT_NEAR(run.finish().trajectory().at(0).T_travel_body.translation().x(), 0.5, 1e-9);
}

TEST(Mapper, MapsAtOneSpotWhereNobodyTellsOfMovement) {
  Drive run;
  for (int i = 0; i < 200; ++i) run.feed({scan(0.01 * i)});
  EXPECT_GT(run.mapper.report().used, 100) << "does not wait for ever";
  const auto view = run.finish();
  EXPECT_THAT(view.graph().nodes(), SizeIs(1));
  EXPECT_EQ(run.mapper.report().used, 200);
}

TEST(Mapper, BearsPosesThatAllComeFirstAndReadingsOutOfOrder) {
  Drive run;
  for (int i = 0; i <= 1000; ++i) run.feed({odometry(i, geometry::toPose3({0.01 * i, 0, 0}))});
  run.feed({scan(300), scan(299.5), scan(500)});
  const auto trajectory = run.finish().trajectory();
  ASSERT_THAT(trajectory, SizeIs(3));
  EXPECT_NEAR(trajectory[0].T_travel_body.translation().x(), 3.0, 1e-9);
  EXPECT_NEAR(trajectory[1].T_travel_body.translation().x(), 2.995, 1e-9);
  EXPECT_NEAR(trajectory[2].T_travel_body.translation().x(), 5.0, 1e-9);
}

TEST(Mapper, SkipsReadingsWithoutARecordedPoseNear) {
  Drive run({}, true);
  run.feed({scan(0), recorded(10, Pose3::Identity()), scan(10.5), scan(15), recorded(20, Pose3::Identity()), scan(22)});
  run.finish();
  EXPECT_THAT(run.mapper.report().skippedByReason, ElementsAre(Pair("no recorded pose near", 3)));
  EXPECT_THAT(run.mapper.report().usedByKind, UnorderedElementsAre(Pair("laser_scan", 1), Pair("recorded_pose", 2)));
}

TEST(Mapper, LeavesOutPosesThatAreNotFinite) {
  Pose3 bad = Pose3::Identity();
  bad.translation().x() = std::nan("");
  Drive run;
  run.feed({odometry(0, Pose3::Identity()), odometry(1, bad), scan(1), odometry(2, geometry::toPose3({2, 0, 0}))});
  const auto view = run.finish();
  EXPECT_NEAR(view.trajectory().at(0).T_travel_body.translation().x(), 1.0, 1e-9) << "from its neighbours";
  EXPECT_THAT(run.mapper.report().skippedByReason, ElementsAre(Pair("pose is not finite", 1)));
}

TEST(Mapper, CountsWhatItCannotUse) {
  Drive run;
  run.mapper.skip({"unsupported CObservationGPS", ""});
  run.mapper.skip({"unreadable image", "a.rawlog: image 7 is damaged"});
  sensors::Reading half = scan(0);
  half.fault = "a.rawlog: no colour";
  run.feed({half,
            recorded(0, Pose3::Identity()),
            {at(0), "camera", sensors::Detections{}, ""},
            {at(0), "camera", sensors::KeyPoints{}, ""},
            {at(0), "camera", sensors::RgbdFrame{}, ""}});
  run.finish();
  const auto& report = run.mapper.report();
  EXPECT_EQ(report.read, 7);
  EXPECT_EQ(report.used, 1);
  EXPECT_THAT(report.skippedByReason,
              UnorderedElementsAre(Pair("unsupported CObservationGPS", 1), Pair("unreadable image", 1),
                                   Pair("recorded_pose not asked for", 1), Pair("no layer takes a detections", 1),
                                   Pair("no layer takes a key_points", 1), Pair("no layer takes a rgbd_frame", 1)));
  EXPECT_THAT(report.faults, ElementsAre("a.rawlog: image 7 is damaged", "a.rawlog: no colour"));
}

TEST(Mapper, BeginsNoSubMapForReadingsThatShowNothing) {
  Drive run(byDistance(2.0));
  for (int i = 0; i < 100; ++i) {
    run.feed({odometry(i, geometry::toPose3({0.5 * i, 0, 0})), {at(i), "camera", sensors::Detections{}, ""}});
  }
  const auto view = run.finish();
  EXPECT_THAT(view.graph().nodes(), IsEmpty());
  EXPECT_EQ(run.mapper.report().submaps, 0);
}

TEST(Mapper, FinishesAnEmptyLogAsAnEmptyMap) {
  Drive run;
  const auto view = run.finish();
  EXPECT_THAT(view.graph().nodes(), IsEmpty());
  EXPECT_EQ(view.sessions().back().state, map::SessionState::kComplete);
  EXPECT_THAT(view.floors(), SizeIs(1));
}

TEST(Mapper, ShowsTheRunningSubMapInItsView) {
  Drive run(byDistance(6.0));
  run.feed(straight(8.0));
  const auto running = run.mapper.view();
  ASSERT_THAT(running.graph().nodes(), SizeIs(2));
  EXPECT_TRUE(running.graph().hasEdge({0}));
  const auto before = running.findLayer<map::OccupancyGrid>({1});
  ASSERT_NE(before, nullptr);
  const auto known = before->knownBox();
  run.feed({odometry(9, geometry::toPose3({20, 0, 0})), scan(9)});
  EXPECT_EQ(before->knownBox(), known) << "a view stays what it was";
  EXPECT_GT(run.mapper.view().graph().nodes().size(), 2U);
}

TEST(Mapper, WritesEachSubMapOnceItIsFinished) {
  Drive run(byDistance(6.0));
  run.feed(straight(13.0));
  const auto written = run.store.view();
  EXPECT_THAT(written.graph().nodes(), SizeIs(2));
  EXPECT_EQ(written.sessions().back().state, map::SessionState::kRunning);
  EXPECT_TRUE(run.store.findCheckpoint({0}).has_value());
  std::vector<std::string> events;
  for (const auto& event : written.events()) events.push_back(event.kind + " " + event.subject);
  EXPECT_THAT(events, ElementsAre("submap_begun s0", "submap_finished s0", "submap_begun s1", "submap_finished s1"));
  run.finish();
  EXPECT_FALSE(run.store.findCheckpoint({0}).has_value());
}

TEST(Mapper, TakesNothingMoreOnceItHasFinished) {
  Drive run;
  run.feed({scan(0)});
  run.finish();
  EXPECT_THROW(run.mapper.process(scan(1)), base::Error);
  EXPECT_THROW(run.mapper.skip({"late", ""}), base::Error);
  EXPECT_THROW(run.mapper.finish(), base::Error);
  EXPECT_THAT(run.mapper.view().events(), SizeIs(3));
}

TEST(Mapper, AddsSessionsToAMapWithoutTouchingTheFirst) {
  auto store = map::MapStore::inMemory();
  for (int session = 0; session < 2; ++session) {
    Mapper mapper(store, byDistance(6.0), liveInfo());
    for (const auto& reading : straight(8.0)) mapper.process(reading);
    mapper.finish();
  }
  const auto view = store.view();
  EXPECT_THAT(view.sessions(), SizeIs(2));
  EXPECT_THAT(view.graph().nodes(), SizeIs(4));
  EXPECT_THAT(view.graph().edges(), SizeIs(2));
  EXPECT_EQ(view.graph().getNode({1}).session.value, 0);
  EXPECT_EQ(view.graph().getNode({2}).session.value, 1);
  EXPECT_EQ(view.graph().componentCount(), 2);
}

TEST(Mapper, ClosesASessionThatALiveProgramLeftOpen) {
  auto store = map::MapStore::inMemory();
  {
    Mapper mapper(store, byDistance(6.0), liveInfo());
    for (const auto& reading : straight(8.0)) mapper.process(reading);
  }  // the program dies
  Mapper mapper(store, byDistance(6.0), liveInfo());
  mapper.finish();
  const auto& report = mapper.report();
  EXPECT_EQ(report.skippedByReason.at("lost when the session was interrupted"), 1);
  EXPECT_EQ(report.read, report.used + skippedOf(report));
  EXPECT_EQ(store.view().sessions().back().state, map::SessionState::kComplete);
}

TEST(Mapper, BoundsTheSubMapOfAParkedRobot) {
  Drive run;
  for (int i = 0; i < 60'000; ++i) run.feed({scan(0.001 * i, -1.0F)});
  EXPECT_THAT(run.finish().graph().nodes(), SizeIs(2));
}

}  // namespace
}  // namespace prodomos::mapper
