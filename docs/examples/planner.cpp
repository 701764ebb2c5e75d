// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where are rooms that nobody has seen, and where must the robot stand to enter them?
#include "prodomos/base/error.hpp"
#include "prodomos/query/query.hpp"

#include <iostream>

int main(int count, char** arguments) try {
  if (count != 2) return std::cerr << "usage: planner MAP\n", 2;
  const auto map = prodomos::map::MapView::open(arguments[1]);
  for (const auto& room : prodomos::query::predictedRooms(map, 0.5, prodomos::query::Position{0.0, 0.0, 0})) {
    const auto& stand = room.viewpoint_in_map;
    std::cout << room.node << ": " << room.expectedArea << " m² with probability " << room.probability << "; stand at "
              << stand.x << ", " << stand.y << ", facing " << stand.theta << " rad";
    if (room.route) std::cout << ", " << room.route->length << " m from home";
    std::cout << '\n';
  }
} catch (const prodomos::base::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
