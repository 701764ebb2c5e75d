// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where to explore next: goes for the predicted room that promises the most area per metre of way, and keeps up with a
// map that another program is writing.
#include "prodomos/base/error.hpp"
#include "prodomos/query/query.hpp"

#include <charconv>
#include <chrono>
#include <iostream>
#include <string>
#include <thread>

namespace {

using prodomos::map::MapView;
using prodomos::query::Position;
using prodomos::query::PredictedRoom;

/// The last pose of the trajectory, which is where the robot is.
Position robotIn(const MapView& map) {
  const auto trajectory = map.trajectory();
  if (trajectory.empty()) return {0.0, 0.0, {}};
  const auto& last = trajectory.back();
  const auto& position = last.T_map_body.translation();
  return {position.x(), position.y(), map.graph().getNode(last.submap).floor};
}

void tell(const PredictedRoom& room) {
  const auto& stand = room.viewpoint_in_map;
  std::cout << room.node << ": " << room.expectedArea << " m² with probability " << room.probability << "; stand at "
            << stand.x << ", " << stand.y << ", facing " << stand.theta << " rad";
  if (room.route) std::cout << ", " << room.route->length << " m from here: " << *room.gainPerMetre << " m²/m";
  std::cout << '\n';
}

/// The rooms worth going to, the best first; closed doors are left to those who can open them.
void plan(const MapView& map, bool opensDoors) {
  for (const auto& room : prodomos::query::predictedRooms(map, 0.5, robotIn(map))) {
    const bool isClosed = room.doorState == prodomos::map::DoorState::kClosed;
    if (opensDoors || !isClosed) tell(room);
  }
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 2 && count != 3) return std::cerr << "usage: planner MAP [SECONDS]\n", 2;
  const std::string path = arguments[1];
  int seconds = 0;
  if (count == 3) {
    const std::string text = arguments[2];
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (fault != std::errc{} || *end != '\0') return std::cerr << "expected seconds, found '" << text << "'\n", 2;
  }
  auto map = MapView::open(path);
  plan(map, true);
  for (auto revision = map.revision(); seconds > 0; --seconds) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    map = MapView::open(path);
    if (map.revision() == revision) continue;
    const auto changes = map.changesSince(revision);
    revision = changes.revision;
    if (!changes.predictions.empty() || !changes.nodes.empty()) plan(map, true);
  }
} catch (const prodomos::base::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
