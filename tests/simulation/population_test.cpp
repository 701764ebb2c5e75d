// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/population.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/navigation.hpp"

#include "simulation/buildings.hpp"
#include "simulation/ways.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDuration = 120.0;

Building peopled(std::uint64_t seed, Building building = test::office()) {
  populate(building, seed, kDuration);
  return building;
}

bool isSame(const Building& a, const Building& b) {
  return std::ranges::equal(a.people, b.people, [](const Person& one, const Person& other) {
    return one.look == other.look && one.height == other.height && one.storey == other.storey &&
           std::ranges::equal(one.way, other.way, [](const Waypoint& p, const Waypoint& q) {
             return p.time == q.time && p.position == q.position;
           });
  });
}

void expectAscending(const std::vector<Swing>& swings) {
  for (std::size_t i = 1; i < swings.size(); ++i) EXPECT_GT(swings[i].time, swings[i - 1].time);
}

TEST(OpenFor, AClosedDoorOpensInTimeAndClosesAgain) {
  Door door;
  openFor(door, 10.0, 14.0);
  expectAscending(door.swings);
  EXPECT_EQ(openingAngle(door, 8.0), 0.0);
  EXPECT_EQ(openingAngle(door, 10.0 - kSwingTime), 0.0);
  EXPECT_NEAR(openingAngle(door, 10.0), 90.0 * kDegree, 1e-9);
  EXPECT_NEAR(openingAngle(door, 14.0), 90.0 * kDegree, 1e-9);
  EXPECT_NEAR(openingAngle(door, 14.0 + kSwingTime), 0.0, 1e-9);
}

TEST(OpenFor, NoDoorClosesThatWasToBeOpen) {
  base::Random random(4);
  for (int round = 0; round < 200; ++round) {
    Door door;
    if (round % 3 == 1) door.swings = {{0.0, random.uniform(0.0, 1.5)}};
    std::vector<std::pair<double, double>> stays;
    for (int i = 0; i < 6; ++i) {
      const Door before = door;
      const double from = random.uniform(0.0, 40.0);
      const double to = from + random.uniform(0.0, 8.0);
      openFor(door, from, to);
      stays.emplace_back(from, to);
      expectAscending(door.swings);
      for (double time = -5.0; time < 60.0; time += 0.13) {
        EXPECT_GE(openingAngle(door, time), openingAngle(before, time) - 1e-9);
        const bool isAround = time > from - kSwingTime - 1e-6 && time < to + kSwingTime + 1e-6;
        if (!isAround) {
          EXPECT_NEAR(openingAngle(door, time), openingAngle(before, time), 1e-4);
        }
      }
    }
    for (const auto& [from, to] : stays) {
      EXPECT_GT(openingAngle(door, from), 89.9 * kDegree);
      EXPECT_GT(openingAngle(door, std::midpoint(from, to)), 89.9 * kDegree);
    }
  }
}

TEST(OpenFor, AnAjarDoorGoesBackToWhereItWas) {
  Door door{.swings = {{0.0, 0.4}}};
  openFor(door, 10.0, 12.0, 1.4);
  EXPECT_NEAR(openingAngle(door, 0.0), 0.4, 1e-9);
  EXPECT_NEAR(openingAngle(door, 11.0), 1.4, 1e-9);
  EXPECT_NEAR(openingAngle(door, 30.0), 0.4, 1e-9);
}

class PeopleBySeed : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(, PeopleBySeed, testing::Values(1, 2, 3, 4, 5));

TEST_P(PeopleBySeed, StayOnFreeFloor) {
  const auto building = peopled(GetParam());
  const FloorGrid grid(building, 0, 0.2);
  const auto walls = test::wallsOf(building, 0);
  for (const auto& person : building.people) {
    for (std::size_t i = 0; i < person.way.size(); ++i) {
      EXPECT_TRUE(grid.isFree(person.way[i].position)) << person.id << ' ' << person.way[i].position.transpose();
      if (i == 0) continue;
      EXPECT_GT(person.way[i].time, person.way[i - 1].time);
      EXPECT_FALSE(test::crossesWalls(walls, person.way[i - 1].position, person.way[i].position));
    }
    EXPECT_EQ(person.way.front().time, 0.0);
    EXPECT_GE(person.way.back().time, kDuration);
  }
}

TEST_P(PeopleBySeed, WalkAsPeopleDo) {
  const auto building = peopled(GetParam());
  int moving = 0;
  for (const auto& person : building.people) {
    for (std::size_t i = 1; i < person.way.size(); ++i) {
      const double speed =
          (person.way[i].position - person.way[i - 1].position).norm() / (person.way[i].time - person.way[i - 1].time);
      if (speed == 0.0) continue;
      ++moving;
      EXPECT_GT(speed, 0.89);
      EXPECT_LT(speed, 1.41);
    }
  }
  EXPECT_GT(moving, 20);
}

TEST_P(PeopleBySeed, FindDoorsOpenWhereTheyPass) {
  const auto building = peopled(GetParam());
  int passages = 0;
  for (const auto& person : building.people) {
    for (double time = 0.0; time < kDuration; time += 0.05) {
      const auto position = positionAt(person, time);
      for (const auto& door : building.doors) {
        const Eigen::Vector2d inDoor = geometry::inverse(door.pose) * position;
        if (door.leaves == 0 || std::abs(inDoor.x()) > 0.3 || std::abs(inDoor.y()) > door.width / 2.0) continue;
        // Only where the way leads through, not past it.
        if (roomAt(building, 0, position) != kOutside) continue;
        ++passages;
        EXPECT_GT(openingAngle(door, time), 80.0 * kDegree) << person.id << " at " << time;
      }
    }
  }
  EXPECT_GT(passages, 0);
  for (const auto& door : building.doors) expectAscending(door.swings);
}

TEST_P(PeopleBySeed, SitOnChairsAndFaceWhereTheseDo) {
  auto furnished = test::office();
  for (int i = 0; i < 6; ++i) {
    test::addThing(furnished, i % 2 == 0 ? "chair" : "office_chair", {2.0 + 5.0 * i, -2.5}, {0.5, 0.5, 0.9}, 0.7 * i);
  }
  const auto building = peopled(GetParam(), furnished);
  int sitters = 0;
  for (const auto& person : building.people) {
    if (!person.sits) continue;
    ++sitters;
    const auto isIts = [&](const Thing& chair) {
      return (chair.T_world_thing.translation().head<2>() - person.way.front().position).norm() < 1e-9 &&
             std::abs(geometry::normalizeAngle(geometry::yaw(chair.T_world_thing) - person.heading)) < 1e-9;
    };
    EXPECT_EQ(std::ranges::count_if(building.things, isIts), 1);
  }
  EXPECT_GE(sitters, 1);
}

TEST(People, AreMoreInLargerBuildings) {
  const auto count = [](const Building& building) { return building.people.size(); };
  EXPECT_GE(count(peopled(1)), 3U);
  EXPECT_LE(count(peopled(1, test::corridorWithTwoRooms())), 2U);
  EXPECT_GT(count(peopled(1, test::twoStoreyOffice())), count(peopled(1)));
}

TEST(People, AreTheSameForTheSameSeedAlone) {
  EXPECT_TRUE(isSame(peopled(8), peopled(8)));
  EXPECT_FALSE(isSame(peopled(8), peopled(9)));
}

TEST(People, OfTheSourceAreKeptAndDoorsOpenForThem) {
  auto building = test::corridorWithTwoRooms();
  building.people = {{.id = "guard", .way = {{0.0, {3.0, 1.0}}, {10.0, {3.0, 1.0}}, {13.0, {3.0, 4.0}}}}};
  populate(building, 5, kDuration);
  ASSERT_EQ(building.people.size(), 1U);
  EXPECT_EQ(building.people.front().id, "guard");
  EXPECT_GT(openingAngle(building.doors[0], 11.1), 80.0 * kDegree);
  EXPECT_EQ(openingAngle(building.doors[0], 5.0), 0.0);
  EXPECT_TRUE(building.doors[1].swings.empty());
}

TEST(People, ABuildingWithoutFloorHasNone) {
  Building building{.name = "nothing", .storeys = {{}}};
  populate(building, 1, kDuration);
  EXPECT_TRUE(building.people.empty());
}

TEST(People, AreWhereTheirWayHasThem) {
  const Person person{.way = {{1.0, {0.0, 0.0}}, {3.0, {2.0, 0.0}}, {4.0, {2.0, 0.0}}}};
  EXPECT_EQ(positionAt(person, 0.0), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(positionAt(person, 2.0), Eigen::Vector2d(1.0, 0.0));
  EXPECT_EQ(positionAt(person, 3.5), Eigen::Vector2d(2.0, 0.0));
  EXPECT_EQ(positionAt(person, 9.0), Eigen::Vector2d(2.0, 0.0));
}

}  // namespace
}  // namespace prodomos::simulation
