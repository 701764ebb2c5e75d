// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/scene_file.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"
#include "prodomos/simulation/furniture.hpp"

#include "simulation/scene_geometry.hpp"
#include "simulation/scene_people.hpp"
#include "simulation/yaml_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::string_view kOutsideName = "outside";

constexpr std::array<std::string_view, 3> kStates{"closed", "ajar", "open"};
constexpr std::array<double, 3> kAngles{0.0, 30.0 * kDegree, 90.0 * kDegree};
constexpr double kTurning = 2.0;  // seconds that a leaf takes from one state to another

std::optional<double> angleOf(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  const auto state = std::ranges::find(kStates, node.Scalar());
  if (state == kStates.end()) return std::nullopt;
  return kAngles[static_cast<std::size_t>(state - kStates.begin())];
}

/// Reads one scene: first all rooms, then what stands between and in them.
class SceneReader {
 public:
  SceneReader(const std::filesystem::path& path, std::uint64_t seed) : faults_(path.string()), seed_(seed) {}

  Building read(const YAML::Node& root);

 private:
  void readStorey(YamlMap& map, int storey);
  void readRoom(const YAML::Node& node, int storey);
  Polygon readOutline(YamlMap& map);
  void checkRoomsAreApart(int storey);
  void readDoor(const YAML::Node& node, int storey);
  std::array<int, 2> readDoorRooms(YamlMap& map, int storey);
  void placeDoor(YamlMap& map, Door& door);
  std::vector<WallStretch> wallsBetween(const std::array<int, 2>& rooms) const;
  void readLeaves(YamlMap& map, Door& door);
  void readSwings(YamlMap& map, Door& door);
  void readStairs(const YAML::Node& node, int storey);
  double riseOf(YamlMap& map, const Staircase& stairs, std::optional<double> stepHeight) const;
  int roomHolding(YamlMap& map, const Staircase& stairs, bool head);
  void readLift(const YAML::Node& node);
  void readThing(const YAML::Node& node, int storey);
  void placeThing(YamlMap& map, const ThingKind& kind, const Eigen::Vector2d& at, Thing& thing);
  void readPersonOf(const YAML::Node& node, int storey);
  void seatPeople();
  void drawStates();
  void readLighting(YamlMap& map);
  void markFurnished();

  std::string readId(YamlMap& map, std::string_view what);
  std::optional<int> roomNamed(const std::string& id) const;
  double rise(int storey) const { return building_.storeys[static_cast<std::size_t>(storey)].ceilingHeight + slab_; }
  bool isModelled(int storey) const { return storey >= 0 && storey < static_cast<int>(building_.storeys.size()); }
  const Room& room(int index) const { return building_.rooms[static_cast<std::size_t>(index)]; }

  Faults faults_;
  std::uint64_t seed_;
  Building building_;
  double wallThickness_ = 0.2;
  double slab_ = 0.3;
  std::vector<Polygon> centreLines_;          ///< by room
  std::vector<int> roomLines_;                ///< by room
  std::vector<std::optional<bool>> furnish_;  ///< by room, as given
  std::vector<bool> stateGiven_;              ///< by door
  std::set<std::size_t> passed_;              ///< doors that people go through
  std::set<std::string> ids_;
};

Building SceneReader::read(const YAML::Node& root) {
  YamlMap map(faults_, root, "scene");
  building_.name = map.text("scene").value_or("");
  wallThickness_ = map.number("wall_thickness", {0.05, 0.6}).value_or(wallThickness_);
  slab_ = map.number("floor_thickness", {0.1, 1.0}).value_or(slab_);
  map.require("storeys", "a list of storeys");
  const auto storeys = map.list("storeys");
  if (map.has("storeys") && storeys.empty()) map.fault("storeys", "one storey or more", "none");
  std::vector<YamlMap> maps;
  for (std::size_t i = 0; i < storeys.size(); ++i) {
    maps.emplace_back(faults_, storeys[i], "storey " + std::to_string(i));
    readStorey(maps.back(), static_cast<int>(i));
  }
  const auto readAll = [&](std::string_view key, auto read) {
    for (std::size_t i = 0; i < maps.size(); ++i) {
      for (const auto& node : maps[i].list(key)) (this->*read)(node, static_cast<int>(i));
    }
  };
  readAll("doors", &SceneReader::readDoor);
  readAll("stairs", &SceneReader::readStairs);
  readAll("furniture", &SceneReader::readThing);
  readAll("people", &SceneReader::readPersonOf);
  for (const auto& node : map.list("lifts")) readLift(node);
  readLighting(map);
  for (auto& storey : maps) storey.finish();
  map.finish();
  faults_.throwIfAny();
  markFurnished();
  seatPeople();
  drawStates();
  return std::move(building_);
}

void SceneReader::readStorey(YamlMap& map, int storey) {
  const double below = storey == 0 ? 0.0 : building_.storeys.back().floor_z + rise(storey - 1);
  const double height = map.number("height", {2.2, 10.0}).value_or(2.8);
  building_.storeys.push_back({below, height});
  if (map.require("rooms", "a list of rooms")) {
    for (const auto& node : map.list("rooms")) readRoom(node, storey);
  }
  checkRoomsAreApart(storey);
  for (const auto& lamp : map.list("lamps")) {
    const auto point = parsePoint(lamp);
    if (!point || roomAt(building_, storey, *point) == kOutside) {
      map.fault("lamps", "a point [x, y] in a room", shown(lamp));
    } else {
      building_.lighting.lamps.emplace_back(point->x(), point->y(), below + height - 0.15);
    }
  }
}

std::string SceneReader::readId(YamlMap& map, std::string_view what) {
  if (!map.require("id", "a name")) return "";
  const auto id = map.text("id").value_or("");
  map.rename(std::string(what) + " '" + id + "'");
  if (id == kOutsideName || !ids_.insert(id).second) {
    map.fault("id", "a name that nothing else has", "'" + id + "'");
  }
  return id;
}

std::optional<int> SceneReader::roomNamed(const std::string& id) const {
  const auto room = std::ranges::find(building_.rooms, id, &Room::id);
  if (room == building_.rooms.end()) return std::nullopt;
  return static_cast<int>(room - building_.rooms.begin());
}

void SceneReader::readRoom(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "room");
  Room room;
  room.storey = storey;
  room.id = readId(map, "room");
  if (map.require("label", "what the room is: OFFICE, CORRIDOR, STAIRS")) room.label = map.text("label").value_or("");
  room.use = useOfLabel(room.label);
  const auto furnish = map.flag("furnish");
  const auto centreLines = readOutline(map);
  map.finish();
  if (centreLines.empty()) return;
  room.outline = insetBy(centreLines, wallThickness_ / 2.0);
  if (findSelfCrossing(room.outline) || signedArea(room.outline) < 0.1) {
    faults_.add(map.line(), map.name(), "a room wider than its walls are thick", "none between them");
    return;
  }
  building_.rooms.push_back(std::move(room));
  centreLines_.push_back(centreLines);
  roomLines_.push_back(map.line());
  furnish_.push_back(furnish);
}

/// Centre lines of the walls, counter-clockwise; empty where they are faulty.
Polygon SceneReader::readOutline(YamlMap& map) {
  if (map.has("rectangle") == map.has("polygon")) {
    map.fault("rectangle", "either 'rectangle' or 'polygon'", map.has("polygon") ? "both" : "none");
    map.find("rectangle");
    map.find("polygon");
    return {};
  }
  if (map.find("rectangle")) {
    const auto sides = map.numbers("rectangle", 4);
    if (!sides) return {};
    const auto& [x0, y0, x1, y1] = std::array{(*sides)[0], (*sides)[1], (*sides)[2], (*sides)[3]};
    if (x0 < x1 && y0 < y1) return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    map.fault("rectangle", "[x0, y0, x1, y1] with x0 < x1 and y0 < y1", shown(*map.find("rectangle")));
    return {};
  }
  Polygon polygon;
  for (const auto& item : map.list("polygon")) {
    const auto corner = parsePoint(item);
    if (corner) {
      polygon.push_back(*corner);
    } else {
      map.fault("polygon", "corners [x, y]", shown(item));
      return {};
    }
  }
  if (polygon.size() < 3) {
    map.fault("polygon", "three corners or more", std::to_string(polygon.size()));
    return {};
  }
  if (const auto crossing = findSelfCrossing(polygon)) {
    map.fault("polygon", "walls that do not cross or touch",
              "those from " + toText(polygon[crossing->first]) + " and from " + toText(polygon[crossing->second]));
    return {};
  }
  return tidied(std::move(polygon));
}

void SceneReader::checkRoomsAreApart(int storey) {
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& room = building_.rooms[i];
      const auto& other = building_.rooms[j];
      if (room.storey != storey || other.storey != storey || !overlap(room.outline, other.outline)) continue;
      faults_.add(roomLines_[i], "room '" + room.id + "'", "a room of its own", "one that overlaps '" + other.id + "'");
    }
  }
}

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
  const double floor_z = building_.storeys[static_cast<std::size_t>(storey)].floor_z;
  stairs.foot << foot, up ? floor_z : floor_z - height;
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

void SceneReader::readThing(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "furniture");
  Thing thing;
  thing.storey = storey;
  map.require("kind", "what it is: desk, chair, poster");
  map.require("at", "a point [x, y]");
  thing.kind = map.text("kind").value_or("");
  map.rename("furniture '" + thing.kind + "'");
  thing.id = map.has("id") ? readId(map, "furniture") : thing.kind + "_" + std::to_string(building_.things.size() + 1);
  const auto* kind = findThingKind(thing.kind);
  if (kind == nullptr && map.has("kind")) {
    std::string known;
    for (const auto& each : thingKinds()) known += (known.empty() ? "" : ", ") + std::string(each.name);
    map.fault("kind", "one of " + known, "'" + thing.kind + "'");
  }
  const auto at = map.point("at");
  const auto size = map.numbers("size", 3);
  if (size && std::ranges::any_of(*size, [](double side) { return side < 0.005 || side > 10.0; })) {
    map.fault("size", "[depth, width, height], each of 0.005 to 10 m", shown(*map.find("size")));
  }
  if (kind != nullptr) thing.size = (kind->least + kind->most) / 2.0;
  if (size) thing.size = Eigen::Vector3d((*size)[0], (*size)[1], (*size)[2]);
  if (kind != nullptr && at) placeThing(map, *kind, *at, thing);
  map.finish();
  building_.things.push_back(std::move(thing));
}

/// What hangs is drawn to the nearest wall, unless its yaw is given.
void SceneReader::placeThing(YamlMap& map, const ThingKind& kind, const Eigen::Vector2d& at, Thing& thing) {
  constexpr double kReach = 0.5;  // metres
  const auto& storey = building_.storeys[static_cast<std::size_t>(thing.storey)];
  const double bottom = map.number("z", {0.0, storey.ceilingHeight}).value_or(kind.bottom);
  const auto given = map.number("yaw", {-360.0, 360.0});
  double yaw = given.value_or(0.0) * kDegree;
  Eigen::Vector2d middle = at;
  const int in = roomAt(building_, thing.storey, at);
  if (in == kOutside) {
    map.fault("at", "a point in a room", toText(at));
    return;
  }
  if (kind.hangs && !given) {
    double nearest = kReach;
    for (const auto& wall : wallsOf(room(in).outline)) {
      const double distance = distanceToSegment(at, wall.from, wall.to);
      if (distance >= nearest) continue;
      nearest = distance;
      middle = at + (thing.size.x() / 2.0 - wall.inward().dot(at - wall.from)) * wall.inward();
      yaw = std::atan2(wall.inward().y(), wall.inward().x());
    }
    if (nearest == kReach) map.fault("at", "a point within 0.5 m of a wall, or a yaw", toText(at));
  }
  thing.T_world_thing =
      geometry::toPose3({middle.x(), middle.y(), yaw}, storey.floor_z + bottom + thing.size.z() / 2.0);
  if (bottom + thing.size.z() > storey.ceilingHeight) {
    map.fault("z", "a thing below the ceiling", "one up to " + toText(bottom + thing.size.z()) + " m");
  }
  if (!isWithin(room(in).outline, placeOf(thing))) {
    map.fault("at", "a thing within the walls of '" + room(in).id + "'", "one that cuts them at " + toText(at));
  }
}

void SceneReader::readPersonOf(const YAML::Node& node, int storey) {
  YamlMap map(faults_, node, "person");
  std::vector<Passage> passages;
  auto person = readPerson(map, building_, storey, passages);
  if (!person.id.empty() && !ids_.insert(person.id).second) {
    map.fault("id", "a name that nothing else has", "'" + person.id + "'");
  }
  if (!map.has("look")) person.look = base::Random(seed_, "scene person " + person.id).integer(0, 1 << 30);
  building_.people.push_back(std::move(person));
  for (const auto& passage : passages) {
    passed_.insert(passage.door);
    const auto& door = building_.doors[passage.door];
    const bool closed = stateGiven_[passage.door] && door.leaves > 0 &&
                        stateOf(openingAngle(door, passage.time)) != map::DoorState::kOpen;
    if (!closed) continue;
    map.fault("path", "an open door",
              "'" + door.id + "' not open at " + toText(std::round(passage.time * 10.0) / 10.0) + " s");
    break;
  }
}

/// Who sits, sits on something.
void SceneReader::seatPeople() {
  for (const auto& person : building_.people) {
    if (!person.sits) continue;
    const auto& seat = person.way.front().position;
    const auto isBelow = [&](const Thing& thing) {
      return thing.storey == person.storey && placeOf(thing).distanceTo(seat) < 0.2;
    };
    if (std::ranges::any_of(building_.things, isBelow)) continue;
    const auto* kind = findThingKind("chair");
    Thing chair{.id = person.id + "_chair", .kind = "chair", .storey = person.storey};
    chair.size = (kind->least + kind->most) / 2.0;
    const double floor_z = building_.storeys[static_cast<std::size_t>(person.storey)].floor_z;
    chair.T_world_thing = geometry::toPose3({seat.x(), seat.y(), person.heading}, floor_z + chair.size.z() / 2.0);
    building_.things.push_back(std::move(chair));
  }
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

void SceneReader::readLighting(YamlMap& map) {
  const auto node = map.find("lighting");
  if (!node) return;
  YamlMap lighting(faults_, *node, "lighting");
  auto& light = building_.lighting;
  light.brightness = lighting.number("brightness", {0.05, 4.0}).value_or(light.brightness);
  light.ambient = lighting.number("ambient", {0.0, 1.0}).value_or(light.ambient);
  if (const auto tint = lighting.numbers("tint", 3)) {
    for (int i = 0; i < 3; ++i) light.tint[i] = static_cast<float>((*tint)[static_cast<std::size_t>(i)]);
    if (light.tint.minCoeff() < 0.0F || light.tint.maxCoeff() > 2.0F) {
      lighting.fault("tint", "three numbers of 0 to 2", shown(*lighting.find("tint")));
    }
  }
  lighting.finish();
  if (light.lamps.empty()) light.lamps = lampsOf(building_);
}

/// A room is furnished by seed where the file puts nothing into it, or asks for it.
void SceneReader::markFurnished() {
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    auto& room = building_.rooms[i];
    const auto standsIn = [&](const Thing& thing) {
      return thing.storey == room.storey && contains(room.outline, placeOf(thing).middle);
    };
    room.furnished = furnish_[i] ? !*furnish_[i] : std::ranges::any_of(building_.things, standsIn);
  }
}

}  // namespace

bool isSceneFile(const std::filesystem::path& path) {
  constexpr std::size_t kEnough = 4096;
  std::ifstream file(path, std::ios::binary);
  std::string begin(kEnough, '\0');
  file.read(begin.data(), kEnough);
  begin.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  for (std::size_t at = 0; at < begin.size();) {
    const auto end = std::min(begin.find('\n', at), begin.size());
    const std::string_view line = std::string_view(begin).substr(at, end - at);
    const auto word = line.find_first_not_of(" \t\r");
    if (word != std::string_view::npos && line[word] != '#' && !line.starts_with("---")) {
      return line.starts_with("scene:");
    }
    at = end + 1;
  }
  return false;
}

Building readSceneFile(const std::filesystem::path& path, std::uint64_t seed) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw base::FileError(base::expectedFound(path.string(), "a scene file", "none that can be read"));
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  try {
    return SceneReader(path, seed).read(YAML::Load(text));
  } catch (const YAML::Exception& fault) {
    throw base::FileError(
        base::expectedFound(path.string() + ":" + std::to_string(fault.mark.line + 1), "YAML", fault.msg));
  }
}

}  // namespace prodomos::simulation
