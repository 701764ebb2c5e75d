// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// All plans of the data set. PRODOMOS_TABLE=1 prints the table of docs/floor-plans.md.
#include "prodomos/simulation/floor_plan.hpp"

#include "simulation/plans/plan_drawing.hpp"
#include "simulation/polygons.hpp"
#include "support/datasets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::simulation {
namespace {

constexpr FloorPlanOptions kOptions{.seed = 1, .storeys = 2};

std::vector<std::filesystem::path> allPlans() {
  std::vector<std::filesystem::path> plans;
  for (const char* kind : {"buildings/plans/office", "buildings/plans/school"}) {
    const auto folder = test::dataset(kind);
    if (!folder) continue;
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
      if (entry.path().extension() == ".xml") plans.push_back(entry.path());
    }
  }
  std::ranges::sort(plans);
  return plans;
}

class FloorPlansOfTheDataSet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (const auto& plan : allPlans()) buildings_.push_back(readFloorPlan(plan, kOptions));
  }
  static void TearDownTestSuite() { buildings_.clear(); }
  void SetUp() override {
    if (buildings_.empty()) GTEST_SKIP() << "needs buildings/plans";
  }

  static inline std::vector<Building> buildings_;
};

bool hasRemark(const Building& building, const std::string& about, const std::string& what = "") {
  return std::ranges::any_of(building.remarks, [&](const std::string& remark) {
    return remark.find(about) != std::string::npos && remark.find(what) != std::string::npos;
  });
}

/// Corners of what a door takes of its wall and a hand's breadth before it.
Polygon bodyOf(const Door& door) {
  const double x = door.wallThickness / 2.0 + 0.05;
  const double y = door.width / 2.0;
  using Point = Eigen::Vector2d;
  return {door.pose * Point(-x, -y), door.pose * Point(x, -y), door.pose * Point(x, y), door.pose * Point(-x, y)};
}

TEST_F(FloorPlansOfTheDataSet, AllAreBuildings) {
  EXPECT_EQ(buildings_.size(), 42U);
  for (const auto& building : buildings_) {
    SCOPED_TRACE(building.name);
    EXPECT_GE(building.rooms.size(), 2U * 8U);
    EXPECT_GE(building.doors.size(), 2U * 8U);
  }
}

TEST_F(FloorPlansOfTheDataSet, RoomsAreSimpleAndCounterClockwise) {
  for (const auto& building : buildings_) {
    for (const auto& room : building.rooms) {
      SCOPED_TRACE(building.name + " " + room.id);
      EXPECT_GT(signedArea(room.outline), 0.4);
      EXPECT_FALSE(findSelfCrossing(room.outline));
    }
  }
}

TEST_F(FloorPlansOfTheDataSet, NoTwoRoomsOverlap) {
  for (const auto& building : buildings_) {
    for (std::size_t i = 0; i < building.rooms.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto& a = building.rooms[i];
        const auto& b = building.rooms[j];
        if (a.storey != 0 || b.storey != 0) continue;
        EXPECT_EQ(overlapArea(a.outline, b.outline), 0.0) << building.name << " " << a.id << " " << b.id;
      }
    }
  }
}

TEST_F(FloorPlansOfTheDataSet, EveryDoorLiesBetweenItsRooms) {
  for (const auto& building : buildings_) {
    for (const auto& door : building.doors) {
      SCOPED_TRACE(building.name + " " + door.id);
      const double x = door.wallThickness / 2.0 + 0.3;
      EXPECT_EQ(roomAt(building, door.storey, door.pose * Eigen::Vector2d(-x, 0.0)), door.rooms[0]);
      EXPECT_EQ(roomAt(building, door.storey, door.pose * Eigen::Vector2d(x, 0.0)), door.rooms[1]);
      // The wall itself is nobody's.
      EXPECT_EQ(roomAt(building, door.storey, {door.pose.x, door.pose.y}), kOutside);
      EXPECT_GE(door.width, 0.6 - 1e-9);
    }
  }
}

TEST_F(FloorPlansOfTheDataSet, NoTwoDoorsOverlap) {
  for (const auto& building : buildings_) {
    for (std::size_t i = 0; i < building.doors.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto& a = building.doors[i];
        const auto& b = building.doors[j];
        if (a.storey != b.storey) continue;
        EXPECT_EQ(overlapArea(bodyOf(a), bodyOf(b)), 0.0) << building.name << " " << a.id << " " << b.id;
      }
    }
  }
}

TEST_F(FloorPlansOfTheDataSet, RoomsAreJoinedAsDrawnButForWhatIsRemarked) {
  const auto plans = allPlans();
  for (std::size_t p = 0; p < plans.size(); ++p) {
    const Building& building = buildings_[p];
    SCOPED_TRACE(building.name);
    const auto drawing = readDrawing(plans[p]);
    std::vector<int> roomOf;
    int next = 0;
    for (const auto& space : drawing.spaces) {
      const bool isLeftOut = hasRemark(building, "space " + space.id, "is left out");
      roomOf.push_back(isLeftOut ? kOutside : next++);
      if (isLeftOut) continue;
      ASSERT_EQ(building.rooms[static_cast<std::size_t>(roomOf.back())].label, space.label);
    }
    using Pair = std::pair<int, int>;
    std::set<Pair> drawn;
    for (const auto& portal : drawing.portals) {
      if (hasRemark(building, "portal " + portal.id, "left out")) continue;
      drawn.insert(std::minmax(roomOf[portal.spaces[0]], roomOf[portal.spaces[1]]));
    }
    std::set<Pair> built;
    for (const auto& door : building.doors) {
      if (door.storey == 0) built.insert(std::minmax(door.rooms[0], door.rooms[1]));
    }
    EXPECT_EQ(built, drawn);
  }
}

TEST_F(FloorPlansOfTheDataSet, FewPortalsAreLeftOut) {
  std::size_t portals = 0;
  std::size_t leftOut = 0;
  for (const auto& plan : allPlans()) portals += readDrawing(plan).portals.size();
  for (const auto& building : buildings_) {
    leftOut += static_cast<std::size_t>(std::ranges::count_if(building.remarks, [](const std::string& remark) {
      return remark.starts_with("portal") && remark.find("left out") != std::string::npos;
    }));
  }
  EXPECT_GT(portals, 1800U);
  EXPECT_LT(static_cast<double>(leftOut), 0.015 * static_cast<double>(portals));
}

TEST_F(FloorPlansOfTheDataSet, FlightsStandInTheirStairwells) {
  for (const auto& building : buildings_) {
    for (const auto& stairs : building.stairs) {
      SCOPED_TRACE(building.name + " " + stairs.id);
      const auto& room = building.rooms[static_cast<std::size_t>(stairs.rooms[0])];
      EXPECT_EQ(room.use, RoomUse::kStairs);
      const Eigen::Vector2d ahead(std::cos(stairs.direction), std::sin(stairs.direction));
      const Eigen::Vector2d left(-ahead.y(), ahead.x());
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d aside = side * (stairs.width / 2.0 - 0.01) * left;
        EXPECT_TRUE(contains(room.outline, stairs.foot.head<2>() + aside));
        EXPECT_TRUE(contains(room.outline, headOf(stairs).head<2>() + aside));
      }
    }
  }
}

TEST_F(FloorPlansOfTheDataSet, ATableOfThemCanBePrinted) {
  if (std::getenv("PRODOMOS_TABLE") == nullptr) GTEST_SKIP() << "set PRODOMOS_TABLE=1";
  std::puts("| plan | rooms | m² | doors | double | doorways | passages | lifts | stairwells: used / all | remarks |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|");
  for (const auto& building : buildings_) {
    std::array<int, 3> leaves{};
    int rooms = 0;
    int wells = 0;
    int passages = 0;
    double area = 0.0;
    std::set<int> used;
    for (const auto& room : building.rooms) {
      if (room.storey != 0) continue;
      ++rooms;
      area += signedArea(room.outline);
      if (room.use == RoomUse::kStairs) ++wells;
    }
    for (const auto& door : building.doors) {
      if (door.storey != 0 || isLiftDoor(building, door)) continue;
      ++leaves[static_cast<std::size_t>(door.leaves)];
      if (door.leaves == 0 && door.height > 2.15) ++passages;
    }
    for (const auto& stairs : building.stairs) used.insert(stairs.rooms[0]);
    std::printf("| %s | %d | %.0f | %d | %d | %d | %d | %zu | %zu / %d | %zu |\n", building.name.c_str(), rooms, area,
                leaves[1], leaves[2], leaves[0] - passages, passages, building.lifts.size(), used.size(), wells,
                building.remarks.size());
  }
  for (const auto& building : buildings_) {
    for (const auto& remark : building.remarks) std::printf("%s: %s\n", building.name.c_str(), remark.c_str());
  }
}

}  // namespace
}  // namespace prodomos::simulation
