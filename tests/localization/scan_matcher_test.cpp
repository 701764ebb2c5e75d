// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/scan_matcher.hpp"

#include "localization/flat_building.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using test::FlatBuilding;
using test::kDegree;

/// A room of six by five metres with a cupboard, a table and a slanting screen.
FlatBuilding room() {
  FlatBuilding building;
  building.addBox({0.0, 0.0, 0.0}, 6.0, 5.0);
  building.addBox({-2.7, 1.0, 0.0}, 0.6, 1.4);
  building.addBox({1.2, -1.1, 0.5}, 1.1, 0.6);
  building.addWall({0.6, 2.5}, {1.5, 1.9});
  return building;
}

/// A corridor without ends, two metres wide.
FlatBuilding corridor() {
  FlatBuilding building;
  building.addWall({-500.0, -1.0}, {500.0, -1.0});
  building.addWall({-500.0, 1.0}, {500.0, 1.0});
  return building;
}

/// The building's walls by beams from many places, so dense that cells hold means on the walls themselves.
map::SurfaceLayer surfaceOf(const FlatBuilding& building, const std::vector<Pose2>& T_building_bodies,
                            const Pose2& T_building_map = {}) {
  map::SurfaceLayer surface;
  for (const auto& T_building_body : T_building_bodies) {
    for (const auto& point : test::pointsOf(building.scan(T_building_body)))
      surface.insert(test::apply(geometry::inverse(T_building_map) * T_building_body, point));
  }
  return surface;
}

std::vector<Pose2> placesInRoom(base::Random& random, int count) {
  std::vector<Pose2> places;
  while (static_cast<int>(places.size()) < count) {
    const Pose2 place{random.uniform(-2.2, 2.7), random.uniform(-2.2, 1.7),
                      random.uniform(-std::numbers::pi, std::numbers::pi)};
    const bool isOnTable = std::hypot(place.x - 1.2, place.y + 1.1) < 0.8;
    if (!isOnTable) places.push_back(place);
  }
  return places;
}

Pose2 offBy(base::Random& random, double distance, double turn) {
  const double direction = random.uniform(-std::numbers::pi, std::numbers::pi);
  return {distance * std::cos(direction), distance * std::sin(direction), random.uniform() < 0.5 ? turn : -turn};
}

TEST(ScanMatcher, FindsItsPlaceInARoomToAMillimetre) {
  base::Random random(1);
  double sum = 0.0;
  const auto building = room();
  for (const Pose2 T_building_map : {Pose2{}, Pose2{30.0, -7.0, 2.2}, Pose2{-3.0, 1.0, -0.6}}) {
    const auto surface = surfaceOf(building, placesInRoom(random, 60), T_building_map);
    for (const auto& T_building_body : placesInRoom(random, 40)) {
      const auto points = test::pointsOf(building.scan(T_building_body));
      const auto truth = geometry::inverse(T_building_map) * T_building_body;
      const PosePrior prior{.T_map_body = truth * offBy(random, 0.15, 8.0 * kDegree)};
      const auto match = matchScan(points, surface, prior);
      const auto error = test::errorOf(match.T_map_body, truth);
      EXPECT_LT(error.metres, 0.004) << "the worst";
      EXPECT_LT(error.radians, 0.001);
      sum += error.metres;
      EXPECT_GT(match.explained, 0.95);
      EXPECT_LT(match.residual, 0.02);
    }
  }
  EXPECT_LT(sum / 120.0, 0.001);
}

TEST(ScanMatcher, IsNotDraggedByPeople) {
  base::Random random(2);
  const auto building = room();
  const auto surface = surfaceOf(building, placesInRoom(random, 60));
  for (const auto& truth : placesInRoom(random, 20)) {
    auto points = test::pointsOf(building.scan(truth));
    // Half of the beams end on legs before the walls: runs of twelve, each at one distance.
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((i / 12) % 2 == 0) points[i] *= 0.3 + 0.5 * std::fmod(0.37 * static_cast<double>(i / 12), 1.0);
    }
    const PosePrior prior{.T_map_body = truth * offBy(random, 0.05, 2.0 * kDegree)};
    const auto match = matchScan(points, surface, prior);
    const auto error = test::errorOf(match.T_map_body, truth);
    EXPECT_LT(error.metres, 0.03);
    EXPECT_LT(error.radians, 0.005);
    EXPECT_GT(match.explained, 0.4);
    EXPECT_LT(match.explained, 0.75);
  }
}

TEST(ScanMatcher, KnowsNothingAlongAnEndlessCorridorWhereThePriorDecides) {
  const auto building = corridor();
  const auto surface = surfaceOf(building, test::placesAlong({-15.0, 0.0}, {15.0, 0.0}, 0.1));
  for (const double heading : {0.0, 0.6, -2.0}) {
    const Pose2 truth{0.3, 0.2, heading};
    const auto points = test::pointsOf(building.scan(truth));
    const Pose2 guess{0.3, 0.09, heading + 7.0 * kDegree};
    PosePrior prior{.T_map_body = guess};
    prior.information.diagonal() << 1e4, 1e4, 1e2;
    const auto match = matchScan(points, surface, prior);
    EXPECT_NEAR(match.T_map_body.x, guess.x, 0.002) << "along, where nothing but the prior tells";
    EXPECT_NEAR(match.T_map_body.y, truth.y, 0.02);
    EXPECT_NEAR(match.T_map_body.theta, truth.theta, 0.005);

    const Eigen::Matrix2d places = match.information.topLeftCorner<2, 2>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(places);
    EXPECT_LT(axes.eigenvalues()[0], 1e-3 * axes.eigenvalues()[1]);
    // In the body's own axes.
    const Eigen::Vector2d along = axes.eigenvectors().col(0);
    const Eigen::Vector2d expected(std::cos(-truth.theta), std::sin(-truth.theta));
    EXPECT_NEAR(std::abs(along.dot(expected)), 1.0, 1e-3);
  }
}

TEST(ScanMatcher, WeighsAPriorInTheAxesOfItsOwnBody) {
  // Ahead the wheels tell nothing, sideways all; the corridor is blind along x. Its walls alone set y and heading.
  const auto building = corridor();
  const auto surface = surfaceOf(building, test::placesAlong({-15.0, 0.0}, {15.0, 0.0}, 0.1));
  const double heading = 0.7;
  const Pose2 truth{0.0, 0.0, heading};
  const Pose2 guess{0.0, 0.1, heading};
  PosePrior prior{.T_map_body = guess};
  prior.information.diagonal() << 0.0, 1e3, 0.0;
  const auto match = matchScan(test::pointsOf(building.scan(truth)), surface, prior);
  // It slid along its own x-axis, until y fitted.
  const auto slid = geometry::inverse(guess) * match.T_map_body;
  EXPECT_NEAR(match.T_map_body.y, 0.0, 0.003);
  EXPECT_NEAR(slid.y, 0.0, 0.003);
  EXPECT_NEAR(slid.x, -0.1 / std::sin(heading), 0.01);
}

TEST(ScanMatcher, GivesThePriorBackWhereThereIsNothingToMatch) {
  base::Random random(3);
  const auto building = room();
  const auto surface = surfaceOf(building, placesInRoom(random, 10));
  const auto points = test::pointsOf(building.scan({0.0, 0.0, 0.0}));
  PosePrior known{.T_map_body = {0.4, -0.2, 1.0}};
  known.information.diagonal() << 1e4, 1e4, 1e4;
  PosePrior unknown{.T_map_body = {0.4, -0.2, 1.0}};
  PosePrior far{.T_map_body = {1e5, -1e5, 1.0}};
  const std::vector<Eigen::Vector2d> none;
  const auto expectPrior = [](const Match& match, const PosePrior& prior) {
    const auto error = test::errorOf(match.T_map_body, prior.T_map_body);
    EXPECT_LT(error.metres, 1e-9);
    EXPECT_LT(error.radians, 1e-9);
    EXPECT_EQ(match.explained, 0.0);
    EXPECT_EQ(match.residual, 0.0);
    EXPECT_TRUE(match.information.isZero());
  };
  for (const auto& prior : {known, unknown}) {
    expectPrior(matchScan(none, surface, prior), prior);
    expectPrior(matchScan(points, map::SurfaceLayer(), prior), prior);
  }
  expectPrior(matchScan(points, surface, far), far);
}

TEST(ScanMatcher, TellsOfASinglePointAsMuchAsAPointTells) {
  map::SurfaceLayer surface;
  surface.insert({1.0, 0.0});
  const std::vector<Eigen::Vector2d> points = {{1.05, 0.0}};
  const auto match = matchScan(points, surface, {});
  EXPECT_TRUE(std::isfinite(match.T_map_body.x + match.T_map_body.y + match.T_map_body.theta));
  EXPECT_TRUE(match.information.allFinite());
  EXPECT_EQ(match.explained, 0.0) << "a point is no surface";
}

}  // namespace
}  // namespace prodomos::localization
