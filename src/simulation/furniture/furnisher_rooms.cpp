// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/furniture.hpp"

#include "simulation/furniture/furnisher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prodomos::simulation {

/// Which rooms are furnished how: the first whose word stands in the label, rooms of one use apart.
struct Furnisher::Recipe {
  std::string_view word;
  void (Furnisher::*furnish)();
};

const Furnisher::Recipe& Furnisher::recipeOf(const Room& room) {
  // Before what is a part of another: "CONFERENCE HALL" before "CONFERENCE".
  static constexpr std::array<Recipe, 43> kRecipes{{
      {"CLASS", &Furnisher::classroom},
      {"WARDROBE", &Furnisher::storage},
      {"CONFERENCE HALL", &Furnisher::lectureHall},
      {"LECTURE", &Furnisher::lectureHall},
      {"CONFERENCE", &Furnisher::meetingRoom},
      {"MEETING", &Furnisher::meetingRoom},
      {"LABORATORY", &Furnisher::laboratory},
      {"LAB", &Furnisher::laboratory},
      {"LOBBY", &Furnisher::lobby},
      {"ENTRANCE", &Furnisher::lobby},
      {"HALL", &Furnisher::lobby},
      {"WAITING", &Furnisher::lobby},
      {"CORRIDOR", &Furnisher::corridor},
      {"SHARED OFFICE", &Furnisher::sharedOffice},
      {"BIG ADMINISTRATIVE", &Furnisher::sharedOffice},
      {"MEDIUM ADMINISTRATIVE", &Furnisher::sharedOffice},
      {"ADMINISTRATIVE", &Furnisher::office},
      {"OPENSPACE", &Furnisher::openSpace},
      {"OPEN SPACE", &Furnisher::openSpace},
      {"CUBIC", &Furnisher::openSpace},
      {"OFFICE", &Furnisher::office},
      {"STUDY", &Furnisher::office},
      {"CLOSET", &Furnisher::storage},
      {"STORAGE", &Furnisher::storage},
      {"CELLAR", &Furnisher::storage},
      {"SERVICE", &Furnisher::storage},
      {"STORE", &Furnisher::shop},
      {"SHOP", &Furnisher::shop},
      {"WASHROOM", &Furnisher::washroom},
      {"BATH", &Furnisher::washroom},
      {"TOILET", &Furnisher::washroom},
      {"KITCHEN", &Furnisher::kitchen},
      {"CANTEEN", &Furnisher::canteen},
      {"CAFETERIA", &Furnisher::canteen},
      {"DINING", &Furnisher::canteen},
      {"GYM", &Furnisher::gym},
      {"LIBRARY", &Furnisher::library},
      {"RECEPTION", &Furnisher::reception},
      {"LIVING", &Furnisher::livingRoom},
      {"BEDROOM", &Furnisher::bedroom},
      {"PATIENT", &Furnisher::patientRoom},
      {"WARD", &Furnisher::patientRoom},
      {"", &Furnisher::otherRoom},
  }};
  static constexpr Recipe kStairwell{"STAIRS", &Furnisher::stairwell};
  if (room.use == RoomUse::kStairs) return kStairwell;
  const auto isFor = [&](const Recipe& recipe) { return room.label.find(recipe.word) != std::string::npos; };
  return *std::ranges::find_if(kRecipes, isFor);
}

std::vector<Thing> Furnisher::furnish() {
  if (space_.room().use == RoomUse::kLift) return {};
  (this->*recipeOf(space_.room()).furnish)();
  return space_.takeAdded();
}

void Furnisher::classroom() {
  const WallStretch* front = nullptr;
  for (const auto& wall : space_.walls()) {
    if (wall.length() < 2.6) continue;
    if (!addAtWall(chance(0.5) ? "blackboard" : "whiteboard", wall, wall.length() / 2.0)) continue;
    front = &wall;
    break;
  }
  windows();
  addAtWalls("cupboard", by(0.02, 0, 3));
  if (front != nullptr) {
    const geometry::Pose2 T_world_front{front->from.x(), front->from.y(),
                                        std::atan2(front->along().y(), front->along().x())};
    // The teacher's desk: one sits with the back to the board.
    const double at = front->length() * (chance(0.5) ? 0.3 : 0.7);
    workplace(T_world_front * geometry::Pose2{at, 1.4, -std::numbers::pi / 2.0}, "desk");
    rows(*front, random_.uniform(2.4, 2.9), random_.uniform(1.4, 1.6),
         make("school_desk").size.y() + random_.uniform(0.6, 0.8), &Furnisher::pupils);
  } else {
    tableWithSeats("table", "chair");
  }
  radiators();
  addAtWall("bin");
  decorate(4);
}

void Furnisher::laboratory() {
  addAtWall("whiteboard");
  windows();
  addAtWalls("cupboard", by(0.03, 1, 4));
  addAtWall("sink");
  if (chance(0.5)) {
    rows(longestWall(), 2.2, random_.uniform(1.9, 2.2), make("desk").size.y() + 0.05, &Furnisher::computerPlace);
  } else {
    addAtWalls("lab_bench", by(0.05, 1, 8));
    for (int i = by(0.03, 0, 8); i > 0; --i) tableWithSeats("table", "chair");
  }
  addAtWalls("storage_shelf", by(0.02, 0, 3));
  decorate(4);
}

void Furnisher::office() {
  if (area_ > 40.0) {
    sharedOffice();
    return;
  }
  windows();
  workplacesAtWalls(area_ > 16.0 && chance(0.4) ? 2 : 1, "desk");
  addAtWall(chance(0.5) ? "shelf" : "cupboard");
  addAtWall("filing_cabinet");
  if (area_ > 18.0) tableWithSeats("table", "chair");
  if (area_ > 25.0 && chance(0.6)) addAtWall("sofa");
  addAtWall("bin");
  if (chance(0.5)) addAtWall("plant");
  if (chance(0.4)) addAtWall("whiteboard");
  if (area_ > 11.0) addAtWall("shelf");
  radiators();
  decorate(3);
}

void Furnisher::sharedOffice() {
  windows();
  workplacesAtWalls(by(0.12, 2, 8), "desk");
  addAtWalls("shelf", by(0.04, 1, 4));
  addAtWalls("cupboard", by(0.03, 1, 4));
  if (area_ > 35.0) tableWithSeats("meeting_table", "office_chair");
  if (chance(0.6)) addAtWall("printer");
  if (chance(0.6)) addAtWall("whiteboard");
  addAtWall("plant");
  addAtWall("bin");
  radiators();
  decorate(4);
}

void Furnisher::openSpace() {
  windows();
  addAtWalls("cupboard", by(0.01, 1, 4));
  addAtWalls("shelf", by(0.01, 0, 3));
  rows(longestWall(), random_.uniform(1.6, 2.4), random_.uniform(2.1, 2.5),
       make("desk").size.y() + random_.uniform(0.05, 0.5), &Furnisher::deskWithPartition);
  if (space_.addedCount() < 6) workplacesAtWalls(2, "desk");
  addAtWall("printer");
  addAtWalls("plant", by(0.02, 1, 3));
  decorate(4);
}

void Furnisher::meetingRoom() {
  addAtWall(chance(0.5) ? "whiteboard" : "tv");
  windows();
  if (!tableWithSeats("meeting_table", "office_chair")) tableWithSeats("table", "chair");
  if (area_ > 45.0) tableWithSeats("meeting_table", "office_chair");
  addAtWall("low_cupboard");
  addAtWall("plant");
  decorate(3);
}

void Furnisher::lectureHall() {
  const auto& front = longestWall();
  addAtWall("whiteboard", front, front.length() / 2.0);
  windows();
  addAtWall("counter");
  rows(front, 2.8, random_.uniform(1.0, 1.2), random_.uniform(0.75, 0.9), &Furnisher::seat, 56);
  decorate(4);
}

void Furnisher::storage() {
  addAtWalls("storage_shelf", by(0.25, 1, 8));
  if (area_ > 40.0) rows(longestWall(), 3.0, 2.2, 1.7, &Furnisher::rack);
  if (chance(0.4)) addAtWall("cupboard");
  if (chance(0.3)) addAtWall("washing_machine");
  for (int i = random_.integer(0, 3); i > 0; --i) addAtWall("box");
  if (area_ > 6.0) addAtWall("box_pile");
  if (chance(0.4)) addAtWall("cart");
  if (chance(0.4)) addAtWall("fuse_box");
}

void Furnisher::washroom() {
  addAtWalls("toilet", by(0.15, 1, 6));
  addAtWalls("sink", by(0.15, 1, 6));
  const bool isPrivate = space_.room().label.find("BATH") != std::string::npos && area_ < 16.0;
  if (isPrivate && chance(0.6)) addAtWall("bathtub");
  if (isPrivate && chance(0.3)) addAtWall("washing_machine");
  windows();
  addAtWall("bin");
  if (chance(0.4)) addAtWall("radiator");
}

void Furnisher::kitchen() {
  windows();
  addAtWalls("kitchen_counter", by(0.12, 1, 4));
  addAtWall("fridge");
  addAtWall("stove");
  addAtWall("sink");
  if (area_ > 8.0) tableWithSeats("table", "chair");
  if (area_ > 12.0) addAtWall("cupboard");
  addAtWall("bin");
  decorate(2);
}

void Furnisher::canteen() {
  windows();
  if (area_ > 25.0) addAtWalls("counter", by(0.01, 1, 3));
  if (area_ > 25.0) addAtWalls("vending_machine", random_.integer(0, 2));
  for (int i = by(0.08, 1, 12); i > 0 && tableWithSeats("table", "chair"); --i) continue;
  addAtWalls("plant", by(0.01, 0, 3));
  addAtWalls("bin", 2);
  decorate(4);
}

void Furnisher::gym() {
  windows();
  addAtWalls("wall_bars", by(0.03, 2, 10));
  addAtWalls("bench", by(0.02, 1, 6));
  addAtWalls("box", random_.integer(1, 4));
  if (chance(0.5)) addAtWall("cart");
  if (chance(0.5)) addAtWall("box_pile");
  decorate(3);
}

void Furnisher::library() {
  windows();
  addAtWalls("shelf", by(0.08, 3, 16));
  addAtWall("counter");
  for (int i = by(0.04, 1, 6); i > 0 && tableWithSeats("table", "chair"); --i) continue;
  // Free-standing rows of books.
  if (area_ > 30.0) rows(longestWall(), 3.0, 2.0, 1.3, &Furnisher::bookcase);
  addAtWalls("armchair", by(0.02, 0, 3));
  decorate(3);
}

void Furnisher::reception() {
  windows();
  if (const auto counter = addInTheMiddle("counter")) {
    const auto pose = geometry::toPose2(counter->T_world_thing);
    add("office_chair", pose * geometry::Pose2{-counter->size.x() / 2.0 - 0.5, 0.0, 0.0});
  }
  addAtWalls("armchair", by(0.05, 1, 4));
  addAtWall("cupboard");
  addAtWall("coffee_table");
  addAtWalls("plant", 2);
  decorate(4);
}

void Furnisher::lobby() {
  windows();
  trapDoorDetectors(by(0.02, 1, 4));
  trapStairDetectors();
  addAtWalls("bench", by(0.02, 0, 4));
  if (area_ > 25.0) addAtWalls("sofa", random_.integer(0, 2));
  if (area_ > 40.0 && chance(0.5)) addAtWall("counter");
  if (area_ > 15.0 && chance(0.4)) addAtWall("vending_machine");
  addAtWalls("plant", by(0.02, 0, 4));
  addAtWalls("noticeboard", by(0.02, 0, 4));
  radiators();
  decorate(5);
}

void Furnisher::corridor() {
  windows();
  trapDoorDetectors(by(0.06, 1, 8));
  trapStairDetectors();
  addAtWalls("noticeboard", by(0.03, 1, 6));
  addAtWalls("poster", by(0.06, 1, 8));
  addAtWalls("sign", by(0.03, 1, 6));
  if (chance(0.5)) addAtWalls("low_cupboard", by(0.015, 0, 3));
  if (chance(0.4)) addAtWalls("bench", by(0.015, 0, 4));
  if (chance(0.4)) addAtWalls("lockers", by(0.02, 0, 6));
  if (chance(0.5)) addAtWalls("plant", by(0.02, 0, 4));
  if (chance(0.5)) addAtWall("fuse_box");
  addAtWalls("bin", by(0.01, 0, 2));
  radiators();
}

void Furnisher::livingRoom() {
  windows();
  addAtWall("sofa");
  addAtWall("low_cupboard");
  addAtWall("tv");
  addInTheMiddle("coffee_table");
  addAtWalls("armchair", by(0.06, 0, 2));
  addAtWalls("shelf", by(0.06, 1, 3));
  if (area_ > 22.0) tableWithSeats("table", "chair");
  addAtWall("floor_lamp");
  addAtWalls("plant", random_.integer(0, 2));
  decorate(3);
}

void Furnisher::bedroom() {
  windows();
  addAtWall("bed", 40);
  addAtWall("wardrobe");
  addAtWall("bedside_table");
  if (area_ > 11.0) workplacesAtWalls(1, "desk");
  if (area_ > 14.0) addAtWall("shelf");
  if (chance(0.4)) addAtWall("armchair");
  if (chance(0.5)) addAtWall("floor_lamp");
  decorate(3);
}

void Furnisher::patientRoom() {
  windows();
  for (int i = by(0.08, 1, 8); i > 0; --i) {
    const auto bed = addAtWall("hospital_bed", 30);
    if (!bed) break;
    const auto pose = geometry::toPose2(bed->T_world_thing);
    const auto table = make("bedside_table");
    const double back = (table.size.x() - bed->size.x()) / 2.0;
    const double beside = (bed->size.y() + table.size.y()) / 2.0 + 0.08;
    add(table, pose * geometry::Pose2{back, chance(0.5) ? beside : -beside, 0.0}, 0.0);
  }
  addAtWall("wardrobe");
  addAtWall("sink");
  addAtWalls("chair", by(0.05, 1, 4));
  if (chance(0.4)) addAtWall("cart");
  addAtWall("tv");
  addAtWall("bin");
  decorate(2);
}

void Furnisher::shop() {
  windows();
  addAtWall("counter");
  addAtWalls("storage_shelf", by(0.08, 2, 10));
  if (area_ > 25.0) rows(longestWall(), 2.6, 2.2, 1.8, &Furnisher::rack);
  if (chance(0.6)) addAtWall("fridge");
  if (chance(0.5)) addAtWall("vending_machine");
  addAtWall("box_pile");
  decorate(4);
}

void Furnisher::stairwell() {
  windows();
  for (int i = random_.integer(0, 2); i > 0; --i) addAtWall("sign");
  if (chance(0.4)) addAtWall("poster");
}

/// Of no known use.
void Furnisher::otherRoom() {
  windows();
  if (area_ < 8.0) {
    storage();
    return;
  }
  if (chance(0.6)) workplacesAtWalls(by(0.04, 1, 4), "desk");
  if (chance(0.5)) tableWithSeats("table", "chair");
  addAtWalls("cupboard", by(0.03, 1, 3));
  addAtWalls("shelf", by(0.03, 0, 3));
  radiators();
  decorate(4);
}

}  // namespace prodomos::simulation
