// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "score_report.hpp"

#include "text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <iostream>
#include <string_view>
#include <utility>

namespace prodomos::apps {

namespace {

using evaluation::ScoreTable;
using Json = nlohmann::ordered_json;

constexpr const char* kNone = "–";
constexpr const char* kBuildings = "buildings";

/// "false_negatives" is "false negatives", "position_m" is "position, m".
std::string nameOf(std::string key) {
  constexpr std::array<std::pair<const char*, const char*>, 5> kUnits = {
      {{"_m2", ", m²"}, {"_m", ", m"}, {"_deg", ", °"}, {"_percent", ", %"}, {"_s", ", s"}}};
  for (const auto& [suffix, unit] : kUnits) {
    if (!key.ends_with(suffix)) continue;
    key.erase(key.size() - std::string_view(suffix).size());
    const bool isOfNumber = std::isdigit(static_cast<unsigned char>(key.back())) != 0;  // "up_to_60_m2"
    key += isOfNumber ? unit + 1 : unit;
    break;
  }
  std::ranges::replace(key, '_', ' ');
  return key;
}

bool isStatistics(const Json& value) {
  return value.is_object() && value.contains("median") && value.contains("rmse");
}

/// Things of one kind by their names, or a list of them: they are a table.
bool isTable(const Json& value) {
  if (value.is_array()) return !value.empty() && value.front().is_object();
  if (!value.is_object() || value.empty() || isStatistics(value)) return false;
  return std::ranges::all_of(value, [](const Json& row) { return row.is_object() && !isStatistics(row); });
}

std::string shown(const Json& value) {
  if (value.is_null()) return kNone;
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return grouped(value.get<std::int64_t>());
  if (value.is_number()) return fixed(value.get<double>(), 3);
  if (value.is_string()) return value.get<std::string>();
  if (isStatistics(value)) {
    return fixed(value["median"].get<double>(), 3) + " (mean " + fixed(value["mean"].get<double>(), 3) + ", max " +
           fixed(value["max"].get<double>(), 3) + ")";
  }
  return value.dump();
}

/// Where a measure stands in a report, and its name.
struct Row {
  Json::json_pointer place;
  std::string name;
};

void collectRows(const Json& value, const Json::json_pointer& place, const std::string& name, std::vector<Row>& rows) {
  for (const auto& [key, part] : value.items()) {
    if (key == kBuildings || key == "building" || key == "map" || key == "worst" || isTable(part)) continue;
    const auto named = name.empty() ? nameOf(key) : name + " · " + nameOf(key);
    if (part.is_object() && !isStatistics(part)) {
      collectRows(part, place / key, named, rows);
    } else {
      rows.push_back({place / key, isStatistics(part) ? named + ", median" : named});
    }
  }
}

Json at(const Json& report, const Json::json_pointer& place) {
  return report.contains(place) ? report.at(place) : Json();
}

ScoreTable measuresOf(const Json& report) {
  ScoreTable table{
      .title = "Measures", .text = "– where a measure cannot be taken", .columns = {"", "all"}, .rows = {}};
  const auto& buildings = report.contains(kBuildings) ? report[kBuildings] : Json::array();
  const bool several = buildings.size() > 1;
  if (several) {
    for (const auto& building : buildings) table.columns.push_back(shown(building["building"]));
  }
  std::vector<Row> rows;
  collectRows(report, Json::json_pointer(), "", rows);
  for (const auto& row : rows) {
    std::vector<std::string> cells = {row.name, shown(at(report, row.place))};
    if (several) {
      for (const auto& building : buildings) cells.push_back(shown(at(building, row.place)));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// A list of objects, or an object of them by names.
ScoreTable tableOf(const std::string& title, const Json& value) {
  ScoreTable table{.title = title, .columns = {}, .rows = {}};
  std::vector<std::string> keys;
  for (const auto& row : value) {
    for (const auto& [key, cell] : row.items()) {
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    }
  }
  if (value.is_object()) table.columns.emplace_back();
  std::ranges::transform(keys, std::back_inserter(table.columns), nameOf);
  for (const auto& [name, row] : value.items()) {
    std::vector<std::string> cells;
    if (value.is_object()) cells.push_back(name);
    for (const auto& key : keys) cells.push_back(row.contains(key) ? shown(row[key]) : kNone);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

void collectTables(const Json& value, const std::string& name, std::vector<ScoreTable>& tables) {
  for (const auto& [key, part] : value.items()) {
    if (key == kBuildings) continue;
    const auto named = name.empty() ? nameOf(key) : name + " · " + nameOf(key);
    if (isTable(part)) {
      tables.push_back(tableOf(named, part));
    } else if (part.is_object() && !isStatistics(part)) {
      collectTables(part, named, tables);
    }
  }
}

/// Columns on a screen: bytes that begin a character of UTF-8.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

void print(const ScoreTable& table, std::size_t mostColumns) {
  const std::size_t columns = std::min(mostColumns, table.columns.size());
  auto rows = table.rows;
  rows.insert(rows.begin(), table.columns);
  std::vector<std::size_t> widths(columns, 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < columns; ++i) widths[i] = std::max(widths[i], widthOf(row[i]));
  }
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < columns; ++i) {
      const std::string blanks(widths[i] - widthOf(row[i]), ' ');
      line += " " + (i == 0 ? row[i] + blanks : " " + blanks + row[i]);
    }
    std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }
}

}  // namespace

Json measure(std::optional<double> value) {
  return value ? Json(*value) : Json(nullptr);
}

Json errorsOf(std::vector<double> errors, double unit) {
  if (errors.empty()) return nullptr;
  for (double& error : errors) error *= unit;
  return toJson(evaluation::statisticsOf(std::move(errors)));
}

std::vector<ScoreTable> tablesOf(const Json& report) {
  std::vector<ScoreTable> tables = {measuresOf(report)};
  collectTables(report, "", tables);
  return tables;
}

void printReport(const std::string& title, const Json& report) {
  constexpr std::size_t kMostColumns = 8;
  std::cout << title << '\n';
  bool first = true;
  for (const auto& table : tablesOf(report)) {
    if (!std::exchange(first, false)) std::cout << "\n  " << table.title << '\n';
    print(table, kMostColumns);
    if (table.columns.size() > kMostColumns) {
      std::cout << "  and " << table.columns.size() - kMostColumns << " more columns, see --json or --html\n";
    }
  }
}

void writeReportPage(const std::string& path, const std::string& title, const Json& report,
                     std::vector<evaluation::ScorePicture> pictures, std::vector<std::string> lines) {
  evaluation::writeScorePage({title, std::move(lines), tablesOf(report), std::move(pictures)}, path);
}

void writeReportPage(const std::string& path, const std::string& title, const Json& report,
                     std::vector<evaluation::ScorePicture> pictures, const std::vector<MapAndTruth>& maps) {
  std::vector<std::string> lines;
  for (const auto& [map, truthFile] : maps) {
    const auto truth = evaluation::readTruth(truthFile);
    lines.push_back(map + " against " + truthFile);
    for (auto& picture : evaluation::planPictures(map::MapView::open(map), truth)) {
      picture.title = truth.building + ", " + picture.title;
      pictures.push_back(std::move(picture));
    }
  }
  writeReportPage(path, title, report, std::move(pictures), std::move(lines));
}

}  // namespace prodomos::apps
