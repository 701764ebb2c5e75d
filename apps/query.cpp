// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

#include "prodomos/base/error.hpp"

#include "commands.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <iostream>

namespace prodomos::apps {

namespace {

using nlohmann::json;

struct QueryOptions {
  std::string map;
  std::vector<std::string> positions;
  std::string from;
  double leastProbability = 0.0;
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

template <typename T>
json orNull(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

std::string_view name(map::CellState state) {
  return state == map::CellState::kFree ? "free" : state == map::CellState::kOccupied ? "occupied" : "unknown";
}

json toJson(const map::Route& route) {
  json submaps = json::array();
  json edges = json::array();
  for (const auto id : route.submaps) submaps.push_back(toString(id));
  for (const auto id : route.edges) edges.push_back(toString(id));
  return {{"length_m", route.length}, {"submaps", submaps}, {"edges", edges}};
}

void answerPlace(const QueryOptions& options) {
  const auto position = parsePosition(options.positions.at(0));
  const auto answer = query::placeAt(map::MapView::open(options.map), position);
  if (options.json) {
    std::cout << json{{"place", orNull(answer.place)},
                      {"submap", answer.submap ? json(toString(*answer.submap)) : json(nullptr)},
                      {"floor", orNull(answer.floor)},
                      {"state", name(answer.state)},
                      {"probability", answer.probability}}
                     .dump(2)
              << '\n';
  } else if (!answer.submap) {
    std::cout << "unknown: no sub-map knows this spot\n";
  } else {
    std::cout << "place " << answer.place.value_or(-1) << ", sub-map " << *answer.submap << ", floor "
              << answer.floor.value_or(0) << ", " << name(answer.state) << " (" << fixed(100.0 * answer.probability, 0)
              << " % occupied)\n";
  }
}

void answerRoute(const QueryOptions& options) {
  const auto from = parsePosition(options.positions.at(0));
  const auto to = parsePosition(options.positions.at(1));
  const auto route = query::routeBetween(map::MapView::open(options.map), from, to);
  if (options.json) {
    std::cout << (route ? toJson(*route) : json(nullptr)).dump(2) << '\n';
  } else if (!route) {
    std::cout << "no route: one of the spots is unknown, or they are not connected\n";
  } else {
    std::cout << fixed(route->length, 1) << " m over";
    for (const auto id : route->submaps) std::cout << " " << id;
    std::cout << '\n';
  }
}

void answerPredictedRooms(const QueryOptions& options) {
  const auto view = map::MapView::open(options.map);
  const auto from = options.from.empty() ? std::nullopt : std::optional(parsePosition(options.from));
  const auto rooms = query::predictedRooms(view, options.leastProbability, from);
  json list = json::array();
  for (const auto& room : rooms) {
    const auto& viewpoint = room.viewpoint_in_map;
    list.push_back({{"node", toString(room.node)},
                    {"prediction", toString(room.prediction)},
                    {"cause", toString(room.cause)},
                    {"floor", orNull(room.floor)},
                    {"probability", room.probability},
                    {"expected_area_m2", room.expectedArea},
                    {"viewpoint", {{"x", viewpoint.x}, {"y", viewpoint.y}, {"theta", viewpoint.theta}}},
                    {"route", room.route ? toJson(*room.route) : json(nullptr)}});
  }
  if (options.json) {
    std::cout << list.dump(2) << '\n';
    return;
  }
  if (rooms.empty()) std::cout << "no predicted rooms\n";
  for (const auto& room : rooms) {
    std::cout << room.node << "  " << fixed(100.0 * room.probability, 0) << " %  " << fixed(room.expectedArea, 1)
              << " m²  stand at " << fixed(room.viewpoint_in_map.x, 2) << "," << fixed(room.viewpoint_in_map.y, 2);
    if (room.route) std::cout << ", " << fixed(room.route->length, 1) << " m away";
    std::cout << '\n';
  }
}

}  // namespace

void addQuery(CLI::App& program) {
  auto* command = program.add_subcommand("query", "ask a map what planners ask");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  prodomos query office.prodomos place 3.5,-1.2\n"
      "  prodomos query office.prodomos route 0,0 12.5,4 --json");
  auto options = std::make_shared<QueryOptions>();
  command->add_option("MAP", options->map, "the map file")->required();

  const auto add = [&](const char* name, const char* text, int positions, void (*answer)(const QueryOptions&)) {
    auto* question = command->add_subcommand(name, text);
    if (positions > 0) {
      question->add_option("POSITION", options->positions, "X,Y or X,Y,FLOOR: metres in the map frame")
          ->expected(positions)
          ->required();
    }
    question->add_flag("--json", options->json, "as JSON (docs/json.md)");
    question->callback([options, answer] { answer(*options); });
    return question;
  };
  add("place", "which place, sub-map and cell lies there", 1, answerPlace);
  add("route", "the way over the graph from one spot to another", 2, answerRoute);
  auto* rooms =
      add("predicted-rooms", "rooms that nobody has seen, and where to stand to enter them", 0, answerPredictedRooms);
  rooms->add_option("--from", options->from, "X,Y[,FLOOR] to measure the way from");
  rooms->add_option("--min-probability", options->leastProbability, "leave out less probable ones")
      ->check(CLI::Range(0.0, 1.0));
}

}  // namespace prodomos::apps
