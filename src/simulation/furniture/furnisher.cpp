// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/furnisher.hpp"

#include "prodomos/simulation/furniture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prodomos::simulation {

namespace {

constexpr double kBehind = 0.03;         // metres between furniture and wall: skirting
constexpr double kOnWall = 0.002;        // metres behind what hangs
constexpr std::size_t kMostThings = 80;  // a room, windows and all

geometry::Pose2 poseOf(const Thing& thing) {
  return geometry::toPose2(thing.T_world_thing);
}

}  // namespace

Furnisher::Furnisher(const Building& building, int room, std::uint64_t seed)
    : building_(building),
      space_(building, room),
      random_(seed, "furniture of " + space_.room().id),
      area_(signedArea(space_.room().outline)) {}

bool Furnisher::isFull() const {
  return space_.addedCount() >= kMostThings;
}

int Furnisher::by(double perSquareMetre, int least, int most) const {
  return std::clamp(static_cast<int>(std::lround(area_ * perSquareMetre)), least, most);
}

const WallStretch& Furnisher::longestWall() const {
  return *std::ranges::max_element(space_.walls(), {}, &WallStretch::length);
}

/// No room lies behind it.
bool Furnisher::isOuter(const WallStretch& wall, double at) const {
  const Eigen::Vector2d point = wall.from + at * wall.along();
  return std::ranges::all_of(std::array{0.1, 0.3, 0.5}, [&](double behind) {
    return roomAt(building_, space_.room().storey, point - behind * wall.inward()) == kOutside;
  });
}

Thing Furnisher::make(std::string_view kind, bool varies) {
  const auto* found = findThingKind(kind);
  const auto draw = [&] {
    Eigen::Vector3d size;
    for (int axis = 0; axis < 3; ++axis) size[axis] = random_.uniform(found->least[axis], found->most[axis]);
    return size;
  };
  Thing thing;
  thing.kind = kind;
  thing.storey = space_.room().storey;
  thing.size = varies ? draw() : sizes_.try_emplace(found->name, Eigen::Vector3d::Zero()).first->second;
  if (thing.size.isZero()) thing.size = sizes_[found->name] = draw();
  return thing;
}

std::optional<Thing> Furnisher::add(Thing thing, const geometry::Pose2& pose, double bottom) {
  if (isFull()) return std::nullopt;
  thing.id = space_.room().id + "/" + thing.kind + "_" + std::to_string(space_.addedCount() + 1);
  thing.T_world_thing = geometry::toPose3(pose, space_.floorLevel() + bottom + thing.size.z() / 2.0);
  if (!space_.tryAdd(thing)) return std::nullopt;
  return thing;
}

std::optional<Thing> Furnisher::add(std::string_view kind, const geometry::Pose2& pose) {
  return add(make(kind), pose, findThingKind(kind)->bottom);
}

std::optional<Thing> Furnisher::addAtWall(std::string_view kind, const WallStretch& wall, double at) {
  const auto* found = findThingKind(kind);
  const auto thing = make(kind, found->hangs);
  const double depth = thing.size.x() / 2.0 + (found->hangs ? kOnWall : kBehind);
  const Eigen::Vector2d middle = wall.from + at * wall.along() + depth * wall.inward();
  return add(thing, {middle.x(), middle.y(), std::atan2(wall.inward().y(), wall.inward().x())}, found->bottom);
}

/// Longer walls are tried more often; corners and places beside what stands there already as often as others.
std::optional<Thing> Furnisher::addAtWall(std::string_view kind, int tries) {
  double whole = 0.0;
  for (const auto& wall : space_.walls()) whole += wall.length();
  const double half = findThingKind(kind)->most.y() / 2.0;
  for (int i = 0; i < tries; ++i) {
    double at = random_.uniform(0.0, whole);
    const auto* wall = &space_.walls().front();
    while (at > wall->length() && wall != &space_.walls().back()) at -= (wall++)->length();
    const double margin = std::min(half + 0.05, wall->length() / 2.0);
    const bool inCorner = chance(0.3);
    const double place =
        inCorner ? (chance(0.5) ? margin : wall->length() - margin) : std::clamp(at, margin, wall->length() - margin);
    if (auto added = addAtWall(kind, *wall, place)) return added;
  }
  return std::nullopt;
}

void Furnisher::addAtWalls(std::string_view kind, int count) {
  for (int i = 0; i < count; ++i) {
    if (!addAtWall(kind)) return;
  }
}

/// Parallel to the longest wall, at the outline's middle if it fits there, else where there is room to walk.
std::optional<Thing> Furnisher::addInTheMiddle(std::string_view kind) {
  constexpr int kTries = 20;
  const auto& wall = longestWall();
  const double heading = std::atan2(wall.inward().y(), wall.inward().x());
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& corner : space_.room().outline) middle += corner / static_cast<double>(space_.room().outline.size());
  if (auto added = add(kind, {middle.x(), middle.y(), heading})) return added;
  for (int i = 0; i < kTries && space_.freeCells() > 0; ++i) {
    const auto cell =
        space_.freeCell(static_cast<std::size_t>(random_.integer(0, static_cast<int>(space_.freeCells()) - 1)));
    if (auto added = add(kind, {cell.x(), cell.y(), heading})) return added;
  }
  return std::nullopt;
}

/// Evenly along outer walls, all of one size; glass to the floor in some rooms.
void Furnisher::windows() {
  const std::string_view kind = chance(0.12) ? "tall_window" : "window";
  const auto pattern = make(kind);
  const double pitch = pattern.size.y() + random_.uniform(0.5, 1.6);
  for (const auto& wall : space_.walls()) {
    const int count = static_cast<int>((wall.length() - 0.3) / pitch);
    for (int i = 0; i < count && space_.addedCount() < kMostThings / 3; ++i) {
      const double at = wall.length() * (i + 0.5) / count;
      const double half = pattern.size.y() / 2.0;
      if (!isOuter(wall, at - half) || !isOuter(wall, at) || !isOuter(wall, at + half)) continue;
      const Eigen::Vector2d middle = wall.from + at * wall.along() + (pattern.size.x() / 2.0 + kOnWall) * wall.inward();
      const geometry::Pose2 pose{middle.x(), middle.y(), std::atan2(wall.inward().y(), wall.inward().x())};
      add(pattern, pose, findThingKind(kind)->bottom);
    }
  }
}

/// A desk, what one looks at on it, and a chair before it.
bool Furnisher::workplace(const geometry::Pose2& desk, std::string_view kind) {
  const auto table = add(kind, desk);
  if (!table) return false;
  const auto chair = make("office_chair");
  const double turn = random_.uniform(-0.4, 0.4);
  const double reach = chair.size.x() * std::cos(turn) + chair.size.y() * std::abs(std::sin(turn));
  const double before = (table->size.x() + reach) / 2.0 + random_.uniform(0.01, 0.12);
  add(chair, desk * geometry::Pose2{before, random_.uniform(-0.15, 0.15), std::numbers::pi + turn}, 0.0);
  const auto screen = make("screen");
  const double back = (screen.size.x() - table->size.x()) / 2.0 + 0.06;
  add(screen, desk * geometry::Pose2{back, random_.uniform(-0.15, 0.15), 0.0}, table->size.z());
  return true;
}

void Furnisher::workplacesAtWalls(int count, std::string_view kind) {
  constexpr int kTries = 8;
  for (int i = 0, failed = 0; i < count && failed < kTries;) {
    const auto& wall =
        space_.walls()[static_cast<std::size_t>(random_.integer(0, static_cast<int>(space_.walls().size()) - 1))];
    const auto desk = make(kind);
    const double half = desk.size.y() / 2.0 + 0.05;
    const double at = random_.uniform(half, std::max(half, wall.length() - half));
    const Eigen::Vector2d middle = wall.from + at * wall.along() + (desk.size.x() / 2.0 + kBehind) * wall.inward();
    if (workplace({middle.x(), middle.y(), std::atan2(wall.inward().y(), wall.inward().x())}, kind)) {
      ++i;
    } else {
      ++failed;
    }
  }
}

/// Along both long sides, and where it is wide at its ends.
void Furnisher::seatsAround(const Thing& table, std::string_view kind, double pitch) {
  const auto pose = poseOf(table);
  const auto chair = make(kind);
  const auto side = [&](double length, double offset, double heading) {
    const int count = static_cast<int>(length / pitch);
    for (int i = 0; i < count; ++i) {
      const double at = length * ((i + 0.5) / count - 0.5);
      const double out = offset + chair.size.x() / 2.0 + random_.uniform(0.02, 0.1);
      const geometry::Pose2 T_table_side{0.0, 0.0, heading};
      add(chair, pose * T_table_side * geometry::Pose2{out, at, std::numbers::pi}, 0.0);
    }
  };
  side(table.size.y(), table.size.x() / 2.0, 0.0);
  side(table.size.y(), table.size.x() / 2.0, std::numbers::pi);
  side(table.size.x(), table.size.y() / 2.0, std::numbers::pi / 2.0);
  side(table.size.x(), table.size.y() / 2.0, -std::numbers::pi / 2.0);
}

bool Furnisher::tableWithSeats(std::string_view table, std::string_view seat) {
  const auto added = addInTheMiddle(table);
  if (added) seatsAround(*added, seat, 0.65);
  return added.has_value();
}

/// Rows that face a wall, the first `begin` metres before it, `gap` from the middle of one to the next beside it. Where
/// those were more than `most`, they stand wider apart.
void Furnisher::rows(const WallStretch& front, double begin, double pitch, double gap,
                     bool (Furnisher::*add)(geometry::Pose2), int most) {
  double depth = 0.0;
  double left = 0.0;
  double right = 0.0;
  for (const auto& corner : space_.room().outline) {
    depth = std::max(depth, front.inward().dot(corner - front.from));
    left = std::min(left, front.along().dot(corner - front.from));
    right = std::max(right, front.along().dot(corner - front.from));
  }
  const double wider = std::sqrt(std::max(1.0, (depth - begin) / pitch * (right - left) / gap / most));
  const double heading = std::atan2(front.inward().y(), front.inward().x());
  const int columns = std::max(1, static_cast<int>((right - left - 0.6) / (gap * wider)));
  for (double row = begin; row < depth - 0.5; row += pitch * wider) {
    for (int column = 0; column < columns; ++column) {
      const double at = (left + right) / 2.0 + (column - (columns - 1) / 2.0) * gap * wider;
      const Eigen::Vector2d place = front.from + at * front.along() + row * front.inward();
      (this->*add)({place.x(), place.y(), heading});
    }
  }
}

bool Furnisher::pupils(geometry::Pose2 desk) {
  if (chance(0.04)) return false;
  const auto table = add("school_desk", desk);
  if (!table) return false;
  const auto chair = make("chair");
  for (const double aside : {-0.25, 0.25}) {
    const double before = (table->size.x() + chair.size.x()) / 2.0 + random_.uniform(0.0, 0.12);
    add(chair, desk * geometry::Pose2{before, aside * table->size.y(), std::numbers::pi}, 0.0);
  }
  return true;
}

bool Furnisher::computerPlace(geometry::Pose2 desk) {
  return workplace(desk, "desk");
}

bool Furnisher::seat(geometry::Pose2 pose) {
  return add("chair", pose * geometry::Pose2{0.0, 0.0, std::numbers::pi}).has_value();
}

bool Furnisher::deskWithPartition(geometry::Pose2 desk) {
  if (!workplace(desk, "desk")) return false;
  const auto size = make("desk").size;
  add("partition", desk * geometry::Pose2{-size.x() / 2.0 - 0.05, 0.0, 0.0});
  return true;
}

bool Furnisher::rack(geometry::Pose2 pose) {
  return add("storage_shelf", pose).has_value();
}

bool Furnisher::bookcase(geometry::Pose2 pose) {
  return add("shelf", pose).has_value();
}

void Furnisher::radiators() {
  if (chance(0.5)) addAtWalls("radiator", by(0.03, 1, 3));
}

/// What hangs and stands in all sorts of rooms.
void Furnisher::decorate(int most) {
  constexpr std::array<std::string_view, 6> kKinds{"poster", "poster", "noticeboard", "plant", "sign", "bin"};
  const int count = random_.integer(0, most);
  for (int i = 0; i < count; ++i) {
    addAtWall(kKinds[static_cast<std::size_t>(random_.integer(0, static_cast<int>(kKinds.size()) - 1))]);
  }
}

/// Of a door's size, but none.
void Furnisher::trapDoorDetectors(int most) {
  constexpr std::array<std::string_view, 5> kKinds{"wall_panel", "tall_poster", "cupboard", "lockers", "noticeboard"};
  const int count = random_.integer(0, most);
  for (int i = 0; i < count; ++i) {
    addAtWall(kKinds[static_cast<std::size_t>(random_.integer(0, static_cast<int>(kKinds.size()) - 1))]);
  }
}

void Furnisher::trapStairDetectors() {
  if (chance(0.2)) addAtWall("ramp");
  if (chance(0.35)) addAtWall("box_pile");
}

}  // namespace prodomos::simulation
