// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/entity.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/map/topological_graph.hpp"

#include "map/names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace prodomos::map {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// One of each class; the compiler asks for a new one here.
std::vector<EntityAttributes> oneOfEach() {
  std::vector<EntityAttributes> all = {
      Staircase{.height = -3.2, .stepWidth = 1.0 / 3.0, .stepHeight = 0.17, .stepDepth = 0.28, .stepCount = 17},
      Door{.width = 0.9, .height = 2.1, .hasLeaf = false, .hingeSide = HingeSide::kRight, .state = DoorState::kAjar},
      Human{.dominantSide = -1, .velocity = {0.1, -0.2, 0.3}},
      ObjectBox{.classId = 12, .size = {1, 2, 3}, .velocity = {4, 5, 6e-300}},
      Cuboid{.classId = 0, .size = {0.1, 0.2, 0.3}},
      PlanePatch{.area = 2.5, .outline_in_patch = {{0, 0}, {1.25, 0}, {1, 2}}}};
  EXPECT_EQ(all.size(), std::variant_size_v<EntityAttributes>);
  return all;
}

EntityAttributes roundTrip(const EntityAttributes& attributes) {
  return entityAttributesFromJson(className(attributes), toJson(attributes));
}

TEST(Entity, AttributesOfEveryClassAreReadBackAsTheyAreWritten) {
  for (const auto& attributes : oneOfEach()) {
    const auto read = roundTrip(attributes);
    EXPECT_EQ(read.index(), attributes.index());
    EXPECT_EQ(toJson(read), toJson(attributes)) << className(attributes);
  }
}

TEST(Entity, AttributesKeepEveryValue) {
  const auto all = oneOfEach();
  const auto stairs = std::get<Staircase>(roundTrip(all[0]));
  EXPECT_EQ(stairs.height, -3.2);
  EXPECT_EQ(stairs.stepWidth, 1.0 / 3.0);
  EXPECT_EQ(stairs.stepHeight, 0.17);
  EXPECT_EQ(stairs.stepDepth, 0.28);
  EXPECT_EQ(stairs.stepCount, 17);
  const auto door = std::get<Door>(roundTrip(all[1]));
  EXPECT_EQ(door.width, 0.9);
  EXPECT_EQ(door.height, 2.1);
  EXPECT_FALSE(door.hasLeaf);
  EXPECT_EQ(door.hingeSide, HingeSide::kRight);
  EXPECT_EQ(door.state, DoorState::kAjar);
  const auto human = std::get<Human>(roundTrip(all[2]));
  EXPECT_EQ(human.dominantSide, -1);
  EXPECT_EQ(human.velocity, Eigen::Vector3d(0.1, -0.2, 0.3));
  const auto box = std::get<ObjectBox>(roundTrip(all[3]));
  EXPECT_EQ(box.classId, 12);
  EXPECT_EQ(box.size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(box.velocity, Eigen::Vector3d(4, 5, 6e-300));
  const auto cuboid = std::get<Cuboid>(roundTrip(all[4]));
  EXPECT_EQ(cuboid.classId, 0);
  EXPECT_EQ(cuboid.size, Eigen::Vector3d(0.1, 0.2, 0.3));
  const auto patch = std::get<PlanePatch>(roundTrip(all[5]));
  EXPECT_EQ(patch.area, 2.5);
  EXPECT_EQ(patch.outline_in_patch, (std::vector<Eigen::Vector2d>{{0, 0}, {1.25, 0}, {1, 2}}));
}

TEST(Entity, AttributesMayBeNotANumber) {
  const Eigen::Vector3d unknown(kNan, 1.0, kNan);
  const auto stairs = std::get<Staircase>(roundTrip(Staircase{kNan, kNan, kNan, kNan, 0}));
  EXPECT_TRUE(std::isnan(stairs.height) && std::isnan(stairs.stepWidth) && std::isnan(stairs.stepDepth));
  const auto door = std::get<Door>(roundTrip(Door{.width = kNan, .height = kNan}));
  EXPECT_TRUE(std::isnan(door.width) && std::isnan(door.height));
  const auto human = std::get<Human>(roundTrip(Human{.velocity = unknown}));
  EXPECT_TRUE(std::isnan(human.velocity.x()) && human.velocity.y() == 1.0 && std::isnan(human.velocity.z()));
  const auto box = std::get<ObjectBox>(roundTrip(ObjectBox{.size = unknown, .velocity = unknown}));
  EXPECT_TRUE(std::isnan(box.size.x()) && std::isnan(box.velocity.z()));
  EXPECT_TRUE(std::isnan(std::get<Cuboid>(roundTrip(Cuboid{.size = unknown})).size.z()));
  const auto patch = std::get<PlanePatch>(roundTrip(PlanePatch{.area = kNan, .outline_in_patch = {{kNan, 2.0}}}));
  EXPECT_TRUE(std::isnan(patch.area) && std::isnan(patch.outline_in_patch.at(0).x()));
}

TEST(Entity, AttributesAreNotReadFromAnythingElse) {
  for (const auto& attributes : oneOfEach()) {
    for (const char* json : {"", "{", "[]", "null", "5", "{}", R"({"width": "wide"})"}) {
      EXPECT_THROW(entityAttributesFromJson(className(attributes), json), base::Error) << className(attributes) << json;
    }
  }
  EXPECT_THROW(entityAttributesFromJson("dragon", "{}"), base::Error);
  EXPECT_THROW(entityAttributesFromJson(
                   "door", R"({"width":1,"height":2,"has_leaf":true,"hinge_side":"middle","state":"open"})"),
               base::Error);
  EXPECT_THROW(entityAttributesFromJson("cuboid", R"({"class":1,"size":[1,2]})"), base::Error);
}

TEST(Entity, ClassesHaveTheNamesThatStandInMapFiles) {
  std::vector<std::string_view> names;
  for (const auto& attributes : oneOfEach()) names.push_back(className(attributes));
  EXPECT_THAT(names, testing::ElementsAre("staircase", "door", "human", "object_box", "cuboid", "plane_patch"));
}

TEST(Entity, DoorsMayBeMovedAndHumansMove) {
  std::vector<Mobility> mobilities;
  for (const auto& attributes : oneOfEach()) mobilities.push_back(mobility(attributes));
  EXPECT_THAT(mobilities, testing::ElementsAre(Mobility::kStatic, Mobility::kQuasiStatic, Mobility::kDynamic,
                                               Mobility::kDynamic, Mobility::kStatic, Mobility::kStatic));
}

// --- the run of a flight

Entity flight(double height, double stepHeight, double stepDepth) {
  Entity entity;
  entity.T_submap_entity = geometry::toPose3({5.0, -1.0, 0.5}, height / 2.0);
  entity.attributes =
      Staircase{.height = height, .stepWidth = 1.2, .stepHeight = stepHeight, .stepDepth = stepDepth, .stepCount = 15};
  return entity;
}

TEST(RunOfAFlight, IsThatOfItsSteps) {
  for (const double height : {2.55, -2.55}) {
    auto entity = flight(height, 0.17, 0.28);
    EXPECT_NEAR(runOf(entity).value(), 15 * 0.28, 1e-9) << "up or down";
    entity.points_in_submap = {{0, 0, 0}, {1, 1, 1}};
    EXPECT_NEAR(runOf(entity).value(), 15 * 0.28, 1e-9) << "whatever points one has of it";
  }
}

TEST(RunOfAFlight, IsThatOfItsPointsWhereStepsAreNotMeasured) {
  auto entity = flight(2.5, 0.0, 0.28);
  EXPECT_EQ(runOf(entity), std::nullopt);
  for (const double along : {-1.5, 0.3, 2.0}) {
    const Eigen::Vector3d point_in_entity(along, 0.4 * along, 7.0 - along);
    entity.points_in_submap.push_back((entity.T_submap_entity * point_in_entity).cast<float>());
  }
  EXPECT_NEAR(runOf(entity).value(), 3.5, 1e-5);
}

TEST(RunOfAFlight, IsNotToldOfWhatHasNone) {
  EXPECT_EQ(runOf(flight(kNan, 0.17, 0.28)), std::nullopt);
  EXPECT_EQ(runOf(flight(2.5, kNan, 0.28)), std::nullopt);
  EXPECT_EQ(runOf(flight(2.5, 0.17, -0.28)), std::nullopt);
  auto door = flight(2.5, 0.17, 0.28);
  door.points_in_submap = {{0, 0, 0}, {1, 1, 1}};
  door.attributes = Door{.width = 0.9};
  EXPECT_EQ(runOf(door), std::nullopt);
}

// --- every name of every enumeration

template <typename Enum>
void expectNames(const std::vector<std::string_view>& names) {
  const auto last = static_cast<Enum>(names.size() - 1);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(toString(static_cast<Enum>(i)), names[i]);
    EXPECT_EQ(fromName(names[i], last), static_cast<Enum>(i));
  }
  EXPECT_THROW(fromName("nonsense", last), base::Error);
  EXPECT_THROW(fromName("", last), base::Error);
}

TEST(Names, AreReadBackAsTheyAreWritten) {
  expectNames<Mobility>({"static", "quasi_static", "dynamic"});
  expectNames<HingeSide>({"unknown", "left", "right"});
  expectNames<DoorState>({"unknown", "closed", "ajar", "open"});
  expectNames<PredictionState>({"open", "confirmed", "refuted", "merged"});
  expectNames<SessionState>({"running", "complete"});
  expectNames<SubMapKind>({"observed", "predicted"});
  expectNames<EdgeKind>({"travelled", "door", "stairs", "loop", "lift"});
}

TEST(Names, ThatAreNotKnownAreAnsweredWithThoseThatAre) {
  try {
    fromName("shut", DoorState::kOpen);
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_STREQ(error.what(), "expected one of unknown, closed, ajar, open, found 'shut'");
  }
}

}  // namespace
}  // namespace prodomos::map
