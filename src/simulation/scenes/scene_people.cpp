// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenes/scene_people.hpp"

#include "simulation/scenes/scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace prodomos::simulation {

namespace {

constexpr double kDefaultSpeed = 1.1;  // m/s
constexpr double kGreatestSpeed = 2.5;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Index of the door whose opening holds the point, or none.
std::optional<std::size_t> doorAt(const Building& building, int storey, const Eigen::Vector2d& point) {
  constexpr double kMargin = 0.03;  // metres: a sill is no gap in the way
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    const auto& door = building.doors[i];
    const Footprint opening{
        {door.pose.x, door.pose.y}, door.pose.theta, {door.wallThickness + 2.0 * kMargin, door.width}};
    if (door.storey == storey && opening.distanceTo(point) == 0.0) return i;
  }
  return std::nullopt;
}

/// [x, y] or [x, y, time]; without a time, one comes there at `speed`.
void readWaypoints(YamlMap& map, double speed, double start, Person& person) {
  const auto node = map.find("path");
  if (!node) return;
  for (const auto& item : map.list("path")) {
    const auto numbers = parseNumbers(item, 2, 3);
    if (!numbers) {
      map.fault("path", "points [x, y] or [x, y, seconds]", shown(item));
      return;
    }
    const Eigen::Vector2d position((*numbers)[0], (*numbers)[1]);
    const double way = person.way.empty() ? 0.0 : (position - person.way.back().position).norm();
    const double before = person.way.empty() ? start : person.way.back().time;
    const double time = numbers->size() == 3 ? (*numbers)[2] : before + way / speed;
    if (time < before || way > (time - before) * kGreatestSpeed + 1e-9) {
      map.fault("path", "a way of at most " + toText(kGreatestSpeed) + " m/s",
                toText(way) + " m in " + toText(time - before) + " s before " + toText(position));
      return;
    }
    person.way.push_back({time, position});
  }
  if (person.way.size() < 2) map.fault("path", "two points or more", std::to_string(person.way.size()));
}

/// Walks its way back and forth again, as fast as before.
void repeatUntil(double end, std::vector<Waypoint>& way) {
  const auto once = way;
  if (once.size() < 2 || once.back().time <= once.front().time) return;
  for (bool forth = false; way.back().time < end; forth = !forth) {
    const double begin = way.back().time;
    for (std::size_t i = 1; i < once.size(); ++i) {
      const auto& point = forth ? once[i] : once[once.size() - 1 - i];
      const double passed = forth ? point.time - once.front().time : once.back().time - point.time;
      way.push_back({begin + passed, point.position});
    }
  }
}

/// Every 5 cm of the way must lie in a room or in a door's opening. Tells the first place that does not.
void checkWay(YamlMap& map, const Building& building, const Person& person, std::vector<Passage>& passages) {
  constexpr double kStep = 0.05;
  for (std::size_t i = 0; i < person.way.size(); ++i) {
    const auto& from = person.way[i];
    const auto& to = person.way[std::min(i + 1, person.way.size() - 1)];
    const int steps = std::max(1, static_cast<int>(std::ceil((to.position - from.position).norm() / kStep)));
    for (int step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      const Eigen::Vector2d position = from.position + t * (to.position - from.position);
      if (const auto door = doorAt(building, person.storey, position)) {
        passages.push_back({*door, std::lerp(from.time, to.time, t)});
      } else if (roomAt(building, person.storey, position) == kOutside) {
        map.fault(map.has("path") ? "path" : "at", "a way through rooms and doors", "a wall at " + toText(position));
        return;
      }
    }
  }
}

void readSeat(YamlMap& map, Person& person) {
  const auto position = map.point("at");
  if (!position) return;
  person.way = {{0.0, *position}};
}

}  // namespace

Person readPerson(YamlMap& map, const Building& building, int storey, std::vector<Passage>& passages) {
  Person person;
  person.storey = storey;
  if (map.require("id", "a name")) person.id = map.text("id").value_or("");
  map.rename("person '" + person.id + "'");
  person.height = map.number("height", {1.0, 2.1}).value_or(person.height);
  person.sits = map.flag("sits").value_or(false);
  person.heading = map.number("yaw", {-360.0, 360.0}).value_or(0.0) * kDegree;
  if (const auto look = map.wholeNumber("look", {0.0, 1e6})) person.look = static_cast<std::uint64_t>(*look);
  const double speed = map.number("speed", {0.1, kGreatestSpeed}).value_or(kDefaultSpeed);
  const double start = map.number("start", {0.0, 3600.0}).value_or(0.0);
  const auto repeated = map.number("to_and_fro_until", {0.0, 3600.0});
  if (map.has("path") == map.has("at")) {
    map.fault("path", "either 'at' or 'path'", map.has("path") ? "both" : "none");
    map.find("path");
    map.find("at");
  } else if (map.has("path")) {
    if (person.sits) map.fault("sits", "a place 'at' for one who sits", "a path");
    readWaypoints(map, speed, start, person);
    if (repeated) repeatUntil(*repeated, person.way);
  } else {
    readSeat(map, person);
  }
  map.finish();
  checkWay(map, building, person, passages);
  return person;
}

}  // namespace prodomos::simulation
