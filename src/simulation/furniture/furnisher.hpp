// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/building.hpp"

#include "simulation/furniture/room_space.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::simulation {

/// Furnishes one room by what its label says it is for.
class Furnisher {
 public:
  Furnisher(const Building& building, int room, std::uint64_t seed);

  std::vector<Thing> furnish();

 private:
  struct Recipe;
  static const Recipe& recipeOf(const Room& room);

  // Rooms (furnisher_rooms.cpp).
  void classroom();
  void laboratory();
  void office();
  void sharedOffice();
  void openSpace();
  void meetingRoom();
  void lectureHall();
  void storage();
  void washroom();
  void kitchen();
  void canteen();
  void gym();
  void library();
  void reception();
  void lobby();
  void corridor();
  void livingRoom();
  void bedroom();
  void patientRoom();
  void shop();
  void stairwell();
  void otherRoom();

  // Parts of rooms.
  void windows();
  void radiators();
  void decorate(int most);
  void trapDoorDetectors(int most);
  void trapStairDetectors();
  bool workplace(const geometry::Pose2& desk, std::string_view kind);
  void workplacesAtWalls(int count, std::string_view kind);
  void seatsAround(const Thing& table, std::string_view kind, double pitch);
  bool tableWithSeats(std::string_view table, std::string_view seat);
  void rows(const WallStretch& front, double begin, double pitch, double gap, bool (Furnisher::*add)(geometry::Pose2),
            int most = 20);
  bool pupils(geometry::Pose2 desk);
  bool computerPlace(geometry::Pose2 desk);
  bool seat(geometry::Pose2 pose);
  bool deskWithPartition(geometry::Pose2 desk);
  bool rack(geometry::Pose2 pose);
  bool bookcase(geometry::Pose2 pose);

  // Single things.
  /// Of one size in a room, unless it `varies`.
  Thing make(std::string_view kind, bool varies = false);
  std::optional<Thing> add(Thing thing, const geometry::Pose2& pose, double bottom);
  std::optional<Thing> add(std::string_view kind, const geometry::Pose2& pose);
  std::optional<Thing> addAtWall(std::string_view kind, int tries = 12);
  std::optional<Thing> addAtWall(std::string_view kind, const WallStretch& wall, double at);
  std::optional<Thing> addInTheMiddle(std::string_view kind);
  /// `count` of them, or fewer.
  void addAtWalls(std::string_view kind, int count);

  bool isFull() const;
  bool isOuter(const WallStretch& wall, double at) const;
  /// The longest wall; with `free`, of those without doors if there are any.
  const WallStretch& longestWall() const;
  int by(double perSquareMetre, int least, int most) const;
  bool chance(double probability) { return random_.uniform() < probability; }

  const Building& building_;
  RoomSpace space_;
  base::Random random_;
  double area_;
  std::map<std::string_view, Eigen::Vector3d> sizes_;
};

}  // namespace prodomos::simulation
