// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/map_view.hpp"

#include "commands.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <iostream>
#include <map>

namespace prodomos::apps {

namespace {

using nlohmann::json;

struct Counts {
  std::size_t observed = 0;
  std::size_t predicted = 0;
  std::map<std::string, int> edges;
  std::map<std::string, int> entities;
  std::map<std::string, int> predictions;
  double distance = 0.0;
};

Counts countsOf(const map::MapView& view) {
  Counts counts;
  const auto& graph = view.graph();
  for (const auto id : graph.nodes()) {
    ++(graph.getNode(id).kind == map::SubMapKind::kObserved ? counts.observed : counts.predicted);
  }
  for (const auto id : graph.edges()) ++counts.edges[std::string(toString(graph.getEdge(id).kind))];
  for (const auto& entity : view.entities()) ++counts.entities[std::string(className(entity.attributes))];
  for (const auto& prediction : view.predictions()) ++counts.predictions[std::string(toString(prediction.state))];
  for (const auto& session : view.sessions()) counts.distance += session.distance;
  return counts;
}

json toJson(const map::MapView& view) {
  const auto counts = countsOf(view);
  json sessions = json::array();
  for (const auto& session : view.sessions()) {
    sessions.push_back({{"id", toString(session.id)},
                        {"log", session.log},
                        {"kind", session.logKind},
                        {"poses", session.poses},
                        {"state", toString(session.state)},
                        {"begin", base::toString(session.begin)},
                        {"end", base::toString(session.end)},
                        {"distance_m", session.distance},
                        {"version", session.version}});
  }
  json floors = json::array();
  for (const auto& floor : view.floors()) floors.push_back({{"number", floor.number}, {"height_m", floor.height}});
  return {{"revision", view.revision()},
          {"sessions", sessions},
          {"submaps", {{"observed", counts.observed}, {"predicted", counts.predicted}}},
          {"places", view.graph().places().size()},
          {"components", view.graph().componentCount()},
          {"floors", floors},
          {"edges", counts.edges},
          {"entities", counts.entities},
          {"predictions", counts.predictions},
          {"distance_m", counts.distance}};
}

void printCounts(const char* title, const std::map<std::string, int>& counts) {
  std::cout << "  " << title;
  if (counts.empty()) std::cout << "none";
  const char* comma = "";
  for (const auto& [name, count] : counts) {
    std::cout << comma << count << " " << name;
    comma = ", ";
  }
  std::cout << '\n';
}

void printEntities(const std::map<std::string, int>& counts) {
  std::cout << "  entities     " << (counts.empty() ? "none" : "");
  const char* comma = "";
  for (const auto& [name, count] : counts) {
    std::cout << comma << counted(static_cast<std::size_t>(count), name);
    comma = ", ";
  }
  std::cout << '\n';
}

void print(const map::MapView& view, const std::string& path) {
  const auto counts = countsOf(view);
  std::cout << path << ", " << fileSize(std::filesystem::file_size(path)) << ", revision " << view.revision() << '\n';
  for (const auto& session : view.sessions()) {
    const bool complete = session.state == map::SessionState::kComplete;
    std::cout << "  session " << session.id << "   " << session.log << " (" << session.logKind << "), poses "
              << session.poses << ", " << clockTime(base::seconds(session.end - session.begin)) << " long, "
              << fixed(session.distance, 1) << " m"
              << (complete ? "" : "; not finished: still running, or interrupted (replay --resume goes on)") << '\n';
  }
  std::cout << "  sub-maps     " << counts.observed << " observed, " << counts.predicted << " predicted\n";
  std::cout << "  places       " << view.graph().places().size();
  if (const int parts = view.graph().componentCount(); parts > 1) std::cout << ", in " << parts << " unconnected parts";
  std::cout << "\n  floors       ";
  const char* comma = "";
  for (const auto& floor : view.floors()) {
    std::cout << comma << floor.number << " at " << fixed(floor.height, 2) << " m";
    comma = ", ";
  }
  std::cout << '\n';
  printCounts("edges        ", counts.edges);
  printEntities(counts.entities);
  printCounts("predictions  ", counts.predictions);
}

}  // namespace

void addInfo(CLI::App& program) {
  auto* command = program.add_subcommand("info", "what a map holds");
  command->footer(
      "Examples:\n"
      "  prodomos info office.prodomos\n"
      "  prodomos info office.prodomos --json | jq .submaps.observed");
  struct Options {
    std::string map;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  command->add_option("MAP", options->map, "the map file")->required();
  command->add_flag("--json", options->json, "as JSON (docs/json.md)");
  command->callback([options] {
    const auto view = map::MapView::open(options->map);
    if (options->json) {
      std::cout << toJson(view).dump(2) << '\n';
    } else {
      print(view, options->map);
    }
  });
}

}  // namespace prodomos::apps
