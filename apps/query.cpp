// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

#include "prodomos/base/error.hpp"

#include "commands.hpp"
#include "query_json.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <iostream>
#include <numbers>

namespace prodomos::apps {

namespace {

using map::MapView;

struct QueryOptions {
  std::string map;
  std::vector<std::string> positions;
  std::string from;
  std::string node;
  double leastProbability = 0.0;
  double threshold = 0.5;
  std::int64_t revision = 0;
  bool json = false;
};

/// "X,Y" or "X,Y,FLOOR".
query::Position parsePosition(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  const auto parse = [](const std::string& part, auto& number) {
    const auto [end, fault] = std::from_chars(part.data(), part.data() + part.size(), number);
    return fault == std::errc{} && end == part.data() + part.size() && std::isfinite(static_cast<double>(number));
  };
  query::Position position;
  int floor = 0;
  const bool good = (parts.size() == 2 || parts.size() == 3) && parse(parts[0], position.x) &&
                    parse(parts[1], position.y) && (parts.size() == 2 || parse(parts[2], floor));
  if (!good) throw base::UsageError(base::expectedFound("position", "X,Y or X,Y,FLOOR in metres", "'" + text + "'"));
  if (parts.size() == 3) position.floor = floor;
  return position;
}

std::string spot(double x, double y) {
  return fixed(x, 2) + "," + fixed(y, 2);
}

std::string degrees(double radians) {
  return fixed(radians * 180.0 / std::numbers::pi, 0) + "°";
}

std::string percent(double share) {
  return fixed(100.0 * share, 0) + " %";
}

void print(const query::PlaceAnswer& answer) {
  if (!answer.submap) {
    std::cout << "unknown: no sub-map knows this spot\n";
    return;
  }
  std::cout << (answer.place ? "place " + std::to_string(*answer.place) : "no place") << ", sub-map " << *answer.submap
            << ", floor " << answer.floor.value_or(0) << ", " << toString(answer.state) << " ("
            << percent(answer.probability) << " occupied)\n";
}

void print(const std::optional<query::Route>& route) {
  if (!route) {
    std::cout << "no route: one of the spots is unknown, or they are not connected\n";
    return;
  }
  std::cout << fixed(route->length, 1) << " m over";
  for (const auto id : route->submaps) std::cout << " " << id;
  if (route->probability < 1.0) std::cout << ", if it is there: " << percent(route->probability);
  std::cout << '\n';
}

void print(const query::PredictedRoom& room) {
  const auto& viewpoint = room.viewpoint_in_map;
  std::cout << room.node << "  " << percent(room.probability) << "  " << fixed(room.expectedArea, 1) << " m²  behind "
            << room.cause;
  if (room.doorState) std::cout << " (" << map::toString(*room.doorState) << ")";
  std::cout << "  stand at " << spot(viewpoint.x, viewpoint.y) << " facing " << degrees(viewpoint.theta)
            << (room.isViewpointFree ? "" : ", which nobody has seen") << (room.blocked ? ", blocked" : "");
  if (room.route) {
    std::cout << ", " << fixed(room.route->length, 1) << " m away: " << fixed(*room.gainPerMetre, 1) << " m²/m";
  }
  std::cout << '\n';
}

void print(const query::FreeFloor& floor) {
  std::cout << fixed(floor.area, 1) << " m² within";
  for (const auto& corner : floor.outline_in_map) std::cout << " " << spot(corner.x(), corner.y());
  std::cout << '\n';
}

void print(const map::MapChanges& changes) {
  const auto list = [](const char* name, const auto& ids) {
    if (ids.empty()) return;
    std::cout << name << ":";
    for (const auto id : ids) std::cout << " " << id;
    std::cout << '\n';
  };
  std::cout << "revision " << changes.revision << '\n';
  list("sub-maps", changes.nodes);
  list("edges", changes.edges);
  list("entities", changes.entities);
  list("predictions", changes.predictions);
  if (!changes.events.empty()) std::cout << counted(changes.events.size(), "event") << '\n';
}

template <typename Attributes>
void printPose(const query::Seen<Attributes>& seen) {
  const auto pose = geometry::toPose2(seen.T_map_entity);
  std::cout << seen.id << "  " << percent(seen.confidence) << "  at " << spot(pose.x, pose.y) << " facing "
            << degrees(pose.theta);
}

void print(const query::Seen<map::Door>& door) {
  printPose(door);
  std::cout << "  " << (door.attributes.hasLeaf ? "door" : "doorway") << ", " << fixed(door.attributes.width, 2)
            << " m wide";
  if (door.attributes.hasLeaf) {
    std::cout << ", " << map::toString(door.attributes.state) << ", hinges "
              << map::toString(door.attributes.hingeSide);
  }
  std::cout << '\n';
}

void print(const query::Seen<map::Staircase>& stairs) {
  printPose(stairs);
  const double height = stairs.attributes.height;
  std::cout << "  " << fixed(std::abs(height), 2) << " m " << (height < 0.0 ? "down" : "up") << ", "
            << fixed(stairs.attributes.stepWidth, 2) << " m wide";
  if (stairs.attributes.stepCount > 0) std::cout << ", " << counted(std::size_t(stairs.attributes.stepCount), "step");
  std::cout << '\n';
}

void print(const query::Seen<map::Human>& person) {
  printPose(person);
  std::cout << "  going " << fixed(person.attributes.velocity.norm(), 2) << " m/s, last seen "
            << base::toString(person.lastSeen) << '\n';
}

template <typename Answer>
void tell(const QueryOptions& options, const Answer& answer) {
  if (options.json) {
    std::cout << toJson(answer).dump(2) << '\n';
  } else {
    print(answer);
  }
}

template <typename Answer>
void tell(const QueryOptions& options, const std::vector<Answer>& answers, const char* none) {
  if (options.json) {
    auto list = nlohmann::json::array();
    for (const auto& answer : answers) list.push_back(toJson(answer));
    std::cout << list.dump(2) << '\n';
    return;
  }
  if (answers.empty()) std::cout << none << '\n';
  for (const auto& answer : answers) print(answer);
}

void answerFreeSpace(const QueryOptions& options) {
  const auto node = base::parseId<base::SubMapId>(options.node);
  if (!node) throw base::UsageError(base::expectedFound("node", "an id such as s12", "'" + options.node + "'"));
  const auto view = MapView::open(options.map);
  if (!view.graph().hasNode(*node)) throw base::Error("the map has no sub-map " + options.node);
  tell(options, query::freeFloor(view, *node, options.threshold), "nothing is predicted there");
}

void answerPredictedRooms(const QueryOptions& options) {
  const auto from = options.from.empty() ? std::nullopt : std::optional(parsePosition(options.from));
  tell(options, query::predictedRooms(MapView::open(options.map), options.leastProbability, from),
       "no predicted rooms");
}

}  // namespace

void addQuery(CLI::App& program) {
  auto* command = program.add_subcommand("query", "ask a map what planners ask");
  command->require_subcommand(1);
  command->footer(
      "docs/query.md has every field of the answers.\n"
      "Examples:\n"
      "  prodomos query office.prodomos predicted-rooms --from 0,0\n"
      "  prodomos query office.prodomos route 0,0 12.5,4 --json");
  auto options = std::make_shared<QueryOptions>();
  command->add_option("MAP", options->map, "the map file")->required();

  const auto add = [&](const char* name, const char* text, auto answer) {
    auto* question = command->add_subcommand(name, text);
    question->add_flag("--json", options->json, "as JSON (docs/query.md)");
    question->callback([options, answer] { answer(*options); });
    return question;
  };
  const auto takePositions = [&](CLI::App* question, int count) {
    question->add_option("POSITION", options->positions, "X,Y or X,Y,FLOOR: metres in the map frame")
        ->expected(count)
        ->required();
  };

  auto* rooms =
      add("predicted-rooms", "rooms that nobody has seen, and where to stand to enter them", answerPredictedRooms);
  rooms->add_option("--from", options->from,
                    "X,Y[,FLOOR] to measure the way from; the best gain per metre comes first");
  rooms->add_option("--min-probability", options->leastProbability, "leave out less probable ones")
      ->check(CLI::Range(0.0, 1.0));
  auto* space = add("free-space", "floor that is predicted to be free there", answerFreeSpace);
  space->add_option("NODE", options->node, "a sub-map, such as s12")->required();
  space->add_option("--threshold", options->threshold, "0.5, 0.6 or 0.7: of the density's peak, the greater the surer");

  takePositions(add("place", "which place, sub-map and cell lies there",
                    [](const QueryOptions& given) {
                      const auto position = parsePosition(given.positions.at(0));
                      const auto view = MapView::open(given.map);
                      const map::PlaceMap places(view);
                      tell(given, query::placeAt(view, position, &places));
                    }),
                1);
  takePositions(add("route", "the way over the graph from one spot to another, through predicted rooms too",
                    [](const QueryOptions& given) {
                      const auto from = parsePosition(given.positions.at(0));
                      const auto to = parsePosition(given.positions.at(1));
                      tell(given, query::routeBetween(MapView::open(given.map), from, to));
                    }),
                2);
  add("doors", "doors and doorways",
      [](const QueryOptions& given) { tell(given, query::doors(MapView::open(given.map)), "no doors"); });
  add("stairs", "flights of stairs",
      [](const QueryOptions& given) { tell(given, query::stairs(MapView::open(given.map)), "no stairs"); });
  add("people", "people, where they were seen last",
      [](const QueryOptions& given) { tell(given, query::people(MapView::open(given.map)), "nobody"); });
  add("changes", "what has changed after a revision of the map",
      [](const QueryOptions& given) { tell(given, MapView::open(given.map).changesSince(given.revision)); })
      ->add_option("REVISION", options->revision, "that one knows already; 0: none")
      ->required()
      ->check(CLI::NonNegativeNumber);
}

}  // namespace prodomos::apps
