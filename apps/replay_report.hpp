// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/mapper/report.hpp"
#include "prodomos/sensors/source.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace prodomos::apps {

/// What a replay has come to.
struct ReplayResult {
  mapper::Report report;
  std::map<std::string, double, std::less<>> seconds;  ///< by stage
  std::string poses;                                   ///< where they come from
  std::size_t places = 0;
  std::size_t floors = 0;
  std::size_t loops = 0;                        ///< of the whole map
  std::map<std::string, std::size_t> entities;  ///< of the whole map: "door", "doorway", "staircase", "person"
  std::optional<bool> meetsEarlier;  ///< was the log found in what the map held before? None where that was nothing
};

/// As JSON (docs/json.md). Throws base::FileError where the file cannot be written.
void writeReport(const ReplayResult& result, const std::string& path);
/// For people, to standard output.
void printReport(const ReplayResult& result, const sensors::SourceInfo& log, const std::filesystem::path& map);

}  // namespace prodomos::apps
