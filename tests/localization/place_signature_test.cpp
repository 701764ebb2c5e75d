// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/place_signature.hpp"

#include "localization/flat_building.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using test::FlatBuilding;
using test::kDegree;

Pose2 randomFrame(base::Random& random) {
  return {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-std::numbers::pi, std::numbers::pi)};
}

/// A room around the origin with a door in its southern and one in its northern wall.
struct Room {
  FlatBuilding building;
  double length;
  double width;
};

Room randomRoom(base::Random& random) {
  Room room{.building = {}, .length = random.uniform(3.0, 9.0), .width = random.uniform(3.0, 7.0)};
  const double x = 0.5 * room.length;
  const double y = 0.5 * room.width;
  room.building.addWallWithDoors({-x, -y}, {x, -y}, {random.uniform(0.6, room.length - 0.6)});
  room.building.addWallWithDoors({-x, y}, {x, y}, {random.uniform(0.6, room.length - 0.6)});
  room.building.addWall({-x, -y}, {-x, y});
  room.building.addWall({x, -y}, {x, y});
  room.building.addFurniture(random, random.integer(2, 5), room.length, room.width,
                             test::placesAlong({0.0, -0.35 * room.width}, {0.0, 0.35 * room.width}));
  return room;
}

/// As seen by one who walks through it from south to north, or back, a little beside.
map::SurfaceLayer walkedThrough(const Room& room, bool isBack, double beside, base::Random& random) {
  const double y = 0.35 * room.width;
  const auto places =
      isBack ? test::placesAlong({beside, y}, {beside, -y}) : test::placesAlong({beside, -y}, {beside, y});
  return *test::layersOf(room.building, places, randomFrame(random), &random).surface;
}

TEST(PlaceSignature, IsTheSameWhicheverWayTheFrameLies) {
  base::Random random(1);
  const auto room = randomRoom(random);
  const auto places = test::placesAlong({0.0, -1.0}, {0.0, 1.0}, 0.3);
  const auto a = placeSignatures(*test::layersOf(room.building, places, randomFrame(random)).surface);
  const auto b = placeSignatures(*test::layersOf(room.building, places, randomFrame(random)).surface);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(mostAlike({a[i]}, {b[i]}).difference, 1.0);
    for (std::size_t k = 0; k < PlaceSignature::kFrequencies; ++k)
      EXPECT_NEAR(static_cast<double>(a[i].magnitudes[k]), static_cast<double>(b[i].magnitudes[k]), 0.15);
  }
}

TEST(PlaceSignature, OfARoundHallIsItsRadius) {
  map::SurfaceLayer hall;
  for (int i = 0; i < 3600; ++i)
    hall.insert({1.0 + 4.0 * std::cos(i * 0.1 * kDegree), 4.0 * std::sin(i * 0.1 * kDegree)});
  hall.addViewpoint({1.0, 0.0});
  const auto signatures = placeSignatures(hall);
  ASSERT_EQ(signatures.size(), 1U);
  EXPECT_NEAR(signatures[0].magnitudes[0], 4.0F, 0.03F);
  for (std::size_t k = 1; k < PlaceSignature::kFrequencies; ++k) EXPECT_LT(signatures[0].magnitudes[k], 0.02F);
}

TEST(PlaceSignature, TellsARoomFromOthersThoughWalkedThroughTheOtherWay) {
  int rooms = 0;
  int first = 0;
  int amongTwo = 0;
  for (const std::uint64_t seed : {11, 12, 13, 14}) {
    base::Random random(seed);
    std::vector<std::vector<PlaceSignature>> there;
    std::vector<std::vector<PlaceSignature>> back;
    for (int i = 0; i < 12; ++i) {
      const auto room = randomRoom(random);
      there.push_back(placeSignatures(walkedThrough(room, false, -0.2, random)));
      back.push_back(placeSignatures(walkedThrough(room, true, 0.2, random)));
    }
    for (std::size_t i = 0; i < there.size(); ++i) {
      const double own = mostAlike(there[i], back[i]).difference;
      const auto better = std::ranges::count_if(
          back, [&](const auto& signatures) { return mostAlike(there[i], signatures).difference < own; });
      ++rooms;
      first += better == 0 ? 1 : 0;
      amongTwo += better <= 1 ? 1 : 0;
    }
  }
  // By chance it would be one in twelve, and two.
  EXPECT_GE(first, rooms / 3);
  EXPECT_GE(amongTwo, rooms / 2);
}

TEST(PlaceSignature, OfTheMostAlikeNamesTheViewpoints) {
  const auto signature = [](float mean) {
    PlaceSignature signature;
    signature.magnitudes[0] = mean;
    return signature;
  };
  const auto likeness = mostAlike({signature(1), signature(5), signature(9)}, {signature(20), signature(5.5F)});
  EXPECT_EQ(likeness.from, 1U);
  EXPECT_EQ(likeness.to, 1U);
  EXPECT_NEAR(likeness.difference, 0.5, 1e-6);
  EXPECT_TRUE(std::isinf(mostAlike({}, {signature(1)}).difference));
  EXPECT_TRUE(std::isinf(mostAlike({signature(1)}, {}).difference));
}

TEST(PlaceSignature, IsNoneWhereNothingWasSeen) {
  map::SurfaceLayer nothing;
  nothing.addViewpoint({0.0, 0.0});
  EXPECT_TRUE(placeSignatures(nothing).empty()) << "two that saw nothing would look alike";
  EXPECT_TRUE(placeSignatures(map::SurfaceLayer()).empty());
}

TEST(AlignViewpoints, FindsTheTurnToSixDegrees) {
  base::Random random(2);
  for (int i = 0; i < 40; ++i) {
    const auto room = randomRoom(random);
    const std::vector<Pose2> places = {{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.0}};
    const auto T_building_from = randomFrame(random);
    const auto T_building_to = randomFrame(random);
    const auto from = test::layersOf(room.building, places, T_building_from, &random);
    const auto to = test::layersOf(room.building, places, T_building_to, &random);
    const auto likeness = mostAlike(placeSignatures(*from.surface), placeSignatures(*to.surface));
    const auto T_from_to = alignViewpoints(*from.surface, *to.surface, likeness);
    const auto error = test::errorOf(T_from_to, geometry::inverse(T_building_from) * T_building_to);
    EXPECT_LT(error.radians, 6.0 * kDegree);
    // The viewpoints lie on each other, however far off the frames' origins are.
    const auto there = from.surface->viewpoints()[likeness.from].position_in_submap();
    const auto here = to.surface->viewpoints()[likeness.to].position_in_submap();
    EXPECT_LT((test::apply(T_from_to, here) - there).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace prodomos::localization
