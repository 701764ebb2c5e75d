// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/tour.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/simulation/population.hpp"

#include "simulation/buildings.hpp"
#include "simulation/ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

namespace prodomos::simulation {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

double headingOf(const TourPose& pose) {
  return geometry::yaw(pose.T_world_body);
}

/// In the order in which they are first stood in.
std::vector<int> roomsOf(const Building& building, const Tour& tour) {
  std::vector<int> rooms;
  for (const auto& pose : tour.poses) {
    const int storey = test::storeyOf(building, pose);
    const int room = storey < 0 ? kOutside : roomAt(building, storey, test::positionOf(pose));
    if (room != kOutside && std::ranges::find(rooms, room) == rooms.end()) rooms.push_back(room);
  }
  return rooms;
}

std::set<int> storeysOf(const Building& building, const Tour& tour) {
  std::set<int> storeys;
  for (const auto& pose : tour.poses) {
    if (const int storey = test::storeyOf(building, pose); storey >= 0) storeys.insert(storey);
  }
  return storeys;
}

bool isSame(const Tour& a, const Tour& b) {
  return std::ranges::equal(a.poses, b.poses, [](const TourPose& one, const TourPose& other) {
    return one.time == other.time && one.T_world_body.matrix() == other.T_world_body.matrix();
  });
}

void expectWithinLimits(const Tour& tour, const TourOptions& options) {
  double speed = 0.0;
  double turnRate = 0.0;
  for (std::size_t i = 1; i + 1 < tour.poses.size(); ++i) {
    const auto& before = tour.poses[i - 1];
    const auto& now = tour.poses[i];
    const double step = now.time - before.time;
    const Eigen::Vector2d moved = test::positionOf(now) - test::positionOf(before);
    const double turned = geometry::normalizeAngle(headingOf(now) - headingOf(before));
    const double heading = headingOf(before) + turned / 2.0;
    const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
    ASSERT_NEAR(moved.dot(Eigen::Vector2d(-ahead.y(), ahead.x())), 0.0, 1e-9) << "sideways at " << now.time;
    const double newSpeed = moved.dot(ahead) / step;
    const double newTurnRate = turned / step;
    ASSERT_LE(newSpeed, options.speed + 1e-6) << now.time;
    ASSERT_GE(newSpeed, -1e-6) << now.time;
    ASSERT_LE(std::abs(newTurnRate), options.turnRate + 1e-6) << now.time;
    ASSERT_LE(std::abs(newSpeed - speed), options.acceleration * step + 1e-6) << now.time;
    ASSERT_LE(std::abs(newTurnRate - turnRate), options.turnAcceleration * step + 1e-6) << now.time;
    speed = newSpeed;
    turnRate = newTurnRate;
  }
}

void expectClearOfWalls(const Building& building, const Tour& tour, double radius) {
  std::vector<std::vector<test::WallPiece>> walls;
  for (int storey = 0; storey < static_cast<int>(building.storeys.size()); ++storey) {
    walls.push_back(test::wallsOf(building, storey));
  }
  constexpr std::size_t kEvery = 25;
  for (std::size_t i = 0; i + kEvery < tour.poses.size(); i += kEvery) {
    const int storey = test::storeyOf(building, tour.poses[i]);
    if (storey < 0) continue;
    const auto& of = walls[static_cast<std::size_t>(storey)];
    const Eigen::Vector2d position = test::positionOf(tour.poses[i]);
    ASSERT_GT(test::distanceToWalls(of, position), radius) << tour.poses[i].time;
    if (storey == test::storeyOf(building, tour.poses[i + kEvery])) {
      ASSERT_FALSE(test::crossesWalls(of, position, test::positionOf(tour.poses[i + kEvery]))) << tour.poses[i].time;
    }
  }
}

/// Wherever the way leads through a door, that is open while the robot is near. Returns how many passages there were.
int expectOpenDoors(const Building& building, const Tour& tour) {
  int passages = 0;
  for (const auto& door : building.doors) {
    if (door.leaves == 0) continue;
    const Eigen::Vector2d middle(door.pose.x, door.pose.y);
    std::optional<std::size_t> came;
    bool passed = false;
    for (std::size_t i = 0; i < tour.poses.size(); ++i) {
      const bool isNear = test::storeyOf(building, tour.poses[i]) == door.storey &&
                          (test::positionOf(tour.poses[i]) - middle).norm() < 0.6;
      if (isNear && !came) came = i;
      const Eigen::Vector2d inDoor = geometry::inverse(door.pose) * test::positionOf(tour.poses[i]);
      passed = passed || (isNear && std::abs(inDoor.x()) < 0.05);
      if (isNear || !came) continue;
      for (std::size_t k = *came; passed && k < i; ++k) {
        EXPECT_GT(openingAngle(door, tour.poses[k].time), 70.0 * kDegree) << door.id << " at " << tour.poses[k].time;
      }
      passages += passed ? 1 : 0;
      came.reset();
      passed = false;
    }
  }
  return passages;
}

class ToursBySeed : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(, ToursBySeed, testing::Values(1, 2, 3, 4));

TEST_P(ToursBySeed, KeepLimitsAndDistanceAndOpenDoors) {
  auto building = test::office();
  const TourOptions options{.seed = GetParam(), .duration = 240.0};
  const auto tour = planTour(building, options);
  EXPECT_EQ(tour.poses.front().time, 0.0);
  EXPECT_EQ(tour.poses.back().time, options.duration);
  expectWithinLimits(tour, options);
  expectClearOfWalls(building, tour, options.robotRadius);
  EXPECT_GE(expectOpenDoors(building, tour), 2);
}

TEST_P(ToursBySeed, SeeAllCorridorsBeforeTheFirstRoom) {
  auto building = test::office();
  const auto tour = planTour(building, {.seed = GetParam(), .duration = 400.0});
  const auto rooms = roomsOf(building, tour);
  ASSERT_GE(rooms.size(), 5U);
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(rooms[0])].use, RoomUse::kCorridor);
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(rooms[1])].use, RoomUse::kCorridor);
  EXPECT_EQ(building.rooms[static_cast<std::size_t>(rooms[2])].use, RoomUse::kRoom);
}

TEST_P(ToursBySeed, TurnRoundInTheRoomsTheyEnter) {
  auto building = test::office();
  const auto tour = planTour(building, {.seed = GetParam(), .duration = 300.0});
  std::vector<double> turned(building.rooms.size(), 0.0);
  for (std::size_t i = 1; i < tour.poses.size(); ++i) {
    const int room = roomAt(building, 0, test::positionOf(tour.poses[i]));
    if (room == kOutside) continue;
    turned[static_cast<std::size_t>(room)] +=
        std::abs(geometry::normalizeAngle(headingOf(tour.poses[i]) - headingOf(tour.poses[i - 1])));
  }
  auto rooms = roomsOf(building, tour);
  rooms.pop_back();  // In the last it may have had no time.
  for (const int room : rooms) {
    if (building.rooms[static_cast<std::size_t>(room)].use != RoomUse::kRoom) continue;
    EXPECT_GT(turned[static_cast<std::size_t>(room)], 200.0 * kDegree) << room;
  }
}

TEST_P(ToursBySeed, SomeDoorsStayClosedAndSomeOpenLater) {
  auto building = test::office();
  planTour(building, {.seed = GetParam(), .duration = 300.0});
  const auto opens = [](const Door& door) { return !door.swings.empty() && openingAngle(door, 0.0) == 0.0; };
  const auto staysClosed = [](const Door& door) { return door.leaves > 0 && door.swings.empty(); };
  EXPECT_GE(std::ranges::count_if(building.doors, opens), 2);
  EXPECT_GE(std::ranges::count_if(building.doors, staysClosed), 1);
}

TEST_P(ToursBySeed, ChangeFloorOverStairs) {
  auto building = test::officeWithStairs();
  const TourOptions options{.seed = GetParam(), .duration = 150.0};
  const auto tour = planTour(building, options);
  EXPECT_EQ(storeysOf(building, tour), (std::set{0, 1}));
  expectWithinLimits(tour, options);
  expectClearOfWalls(building, tour, options.robotRadius);
  expectOpenDoors(building, tour);
  const auto& stairs = building.stairs.front();
  double before = tour.poses.front().T_world_body.translation().z();
  int onStairs = 0;
  for (const auto& pose : tour.poses) {
    const Eigen::Vector3d position = pose.T_world_body.translation();
    EXPECT_NEAR((pose.T_world_body.linear() * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-12);
    EXPECT_LT(std::abs(position.z() - before), 0.01);
    before = position.z();
    if (test::storeyOf(building, pose) >= 0) continue;
    ++onStairs;
    // On the line through the noses of the steps, and in the middle of the flight.
    EXPECT_NEAR(position.z(),
                (position.x() - stairs.foot.x() + stairs.stepDepth) * stairs.stepHeight / stairs.stepDepth, 0.05);
    EXPECT_NEAR(position.y(), stairs.foot.y(), 0.1);
  }
  EXPECT_GT(onStairs, 200);
}

TEST_P(ToursBySeed, ChangeFloorByLift) {
  auto building = test::officeWithLift();
  const TourOptions options{.seed = GetParam(), .duration = 150.0};
  const auto tour = planTour(building, options);
  EXPECT_EQ(storeysOf(building, tour), (std::set{0, 1}));
  expectWithinLimits(tour, options);
  expectClearOfWalls(building, tour, options.robotRadius);
  EXPECT_GE(expectOpenDoors(building, tour), 2);
  const auto& cabin = building.lifts.front().outline;
  for (const auto& pose : tour.poses) {
    if (test::storeyOf(building, pose) >= 0) continue;
    EXPECT_TRUE(contains(cabin, test::positionOf(pose)));
    for (const auto& door : building.doors) {
      if (isLiftDoor(building, door)) {
        EXPECT_EQ(stateOf(openingAngle(door, pose.time)), map::DoorState::kClosed) << pose.time;
      }
    }
  }
}

TEST(Tour, TakesLiftAndStairsByTurns) {
  int byLift = 0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    auto building = test::officeWithStairs();
    test::addLift(building);
    const auto tour = planTour(building, {.seed = seed, .duration = 150.0});
    const auto isBetween = [&](const TourPose& pose) { return test::storeyOf(building, pose) < 0; };
    const auto between = std::ranges::find_if(tour.poses, isBetween);
    ASSERT_NE(between, tour.poses.end());
    // By the middle of the time, and what it was busy with by then.
    EXPECT_LT(between->time, 75.0 + 20.0);
    byLift += test::positionOf(*between).x() > 15.0 ? 1 : 0;
  }
  EXPECT_GE(byLift, 2);
  EXPECT_LE(byLift, kSeeds - 2);
}

TEST(Tour, TheSameSeedIsTheSameTourAndAnotherIsNot) {
  const auto plan = [](std::uint64_t seed) {
    auto building = test::office();
    populate(building, seed, 60.0);
    return planTour(building, {.seed = seed, .duration = 60.0});
  };
  EXPECT_TRUE(isSame(plan(1), plan(1)));
  EXPECT_FALSE(isSame(plan(1), plan(2)));
}

TEST(Tour, PosesBetweenTwoAreInterpolated) {
  Tour tour;
  geometry::Pose3 moved = geometry::Pose3::Identity();
  moved.translation().x() = 2.0;
  tour.poses = {{1.0, geometry::Pose3::Identity()}, {2.0, moved}};
  EXPECT_EQ(poseAt(tour, 0.0).translation().x(), 0.0);
  EXPECT_NEAR(poseAt(tour, 1.25).translation().x(), 0.5, 1e-12);
  EXPECT_EQ(poseAt(tour, 9.0).translation().x(), 2.0);
}

TEST(Tour, StopsForWhoWalksIntoItsWay) {
  auto building = test::corridorWithTwoRooms();
  building.people = {{.id = "p1", .way = {{0.0, {5.0, 1.0}}, {12.0, {5.0, 1.0}}, {14.0, {5.0, 1.9}}}}};
  const auto tour = planTour(building, {.duration = 30.0, .path = {{0, {1.0, 1.0}}, {0, {11.0, 1.0}}}});
  for (const auto& pose : tour.poses) {
    if (pose.time < 10.0) {
      EXPECT_LT(test::positionOf(pose).x(), 5.0 - 0.8) << pose.time;
    }
  }
  EXPECT_GT(test::positionOf(tour.poses.back()).x(), 10.5);
}

TEST(Tour, WhoComesTowardsTheRobotStepsAside) {
  auto building = test::corridorWithTwoRooms();
  building.people = {{.id = "p1", .way = {{0.0, {11.0, 1.0}}, {3.0, {11.0, 1.0}}, {12.0, {1.0, 1.0}}}}};
  const auto tour = planTour(building, {.duration = 30.0, .path = {{0, {1.0, 1.0}}, {0, {11.0, 1.0}}}});
  const auto& person = building.people.front();
  for (std::size_t i = 1; i < person.way.size(); ++i) EXPECT_GT(person.way[i].time, person.way[i - 1].time);
  const auto walls = test::wallsOf(building, 0);
  for (const auto& pose : tour.poses) {
    const auto position = positionAt(person, pose.time);
    EXPECT_GT((position - test::positionOf(pose)).norm(), 0.5) << pose.time;
    EXPECT_GT(test::distanceToWalls(walls, position), 0.25) << pose.time;
  }
  EXPECT_EQ(positionAt(person, 30.0), Eigen::Vector2d(1.0, 1.0));
}

TEST(Tour, FollowsAGivenPathAndThenStands) {
  auto building = test::corridorWithTwoRooms();
  const TourOptions options{.duration = 60.0,
                            .path = {{0, {1.0, 1.0}}, {0, {3.0, 1.0}}, {0, {3.0, 4.0}}, {0, {4.5, 4.0}}}};
  const auto tour = planTour(building, options);
  EXPECT_TRUE(tour.remarks.empty());
  expectWithinLimits(tour, options);
  expectClearOfWalls(building, tour, options.robotRadius);
  EXPECT_EQ(expectOpenDoors(building, tour), 1);
  for (const auto& stop : options.path) {
    const auto isThere = [&](const TourPose& pose) { return (test::positionOf(pose) - stop.position).norm() < 0.05; };
    EXPECT_TRUE(std::ranges::any_of(tour.poses, isThere)) << stop.position.transpose();
  }
  EXPECT_LT((test::positionOf(tour.poses.back()) - options.path.back().position).norm(), 0.05);
  EXPECT_EQ(tour.poses.back().time, 60.0);
}

TEST(Tour, AGivenPathMayLeadToAnotherStorey) {
  auto building = test::officeWithStairs();
  const auto tour =
      planTour(building, {.duration = 150.0, .path = {{0, {5.0, 1.0}}, {1, {8.0, 1.0}}, {1, {15.0, 1.0}}}});
  EXPECT_TRUE(tour.remarks.empty());
  EXPECT_LT((tour.poses.back().T_world_body.translation() - Eigen::Vector3d(15.0, 1.0, 3.1)).norm(), 0.05);
  expectOpenDoors(building, tour);
}

TEST(Tour, SaysWhereTheTimeOfAGivenPathEnded) {
  auto building = test::corridorWithTwoRooms();
  const auto tour = planTour(building, {.duration = 5.0, .path = {{0, {1.0, 1.0}}, {0, {11.0, 1.0}}, {0, {2.0, 1.0}}}});
  ASSERT_EQ(tour.remarks.size(), 1U);
  EXPECT_THAT(tour.remarks.front(), HasSubstr("point 2"));
}

/// The message of a base::UsageError.
std::string faultOf(Building building, const TourOptions& options) {
  try {
    planTour(building, options);
  } catch (const base::UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Tour, APathThroughAWallIsRefused) {
  const auto fault = faultOf(test::corridorWithTwoRooms(), {.path = {{0, {6.0, 1.0}}, {0, {7.5, 4.0}}}});
  EXPECT_THAT(fault, HasSubstr("point 2"));
  EXPECT_THAT(fault, HasSubstr("wall"));
}

TEST(Tour, PointsThatCannotBeStoodAtAreAllNamed) {
  auto building = test::corridorWithTwoRooms();
  test::addThing(building, "desk", {2.0, 4.0}, {1.6, 0.8, 0.75});
  const auto fault = faultOf(building, {.path = {{0, {6.0, 1.0}}, {0, {20.0, 1.0}}, {0, {2.0, 4.0}}, {1, {6.0, 1.0}}}});
  EXPECT_THAT(fault, HasSubstr("point 2 of the path (20.00, 1.00)"));
  EXPECT_THAT(fault, HasSubstr("\"r2\""));
  EXPECT_THAT(fault, HasSubstr("point 4"));
  EXPECT_THAT(fault, testing::Not(HasSubstr("point 1")));
}

TEST(Tour, AStoreyThatNothingLeadsToIsNamed) {
  const auto fault = faultOf(test::twoStoreyOffice(), {.path = {{0, {6.0, 1.0}}, {1, {6.0, 1.0}}}});
  EXPECT_THAT(fault, HasSubstr("lift or stairs"));
}

TEST(Tour, SenselessLimitsAreRefused) {
  const auto building = test::corridorWithTwoRooms();
  EXPECT_THAT(faultOf(building, {.duration = 0.0}), HasSubstr("duration"));
  EXPECT_THAT(faultOf(building, {.duration = -1.0}), HasSubstr("duration"));
  EXPECT_THAT(faultOf(building, {.speed = std::numeric_limits<double>::quiet_NaN()}), HasSubstr("speed"));
  EXPECT_THAT(faultOf(building, {.robotRadius = 0.0}), HasSubstr("radius"));
}

TEST(Tour, ABuildingWithoutRoomToStandIsAnError) {
  Building building{.name = "cupboard", .storeys = {{}}};
  test::addRoom(building, "CORRIDOR", {0.0, 0.0}, {0.4, 0.4});
  EXPECT_THROW(planTour(building, {}), base::Error);
  Building empty{.name = "nothing", .storeys = {{}}};
  EXPECT_THROW(planTour(empty, {}), base::Error);
}

TEST(Tour, SaysThatItCannotLeaveItsStorey) {
  auto building = test::twoStoreyOffice();
  const auto tour = planTour(building, {.duration = 60.0});
  ASSERT_EQ(tour.remarks.size(), 1U);
  EXPECT_THAT(tour.remarks.front(), HasSubstr("no lift and no stairs"));
}

TEST(Tour, ARoomWithoutWayOutIsLookedAtUntilTheEnd) {
  Building building{.name = "cell", .storeys = {{}}};
  test::addRoom(building, "CELL", {0.0, 0.0}, {3.0, 3.0});
  const auto tour = planTour(building, {.duration = 40.0});
  EXPECT_EQ(tour.poses.back().time, 40.0);
}

TEST(Tour, AVeryLongTimeIsFilled) {
  auto building = test::corridorWithTwoRooms();
  const auto tour = planTour(building, {.seed = 1, .duration = 900.0});
  EXPECT_EQ(roomsOf(building, tour).size(), 3U);
  double driven = 0.0;
  for (std::size_t i = 1; i < tour.poses.size(); ++i) {
    driven += (test::positionOf(tour.poses[i]) - test::positionOf(tour.poses[i - 1])).norm();
  }
  EXPECT_GT(driven, 100.0);
}

}  // namespace
}  // namespace prodomos::simulation
