// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/person_tracker.hpp"

#include "prodomos/base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace prodomos::perception {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;
constexpr base::SubMapId kSubMap{4};
constexpr double kInterval = 0.2;  // seconds between readings

base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(seconds);
}

Appearance clothes(std::size_t color) {
  Appearance shares{};
  shares[color] = 0.8F;
  shares[20] = 0.2F;
  return shares;
}

PersonSighting seen(const Vector2d& position, std::optional<double> heading = std::nullopt, std::size_t color = 3) {
  PersonSighting sighting;
  sighting.position_in_submap = {position.x(), position.y(), 0.1};
  sighting.positionSigma = 0.05;
  sighting.heading = heading;
  sighting.headingSigma = 0.3;
  sighting.facing = heading ? 1.0 : 0.0;
  sighting.score = 0.9;
  sighting.appearance = clothes(color);
  return sighting;
}

/// A tracker with a clock and a counter of entities.
class Following : public testing::Test {
 protected:
  Following() : tracker(make()) {}

  PersonTracker make() {
    return PersonTracker({}, base::SessionId{2}, 10, [this] { return base::EntityId{nextEntity++}; });
  }
  void show(std::vector<PersonSighting> sightings, const map::OccupancyGrid* grid = nullptr) {
    for (auto& sighting : sightings) sighting.time = at(now);
    tracker.add(kSubMap, at(now), sightings, grid);
    now += kInterval;
  }
  std::vector<map::Track> tracks() {
    map::MapChange change;
    tracker.addTo(change);
    return change.tracks;
  }

  std::int64_t nextEntity = 70;
  double now = 100.0;
  PersonTracker tracker;
};

TEST_F(Following, SomeoneWhoWalksIsOneTrackWithItsVelocity) {
  base::Random random(3, "noise");
  for (int i = 0; i < 25; ++i) {
    show({seen({0.2 * i + random.normal(0.0, 0.04), 1.0 + random.normal(0.0, 0.04)}, kPi + 0.2)});  // 1 m/s
  }
  const auto people = tracker.entities();
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_EQ(people[0].id, base::EntityId{70});
  EXPECT_EQ(people[0].submap, kSubMap);
  EXPECT_EQ(people[0].observations, 25);
  EXPECT_GT(people[0].confidence, 0.95);
  EXPECT_EQ(people[0].firstSeen, at(100.0));
  EXPECT_LT((people[0].T_submap_entity.translation() - Vector3d(4.8, 1.0, 0.1)).norm(), 0.1);
  const auto& human = std::get<map::Human>(people[0].attributes);
  EXPECT_LT((human.velocity - Vector3d(1.0, 0.0, 0.0)).norm(), 0.2);
  EXPECT_EQ(human.dominantSide, 0);
  EXPECT_GT(people[0].covariance(0, 0), 0.0);
  const auto all = tracks();
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(all[0].id, base::TrackId{10});
  EXPECT_EQ(all[0].session, base::SessionId{2});
  EXPECT_EQ(all[0].className, "human");
  EXPECT_THAT(all[0].states, SizeIs(25));
  EXPECT_EQ(all[0].states.front().time, at(100.0));
}

TEST_F(Following, WhoWalksLooksAheadWhateverTheTorsoSeemed) {
  // Taken for looking back at first: what was not written yet is turned as well.
  for (int i = 0; i < 20; ++i) show({seen({0.2 * i, 0.0}, kPi)});
  const auto all = tracks();
  ASSERT_THAT(all, SizeIs(1));
  for (const auto& state : all[0].states) {
    EXPECT_NEAR(geometry::yaw(state.T_submap_thing), 0.0, 0.1) << base::toString(state.time);
  }
}

TEST_F(Following, TheHeadingOfWhoStandsIsSmoothed) {
  base::Random random(9, "noise");
  for (int i = 0; i < 30; ++i) show({seen({2.0, 0.0}, 1.0 + random.normal(0.0, 0.3))});
  EXPECT_NEAR(geometry::yaw(tracker.entities().at(0).T_submap_entity), 1.0, 0.3);
}

TEST_F(Following, AStrayMistakeOfFrontAndBackTurnsNobodyRound) {
  for (int i = 0; i < 20; ++i) show({seen({2.0, 0.0}, i % 5 == 4 ? 0.5 + kPi : 0.5)});
  EXPECT_NEAR(geometry::yaw(tracker.entities().at(0).T_submap_entity), 0.5, 0.1);
}

TEST_F(Following, AFlickerIsNobody) {
  show({seen({1.0, 0.0})});
  for (int i = 0; i < 10; ++i) show({});
  show({seen({3.0, 0.0})});
  for (int i = 0; i < 10; ++i) show({});
  EXPECT_THAT(tracker.entities(), IsEmpty());
  EXPECT_THAT(tracks(), IsEmpty());
  EXPECT_EQ(nextEntity, 70);
}

TEST_F(Following, DoubtfulSightingsBeginNobodyButGoOnWithSomeone) {
  auto doubtful = seen({1.0, 0.0});
  doubtful.score = 0.3;
  for (int i = 0; i < 10; ++i) show({doubtful});
  EXPECT_THAT(tracker.entities(), IsEmpty());
  for (int i = 0; i < 4; ++i) show({seen({1.0, 0.0})});
  for (int i = 0; i < 10; ++i) show({doubtful});
  ASSERT_THAT(tracker.entities(), SizeIs(1));
  EXPECT_EQ(tracker.entities()[0].observations, 14);
}

TEST_F(Following, GapsAreFilledWhereSomeoneWasSeenBeforeAndAfter) {
  for (int i = 0; i < 6; ++i) show({seen({0.2 * i, 0.0})});
  for (int i = 6; i < 9; ++i) show({});
  for (int i = 9; i < 12; ++i) show({seen({0.2 * i, 0.0})});
  for (int i = 12; i < 15; ++i) show({});
  const auto all = tracks();
  ASSERT_THAT(all, SizeIs(1));
  ASSERT_THAT(all[0].states, SizeIs(12));
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(all[0].states[i].time, at(100.0 + kInterval * static_cast<double>(i)));
    EXPECT_NEAR(all[0].states[i].T_submap_thing.translation().x(), 0.2 * static_cast<double>(i), 0.1);
  }
}

TEST_F(Following, IdentityOutlastsAnOcclusion) {
  for (int i = 0; i < 40; ++i) {
    const bool hidden = i >= 15 && i < 22;
    show(hidden ? std::vector<PersonSighting>{} : std::vector{seen({0.2 * i, 0.0})});
  }
  EXPECT_THAT(tracks(), SizeIs(1));
}

TEST_F(Following, WhoCrossEachOtherStayWhoTheyAre) {
  for (const bool alike : {true, false}) {
    tracker = make();
    for (int i = 0; i <= 40; ++i) {
      const double x = -4.0 + 0.2 * i;
      show({seen({x, 0.1}, std::nullopt, 3), seen({-x, -0.1}, std::nullopt, alike ? 3 : 11)});
    }
    const auto all = tracks();
    ASSERT_THAT(all, SizeIs(2));
    for (const auto& track : all) {
      const double begin = track.states.front().T_submap_thing.translation().x();
      const double end = track.states.back().T_submap_thing.translation().x();
      EXPECT_GT(std::abs(end - begin), 7.0) << alike;
    }
  }
}

TEST_F(Following, SomeoneMetAgainIsTheSameByClothesAndPlace) {
  for (int i = 0; i < 10; ++i) show({seen({2.0, 0.0})});
  now += 30.0;
  for (int i = 0; i < 10; ++i) show({seen({8.0, 3.0})});
  EXPECT_THAT(tracker.entities(), SizeIs(1));
  now += 30.0;
  for (int i = 0; i < 10; ++i) show({seen({2.0, 0.0}, std::nullopt, 14)});
  EXPECT_THAT(tracker.entities(), SizeIs(2));
  now += 3.0;
  for (int i = 0; i < 10; ++i) show({seen({200.0, 0.0})});  // too far in that time
  EXPECT_THAT(tracker.entities(), SizeIs(3));
}

TEST_F(Following, FurnitureThatLooksLikeLegsIsNobodyUntilItWalks) {
  base::Random random(1, "noise");
  auto legs = [&](double x) {
    auto sighting = seen({x + random.normal(0.0, 0.03), random.normal(0.0, 0.03)});
    sighting.appearance = {};
    sighting.mustMove = true;
    return sighting;
  };
  for (int i = 0; i < 200; ++i) show({legs(2.0)});
  EXPECT_THAT(tracker.entities(), IsEmpty());
  for (int i = 0; i < 10; ++i) show({legs(2.0 + 0.2 * i)});
  ASSERT_THAT(tracker.entities(), SizeIs(1));
  EXPECT_NEAR(geometry::yaw(tracker.entities()[0].T_submap_entity), 0.0, 0.3);
}

TEST_F(Following, TheDominantSideIsTheOneNearerToAWall) {
  map::OccupancyGrid grid;
  std::vector<map::OccupancyGrid::Beam> wall;  // along x, at y = 0.8
  for (double x = -2.0; x < 8.0; x += 0.02) wall.push_back({{x, 0.8}, true});
  for (int i = 0; i < 5; ++i) grid.insert({3.0, -2.0}, wall);
  for (int i = 0; i < 20; ++i) show({seen({0.2 * i, 0.0}, 0.0)}, &grid);
  EXPECT_EQ(std::get<map::Human>(tracker.entities().at(0).attributes).dominantSide, -1);
  tracker = make();
  for (int i = 0; i < 20; ++i) show({seen({4.0 - 0.2 * i, 0.0}, kPi)}, &grid);
  EXPECT_EQ(std::get<map::Human>(tracker.entities().at(0).attributes).dominantSide, 1);
}

TEST_F(Following, ThoseFollowedComeAlongIntoAnotherSubMap) {
  const auto T_new_old = geometry::fromYawPitchRoll({-1.0, 2.0, 0.0}, kPi / 2.0, 0.0, 0.0);
  for (int i = 0; i < 10; ++i) show({seen({0.2 * i, 0.0}, 0.0)});
  tracker.enter(T_new_old);
  EXPECT_EQ(tracker.entities().at(0).submap, kSubMap);  // where it was seen last
  for (int i = 10; i < 20; ++i) {
    const Vector3d position = T_new_old * Vector3d(0.2 * i, 0.0, 0.0);
    auto sighting = seen(position.head<2>(), kPi / 2.0);
    sighting.time = at(now);
    tracker.add(base::SubMapId{5}, at(now), {sighting}, nullptr);
    now += kInterval;
  }
  const auto all = tracks();
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(all[0].states, SizeIs(20));
  EXPECT_EQ(all[0].states[9].submap, kSubMap);
  EXPECT_EQ(all[0].states[10].submap, base::SubMapId{5});
  const auto person = tracker.entities().at(0);
  EXPECT_LT((person.T_submap_entity.translation() - Vector3d(-1.0, 5.8, 0.1)).norm(), 0.05);
  EXPECT_LT((std::get<map::Human>(person.attributes).velocity - Vector3d(0.0, 1.0, 0.0)).norm(), 0.1);
}

TEST_F(Following, JointsAreWrittenAsTheMapFileWantsThem) {
  auto sighting = seen({1.0, 2.0});
  sighting.joints_in_submap[1] = Vector3d(1.0, 2.0, 1.5);
  for (int i = 0; i < 4; ++i) show({sighting});
  const auto all = tracks();
  EXPECT_EQ(all.at(0).states.at(0).attributes,
            "{\"joints\": [null, [1.000, 2.000, 1.500], null, null, null, null, null, null, null, null, null, null, "
            "null, null]}");
  for (int i = 0; i < 4; ++i) show({seen({1.0, 2.0})});
  EXPECT_EQ(tracks().at(0).states.at(0).attributes, "{}");
}

TEST_F(Following, WritesWhatIsNewSinceTheLastTime) {
  for (int i = 0; i < 5; ++i) show({seen({1.0, 0.0})});
  map::MapChange first;
  tracker.addTo(first);
  EXPECT_THAT(first.entities, SizeIs(1));
  EXPECT_THAT(first.tracks.at(0).states, SizeIs(5));
  map::MapChange nothing;
  tracker.addTo(nothing);
  EXPECT_THAT(nothing.entities, IsEmpty());
  EXPECT_THAT(nothing.tracks, IsEmpty());
  for (int i = 0; i < 2; ++i) show({seen({1.0, 0.0})});
  map::MapChange more;
  tracker.addTo(more);
  EXPECT_THAT(more.tracks.at(0).states, SizeIs(2));
}

TEST_F(Following, GoesOnFromACheckpointBitByBit) {
  base::Random random(4, "noise");
  const auto some = [&] {
    std::vector<PersonSighting> sightings;
    for (int i = 0; i < 3; ++i) {
      if (random.uniform() < 0.8) {
        sightings.push_back(seen({random.normal(2.0 * i, 0.1), random.normal(0.0, 0.1)}, random.uniform(-kPi, kPi)));
      }
    }
    return sightings;
  };
  for (int i = 0; i < 30; ++i) show(some());
  base::ByteWriter saved;
  tracker.save(saved);
  auto resumed = make();
  base::ByteReader in(saved.bytes());
  resumed.load(in);
  EXPECT_EQ(in.left(), 0U);
  for (int i = 0; i < 30; ++i) {
    auto sightings = some();
    for (auto& sighting : sightings) sighting.time = at(now);
    tracker.add(kSubMap, at(now), sightings, nullptr);
    resumed.add(kSubMap, at(now), sightings, nullptr);
    now += kInterval;
  }
  base::ByteWriter one;
  base::ByteWriter other;
  tracker.save(one);
  resumed.save(other);
  EXPECT_EQ(one.bytes(), other.bytes());
}

TEST_F(Following, MemoryIsBounded) {
  base::Random random(8, "places");
  std::size_t early = 0;
  for (int person = 0; person < 400; ++person) {
    const Vector2d place(random.uniform(-500.0, 500.0), random.uniform(-500.0, 500.0));
    for (int i = 0; i < 4; ++i) show({seen(place, 0.0, static_cast<std::size_t>(person) % 16)});
    now += 5.0;
    tracks();
    base::ByteWriter out;
    tracker.save(out);
    if (person == 150) early = out.bytes().size();
    if (person == 399) {
      EXPECT_LT(out.bytes().size(), early + 4096);
    }
  }
}

TEST_F(Following, WantsNoMoreReadingsThanTheRate) {
  // A camera of 30 Hz at a rate of 10 Hz.
  int looks = 0;
  for (int i = 0; i < 300; ++i) {
    const auto time = at(200.0 + i / 30.0);
    if (!tracker.wants(time)) continue;
    tracker.add(kSubMap, time, {}, nullptr);
    ++looks;
  }
  EXPECT_NEAR(looks, 100, 2);
  EXPECT_TRUE(tracker.wants(at(300.0)));
}

}  // namespace
}  // namespace prodomos::perception
