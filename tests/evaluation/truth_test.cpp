// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/truth.hpp"

#include "prodomos/base/error.hpp"

#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prodomos::evaluation {
namespace {

using testing::HasSubstr;

base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(seconds);
}

geometry::Pose3 somePose() {
  return geometry::fromYawPitchRoll({1.25, -2.5, 0.3}, 0.7, -0.2, 0.1);
}

Truth everything() {
  Truth truth;
  truth.building = "a <house> \"of\" mine\n";
  truth.seed = std::numeric_limits<std::uint64_t>::max();
  truth.labels = "degraded";
  truth.classes = {{0, "unlabeled"}, {7, "door"}};
  truth.storeys = {{0.0, 2.8}, {3.1, 2.5}};
  truth.rooms = {{.id = "r1",
                  .storey = 1,
                  .label = "CLASSROOM",
                  .use = "room",
                  .outline = {{0, 0}, {1.0 / 3.0, 0}, {0, 1e-9}},
                  .entered = at(976052857.337530123)},
                 {.id = "r2", .use = "corridor"}};
  truth.doors = {{.id = "d1",
                  .instance = 65535,
                  .storey = 1,
                  .rooms = {"r1", ""},
                  .T_world_door = somePose(),
                  .width = 0.9,
                  .height = 2.05,
                  .wallThickness = 0.2,
                  .leafOffset = -0.08,
                  .leaves = 1,
                  .hingeSide = map::HingeSide::kRight,
                  .states = {{at(0), 0.0, map::DoorState::kClosed}, {at(2.5), 1.2, map::DoorState::kOpen}},
                  .sighting = {0.93, true, at(1.5), true, {at(1.0), at(1.1)}}}};
  truth.stairs = {{.id = "s1",
                   .instance = 2,
                   .storeys = {0, 1},
                   .rooms = {"r2", "r1"},
                   .foot = {1, 2, 0},
                   .head = {5, 2, 3.1},
                   .direction = -1.5,
                   .width = 1.2,
                   .stepDepth = 0.29,
                   .stepHeight = 0.17,
                   .stepCount = 17,
                   .sighting = {}}};
  truth.objects = {{.id = "o1",
                    .instance = 3,
                    .classId = 7,
                    .mobility = map::Mobility::kQuasiStatic,
                    .size = {1, 2, 3},
                    .poses = {{at(0), somePose()}, {at(1), geometry::Pose3::Identity()}},
                    .seen = 0.25}};
  TruePersonState state{.time = at(4), .position = {1, 1, 0}, .heading = 3.0, .velocity = {0.1, -1, 0}, .pixels = 1200};
  state.joints[13] = {1, 1, 0.1};
  truth.people = {{.id = "p1", .instance = 4, .states = {state, {}}}};
  truth.planes = {
      {.id = "w1", .classId = 7, .T_world_plane = somePose(), .outline_in_plane = {{0, 0}, {1, 0}, {1, 1}}}};
  truth.lifts = {{.id = "l1", .rooms = {"r1", "r2"}, .outline = {{0, 0}, {1, 0}, {1, 1}}}};
  truth.trajectory = {{at(0), geometry::Pose3::Identity()}, {at(0.1), somePose()}};
  return truth;
}

struct TruthFile : testing::Test {
  test::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "log.truth.json";

  Truth again(const Truth& truth) const {
    writeTruth(truth, file);
    return readTruth(file);
  }
  /// The file's text with one piece of it exchanged.
  void exchange(const std::string& piece, const std::string& other) const {
    std::string text = test::readFile(file);
    const auto place = text.find(piece);
    ASSERT_NE(place, std::string::npos) << piece;
    text.replace(place, piece.size(), other);
    folder.write("log.truth.json", text);
  }
  std::string fault() const {
    try {
      readTruth(file);
    } catch (const base::FileError& fault) {
      return fault.what();
    }
    return "none";
  }
};

TEST_F(TruthFile, ComesBackAsItWasWritten) {
  const auto truth = everything();
  const auto read = again(truth);
  EXPECT_EQ(read.building, truth.building);
  EXPECT_EQ(read.seed, truth.seed);
  EXPECT_EQ(read.classes, truth.classes);
  ASSERT_EQ(read.rooms.size(), 2U);
  EXPECT_EQ(read.rooms[0].outline, truth.rooms[0].outline);
  EXPECT_EQ(read.rooms[0].entered, truth.rooms[0].entered);
  EXPECT_EQ(read.rooms[1].entered, std::nullopt);
  const auto& door = read.doors.at(0);
  EXPECT_TRUE(door.T_world_door.isApprox(somePose(), 1e-12));
  EXPECT_EQ(door.rooms, truth.doors[0].rooms);
  EXPECT_EQ(door.leafOffset, -0.08);
  EXPECT_EQ(door.hingeSide, map::HingeSide::kRight);
  EXPECT_EQ(door.states.at(1).state, map::DoorState::kOpen);
  EXPECT_EQ(door.states.at(1).time, at(2.5));
  EXPECT_EQ(door.sighting.images, truth.doors[0].sighting.images);
  EXPECT_EQ(door.sighting.since, at(1.5));
  EXPECT_EQ(read.stairs.at(0).head, truth.stairs[0].head);
  EXPECT_EQ(read.stairs.at(0).stepCount, 17);
  EXPECT_EQ(read.objects.at(0).mobility, map::Mobility::kQuasiStatic);
  EXPECT_EQ(read.people.at(0).states.at(0).joints, truth.people[0].states[0].joints);
  EXPECT_EQ(read.planes.at(0).outline_in_plane, truth.planes[0].outline_in_plane);
  EXPECT_EQ(read.lifts.at(0).rooms, truth.lifts[0].rooms);
  EXPECT_EQ(read.trajectory.at(1).time, at(0.1));
}

TEST_F(TruthFile, IsTheSameBytesWhenWrittenAgain) {
  auto truth = everything();
  truth.doors[0].T_world_door = geometry::Pose3::Identity();
  truth.objects[0].poses.clear();
  truth.planes.clear();
  truth.trajectory.pop_back();  // a quaternion may differ in its last digit
  const auto read = again(truth);
  const auto bytes = test::readFile(file);
  writeTruth(read, file);
  EXPECT_EQ(test::readFile(file), bytes);
}

TEST_F(TruthFile, OfNothingIsEmpty) {
  const auto read = again({});
  EXPECT_TRUE(read.rooms.empty());
  EXPECT_TRUE(read.trajectory.empty());
}

TEST_F(TruthFile, KeepsWhatIsNotANumber) {
  auto truth = everything();
  truth.doors[0].height = std::numeric_limits<double>::quiet_NaN();
  truth.people[0].states[0].joints[2].y() = std::numeric_limits<double>::quiet_NaN();
  truth.stairs[0].foot.z() = std::numeric_limits<double>::infinity();
  const auto read = again(truth);
  EXPECT_TRUE(std::isnan(read.doors[0].height));
  EXPECT_TRUE(std::isnan(read.people[0].states[0].joints[2].y()));
  EXPECT_EQ(read.people[0].states[0].joints[2].x(), 0.0);
  EXPECT_TRUE(std::isnan(read.stairs[0].foot.z()));
}

TEST_F(TruthFile, HoldsLongLogs) {
  Truth truth;
  for (int i = 0; i < 3000; ++i) truth.trajectory.push_back({at(0.05 * i), geometry::toPose3({0.01 * i, 0, 0})});
  truth.people.resize(5);
  for (auto& person : truth.people) person.states.resize(1000);
  const auto read = again(truth);
  EXPECT_EQ(read.trajectory.size(), 3000U);
  EXPECT_EQ(read.people[4].states.size(), 1000U);
}

TEST_F(TruthFile, MayHoldKeysThatCameLater) {
  again(everything());
  exchange("\"seed\"", "\"weather\": \"fine\", \"seed\"");
  EXPECT_EQ(fault(), "none");
}

TEST_F(TruthFile, ThatIsMissingIsNamed) {
  EXPECT_THAT(fault(), HasSubstr("log.truth.json: expected a truth file"));
}

TEST_F(TruthFile, ThatIsCutIsNamedWithTheByte) {
  again(everything());
  const auto text = test::readFile(file);
  folder.write("log.truth.json", text.substr(0, text.size() / 2));
  EXPECT_THAT(fault(), HasSubstr("log.truth.json, byte "));
}

TEST_F(TruthFile, OfAnotherKindOrVersionIsRefused) {
  folder.write("log.truth.json", "[1, 2]");
  EXPECT_THAT(fault(), HasSubstr("format: expected \"prodomos truth\""));
  folder.write("log.truth.json", "{\"format\": 3}");
  EXPECT_THAT(fault(), HasSubstr("format: expected \"prodomos truth\""));
  again(everything());
  exchange("\"version\": 1", "\"version\": 2");
  EXPECT_THAT(fault(), HasSubstr("version: expected 1, found 2"));
}

TEST_F(TruthFile, FaultsNameThePlace) {
  const std::vector<std::array<std::string, 3>> faults = {
      {"\"width\":0.9", "\"breadth\":0.9", "doors[0].width: expected a value, found no such key"},
      {"\"width\":0.9", "\"width\":\"wide\"", "doors[0].width: expected a number, found \"wide\""},
      {"\"hinge_side\":\"right\"", "\"hinge_side\":\"top\"",
       "doors[0].hinge_side: expected one of unknown, left, right, found \"top\""},
      {"\"instance\":65535", "\"instance\":65536", "doors[0].instance: expected a smaller number, found 65536"},
      {"\"instance\":65535", "\"instance\":-1", "doors[0].instance: expected a smaller number, found -1"},
      {"\"leaves\":1", "\"leaves\":1.5", "doors[0].leaves: expected a whole number, found 1.5"},
      {"\"visible\":true", "\"visible\":1", "doors[0].sighting.visible: expected true or false, found 1"},
      {"\"time\":\"2.5\"", "\"time\":2.5", "doors[0].states[1].time: expected a time"},
      {"[\"r1\",\"\"]", "[\"r1\"]", "doors[0].rooms: expected an array of 2"},
      {"\"foot\":[1.0,2.0,0.0]", "\"foot\":[1.0,2.0,true]", "stairs[0].foot[2]: expected a number, found true"},
      {"[0.0,0.0,0.0,0.0,0.0,0.0,1.0]", "[0.0,0.0,0.0,0.0,0.0,0.0,0.0]",
       "objects[0].poses[1].pose: expected x y z qx qy qz qw with a quaternion of length 1"},
      {"{\"0\":\"unlabeled\"", "{\"zero\":\"unlabeled\"", "classes: expected names by number"},
  };
  for (const auto& [piece, other, expected] : faults) {
    again(everything());
    exchange(piece, other);
    EXPECT_THAT(fault(), HasSubstr("log.truth.json, " + expected));
  }
}

TEST(TruthPath, LiesBesideTheLog) {
  EXPECT_EQ(truthPath("a/b.rawlog"), "a/b.truth.json");
  EXPECT_EQ(truthPath("a/b.rawlog.gz"), "a/b.truth.json");
  EXPECT_EQ(truthPath("b"), "b.truth.json");
}

TEST_F(TruthFile, ThatCannotBeWrittenIsNamed) {
  EXPECT_THROW(writeTruth({}, folder.path() / "nowhere" / "log.truth.json"), base::FileError);
}

}  // namespace
}  // namespace prodomos::evaluation
