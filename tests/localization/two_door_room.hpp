// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "localization/flat_building.hpp"

#include <algorithm>
#include <iterator>

/// A room that can be entered by two doors, so that two sub-maps of it have seen it from different places.
namespace prodomos::test {

inline std::vector<Pose2> waySouth() {
  return placesAlong({-2.5, -2.9}, {-1.5, -0.3});
}
inline std::vector<Pose2> wayEast() {
  return placesAlong({3.9, 1.2}, {0.8, 0.2});
}

/// Frames of the sub-maps that begin in either door.
inline const Pose2 kSouthDoor{-2.5, -2.9, 1.2};
inline const Pose2 kEastDoor{3.9, 1.2, -2.8};

/// Eight metres by six; what stands in it depends on the seed.
inline FlatBuilding twoDoorRoom(std::uint64_t furniture) {
  FlatBuilding building;
  building.addWallWithDoors({-4.0, -3.0}, {4.0, -3.0}, {1.5});
  building.addWallWithDoors({4.0, -3.0}, {4.0, 3.0}, {4.2});
  building.addWall({4.0, 3.0}, {-4.0, 3.0});
  building.addWall({-4.0, 3.0}, {-4.0, -3.0});
  auto ways = waySouth();
  std::ranges::copy(wayEast(), std::back_inserter(ways));
  base::Random random(furniture);
  building.addFurniture(random, 6, 8.0, 6.0, ways);
  return building;
}

}  // namespace prodomos::test
