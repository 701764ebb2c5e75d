// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// bench_query [SUBMAPS]
//
// How long planners wait for an answer: a map of so many sub-maps (1,000) along corridors, every third with a door to a
// room that nobody has seen. Prints milliseconds of CPU for each question, the median of 20.
#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/place_map.hpp"
#include "prodomos/query/query.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <vector>

namespace prodomos::bench {
namespace {

constexpr int kPerCorridor = 25;
constexpr double kSpacing = 6.0;  // metres between sub-maps

/// 6 m of a corridor, seen from its middle.
map::OccupancyGrid corridor() {
  map::OccupancyGrid grid;
  std::vector<map::OccupancyGrid::Beam> beams;
  for (double x = -4.0; x <= 4.0; x += 0.04) {
    beams.push_back({{x, 1.0}, true});
    beams.push_back({{x, -1.0}, true});
  }
  grid.insert(Eigen::Vector2d::Zero(), beams);
  return grid;
}

void addSubMap(int id, map::MapChange& change) {
  map::Node node;
  node.id = {id};
  node.session = {1};
  node.floor = 0;
  node.T_map_submap = node.T_travel_submap =
      geometry::toPose3({kSpacing * (id % kPerCorridor), 12.0 * (id / kPerCorridor), 0.0});
  change.nodes.push_back(node);
  const auto join = [&](int other) {
    map::Edge edge;
    edge.id = {static_cast<std::int64_t>(change.edges.size())};
    edge.from = {other};
    edge.to = {id};
    change.edges.push_back(edge);
  };
  if (id % kPerCorridor > 0) join(id - 1);
  if (id >= kPerCorridor) join(id - kPerCorridor);
}

void addRoom(int number, int submap, int count, map::MapChange& change) {
  map::Entity door;
  door.id = {number};
  door.submap = {submap};
  door.T_submap_entity = geometry::toPose3({0.0, 1.0, 1.57}, 1.0);
  door.confidence = 0.95;
  door.attributes = map::Door{.width = 0.9, .state = map::DoorState::kClosed};
  change.entities.push_back(door);
  map::Node node = change.nodes[static_cast<std::size_t>(submap)];
  node.id = {count + number};
  node.kind = map::SubMapKind::kPredicted;
  map::Prediction room;
  room.id = {number};
  room.cause = door.id;
  room.submap = {submap};
  room.node = node.id;
  room.T_submap_node = geometry::toPose3({0.0, 1.5, 1.57});
  room.probability = 0.9;
  room.expectedArea = 12.0 + number % 7;
  for (const double threshold : {0.5, 0.6, 0.7}) {
    room.areas.push_back({threshold, {{0, -1}, {3, -1}, {3, 1}, {0, 1}}});
  }
  room.room_in_node = {{0, -2}, {4, -2}, {4, 2}, {0, 2}};
  room.viewpoint_in_submap = {0.0, 0.2, 1.57};
  node.T_map_submap = node.T_map_submap * room.T_submap_node;
  map::Edge edge;
  edge.id = {static_cast<std::int64_t>(change.edges.size())};
  edge.from = room.submap;
  edge.to = node.id;
  edge.kind = map::EdgeKind::kDoor;
  edge.cause = door.id;
  change.nodes.push_back(node);
  change.edges.push_back(edge);
  change.predictions.push_back(room);
}

void print(const char* question, const std::function<void()>& ask) {
  std::vector<double> milliseconds;
  for (int i = 0; i < 20; ++i) {
    const auto before = std::clock();
    ask();
    milliseconds.push_back(1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
  }
  std::ranges::sort(milliseconds);
  std::printf("%-44s %8.2f ms, at most %.2f\n", question, milliseconds[10], milliseconds.back());
}

void run(int count) {
  const auto path = std::filesystem::temp_directory_path() / "prodomos_bench_query.prodomos";
  std::filesystem::remove(path);
  const auto grid = corridor();
  map::MapChange change;
  change.sessions.push_back({.id = {1}, .log = "log", .config = ""});
  change.floors.push_back({0, 0.0});
  for (int id = 0; id < count; ++id) {
    addSubMap(id, change);
    change.layers.emplace_back(base::SubMapId{id}, &grid);
  }
  for (int number = 0; 3 * number < count; ++number) addRoom(number, 3 * number, count, change);
  {
    auto store = map::MapStore::create(path);
    store.commit(change);
    store.close();
  }
  const auto view = map::MapView::open(path);
  std::printf("%d sub-maps, %zu predicted rooms\n", count, query::predictedRooms(view).size());
  const query::Position here{0.2, 0.5, 0};
  const query::Position there{kSpacing * ((count - 1) % kPerCorridor), 12.0 * ((count - 1) / kPerCorridor) + 0.5, 0};
  print("open the map", [&] { map::MapView::open(path); });
  print("predicted-rooms", [&] { query::predictedRooms(view); });
  print("predicted-rooms --from", [&] { query::predictedRooms(view, 0.0, here); });
  print("route from end to end", [&] { query::routeBetween(view, here, there); });
  print("place, of its sub-map", [&] { query::placeAt(view, there); });
  print("place that nobody knows", [&] { query::placeAt(view, {-500.0, 0.0, 0}); });
  print("all places by cells", [&] { map::PlaceMap{view}; });
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace prodomos::bench

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
  if (argc > 2 || count < 1) {
    std::fprintf(stderr, "usage: bench_query [SUBMAPS]\n");
    return 2;
  }
  prodomos::bench::run(count);
  return 0;
}
