// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// Does a scan cost more the larger the map is? Maps a log over and over in one session: forth, back, forth …, so that
/// the robot goes through the same rooms again and never jumps. Prints a table, a line for each hundredth of the way:
///
///     cost_per_scan intel.rawlog --passes 10 > cost.tsv
///     draw_cost_per_scan cost.tsv docs/images/cost_per_scan.png
///
/// Milliseconds a scan by stage of the mapper; `total` is the wall time around all of them.

#include "prodomos/base/error.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/mapper/mapper.hpp"

#include "support/temporary_folder.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

namespace prodomos {
namespace {

constexpr int kLines = 100;
constexpr std::array<const char*, 6> kStages = {"localize", "refine", "occupancy_grid", "points", "surface", "store"};

std::vector<sensors::Reading> readAll(sensors::SensorSource& source) {
  std::vector<sensors::Reading> readings;
  for (;;) {
    auto item = source.next();
    if (auto* reading = std::get_if<sensors::Reading>(&item)) readings.push_back(std::move(*reading));
    if (const auto* end = std::get_if<sensors::EndOfLog>(&item)) {
      if (!end->fault.empty()) throw base::FileError(end->fault);
      return readings;
    }
  }
}

/// The i-th reading of a log that goes forth and back, and on in time.
sensors::Reading readingAt(const std::vector<sensors::Reading>& readings, std::size_t i) {
  const std::size_t pass = i / readings.size();
  const std::size_t inPass = i % readings.size();
  const auto begin = readings.front().time;
  const auto end = readings.back().time;
  auto reading = readings[pass % 2 == 0 ? inPass : readings.size() - 1 - inPass];
  const auto sinceBegin = pass % 2 == 0 ? reading.time - begin : end - reading.time;
  reading.time = begin + static_cast<int>(pass) * (end - begin) + sinceBegin;
  return reading;
}

/// What has been spent so far.
struct Spent {
  std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now();
  std::array<double, kStages.size()> seconds{};  ///< by stage
  std::int64_t scans = 0;
};

Spent spentBy(mapper::Mapper& mapper) {
  Spent spent;
  const auto& seconds = mapper.times().seconds();
  for (std::size_t i = 0; i < kStages.size(); ++i) {
    if (const auto found = seconds.find(kStages[i]); found != seconds.end()) spent.seconds[i] = found->second;
  }
  const auto& report = mapper.report();
  if (const auto found = report.usedByKind.find("laser_scan"); found != report.usedByKind.end())
    spent.scans = found->second;
  return spent;
}

void print(const mapper::Report& report, const Spent& before, const Spent& after) {
  const double perScan = 1e3 / static_cast<double>(std::max<std::int64_t>(1, after.scans - before.scans));
  std::printf("%.1f\t%d", report.distance, report.submaps);
  for (std::size_t i = 0; i < kStages.size(); ++i)
    std::printf("\t%.4f", perScan * (after.seconds[i] - before.seconds[i]));
  std::printf("\t%.4f\n", perScan * std::chrono::duration<double>(after.now - before.now).count());
  std::fflush(stdout);
}

void run(const std::string& log, int passes) {
  const auto source = io::openSource(log);
  const auto readings = readAll(*source);
  if (readings.empty()) throw base::FileError(base::expectedFound(log, "readings", "none"));
  const auto path = std::filesystem::temp_directory_path() /
                    ("cost_per_scan_" + std::to_string(readings.size()) + "_" + std::to_string(passes) + ".prodomos");
  std::filesystem::remove(path);
  auto store = map::MapStore::create(path);
  mapper::MapperConfig config;
  config.input.poses = "estimated";
  mapper::Mapper mapper(store, config, source->info());

  std::printf("way_m\tsubmaps");
  for (const auto* stage : kStages) std::printf("\t%s", stage);
  std::printf("\ttotal\n");
  const std::size_t count = readings.size() * static_cast<std::size_t>(passes);
  Spent before = spentBy(mapper);
  for (std::size_t i = 0, line = 1; i < count; ++i) {
    mapper.process(readingAt(readings, i));
    if (i + 1 < line * count / kLines) continue;
    const Spent after = spentBy(mapper);
    print(mapper.report(), before, after);
    before = after;
    ++line;
  }
  mapper.finish();
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  CLI::App program("milliseconds a scan while a map grows, by stage");
  std::string log;
  int passes = 10;
  program.add_option("LOG", log, "a log of a laser")->required();
  program.add_option("--passes", passes, "through the log, every second one backwards")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    prodomos::run(log, passes);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "cost_per_scan: %s\n", fault.what());
    return 1;
  }
  return 0;
}
