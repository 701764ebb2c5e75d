// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/person_detector.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/perception/person_tracker.hpp"
#include "prodomos/sensors/camera.hpp"

#include "support/datasets.hpp"
#include "support/person_views.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

namespace prodomos::perception {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;
constexpr double kTime = 12.0;

/// Three metres ahead of a camera at (-3, 0, 1.2) that looks along x.
simulation::Person someone(double heading) {
  return {.id = "someone", .height = 1.75, .heading = heading, .way = {{0.0, {0.0, 0.0}}}, .look = 3};
}

test::PersonView facingTheCamera(double roll = 0.0) {
  return test::lookAt(someone(kPi), kTime, test::levelCamera({-3.0, 0.0, 1.2}, roll));
}

/// What a side file would tell, were it right.
sensors::KeyPoints trueJoints(const test::PersonView& view) {
  const sensors::Camera camera(view.frame.camera, view.frame.depth.width(), view.frame.depth.height());
  sensors::PersonKeyPoints person;
  for (const Vector3d& joint : view.truth.joints) {
    const Vector3d p = view.T_world_camera.inverse() * joint;
    const Vector2d pixel = camera.pixel({p.x() / p.z(), p.y() / p.z()});
    person.joints.push_back({pixel.x(), pixel.y(), 0.9});
  }
  return {{person}};
}

double turnBetween(double a, double b) {
  return std::abs(geometry::normalizeAngle(a - b));
}

double metresOff(const PersonSighting& sighting, const test::PersonView& view) {
  return (sighting.position_in_submap - view.truth.position).head<2>().norm();
}

// --- Joints of side files
// ---------------------------------------------------------------------------------------------

TEST(PersonDetector, LocatesAPersonWhoseJointsAreTold) {
  const PersonDetector detector({});
  const auto view = facingTheCamera();
  const auto people = detector.find(view.view(), trueJoints(view));
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_LT(metresOff(people[0], view), 0.06);
  EXPECT_DOUBLE_EQ(people[0].position_in_submap.z(), 0.0);
  ASSERT_TRUE(people[0].heading);
  EXPECT_LT(turnBetween(*people[0].heading, kPi), 0.2);
  EXPECT_GT(people[0].facing, 1.0);
  ASSERT_TRUE(people[0].joints_in_submap[2]);
  EXPECT_LT((*people[0].joints_in_submap[2] - view.truth.joints[2]).norm(), 0.1);
}

TEST(PersonDetector, TellsAllHeadingsByTheSidesOfJoints) {
  const PersonDetector detector({});
  for (const double heading : {-2.6, -2.0, -0.7, 0.0, 0.7, 2.0, 2.6}) {
    const auto view = test::lookAt(someone(heading), kTime, test::levelCamera({-3.0, 0.0, 1.2}));
    const auto people = detector.find(view.view(), trueJoints(view));
    ASSERT_THAT(people, SizeIs(1)) << heading;
    EXPECT_LT(metresOff(people[0], view), 0.12) << heading;
    EXPECT_LT(turnBetween(*people[0].heading, view.truth.heading), 0.6) << heading;
  }
}

TEST(PersonDetector, LocatesInTheSubMapWhereverTheSensorIs) {
  const PersonDetector detector({});
  auto view = facingTheCamera();
  const auto T_submap_world = geometry::fromYawPitchRoll({5.0, -2.0, 1.5}, 2.0, 0.0, 0.0);
  view.T_world_camera = T_submap_world * view.T_world_camera;
  const auto joints = trueJoints(facingTheCamera());
  auto moved = view.view();
  moved.floor_z = 1.5;
  const auto people = detector.find(moved, joints);
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_LT((people[0].position_in_submap - T_submap_world * view.truth.position).norm(), 0.06);
  EXPECT_LT(turnBetween(*people[0].heading, kPi + 2.0), 0.2);
}

TEST(PersonDetector, SeesUprightWhenTheCameraLiesOnItsSide) {
  const PersonDetector detector({});
  for (const double roll : {kPi / 2.0, -kPi / 2.0, kPi, 0.6}) {
    const auto view = facingTheCamera(roll);
    const auto people = detector.find(view.view(), trueJoints(view));
    ASSERT_THAT(people, SizeIs(1)) << roll;
    EXPECT_LT(metresOff(people[0], view), 0.08) << roll;
    EXPECT_LT(turnBetween(*people[0].heading, kPi), 0.25) << roll;
  }
}

TEST(PersonDetector, AnUpperBodyBehindADeskCounts) {
  const PersonDetector detector({});
  simulation::Person person = someone(kPi);
  person.sits = true;
  const simulation::Material wood{.color = {150, 110, 70}};
  const auto desk = simulation::boxSurface(geometry::Pose3(Eigen::Translation3d(-0.6, 0.0, 0.37)), {0.6, 1.6, 0.74},
                                           wood, simulation::classId("table"), 0);
  const auto view = test::lookAt(person, kTime, test::levelCamera({-3.0, 0.0, 1.2}), {desk});
  auto joints = trueJoints(view);
  for (const std::size_t hidden : {8U, 9U, 10U, 11U, 12U, 13U}) joints.persons[0].joints[hidden].score = 0.0;
  const auto people = detector.find(view.view(), joints);
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_LT(metresOff(people[0], view), 0.12);
  EXPECT_LT(turnBetween(*people[0].heading, kPi), 0.3);
  EXPECT_FALSE(people[0].joints_in_submap[10]);
}

TEST(PersonDetector, ToleratesHolesInDepth) {
  const PersonDetector detector({});
  auto view = facingTheCamera();
  view.frame.depth = view.frame.depth.clone();
  base::Random random(5, "holes");
  for (int y = 0; y < view.frame.depth.height(); ++y) {
    for (int x = 0; x < view.frame.depth.width(); ++x) {
      const double chance = random.uniform();
      if (chance < 0.5) view.frame.depth(x, y) = 0.0F;
      if (chance < 0.1) view.frame.depth(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const auto people = detector.find(view.view(), trueJoints(view));
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_LT(metresOff(people[0], view), 0.06);
}

TEST(PersonDetector, APictureOfAPersonIsNone) {
  const PersonDetector detector({});
  auto view = facingTheCamera();
  view.frame.depth = sensors::Image<float>(view.frame.depth.width(), view.frame.depth.height(), 3.0F);
  EXPECT_THAT(detector.find(view.view(), trueJoints(view)), IsEmpty());
}

TEST(PersonDetector, NeitherADollNorAGiantIsAPerson) {
  const PersonDetector detector({});
  for (const float scale : {0.25F, 2.5F}) {
    auto view = facingTheCamera();
    view.frame.depth = view.frame.depth.clone();
    for (int y = 0; y < view.frame.depth.height(); ++y) {
      for (int x = 0; x < view.frame.depth.width(); ++x) view.frame.depth(x, y) *= scale;
    }
    auto scaled = view.view();
    scaled.floor_z = 1.2 * (1.0 - static_cast<double>(scale));  // feet stay on the floor
    EXPECT_THAT(detector.find(scaled, trueJoints(view)), IsEmpty()) << scale;
  }
}

TEST(PersonDetector, WithoutDepthThereIsNobody) {
  const PersonDetector detector({});
  const auto view = facingTheCamera();
  const auto joints = trueJoints(view);
  auto blind = view;
  blind.frame.depth = sensors::Image<float>(640, 480, 0.0F);
  EXPECT_THAT(detector.find(blind.view(), joints), IsEmpty());
  blind.frame.depth = sensors::Image<float>(640, 480, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(detector.find(blind.view(), joints), IsEmpty());
  blind.frame.depth = {};
  EXPECT_THAT(detector.find(blind.view(), joints), IsEmpty());
  blind = view;
  blind.frame.camera.fx = std::nan("");
  EXPECT_THAT(detector.find(blind.view(), joints), IsEmpty());
  blind = view;
  blind.frame.color = sensors::Image<sensors::Rgb>(320, 240);
  EXPECT_THAT(detector.find(blind.view(), joints), IsEmpty());
}

TEST(PersonDetector, JointsNeedNoColour) {
  const PersonDetector detector({});
  auto view = facingTheCamera();
  view.frame.color = {};
  const auto people = detector.find(view.view(), trueJoints(view));
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_THAT(people[0].appearance, testing::Each(0.0F));
}

TEST(PersonDetector, MadJointsAreNobody) {
  const PersonDetector detector({});
  const auto view = facingTheCamera();
  sensors::KeyPoints joints;
  EXPECT_THAT(detector.find(view.view(), joints), IsEmpty());
  joints.persons.resize(3);
  joints.persons[0].joints.assign(14, {std::nan(""), 1e9, 1.0});
  joints.persons[1].joints.assign(3, {-1e12, -1e12, 0.8});
  joints.persons[2].joints.assign(40, {10.0, 10.0, 0.0});
  EXPECT_THAT(detector.find(view.view(), joints), IsEmpty());
}

// --- Label images
// -----------------------------------------------------------------------------------------------------

TEST(PersonDetector, LocatesLabelledPersons) {
  const PersonDetector detector({.fromLabels = true});
  auto view = facingTheCamera();
  const auto& classes = simulation::classTable();
  for (const bool withInstances : {true, false}) {
    if (!withInstances) view.frame.labels->instances = {};
    const auto people = detector.findInLabels(view.view(), classes);
    ASSERT_THAT(people, SizeIs(1));
    EXPECT_LT(metresOff(people[0], view), 0.08);
    EXPECT_FALSE(people[0].heading);
  }
  EXPECT_THAT(detector.findInLabels(view.view(), {{1, "wall"}}), IsEmpty());
  view.frame.labels->classes = sensors::Image<std::uint16_t>(32, 24);
  EXPECT_THAT(detector.findInLabels(view.view(), classes), IsEmpty());
  view.frame.labels.reset();
  EXPECT_THAT(detector.findInLabels(view.view(), classes), IsEmpty());
}

// --- Networks
// ---------------------------------------------------------------------------------------------------------

TEST(PersonDetector, WithoutAFolderOfModelsFindsNobodyInImages) {
  PersonDetector detector({});
  EXPECT_THAT(detector.find(facingTheCamera().view()), IsEmpty());
}

TEST(PersonDetector, NamesTheModelThatIsMissing) {
  const test::TemporaryFolder folder;
  try {
    PersonDetector detector({.models = folder.path().string()});
    FAIL() << "no error";
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr((folder.path() / "yolo-fastest-1.1_body.cfg").string()));
  }
}

TEST(PersonDetector, NamesTheModelThatDoesNotLoad) {
  const auto models = test::dataset("models");
  if (!models) GTEST_SKIP() << "needs models";
  const test::TemporaryFolder folder;
  for (const auto& file : std::filesystem::directory_iterator(*models)) {
    std::filesystem::copy_file(file.path(), folder.path() / file.path().filename());
  }
  std::ofstream(folder.path() / "hourglass_pose14.pb") << "no network";
  try {
    PersonDetector detector({.models = folder.path().string()});
    FAIL() << "no error";
  } catch (const base::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("hourglass_pose14.pb"));
  }
}

TEST(PersonDetector, NetworksFindAPersonAndTellFrontFromBack) {
  const auto models = test::dataset("models");
  if (!models) GTEST_SKIP() << "needs models";
  PersonDetector detector({.models = models->string()});
  for (const double heading : {kPi, 0.0}) {
    const auto view = test::lookAt(someone(heading), kTime, test::levelCamera({-3.0, 0.0, 1.2}));
    const auto people = detector.find(view.view());
    ASSERT_THAT(people, SizeIs(1)) << heading;
    EXPECT_LT(metresOff(people[0], view), 0.08) << heading;
    ASSERT_TRUE(people[0].heading) << heading;
    EXPECT_LT(turnBetween(*people[0].heading, heading), 0.5) << heading;
    EXPECT_GT(people[0].score, 0.9) << heading;
  }
}

TEST(PersonDetector, NetworksFindNobodyInAnEmptyRoomOrWithoutColour) {
  const auto models = test::dataset("models");
  if (!models) GTEST_SKIP() << "needs models";
  PersonDetector detector({.models = models->string()});
  auto view = test::lookAt(someone(0.0), kTime, test::levelCamera({2.0, 0.0, 1.2}));  // behind the camera
  EXPECT_THAT(detector.find(view.view()), IsEmpty());
  view = facingTheCamera();
  view.frame.color = {};
  EXPECT_THAT(detector.find(view.view()), IsEmpty());
}

// --- A real recording
// -------------------------------------------------------------------------------------------------

struct Marks {
  std::vector<bool> seen;  ///< torso and head
  std::vector<bool> some;  ///< something of him
  Vector2d position;
};

Marks readMarks() {
  const auto file = std::filesystem::path(__FILE__).parent_path() / "data/fr1_rpy_people.yaml";
  const YAML::Node yaml = YAML::LoadFile(file.string());
  const auto framesOf = [&](const char* key) {
    std::vector<bool> frames(232, false);
    for (const auto& range : yaml[key]) {
      for (auto i = range[0].as<std::size_t>(); i <= range[1].as<std::size_t>(); ++i) frames[i] = true;
    }
    return frames;
  };
  return {framesOf("torso_and_head"),
          framesOf("less_of_him"),
          {yaml["position"][0].as<double>(), yaml["position"][1].as<double>()}};
}

/// Times of all frames, and who was followed.
struct Followed {
  std::vector<base::Time> frames;
  std::vector<map::Track> tracks;
};

Followed followPeople(const std::string& models, const std::filesystem::path& log) {
  const PeopleConfig config{.models = models};
  PersonDetector detector(config);
  std::int64_t ids = 0;
  PersonTracker tracker(config, base::SessionId{0}, 0, [&] { return base::EntityId{ids++}; });
  const auto source = io::openSource(log);
  geometry::Pose3 T_world_body = geometry::Pose3::Identity();
  Followed followed;
  for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
    const auto* reading = std::get_if<sensors::Reading>(&item);
    if (reading == nullptr) continue;
    if (const auto* pose = std::get_if<sensors::RecordedPose>(&reading->data)) T_world_body = pose->T_world_body;
    const auto* frame = std::get_if<sensors::RgbdFrame>(&reading->data);
    if (frame == nullptr) continue;
    followed.frames.push_back(reading->time);
    if (!tracker.wants(reading->time)) continue;
    const RgbdView view{.time = reading->time, .frame = *frame, .T_submap_camera = T_world_body * frame->T_body_camera};
    tracker.add(base::SubMapId{0}, reading->time, detector.find(view), nullptr);
  }
  map::MapChange change;
  tracker.addTo(change);
  followed.tracks = change.tracks;
  return followed;
}

TEST(PersonDetector, FindsTheSeatedManOfFr1Rpy) {
  const auto models = test::dataset("models");
  const auto log = test::dataset("rgbd/tum_fr1_rpy");
  if (!models || !log) GTEST_SKIP() << "needs models and rgbd/tum_fr1_rpy";
  const Marks marks = readMarks();
  const Followed followed = followPeople(models->string(), *log);
  ASSERT_THAT(followed.frames, SizeIs(marks.seen.size()));
  int seen = 0;
  int found = 0;
  int others = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < followed.frames.size(); ++i) {
    bool isFound = false;
    bool isWrong = false;
    for (const auto& track : followed.tracks) {
      const auto state = std::ranges::find(track.states, followed.frames[i], &map::TrackState::time);
      if (state == track.states.end()) continue;
      const bool isHe = (state->T_submap_thing.translation().head<2>() - marks.position).norm() < 0.4;
      (isHe ? isFound : isWrong) = true;
      // Nothing of him is in the picture.
      if (isHe && !marks.seen[i] && !marks.some[i]) isWrong = true;
    }
    seen += marks.seen[i] ? 1 : 0;
    found += marks.seen[i] && isFound ? 1 : 0;
    others += marks.seen[i] ? 0 : 1;
    wrong += isWrong ? 1 : 0;
    if (marks.seen[i] && !isFound) std::printf("missed in frame %zu\n", i);
    if (isWrong) std::printf("wrong in frame %zu\n", i);
  }
  RecordProperty("found", found);
  RecordProperty("wrong", wrong);
  std::printf("found in %d of %d frames, wrong in %d of %d\n", found, seen, wrong, others);
  EXPECT_GE(found, 0.9 * seen);
  EXPECT_LE(wrong, 0.02 * others);
}

}  // namespace
}  // namespace prodomos::perception
