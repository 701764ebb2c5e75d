// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "replay_report.hpp"

#include "prodomos/base/error.hpp"

#include "text.hpp"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <fstream>
#include <iostream>

namespace prodomos::apps {

namespace fs = std::filesystem;

namespace {

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

void writeReport(const ReplayResult& result, const std::string& path) {
  const auto& report = result.report;
  std::map<std::string, std::size_t> entities;
  for (const auto& [noun, count] : result.entities) entities[pluralOf(noun)] = count;
  const nlohmann::json out = {
      {"readings",
       {{"read", report.read},
        {"used", report.used},
        {"used_by_kind", report.usedByKind},
        {"skipped", report.skippedByReason}}},
      {"faults", {{"count", report.faultCount}, {"first", report.faults}}},
      {"poses", {{"origin", result.poses}, {"lost", report.lost}}},
      {"not_looked_at", report.notLookedAt},
      {"refused", report.refused},
      {"entities", entities},
      {"submaps", report.submaps},
      {"loops", result.loops},
      {"meets_earlier_sessions", result.meetsEarlier ? nlohmann::json(*result.meetsEarlier) : nlohmann::json()},
      {"places", result.places},
      {"distance_m", report.distance},
      {"seconds", result.seconds},
      {"peak_memory_mb", peakMemoryMb()}};
  std::ofstream file(path);
  file << out.dump(2) << '\n';
  if (!file.flush()) throw base::FileError(path + ": the report cannot be written");
}

void printReport(const ReplayResult& result, const sensors::SourceInfo& log, const fs::path& map) {
  const auto& report = result.report;
  std::cout << log.path << " (" << log.kind << ")\n";
  std::cout << "  readings  " << grouped(report.read) << " read, " << grouped(report.used) << " used\n";
  for (const auto& [kind, count] : report.usedByKind)
    std::cout << "            " << grouped(count) << "  " << kind << '\n';
  for (const auto& [reason, count] : report.skippedByReason) {
    std::cout << "  skipped   " << grouped(count) << "  " << reason << '\n';
  }
  std::cout << "  poses     " << result.poses;
  if (report.lost > 0) std::cout << ", " << grouped(report.lost) << " readings not recognised";
  std::cout << '\n';
  std::cout << "  map       " << counted(static_cast<std::size_t>(report.submaps), "sub-map") << ", "
            << counted(result.places, "place") << ", " << counted(result.floors, "floor") << ", "
            << fixed(report.distance, 1) << " m travelled, " << counted(result.loops, "loop") << '\n';
  if (!result.entities.empty()) {
    std::cout << "  found     ";
    const char* comma = "";
    for (const auto& [name, count] : result.entities) {
      std::cout << comma << counted(count, name);
      comma = ", ";
    }
    std::cout << '\n';
  }
  for (const auto& [reason, count] : report.notLookedAt) {
    std::cout << "  unseen    " << grouped(count) << "  " << reason << '\n';
  }
  for (const auto& [reason, count] : report.refused) {
    std::cout << "  refused   " << grouped(count) << "  " << reason << '\n';
  }
  if (result.meetsEarlier && *result.meetsEarlier) {
    std::cout << "            meets what the map held before: all is in one frame\n";
  } else if (result.meetsEarlier) {
    std::cout << "            never meets what the map held before: stays a part of its own, drawn beside it\n";
  }
  std::cout << "  time      " << fixed(result.seconds.at("total"), 2) << " s (";
  const char* comma = "";
  for (const auto& [stage, seconds] : result.seconds) {
    if (stage == "total") continue;
    std::cout << comma << stage << " " << fixed(seconds, 2);
    comma = ", ";
  }
  std::cout << "), " << fixed(peakMemoryMb(), 0) << " MB of memory\n";
  std::cout << "  written   " << map.string() << ", " << fileSize(fs::file_size(map)) << '\n';
}

}  // namespace prodomos::apps
