// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/overlap.hpp"

#include "prodomos/base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::geometry {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

Polygon rectangle(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

/// Simple, but far from convex.
Polygon star(base::Random& random, int corners) {
  const Eigen::Vector2d middle(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    polygon.push_back(middle + random.uniform(0.3, 2.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

bool contains(const OrientedBox& box, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = box.T_frame_box.inverse() * point;
  return (p.cwiseAbs().array() <= 0.5 * box.size.array()).all();
}

OrientedBox askew(base::Random& random) {
  const auto draw = [&](double most) { return random.uniform(-most, most); };
  return {fromYawPitchRoll({draw(0.5), draw(0.5), draw(0.5)}, draw(3.0), draw(1.0), draw(1.0)),
          {random.uniform(0.3, 2.0), random.uniform(0.3, 2.0), random.uniform(0.3, 2.0)}};
}

TEST(SharedArea, OfRectanglesIsTheirOverlap) {
  EXPECT_DOUBLE_EQ(sharedArea(rectangle(0, 0, 2, 1), rectangle(1, 0, 2, 1)), 1.0);
  EXPECT_DOUBLE_EQ(sharedArea(rectangle(0, 0, 2, 1), rectangle(0.5, 0.25, 0.5, 0.5)), 0.25);
  EXPECT_DOUBLE_EQ(sharedArea(rectangle(0, 0, 2, 1), rectangle(2, 0, 2, 1)), 0.0);
  EXPECT_DOUBLE_EQ(sharedArea(rectangle(0, 0, 2, 1), rectangle(5, 0, 2, 1)), 0.0);
}

TEST(SharedArea, DoesNotCareWhichWayRoundPolygonsGo) {
  auto turned = rectangle(1, 0, 2, 1);
  std::ranges::reverse(turned);
  EXPECT_DOUBLE_EQ(sharedArea(rectangle(0, 0, 2, 1), turned), 1.0);
  EXPECT_DOUBLE_EQ(sharedArea(turned, rectangle(0, 0, 2, 1)), 1.0);
  EXPECT_DOUBLE_EQ(areaOf(turned), 2.0);
}

TEST(SharedArea, OfACorridorThatBendsIsExact) {
  const Polygon bend = {{0, 0}, {10, 0}, {10, 8}, {8, 8}, {8, 2}, {0, 2}};
  EXPECT_DOUBLE_EQ(areaOf(bend), 32.0);
  EXPECT_NEAR(sharedArea(bend, bend), 32.0, 1e-12);
  EXPECT_NEAR(sharedArea(bend, rectangle(0, 1, 9, 7)), 8.0 + 7.0, 1e-12);
  EXPECT_NEAR(sharedArea(bend, rectangle(1, 3, 6, 4)), 0.0, 1e-12);  // in the crook of its arm
}

TEST(SharedArea, OfWhatIsNoPolygonIsNone) {
  EXPECT_EQ(sharedArea({}, rectangle(0, 0, 1, 1)), 0.0);
  EXPECT_EQ(sharedArea({{0, 0}, {1, 1}}, rectangle(0, 0, 1, 1)), 0.0);
  EXPECT_EQ(areaOf({{0, 0}, {1, 1}}), 0.0);
}

TEST(SharedArea, OfRandomStarsIsThatOfSampling) {
  base::Random random(1);
  for (int round = 0; round < 10; ++round) {
    const auto a = star(random, 9);
    const auto b = star(random, 12);
    constexpr int kSide = 400;
    int hits = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Eigen::Vector2d p(-3.0 + 6.0 * (i % kSide + 0.5) / kSide, -3.0 + 6.0 * (i / kSide + 0.5) / kSide);
      if (contains(a, p) && contains(b, p)) ++hits;
    }
    EXPECT_NEAR(sharedArea(a, b), 36.0 * hits / (kSide * kSide), 0.02);
    EXPECT_NEAR(sharedArea(a, b), sharedArea(b, a), 1e-12);
  }
}

TEST(IntersectionOverUnion, OfBoxesThatOverlapByHalfIsAThird) {
  const OrientedBox box{Pose3::Identity(), {2, 1, 1}};
  const OrientedBox aside{Pose3(Eigen::Translation3d(1, 0, 0)), {2, 1, 1}};
  EXPECT_DOUBLE_EQ(sharedVolume(box, aside), 1.0);
  EXPECT_DOUBLE_EQ(intersectionOverUnion(box, aside), 1.0 / 3.0);
}

TEST(IntersectionOverUnion, OfABoxWithItselfIsOneHoweverItLies) {
  base::Random random(2);
  for (int round = 0; round < 20; ++round) {
    const auto box = askew(random);
    EXPECT_NEAR(intersectionOverUnion(box, box), 1.0, 1e-6);
    // The same box, its axes named otherwise.
    const Pose3 quarter = fromYawPitchRoll(Eigen::Vector3d::Zero(), std::numbers::pi / 2, 0, 0);
    const OrientedBox renamed{box.T_frame_box * quarter, {box.size.y(), box.size.x(), box.size.z()}};
    EXPECT_NEAR(intersectionOverUnion(box, renamed), 1.0, 1e-6);
  }
}

TEST(IntersectionOverUnion, OfASquareTurnedByAnEighthIsThatOfTheOctagon) {
  const OrientedBox box{Pose3::Identity(), {1, 1, 1}};
  const OrientedBox turned{fromYawPitchRoll(Eigen::Vector3d::Zero(), std::numbers::pi / 4, 0, 0), {1, 1, 1}};
  const double octagon = 2.0 * (std::numbers::sqrt2 - 1.0);
  EXPECT_NEAR(sharedVolume(box, turned), octagon, 1e-12);
  EXPECT_NEAR(intersectionOverUnion(box, turned), octagon / (2.0 - octagon), 1e-12);
}

TEST(IntersectionOverUnion, OfBoxesApartTouchingOrFlatIsZero) {
  const OrientedBox box{Pose3::Identity(), {1, 1, 1}};
  EXPECT_EQ(intersectionOverUnion(box, {Pose3(Eigen::Translation3d(3, 0, 0)), {1, 1, 1}}), 0.0);
  EXPECT_EQ(intersectionOverUnion(box, {Pose3(Eigen::Translation3d(1, 0, 0)), {1, 1, 1}}), 0.0);
  EXPECT_EQ(intersectionOverUnion(box, {Pose3::Identity(), {1, 1, 0}}), 0.0);
  EXPECT_EQ(intersectionOverUnion({}, {}), 0.0);
}

TEST(IntersectionOverUnion, OfBoxesAskewIsThatOfSampling) {
  base::Random random(3);
  for (int round = 0; round < 10; ++round) {
    const auto a = askew(random);
    const auto b = askew(random);
    int inBoth = 0;
    constexpr int kSide = 80;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const Eigen::Vector3d cell(i % kSide, i / kSide % kSide, i / kSide / kSide);
      const Eigen::Vector3d in_a = ((cell.array() + 0.5) / kSide - 0.5).matrix().cwiseProduct(a.size);
      if (contains(b, a.T_frame_box * in_a)) ++inBoth;
    }
    const double sampled = volumeOf(a) * inBoth / (kSide * kSide * kSide);
    EXPECT_NEAR(sharedVolume(a, b), sampled, 0.01 * volumeOf(a));
    EXPECT_NEAR(sharedVolume(a, b), sharedVolume(b, a), 1e-9);
  }
}

TEST(IntersectionOverUnion, StaysWhereBothBoxesAreMoved) {
  base::Random random(4);
  const auto a = askew(random);
  const auto b = askew(random);
  const auto T_b_a = fromYawPitchRoll({500.0, -320.0, 7.0}, 2.0, 0.4, -1.1);
  const OrientedBox movedA{T_b_a * a.T_frame_box, a.size};
  const OrientedBox movedB{T_b_a * b.T_frame_box, b.size};
  EXPECT_NEAR(intersectionOverUnion(movedA, movedB), intersectionOverUnion(a, b), 1e-9);
}

}  // namespace
}  // namespace prodomos::geometry
