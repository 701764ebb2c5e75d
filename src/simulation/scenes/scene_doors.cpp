// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/random.hpp"

#include "simulation/scenes/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

/// Doors, stairs and lifts of scene files.

namespace prodomos::simulation {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::array<std::string_view, 3> kStates{"closed", "ajar", "open"};
constexpr std::array<double, 3> kAngles{0.0, 30.0 * kDegree, 90.0 * kDegree};
constexpr double kTurning = 2.0;  // seconds that a leaf takes from one state to another

std::optional<double> angleOf(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  const auto state = std::ranges::find(kStates, node.Scalar());
  if (state == kStates.end()) return std::nullopt;
  return kAngles[static_cast<std::size_t>(state - kStates.begin())];
}

}  // namespace

void SceneReader::readDoor(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "door");
  const auto faultsBefore = faults_.count();
  Door door;
  door.storey = storey;
  door.wallThickness = wallThickness_;
  door.id = readId(map, "door");
  door.rooms = readDoorRooms(map, storey);
  readLeaves(map, door);
  placeDoor(map, door);
  readSwings(map, door);
  map.finish();
  if (faults_.count() != faultsBefore) return;
  building_.doors.push_back(std::move(door));
  stateGiven_.push_back(map.has("state"));
}

std::array<int, 2> SceneReader::readDoorRooms(YamlMap& map, int storey) {
  std::array<int, 2> rooms{kOutside, kOutside};
  if (!map.require("rooms", "the two rooms it joins")) return rooms;
  const auto names = map.list("rooms");
  if (names.size() != 2 || !names[0].IsScalar() || !names[1].IsScalar() || names[0].Scalar() == names[1].Scalar()) {
    map.fault("rooms", "two rooms, or a room and 'outside'", shown(*map.find("rooms")));
    return rooms;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& name = names[i].Scalar();
    if (name == kOutsideName) continue;
    const auto found = roomNamed(name);
    if (found && room(*found).storey == storey) {
      rooms[i] = *found;
    } else {
      map.fault("rooms", "a room of this storey", "'" + name + "'");
    }
  }
  return rooms;
}

void SceneReader::readLeaves(YamlMap& map, Door& door) {
  static constexpr std::array<std::string_view, 2> kSides{"left", "right"};
  base::Random random(seed_, "scene door " + door.id);
  door.leaves = map.wholeNumber("leaves", {0.0, 2.0}).value_or(door.leaves);
  door.width = map.number("width", {0.5, 6.0}).value_or(door.leaves == 2 ? 1.6 : door.width);
  const double ceiling = building_.storeys[static_cast<std::size_t>(door.storey)].ceilingHeight;
  door.height = map.number("height", {1.6, ceiling - 0.05}).value_or(door.height);
  const auto side = map.choice("hinge", kSides).value_or(random.integer(0, 1));
  door.hingeSide = side == 0 ? map::HingeSide::kLeft : map::HingeSide::kRight;
  // Doors open into rooms, as a rule, so that no leaf stands in a corridor's way.
  const bool fromCorridor = door.rooms[1] == kOutside || room(door.rooms[1]).use == RoomUse::kCorridor;
  door.opensAlongNormal = !fromCorridor;
  if (const auto into = map.text("opens_into")) {
    const auto nameOf = [&](int index) { return index == kOutside ? std::string(kOutsideName) : room(index).id; };
    door.opensAlongNormal = *into == nameOf(door.rooms[1]);
    if (!door.opensAlongNormal && *into != nameOf(door.rooms[0])) {
      map.fault("opens_into", "one of its two rooms", "'" + *into + "'");
    }
  }
}

/// Stretches of wall in which a door may stand, seen from the first room that is one.
std::vector<WallStretch> SceneReader::wallsBetween(const std::array<int, 2>& rooms) const {
  const auto linesOf = [&](int index) -> const Polygon& { return centreLines_[static_cast<std::size_t>(index)]; };
  if (rooms[0] != kOutside && rooms[1] != kOutside) return commonWalls(linesOf(rooms[0]), linesOf(rooms[1]));
  return wallsOf(linesOf(std::max(rooms[0], rooms[1])));
}

void SceneReader::placeDoor(YamlMap& map, Door& door) {
  if (!map.require("at", "a point [x, y] of the wall")) return;
  const auto at = map.point("at");
  if (!at || (door.rooms[0] == kOutside && door.rooms[1] == kOutside)) return;
  const auto walls = wallsBetween(door.rooms);
  if (walls.empty()) {
    map.fault("rooms", "two rooms with a common wall", "none between them");
    return;
  }
  for (const auto& wall : walls) {
    const double off = std::abs(wall.inward().dot(*at - wall.from));
    const double along = wall.along().dot(*at - wall.from);
    const double margin = (door.width + wallThickness_) / 2.0 - 1e-9;
    if (off > wallThickness_ / 2.0 || along < margin || along > wall.length() - margin) continue;
    const Eigen::Vector2d middle = wall.from + along * wall.along();
    const Eigen::Vector2d normal = door.rooms[0] == kOutside ? wall.inward() : Eigen::Vector2d(-wall.inward());
    door.pose = {middle.x(), middle.y(), std::atan2(normal.y(), normal.x())};
    const auto beyond = door.rooms[0] == kOutside || door.rooms[1] == kOutside;
    const Eigen::Vector2d outwards = middle - wall.inward() * wallThickness_;
    if (beyond && roomAt(building_, door.storey, outwards) != kOutside) {
      map.fault("rooms", "an outer wall", "room '" + room(roomAt(building_, door.storey, outwards)).id + "' behind it");
    }
    for (const auto& other : building_.doors) {
      const double distance = std::hypot(other.pose.x - middle.x(), other.pose.y - middle.y());
      if (other.storey == door.storey && distance < (other.width + door.width) / 2.0) {
        map.fault("at", "a place of its own", "door '" + other.id + "' there");
      }
    }
    return;
  }
  map.fault("at", "a point of the common wall with " + toText(door.width + wallThickness_) + " m of it around",
            toText(*at));
}

/// One state, or states by the second at which the leaf begins to turn into them.
void SceneReader::readSwings(YamlMap& map, Door& door) {
  const auto node = map.find("state");
  if (!node) return;
  const std::string expected = "closed, ajar, open, or {seconds: state, …} at least 2 s apart";
  if (node->IsScalar()) {
    const auto angle = angleOf(*node);
    if (!angle) map.fault("state", expected, shown(*node));
    if (angle && *angle > 0.0) door.swings = {{0.0, *angle}};
  } else if (node->IsMap()) {
    double angle = 0.0;
    for (const auto& entry : *node) {
      const auto time = parseNumber(entry.first);
      const auto next = angleOf(entry.second);
      const bool inOrder = time && (door.swings.empty() ? *time >= 0.0 : *time >= door.swings.back().time);
      if (!inOrder || !next) {
        map.fault("state", expected, shown(entry.first) + ": " + shown(entry.second));
        return;
      }
      if (*time > 0.0) door.swings.push_back({*time, angle});
      door.swings.push_back({*time > 0.0 ? *time + kTurning : 0.0, *next});
      angle = *next;
    }
  } else {
    map.fault("state", expected, shown(*node));
  }
  if (door.leaves == 0) map.fault("state", "nothing, as it has no leaf", shown(*node));
}

/// Of doors whose state the file leaves open: those that people pass are open, of the others most are closed.
void SceneReader::drawStates() {
  for (std::size_t i = 0; i < building_.doors.size(); ++i) {
    auto& door = building_.doors[i];
    if (stateGiven_[i] || door.leaves == 0) continue;
    const double drawn = base::Random(seed_, "scene door state " + door.id).uniform();
    if (passed_.contains(i) || drawn > 0.8) {
      door.swings = {{0.0, kAngles[2]}};
    } else if (drawn > 0.65) {
      door.swings = {{0.0, kAngles[1]}};
    }
  }
}

void SceneReader::readStairs(const YAML::Node& node, int storey) {
  static constexpr std::array<std::string_view, 2> kWays{"down", "up"};
  YamlMap map(faults_, node, "stairs");
  const auto faultsBefore = faults_.count();
  Staircase stairs;
  stairs.id = readId(map, "stairs");
  map.require("goes", "up or down");
  map.require("at", "the point [x, y] where one steps on to it");
  map.require("heading", "degrees, the way one walks on it from here");
  const bool up = map.choice("goes", kWays).value_or(1) == 1;
  const auto at = map.point("at").value_or(Eigen::Vector2d::Zero());
  const double heading = map.number("heading", {-360.0, 360.0}).value_or(0.0) * kDegree;
  stairs.width = map.number("width", {0.5, 6.0}).value_or(stairs.width);
  stairs.stepDepth = map.number("step_depth", {0.2, 0.5}).value_or(stairs.stepDepth);
  stairs.stepCount = map.wholeNumber("steps", {2.0, 60.0}).value_or(stairs.stepCount);
  const auto stepHeight = map.number("step_height", {0.05, 0.3});
  stairs.lowerStorey = up ? storey : storey - 1;
  stairs.upperStorey = stairs.lowerStorey + 1;
  stairs.direction = geometry::normalizeAngle(up ? heading : heading + std::numbers::pi);
  const double height = riseOf(map, stairs, stepHeight);
  stairs.stepHeight = height / stairs.stepCount;
  map.finish();
  const Eigen::Vector2d uphill(std::cos(stairs.direction), std::sin(stairs.direction));
  const Eigen::Vector2d foot = up ? at : Eigen::Vector2d(at - (stairs.stepCount - 1) * stairs.stepDepth * uphill);
  const double level = building_.storeys[static_cast<std::size_t>(storey)].floor_z;
  stairs.foot << foot, up ? level : level - height;
  if (faults_.count() != faultsBefore) return;
  stairs.rooms = {roomHolding(map, stairs, false), roomHolding(map, stairs, true)};
  building_.stairs.push_back(std::move(stairs));
}

/// From the lower storey's floor to the upper one's, as far as they are known; else as the steps have it.
double SceneReader::riseOf(YamlMap& map, const Staircase& stairs, std::optional<double> stepHeight) const {
  constexpr double kTolerance = 0.01;
  const bool known = isModelled(stairs.lowerStorey) && isModelled(stairs.upperStorey);
  if (!known && stepHeight) return stairs.stepCount * *stepHeight;
  const double height = rise(std::max(0, stairs.lowerStorey));
  const auto storeys = toText(std::round(height * 1e4) / 1e4) + " m from floor to floor";
  if (stepHeight && std::abs(stairs.stepCount * *stepHeight - height) > kTolerance) {
    map.fault("step_height", "steps that reach the storey, " + storeys,
              std::to_string(stairs.stepCount) + " of " + toText(*stepHeight) + " m");
  } else if (!stepHeight && (height / stairs.stepCount < 0.1 || height / stairs.stepCount > 0.22)) {
    map.fault("steps", "as many that each is 0.1 to 0.22 m high, for " + storeys, std::to_string(stairs.stepCount));
  }
  return height;
}

/// The room of its lower or upper end, which must hold the whole flight and a step before it.
int SceneReader::roomHolding(YamlMap& map, const Staircase& stairs, bool head) {
  constexpr double kLanding = 0.6;  // metres
  const int storey = head ? stairs.upperStorey : stairs.lowerStorey;
  if (!isModelled(storey)) return kOutside;
  auto footprint = placeOf(stairs);
  const Eigen::Vector2d uphill(std::cos(stairs.direction), std::sin(stairs.direction));
  footprint.middle += (head ? 1.0 : -1.0) * kLanding / 2.0 * uphill;
  footprint.size.x() += kLanding;
  const int found = roomAt(building_, storey, footprint.middle);
  if (found != kOutside && isWithin(room(found).outline, footprint)) return found;
  map.fault("at", "a room that holds the flight and 0.6 m before it on storey " + std::to_string(storey),
            found == kOutside ? "none" : "walls of '" + room(found).id + "' in its way");
  return kOutside;
}

void SceneReader::readLift(const YAML::Node& node) {
  YamlMap map(faults_, node, "lift");
  Lift lift;
  lift.id = readId(map, "lift");
  map.require("rooms", "the rooms of its cabin, by storey");
  for (const auto& name : map.list("rooms")) {
    const auto found = name.IsScalar() ? roomNamed(name.Scalar()) : std::nullopt;
    if (!found || room(*found).use != RoomUse::kLift) {
      map.fault("rooms", "rooms labelled ELEVATOR", shown(name));
      continue;
    }
    if (!lift.rooms.empty() && (room(*found).storey <= room(lift.rooms.back()).storey ||
                                !overlap(room(*found).outline, room(lift.rooms.front()).outline))) {
      map.fault("rooms", "rooms one above the other, the lowest first", shown(name));
    }
    lift.rooms.push_back(*found);
  }
  if (map.has("rooms") && lift.rooms.size() < 2) map.fault("rooms", "two rooms or more", shown(*map.find("rooms")));
  map.finish();
  if (lift.rooms.empty()) return;
  lift.outline = room(lift.rooms.front()).outline;
  building_.lifts.push_back(std::move(lift));
}

}  // namespace prodomos::simulation
