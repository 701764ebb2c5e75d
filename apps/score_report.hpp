// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/score_page.hpp"

#include "evaluate_kinds.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

/// Reports of scores as JSON, and what people see of them: every measure of the report, under the name of its key. A
/// report has the measures of all maps together, and in "buildings" those of each, with its "building" and "map".
namespace prodomos::apps {

/// Null where it cannot be taken.
nlohmann::ordered_json measure(std::optional<double> value);
/// Statistics of errors times `unit`; null where there are none.
nlohmann::ordered_json errorsOf(std::vector<double> errors, double unit = 1.0);

/// Measures first, each in a row, a column for all and for each building; then what the report has in tables.
std::vector<evaluation::ScoreTable> tablesOf(const nlohmann::ordered_json& report);

/// As text on the standard output. Of many buildings the first few are shown.
void printReport(const std::string& title, const nlohmann::ordered_json& report);

/// The page of --html: tables of the report and `pictures`, below the title `lines`. Throws base::FileError.
void writeReportPage(const std::string& path, const std::string& title, const nlohmann::ordered_json& report,
                     std::vector<evaluation::ScorePicture> pictures, std::vector<std::string> lines);
/// The same, with a plan of each storey of each map.
void writeReportPage(const std::string& path, const std::string& title, const nlohmann::ordered_json& report,
                     std::vector<evaluation::ScorePicture> pictures, const std::vector<MapAndTruth>& maps);

}  // namespace prodomos::apps
