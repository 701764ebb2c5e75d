// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/ray_scene.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"

#include "support/simulated_rooms.hpp"

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace prodomos::simulation {
namespace {

using testing::HasSubstr;

Eigen::Vector3d randomPoint(base::Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

Eigen::Vector3d randomDirection(base::Random& random) {
  Eigen::Vector3d direction;
  do {
    direction = randomPoint(random, 1.0);
  } while (direction.norm() > 1.0 || direction.norm() < 0.1);
  return direction.normalized();
}

/// Möller and Trumbore 1997, in double precision.
std::optional<double> distanceTo(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                 const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d p = direction.cross(c - a);
  const double determinant = (b - a).dot(p);
  if (std::abs(determinant) < 1e-15) return std::nullopt;
  const double u = (origin - a).dot(p) / determinant;
  const Eigen::Vector3d q = (origin - a).cross(b - a);
  const double v = direction.dot(q) / determinant;
  const double t = (c - a).dot(q) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < 0.0) return std::nullopt;
  return t;
}

/// Every triangle tried.
double nearest(const std::vector<Surface>& surfaces, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double best = std::numeric_limits<double>::infinity();
  for (const Surface& surface : surfaces) {
    for (const auto& [a, b, c] : surface.triangles) {
      const auto at = [&](std::uint32_t vertex) { return Eigen::Vector3d(surface.vertices[vertex].cast<double>()); };
      if (const auto t = distanceTo(at(a), at(b), at(c), origin, direction)) best = std::min(best, *t);
    }
  }
  return best;
}

Surface scatteredTriangles(base::Random& random, int count, double reach) {
  Surface surface;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d middle = randomPoint(random, reach);
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (int corner = 0; corner < 3; ++corner) {
      surface.vertices.push_back((middle + randomPoint(random, 0.8)).cast<float>());
      surface.textureCoordinates.push_back(surface.vertices.back().head<2>());
    }
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

Surface wallAt(double x) {
  Surface wall{.classId = classId("wall")};
  addRectangle(wall, {x, 2.0, -2.0}, {0.0, -4.0, 0.0}, {0.0, 0.0, 4.0});
  return wall;
}

TEST(RayScene, MeetsTheSameTrianglesAsTryingAll) {
  base::Random random(1, "test scene");
  const std::vector<Surface> fixed{scatteredTriangles(random, 300, 3.0), scatteredTriangles(random, 100, 3.0)};
  const std::vector<Surface> moving{scatteredTriangles(random, 100, 3.0)};
  const RayScene scene(fixed, moving);
  std::vector<Surface> all = fixed;
  all.insert(all.end(), moving.begin(), moving.end());
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d origin = randomPoint(random, 4.0);
    const Eigen::Vector3d direction = randomDirection(random);
    const double expected = nearest(all, origin, direction);
    const Hit hit = scene.cast(origin, direction);
    ASSERT_EQ(static_cast<bool>(hit), std::isfinite(expected)) << "ray " << i;
    if (!hit) continue;
    ++met;
    EXPECT_NEAR(hit.distance, expected, 1e-4);
    EXPECT_NEAR(hit.normal.norm(), 1.0, 1e-5);
    EXPECT_LE(hit.normal.dot(direction.cast<float>()), 1e-6) << "the normal is on the ray's side";
    const Eigen::Vector3d point = origin + expected * direction;
    EXPECT_NEAR(hit.textureCoordinates.x(), point.x(), 1e-3) << "they are x and y here";
    EXPECT_NEAR(hit.textureCoordinates.y(), point.y(), 1e-3);
    EXPECT_TRUE(scene.isOccluded(origin, direction, expected + 1e-3));
    EXPECT_FALSE(scene.isOccluded(origin, direction, expected - 1e-3));
  }
  EXPECT_GT(met, 1000);
}

TEST(RayScene, ManyRaysMeetTheSameAsOneByOne) {
  base::Random random(2, "test scene");
  const RayScene scene({scatteredTriangles(random, 200, 3.0)}, {scatteredTriangles(random, 20, 3.0)});
  std::vector<Ray> rays(1003);  // no multiple of a packet
  for (Ray& ray : rays) {
    ray = {randomPoint(random, 4.0).cast<float>(), randomDirection(random).cast<float>(),
           static_cast<float>(random.uniform(1.0, 9.0))};
  }
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  scene.cast(rays, hits, RayOrder::kAny);
  scene.areOccluded(rays, occluded, RayOrder::kAny);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d origin = rays[i].origin.cast<double>();
    const Eigen::Vector3d direction = rays[i].direction.cast<double>();
    const Hit one = scene.cast(origin, direction, rays[i].maxDistance);
    EXPECT_EQ(hits[i].surface, one.surface);
    EXPECT_EQ(hits[i].distance, one.distance);
    EXPECT_EQ(occluded[i] != 0, static_cast<bool>(one));
  }
}

TEST(RayScene, ARoomHasNoCracks) {
  const RayScene scene(test::emptyRoom({7.3, 5.1, 2.7}));
  base::Random random(3, "test rays");
  int lost = 0;
  for (int i = 0; i < 20000; ++i) {
    // Straight at an edge or a corner, where rays slip through first.
    Eigen::Vector3d target(random.integer(0, 1) * 7.3 - 3.65, random.integer(0, 1) * 5.1 - 2.55,
                           random.integer(0, 1) * 2.7);
    target[random.integer(0, 2)] = random.uniform(-0.5, 0.5);
    const Eigen::Vector3d origin(random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0), random.uniform(0.3, 2.3));
    if (!scene.cast(origin, (target - origin).normalized())) ++lost;
  }
  EXPECT_EQ(lost, 0);
}

TEST(RayScene, IsMetFromBehindToo) {
  const RayScene scene({wallAt(2.0)});
  const Hit front = scene.cast({0.0, 0.1, 0.2}, {1.0, 0.0, 0.0});
  const Hit back = scene.cast({5.0, 0.1, 0.2}, {-1.0, 0.0, 0.0});
  ASSERT_TRUE(front);
  ASSERT_TRUE(back);
  EXPECT_FLOAT_EQ(front.distance, 2.0F);
  EXPECT_FLOAT_EQ(back.distance, 3.0F);
  EXPECT_LT(front.normal.x(), -0.99F);
  EXPECT_GT(back.normal.x(), 0.99F);
}

TEST(RayScene, NormalsOfRoundThingsAreSmooth) {
  const RayScene scene({test::sphere({0.0, 0.0, 0.0}, 1.0, 12)});
  base::Random random(4, "test rays");
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d direction = randomDirection(random);
    const Hit hit = scene.cast(-3.0 * direction, direction);
    ASSERT_TRUE(hit);
    EXPECT_GT(-hit.normal.dot(direction.cast<float>()), 0.999F);
  }
}

TEST(RayScene, WhatMovesIsMetWhereItHasMovedToAfterCommit) {
  RayScene scene({wallAt(5.0)}, {wallAt(4.0), wallAt(3.0)});
  const auto distance = [&] { return scene.cast({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}).distance; };
  EXPECT_FLOAT_EQ(distance(), 3.0F);
  scene.move(1, wallAt(4.5));
  scene.commit();
  EXPECT_FLOAT_EQ(distance(), 4.0F);
  scene.move(0, wallAt(-4.0));
  scene.move(1, wallAt(-3.0));
  scene.commit();
  EXPECT_FLOAT_EQ(distance(), 5.0F);
  EXPECT_EQ(scene.cast({0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}).surface, &scene.moving()[1]);
}

TEST(RayScene, EndsAtTheGreatestDistance) {
  const RayScene scene({wallAt(2.0)});
  EXPECT_FALSE(scene.cast({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.99));
  EXPECT_TRUE(scene.cast({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 2.01));
  EXPECT_FALSE(RayScene({}).cast({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0})) << "of nothing";
}

TEST(RayScene, EmptySurfacesDoNoHarm) {
  RayScene scene({Surface{}, wallAt(2.0)}, {Surface{}, wallAt(1.0)});
  scene.move(0, Surface{});
  scene.commit();
  EXPECT_EQ(scene.cast({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}).surface, &scene.moving()[1]);
}

TEST(RayScene, TrianglesWithoutAreaDoNoHarm) {
  Surface line{.vertices = {{1.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {1.0F, 2.0F, 0.0F}},
               .triangles = {{0, 1, 2}, {0, 0, 0}}};
  const RayScene scene({line, wallAt(2.0)});
  const Hit hit = scene.cast({0.0, 0.5, 0.0}, {1.0, 0.0, 0.0});
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit.normal.allFinite());
}

std::string faultOf(Surface surface) {
  try {
    const RayScene scene({std::move(surface)});
  } catch (const base::Error& error) {
    return error.what();
  }
  return "none";
}

TEST(RayScene, RefusesSurfacesWhosePartsDoNotFit) {
  Surface wall = wallAt(1.0);
  wall.textureCoordinates.pop_back();
  EXPECT_THAT(faultOf(wall), HasSubstr("fixed surface 0: expected 4 texture coordinates, found 3"));
  wall = wallAt(1.0);
  wall.normals.resize(1);
  EXPECT_THAT(faultOf(wall), HasSubstr("expected 4 normals, found 1"));
  wall = wallAt(1.0);
  wall.triangles.push_back({0, 1, 4});
  EXPECT_THAT(faultOf(wall), HasSubstr("an index below 4"));
  wall = wallAt(1.0);
  wall.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(faultOf(wall), HasSubstr("finite vertices"));
}

TEST(RayScene, RefusesToMoveASurfaceIntoAnotherOne) {
  RayScene scene({}, {wallAt(1.0)});
  Surface two = wallAt(1.0);
  append(two, wallAt(2.0));
  try {
    scene.move(0, two);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("moving surface 0: expected 4 vertices and 2 triangles, found 8"));
  }
}

}  // namespace
}  // namespace prodomos::simulation
