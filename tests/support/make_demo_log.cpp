// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// Writes the log of the demo: a robot with laser and odometry tours four rooms on a corridor.
//
//   prodomos_demo_log OUT.rawlog
#include "prodomos/io/rawlog_sink.hpp"

#include "support/laser_world.hpp"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: prodomos_demo_log OUT.rawlog\n");
    return 2;
  }
  try {
    auto sink = prodomos::io::createRawlog(argv[1]);
    const auto world = prodomos::testing::fourRooms();
    for (const auto& reading : driveThrough(world, prodomos::testing::tourOfFourRooms())) sink->write(reading);
    sink->close();
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "prodomos_demo_log: %s\n", fault.what());
    return 1;
  }
  return 0;
}
