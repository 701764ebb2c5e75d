// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/population.hpp"

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/navigation.hpp"

#include "simulation/ways/passing.hpp"
#include "simulation/ways/roadmap.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace prodomos::simulation {

namespace {

/// What a person keeps from walls: half its shoulders and a bit, metres.
constexpr double kClearance = 0.3;

/// So many square metres of floor a person, and at least and at most so many on a storey.
constexpr double kFloorPerPerson = 80.0;
constexpr int kFewest = 3;
constexpr int kMost = 12;
/// In a building as small as this, m², one or two are enough.
constexpr double kSmall = 100.0;
constexpr double kShareOfSitters = 0.35;

/// How far a walker goes from one pause to the next, metres.
constexpr double kFarthestErrand = 35.0;

/// A leaf stands open so long before somebody is in the door and after, seconds.
constexpr double kOpenBefore = 0.8;
constexpr double kOpenAfter = 1.0;

/// At each time of either and where they cross, the greater of both.
std::vector<Swing> greaterOf(const std::vector<Swing>& a, const std::vector<Swing>& b) {
  const Door one{.swings = a};
  const Door other{.swings = b};
  std::vector<double> times;
  std::ranges::transform(a, std::back_inserter(times), &Swing::time);
  std::ranges::transform(b, std::back_inserter(times), &Swing::time);
  std::ranges::sort(times);
  const auto difference = [&](double time) { return openingAngle(one, time) - openingAngle(other, time); };
  std::vector<double> crossings;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double before = difference(times[i - 1]);
    const double after = difference(times[i]);
    if (before * after < 0.0) crossings.push_back(std::lerp(times[i - 1], times[i], before / (before - after)));
  }
  times.insert(times.end(), crossings.begin(), crossings.end());
  std::ranges::sort(times);
  std::vector<Swing> greater;
  constexpr double kSameTime = 1e-6;
  for (const double time : times) {
    if (!greater.empty() && time - greater.back().time < kSameTime) continue;
    greater.push_back({time, std::max(openingAngle(one, time), openingAngle(other, time))});
  }
  return greater;
}

/// While somebody is in a door it stands open.
void openDoors(Building& building, const Person& person, double duration) {
  constexpr double kStep = 0.1;     // seconds
  constexpr double kPassing = 1.0;  // two passages closer than this are one, seconds
  if (person.sits || person.way.size() < 2) return;
  for (auto& door : building.doors) {
    if (door.storey != person.storey || door.leaves == 0) continue;
    const double angle = passingAngle(building, door);
    std::optional<double> entered;
    double last = 0.0;
    const auto open = [&] {
      if (entered) openFor(door, *entered - kOpenBefore, last + kOpenAfter, angle);
      entered.reset();
    };
    for (double time = 0.0; time <= duration; time += kStep) {
      if (!liesInOpening(door, positionAt(person, time))) continue;
      if (entered && time - last > kPassing) open();
      if (!entered) entered = time;
      last = time;
    }
    open();
  }
}

/// Draws people for one storey.
class StoreyPopulation {
 public:
  StoreyPopulation(const Building& building, int storey, std::uint64_t seed, double duration)
      : building_(building),
        storey_(storey),
        duration_(duration),
        random_(seed, "people of storey " + std::to_string(storey)),
        grid_(building, storey, kClearance),
        roadmap_(building, grid_) {
    for (std::size_t i = 0; i < roadmap_.nodes().size(); ++i) {
      const auto& node = roadmap_.nodes()[i];
      if (!node.door && isForPeople(useOf(node))) spots_.push_back(i);
    }
  }

  std::vector<Person> draw() {
    std::vector<Person> people;
    const int count = drawCount();
    const auto chairs = drawChairs(static_cast<int>(std::lround(kShareOfSitters * count)));
    std::ranges::transform(chairs, std::back_inserter(people), [&](const Thing* chair) { return sitter(*chair); });
    if (spots_.empty()) return people;
    while (static_cast<int>(people.size()) < count) people.push_back(walker());
    return people;
  }

 private:
  static bool isForPeople(RoomUse use) { return use == RoomUse::kRoom || use == RoomUse::kCorridor; }
  RoomUse useOf(const Roadmap::Node& node) const { return building_.rooms[static_cast<std::size_t>(node.room)].use; }

  int drawCount() {
    double area = 0.0;
    for (const auto& room : building_.rooms) {
      if (room.storey == storey_ && isForPeople(room.use)) area += std::abs(signedArea(room.outline));
    }
    if (area == 0.0) return 0;
    if (area < kSmall) return random_.integer(1, 2);
    const int usual = std::clamp(static_cast<int>(area / kFloorPerPerson), kFewest, kMost);
    return std::clamp(usual + random_.integer(-1, 1), kFewest, kMost);
  }

  std::vector<const Thing*> drawChairs(int count) {
    std::vector<const Thing*> chairs;
    for (const auto& thing : building_.things) {
      if (thing.storey == storey_ && (thing.kind == "chair" || thing.kind == "office_chair")) chairs.push_back(&thing);
    }
    std::vector<const Thing*> drawn;
    while (!chairs.empty() && static_cast<int>(drawn.size()) < count) {
      const auto chair = chairs.begin() + random_.integer(0, static_cast<int>(chairs.size()) - 1);
      drawn.push_back(*chair);
      chairs.erase(chair);
    }
    return drawn;
  }

  Person drawPerson() {
    Person person{.storey = storey_};
    person.height = std::clamp(random_.normal(1.72, 0.09), 1.5, 1.95);
    person.heading = random_.uniform(-std::numbers::pi, std::numbers::pi);
    person.look = static_cast<std::uint64_t>(random_.uniform() * 0x1.0p53);
    return person;
  }

  Person sitter(const Thing& chair) {
    Person person = drawPerson();
    person.sits = true;
    person.heading = geometry::yaw(chair.T_world_thing);
    person.way = {{0.0, chair.T_world_thing.translation().head<2>()}};
    return person;
  }

  Person walker() {
    Person person = drawPerson();
    const double speed = random_.uniform(0.9, 1.4);
    const auto first = spots_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(spots_.size()) - 1))];
    person.way = {{0.0, roadmap_.nodes()[first].position}};
    pause(person, random_.uniform(0.5, 5.0));
    while (person.way.back().time < duration_) {
      walkOn(person, speed);
      const bool isInCorridor =
          useOf(roadmap_.nodes()[*roadmap_.nearestNode(person.way.back().position)]) == RoomUse::kCorridor;
      pause(person, isInCorridor ? random_.uniform(0.5, 4.0) : random_.uniform(2.0, 12.0));
    }
    return person;
  }

  static void pause(Person& person, double seconds) {
    person.way.push_back({person.way.back().time + seconds, person.way.back().position});
  }

  /// To another spot, not too far away; where there is none it stays.
  void walkOn(Person& person, double speed) {
    constexpr double kNearest = 3.0;  // metres
    const Eigen::Vector2d from = person.way.back().position;
    const auto routes = roadmap_.routesFrom(from);
    std::vector<std::size_t> goals;
    std::ranges::copy_if(spots_, std::back_inserter(goals), [&](std::size_t spot) {
      return routes.lengths[spot] > kNearest && routes.lengths[spot] < kFarthestErrand;
    });
    if (goals.empty()) return;
    const auto goal = goals[static_cast<std::size_t>(random_.integer(0, static_cast<int>(goals.size()) - 1))];
    const auto way = roadmap_.path(from, routes, goal);
    if (!way) return;
    for (std::size_t i = 1; i < way->size(); ++i) {
      const auto& last = person.way.back();
      const double length = ((*way)[i] - last.position).norm();
      const bool isEnd = i + 1 == way->size();
      constexpr double kStep = 0.25;  // metres
      if (length < kStep && !isEnd) continue;
      if (length > 0.0) person.way.push_back({last.time + length / speed, (*way)[i]});
    }
  }

  const Building& building_;
  int storey_;
  double duration_;
  base::Random random_;
  FloorGrid grid_;
  Roadmap roadmap_;
  std::vector<std::size_t> spots_;  ///< nodes of rooms and corridors
};

}  // namespace

void openFor(Door& door, double from, double to, double angle) {
  const std::vector<Swing> closed{{from - kSwingTime, 0.0}};
  door.swings = greaterOf(door.swings.empty() ? closed : door.swings,
                          {{from - kSwingTime, 0.0}, {from, angle}, {to, angle}, {to + kSwingTime, 0.0}});
}

Eigen::Vector2d positionAt(const Person& person, double time) {
  const auto next = std::ranges::upper_bound(person.way, time, {}, &Waypoint::time);
  if (next == person.way.begin()) return next->position;
  const auto before = std::prev(next);
  if (next == person.way.end()) return before->position;
  return before->position + (next->position - before->position) * (time - before->time) / (next->time - before->time);
}

void populate(Building& building, std::uint64_t seed, double duration) {
  if (building.people.empty()) {
    for (int storey = 0; storey < static_cast<int>(building.storeys.size()); ++storey) {
      for (auto& person : StoreyPopulation(building, storey, seed, duration).draw()) {
        person.id = "p" + std::to_string(building.people.size() + 1);
        building.people.push_back(std::move(person));
      }
    }
  }
  for (const auto& person : building.people) openDoors(building, person, duration);
}

}  // namespace prodomos::simulation
