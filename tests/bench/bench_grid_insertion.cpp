// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// Inserts the scans of a log into prodomos' grid and into MRPT's COccupancyGridMap2D, in turn, and prints the ratio of
// their times and how far the two agree. Both use the beams that returned, up to the same range.
//
//   bench_grid_insertion LOG [RESOLUTION [ROUNDS]]
#include "prodomos/io/open_source.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <vector>

namespace {

using prodomos::geometry::Pose2;
using prodomos::map::CellState;
using prodomos::map::OccupancyGrid;

struct PlacedScan {
  prodomos::sensors::LaserScan scan;
  Pose2 T_grid_body;
  mrpt::obs::CObservation2DRangeScan observation;
};

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

mrpt::obs::CObservation2DRangeScan toMrpt(const prodomos::sensors::LaserScan& scan) {
  mrpt::obs::CObservation2DRangeScan observation;
  const auto beams = scan.ranges.size();
  observation.resizeScan(beams);
  observation.rightToLeft = scan.angleStep > 0.0;
  observation.aperture = static_cast<float>(std::abs(scan.angleStep) * static_cast<double>(beams - 1));
  observation.maxRange = static_cast<float>(scan.maxRange);
  for (std::size_t i = 0; i < beams; ++i) {
    const bool valid = scan.ranges[i] >= 0.0F && scan.ranges[i] < prodomos::sensors::LaserScan::kNoReturn;
    observation.setScanRange(i, valid ? scan.ranges[i] : static_cast<float>(scan.maxRange));
    observation.setScanRangeValidity(i, valid);
  }
  const Pose2 T_body_sensor = prodomos::geometry::toPose2(scan.T_body_sensor);
  const double middle = scan.firstAngle + scan.angleStep * (static_cast<double>(beams) - 1.0) / 2.0;
  observation.sensorPose =
      mrpt::poses::CPose3D(T_body_sensor.x, T_body_sensor.y, 0.0, T_body_sensor.theta + middle, 0, 0);
  return observation;
}

/// Scans in stretches as long as a sub-map's, so that both grids stay as small as they are in use.
std::vector<std::vector<PlacedScan>> readStretches(const char* log) {
  constexpr std::size_t kStretch = 150;
  auto source = prodomos::io::openSource(log);
  std::vector<std::vector<PlacedScan>> stretches;
  Pose2 T_odom_body;
  Pose2 T_odom_begin;
  for (;;) {
    auto item = source->next();
    if (std::holds_alternative<prodomos::sensors::EndOfLog>(item)) return stretches;
    const auto* reading = std::get_if<prodomos::sensors::Reading>(&item);
    if (reading == nullptr) continue;
    if (const auto* odometry = std::get_if<prodomos::sensors::Odometry>(&reading->data)) {
      T_odom_body = prodomos::geometry::toPose2(odometry->T_odom_body);
    } else if (const auto* scan = std::get_if<prodomos::sensors::LaserScan>(&reading->data)) {
      if (stretches.empty() || stretches.back().size() == kStretch) {
        stretches.emplace_back();
        T_odom_begin = T_odom_body;
      }
      stretches.back().push_back({*scan, inverse(T_odom_begin) * T_odom_body, toMrpt(*scan)});
    }
  }
}

OccupancyGrid insertIntoOurs(const std::vector<PlacedScan>& scans, double resolution, double maxRange) {
  prodomos::map::OccupancyGridConfig config;
  config.resolution = resolution;
  config.maxRange = maxRange;
  config.noReturn = 0.0;
  OccupancyGrid grid(config);
  for (const auto& [scan, T_grid_body, observation] : scans) {
    grid.insert(scan, prodomos::geometry::toPose3(T_grid_body) * scan.T_body_sensor);
  }
  return grid;
}

mrpt::maps::COccupancyGridMap2D insertIntoMrpt(const std::vector<PlacedScan>& scans, double resolution,
                                               double maxRange) {
  mrpt::maps::COccupancyGridMap2D grid(-10, 10, -10, 10, static_cast<float>(resolution));
  grid.insertionOptions.maxDistanceInsertion = static_cast<float>(maxRange);
  grid.insertionOptions.maxOccupancyUpdateCertainty = 0.7F;
  grid.insertionOptions.considerInvalidRangesAsFreeSpace = false;
  for (const auto& [scan, T_grid_body, observation] : scans) {
    grid.insertObservation(observation, mrpt::poses::CPose3D(T_grid_body.x, T_grid_body.y, 0, T_grid_body.theta, 0, 0));
  }
  return grid;
}

struct Agreement {
  std::size_t same = 0;
  std::size_t both = 0;
};

/// Over the cells that both know. MRPT's cells hold P(free), 0.5 where nothing was seen.
Agreement compare(const OccupancyGrid& ours, const mrpt::maps::COccupancyGridMap2D& theirs) {
  Agreement agreement;
  for (unsigned y = 0; y < theirs.getSizeY(); ++y) {
    for (unsigned x = 0; x < theirs.getSizeX(); ++x) {
      const float free = theirs.getCell(static_cast<int>(x), static_cast<int>(y));
      const auto state = ours.state(ours.cellAt({theirs.idx2x(x), theirs.idx2y(y)}));
      if (state == CellState::kUnknown || std::abs(free - 0.5F) < 0.02F) continue;
      ++agreement.both;
      if ((state == CellState::kFree) == (free > 0.5F)) ++agreement.same;
    }
  }
  return agreement;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_grid_insertion LOG [RESOLUTION [ROUNDS]]\n");
    return 2;
  }
  const double resolution = argc > 2 ? std::atof(argv[2]) : 0.05;
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 5;
  const double maxRange = prodomos::map::OccupancyGridConfig{}.maxRange;
  const auto stretches = readStretches(argv[1]);
  std::size_t scans = 0;
  for (const auto& stretch : stretches) scans += stretch.size();
  if (scans == 0) {
    std::fprintf(stderr, "%s: expected laser scans, found none\n", argv[1]);
    return 1;
  }

  std::vector<double> ratios;
  Agreement agreement;
  std::printf("%s: %zu scans of %zu beams, cells of %.3f m\n", argv[1], scans, stretches[0][0].scan.ranges.size(),
              resolution);
  for (int round = 0; round < rounds; ++round) {
    double ours = 0.0;
    double theirs = 0.0;
    agreement = {};
    for (const auto& stretch : stretches) {
      const double begin = cpuSeconds();
      const auto grid = insertIntoOurs(stretch, resolution, maxRange);
      const double middle = cpuSeconds();
      const auto mrpt = insertIntoMrpt(stretch, resolution, maxRange);
      ours += middle - begin;
      theirs += cpuSeconds() - middle;
      const auto part = compare(grid, mrpt);
      agreement.same += part.same;
      agreement.both += part.both;
    }
    ratios.push_back(theirs / ours);
    std::printf("  prodomos %6.1f us/scan   MRPT %6.1f us/scan   MRPT/prodomos %.2f\n",
                1e6 * ours / static_cast<double>(scans), 1e6 * theirs / static_cast<double>(scans), ratios.back());
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("  median: prodomos is %.2f times as fast as MRPT; agreement %.4f over %zu cells both know\n",
              ratios[ratios.size() / 2], static_cast<double>(agreement.same) / static_cast<double>(agreement.both),
              agreement.both);
  return 0;
}
