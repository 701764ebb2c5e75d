// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/person.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace prodomos::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr double kFrame = 1.0 / 30.0;

Person standing(double height = 1.75) {
  return {.id = "anna", .height = height, .heading = 0.7, .way = {{0.0, {1.0, 2.0}}}, .look = 3};
}

/// 1.2 m/s: stands, walks along x, turns left, comes back on its own way, stops.
Person walker(std::uint64_t look = 5) {
  Person person{.id = "ben", .height = 1.8, .heading = kPi / 2.0, .look = look};
  person.way = {{2.0, {0.0, 0.0}},  {7.0, {6.0, 0.0}},  {10.0, {6.0, 3.6}},
                {13.0, {6.0, 0.0}}, {15.0, {6.0, 0.0}}, {18.0, {2.4, 0.0}}};
  return person;
}

Person sitter(double height = 1.75) {
  return {.id = "carl", .height = height, .sits = true, .heading = -2.0, .way = {{0.0, {3.0, -1.0}}}, .look = 8};
}

std::vector<Person> everybody() {
  std::vector<Person> people;
  for (std::uint64_t look = 0; look < 6; ++look) {
    const double height = 1.5 + 0.09 * static_cast<double>(look);
    for (Person person : {standing(height), walker(look), sitter(height)}) {
      person.look = look;
      person.height = height;
      people.push_back(person);
    }
  }
  return people;
}

double length(const PersonState& state, Joint a, Joint b) {
  return (state.joints[a] - state.joints[b]).norm();
}

Eigen::AlignedBox3f boxOf(const std::vector<Surface>& body) {
  Eigen::AlignedBox3f box;
  for (const auto& surface : body) {
    for (const auto& vertex : surface.vertices) box.extend(vertex);
  }
  return box;
}

std::string errorOf(const Person& person) {
  try {
    stateOf(person, 0.0, 0.0);
  } catch (const base::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Person, BonesKeepTheirLengths) {
  constexpr std::array<std::pair<Joint, Joint>, 10> kBones = {{{kHeadTop, kNeck},
                                                               {kRightShoulder, kRightElbow},
                                                               {kRightElbow, kRightWrist},
                                                               {kLeftShoulder, kLeftElbow},
                                                               {kLeftElbow, kLeftWrist},
                                                               {kRightHip, kRightKnee},
                                                               {kRightKnee, kRightAnkle},
                                                               {kLeftHip, kLeftKnee},
                                                               {kLeftKnee, kLeftAnkle},
                                                               {kRightHip, kLeftHip}}};
  for (const Person& person : everybody()) {
    const PersonState first = stateOf(person, 0.0, 0.0);
    for (double time = 0.0; time < 20.0; time += 0.0837) {
      const PersonState state = stateOf(person, 0.0, time);
      for (const auto& [a, b] : kBones) {
        ASSERT_NEAR(length(state, a, b), length(first, a, b), 1e-9)
            << person.id << " at " << time << " s, " << kJointNames[a] << " to " << kJointNames[b];
      }
    }
  }
}

TEST(Person, RightAndLeftAreThoseOfThePerson) {
  for (const Person& person : everybody()) {
    const PersonState state = stateOf(person, 0.0, 0.0);
    const Vector3d left(-std::sin(state.heading), std::cos(state.heading), 0.0);
    for (const Joint joint : {kRightShoulder, kRightElbow, kRightHip, kRightKnee, kRightAnkle}) {
      EXPECT_GT((state.joints[joint + 3U] - state.joints[joint]).dot(left), 0.05) << kJointNames[joint];
    }
    EXPECT_GT(state.joints[kHeadTop].z(), state.joints[kNeck].z() + 0.2);
  }
}

TEST(Person, StandsAsTallAsItIs) {
  for (const double height : {1.5, 1.75, 2.0}) {
    const Person person = standing(height);
    const float top = boxOf(bodyAt(person, 0.0, 1.0, 1)).max().z();
    EXPECT_NEAR(top, height, 0.03 * height);
    EXPECT_NEAR(stateOf(person, 0.0, 1.0).joints[kHeadTop].z(), top, 0.03);
  }
}

TEST(Person, FeetStayAboveTheFloorAndOneIsOnIt) {
  constexpr double kFloor = 3.2;
  for (const Person& person : everybody()) {
    for (double time = 0.0; time < 19.0; time += 0.0613) {
      const auto body = bodyAt(person, kFloor, time, 1);
      const double lowest = boxOf(body).min().z();
      ASSERT_GE(lowest, kFloor - 0.002) << person.id << " at " << time << " s";
      ASSERT_LE(lowest, kFloor + 0.005) << person.id << " at " << time << " s";
    }
  }
}

TEST(Person, AFootThatCarriesDoesNotSlide) {
  Person person = walker();
  person.way = {{0.0, {0.0, 0.0}}, {10.0, {12.0, 0.0}}};
  const double rest = stateOf(person, 0.0, -5.0).joints[kLeftAnkle].z();
  for (const Joint ankle : {kLeftAnkle, kRightAnkle}) {
    int stances = 0;
    for (double time = 1.0; time < 9.0; time += 0.01) {
      // Flat on the floor: the ankle is as low as that of one who stands.
      Eigen::AlignedBox2d box;
      for (; stateOf(person, 0.0, time).joints[ankle].z() < rest + 0.002; time += 0.01) {
        box.extend(Vector2d(stateOf(person, 0.0, time).joints[ankle].head<2>()));
      }
      if (box.isEmpty()) continue;
      ++stances;
      EXPECT_LT(box.diagonal().norm(), 0.02) << "until " << time << " s";
    }
    EXPECT_GE(stances, 5);
  }
}

TEST(Person, FeetTakeTurns) {
  Person person = walker();
  person.way = {{0.0, {0.0, 0.0}}, {10.0, {12.0, 0.0}}};
  int changes = 0;
  bool leftAhead = false;
  for (double time = 1.0; time < 9.0; time += 0.01) {
    const PersonState state = stateOf(person, 0.0, time);
    const double ahead = state.joints[kLeftAnkle].x() - state.joints[kRightAnkle].x();
    const double armAhead = state.joints[kRightWrist].x() - state.joints[kLeftWrist].x();
    if (std::abs(ahead) > 0.4) {
      EXPECT_GT(ahead * armAhead, 0.0) << "the arm goes with the other side's leg";
    }
    EXPECT_LT(std::abs(ahead), 0.85);
    if (time > 1.0 && (ahead > 0.0) != leftAhead) ++changes;
    leftAhead = ahead > 0.0;
  }
  // 1.2 m/s are 105 to 115 steps a minute.
  EXPECT_GE(changes, 13);
  EXPECT_LE(changes, 16);
}

TEST(Person, VelocityIsTheDerivativeOfThePosition) {
  for (const Person& person : everybody()) {
    for (double time = -1.0; time < 20.0; time += 0.0731) {
      constexpr double kStep = 1e-4;
      const Vector3d difference =
          stateOf(person, 0.0, time + kStep).position - stateOf(person, 0.0, time - kStep).position;
      const Vector3d velocity = stateOf(person, 0.0, time).velocity;
      ASSERT_LT((difference / (2.0 * kStep) - velocity).norm(), 2e-3) << person.id << " at " << time << " s";
    }
  }
}

TEST(Person, FollowsItsWay) {
  const Person person = walker();
  EXPECT_NEAR((stateOf(person, 0.5, 0.0).position - Vector3d(0.0, 0.0, 0.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((stateOf(person, 0.5, 4.5).position - Vector3d(3.0, 0.0, 0.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((stateOf(person, 0.5, 14.0).position - Vector3d(6.0, 0.0, 0.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((stateOf(person, 0.5, 99.0).position - Vector3d(2.4, 0.0, 0.5)).norm(), 0.0, 1e-9);
  // It cuts corners, but not by much.
  EXPECT_NEAR((stateOf(person, 0.5, 7.0).position - Vector3d(6.0, 0.0, 0.5)).norm(), 0.0, 0.15);
}

TEST(Person, HeadingFollowsTheWay) {
  const Person person = walker();
  const std::vector<std::pair<double, double>> headings = {
      {0.0, kPi / 2.0}, {4.5, 0.0}, {8.5, kPi / 2.0}, {11.5, -kPi / 2.0}, {14.0, -kPi / 2.0}, {16.5, kPi}, {60.0, kPi}};
  for (const auto& [time, heading] : headings) {
    const PersonState state = stateOf(person, 0.0, time);
    EXPECT_NEAR(geometry::normalizeAngle(state.heading - heading), 0.0, 1e-9) << time << " s";
    const Vector3d across = state.joints[kLeftShoulder] - state.joints[kRightShoulder];
    EXPECT_NEAR(geometry::normalizeAngle(std::atan2(-across.x(), across.y()) - heading), 0.0, 0.2) << time << " s";
  }
}

TEST(Person, NothingJumps) {
  for (std::uint64_t look = 0; look < 4; ++look) {
    const Person person = walker(look);
    constexpr int kFiner = 20;
    PersonState before = stateOf(person, 0.0, 0.0);
    PersonState frameBefore = before;
    for (int i = 1; i < static_cast<int>(20.0 / kFrame) * kFiner; ++i) {
      const PersonState state = stateOf(person, 0.0, i * kFrame / kFiner);
      for (std::size_t joint = 0; joint < state.joints.size(); ++joint) {
        // A foot swings at up to 6 m/s.
        ASSERT_LT((state.joints[joint] - before.joints[joint]).norm(), 6.5 * kFrame / kFiner)
            << kJointNames[joint] << " at " << i * kFrame / kFiner << " s";
      }
      before = state;
      if (i % kFiner != 0) continue;
      const double turned = std::abs(geometry::normalizeAngle(state.heading - frameBefore.heading));
      ASSERT_LE(turned, kPi * kFrame / 0.5);
      for (const Joint joint : {kHeadTop, kNeck, kRightShoulder, kLeftShoulder, kRightHip, kLeftHip}) {
        // A shoulder is 0.2 m from the axis that it turns about.
        ASSERT_LT((state.joints[joint] - frameBefore.joints[joint]).norm(), 0.05 + 0.2 * turned)
            << kJointNames[joint] << " at " << i * kFrame / kFiner << " s";
      }
      frameBefore = state;
    }
  }
}

TEST(Person, WhoStandsMovesALittle) {
  const Person person = standing();
  double farthest = 0.0;
  for (double time = 0.0; time < 30.0; time += 0.5) {
    const PersonState state = stateOf(person, 0.0, time);
    EXPECT_EQ(state.velocity, Vector3d::Zero());
    EXPECT_NEAR((state.joints[kLeftAnkle] - stateOf(person, 0.0, 0.0).joints[kLeftAnkle]).norm(), 0.0, 1e-9);
    farthest = std::max(farthest, (state.joints[kLeftWrist] - stateOf(person, 0.0, 0.0).joints[kLeftWrist]).norm());
  }
  EXPECT_GT(farthest, 0.005);
  EXPECT_LT(farthest, 0.1);
}

TEST(Person, SitsOnAChair) {
  for (const double height : {1.5, 1.75, 2.0}) {
    const Person person = sitter(height);
    const PersonState state = stateOf(person, 1.0, 4.0);
    const Vector3d hips = (state.joints[kRightHip] + state.joints[kLeftHip]) / 2.0;
    // A seat of 0.45 m and 5 to 12 cm to the joints.
    EXPECT_GT(hips.z(), 1.0 + 0.45 + 0.05);
    EXPECT_LT(hips.z(), 1.0 + 0.45 + 0.12);
    EXPECT_NEAR((hips - state.position).head<2>().norm(), 0.0, 1e-9);
    const Vector3d ahead(std::cos(person.heading), std::sin(person.heading), 0.0);
    EXPECT_GT((state.joints[kRightKnee] - hips).dot(ahead), 0.2 * height);
    EXPECT_NEAR(state.joints[kRightKnee].z(), hips.z(), 0.12);
    EXPECT_LT(state.joints[kLeftAnkle].z(), 1.1);
    EXPECT_EQ(state.velocity, Vector3d::Zero());
    EXPECT_NEAR(geometry::normalizeAngle(state.heading - person.heading), 0.0, 1e-9);
  }
}

TEST(Person, JointsLieInTheBody) {
  for (const Person& person : everybody()) {
    for (double time = 0.0; time < 19.0; time += 1.37) {
      const Eigen::AlignedBox3f box = boxOf(bodyAt(person, 0.4, time, 1));
      for (const auto& joint : stateOf(person, 0.4, time).joints) {
        EXPECT_TRUE(box.contains(joint.cast<float>())) << person.id << ": " << joint.transpose();
      }
    }
  }
}

TEST(Person, BodyKeepsItsTriangles) {
  for (const Person& person : everybody()) {
    const auto first = bodyAt(person, 0.0, 0.0, 7);
    std::size_t triangles = 0;
    for (const auto& surface : first) triangles += surface.triangles.size();
    EXPECT_GT(triangles, 2000U);
    EXPECT_LT(triangles, 5000U);
    for (const double time : {2.1, 4.4, 12.9, 30.0}) {
      const auto body = bodyAt(person, 0.0, time, 7);
      ASSERT_EQ(body.size(), first.size());
      for (std::size_t i = 0; i < body.size(); ++i) {
        EXPECT_EQ(body[i].triangles, first[i].triangles);
        EXPECT_EQ(body[i].vertices.size(), first[i].vertices.size());
        EXPECT_EQ(body[i].textureCoordinates.size(), body[i].vertices.size());
        EXPECT_EQ(body[i].normals.size(), body[i].vertices.size());
        EXPECT_EQ(body[i].classId, classId("person"));
        EXPECT_EQ(body[i].instance, 7);
      }
    }
  }
}

TEST(Person, NormalsAreUnitVectorsThatPointOutwards) {
  for (const Person& person : everybody()) {
    std::size_t inwards = 0;
    std::size_t triangles = 0;
    for (const auto& surface : bodyAt(person, 0.0, 5.0, 1)) {
      for (const auto& normal : surface.normals) ASSERT_NEAR(normal.norm(), 1.0F, 1e-4F);
      for (const auto& [a, b, c] : surface.triangles) {
        const Eigen::Vector3f flat =
            (surface.vertices[b] - surface.vertices[a]).cross(surface.vertices[c] - surface.vertices[a]);
        const Eigen::Vector3f smooth = surface.normals[a] + surface.normals[b] + surface.normals[c];
        ++triangles;
        if (flat.dot(smooth) < 0.0F) ++inwards;
      }
    }
    // The insides of bent joints are folded.
    EXPECT_LT(inwards, triangles / 50) << person.id;
  }
}

TEST(Person, IsAFunctionOfPersonAndTime) {
  for (const Person& person : everybody()) {
    const auto once = bodyAt(person, 0.0, 5.0, 1);
    bodyAt(person, 1.0, 9.0, 2);
    const auto again = bodyAt(person, 0.0, 5.0, 1);
    for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].vertices, again[i].vertices);
    EXPECT_EQ(stateOf(person, 0.0, 5.0).joints, stateOf(person, 0.0, 5.0).joints);
  }
}

TEST(Person, LooksDiffer) {
  const auto first = bodyAt(standing(), 0.0, 0.0, 1);
  int differentColors = 0;
  for (std::uint64_t look = 100; look < 110; ++look) {
    Person person = standing();
    person.look = look;
    const auto body = bodyAt(person, 0.0, 0.0, 1);
    const auto color = body[0].material.color;
    const auto other = first[0].material.color;
    if (color.r != other.r || body.size() != first.size()) ++differentColors;
    EXPECT_NE(body[0].vertices, first[0].vertices);
  }
  EXPECT_GE(differentColors, 5);
}

TEST(Person, AnyWayIsWalked) {
  base::Random random(11, "ways of a test");
  for (int trial = 0; trial < 40; ++trial) {
    Person person{.id = "dora", .height = random.uniform(1.2, 2.0), .look = static_cast<std::uint64_t>(trial)};
    double time = 0.0;
    Vector2d position(0.0, 0.0);
    for (int i = random.integer(1, 12); i > 0; --i) {
      person.way.push_back({time, position});
      const double duration = random.uniform(0.05, 4.0);
      time += duration;
      if (random.uniform() < 0.3) continue;
      const double direction = random.uniform(-kPi, kPi);
      position += random.uniform(0.1, 1.6) * duration * Vector2d(std::cos(direction), std::sin(direction));
    }
    for (double t = -1.0; t < time + 1.0; t += 0.11) {
      const PersonState state = stateOf(person, 0.0, t);
      for (const auto& joint : state.joints) {
        ASSERT_TRUE(joint.allFinite());
        ASSERT_LT((joint - state.position).head<2>().norm(), 0.7 * person.height) << trial << " at " << t << " s";
      }
      ASSERT_GT(state.joints[kNeck].z(), 0.55 * person.height) << trial << " at " << t << " s";
    }
  }
}

TEST(Person, BadOnesAreNamed) {
  Person person = walker();
  person.way.clear();
  EXPECT_THAT(errorOf(person), HasSubstr("\"ben\", way: expected at least one point, found none"));
  person = walker();
  person.way[2].time = person.way[1].time;
  EXPECT_THAT(errorOf(person), HasSubstr("\"ben\", way point 3: expected a time after 7"));
  person = walker();
  person.way[1].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(errorOf(person), HasSubstr("\"ben\", way point 2"));
  person = walker();
  person.way[0].time = std::numeric_limits<double>::infinity();
  EXPECT_THAT(errorOf(person), HasSubstr("\"ben\", way point 1"));
  person = walker();
  person.height = 0.0;
  EXPECT_THAT(errorOf(person), HasSubstr("\"ben\", height: expected 0.9 to 2.3 m, found 0"));
  person = walker();
  person.heading = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(errorOf(person), HasSubstr("\"ben\", heading"));
  EXPECT_THROW(bodyAt(person, 0.0, 0.0, 1), base::Error);
  EXPECT_EQ(errorOf(walker()), "no error");
}

}  // namespace
}  // namespace prodomos::simulation
