// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sqlite3.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace prodomos::test {

/// All rows of a query, one line each, blobs in full.
inline std::vector<std::string> rowsOf(sqlite3* database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    throw std::runtime_error(sqlite3_errmsg(database));
  }
  std::vector<std::string> rows;
  while (sqlite3_step(statement) == SQLITE_ROW) {
    std::string row;
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, i));
      row.append(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement, i))).append("|");
    }
    rows.push_back(std::move(row));
  }
  sqlite3_finalize(statement);
  return rows;
}

/// Everything that a map file holds, table by table, but for the wall clock.
inline std::map<std::string, std::vector<std::string>> tablesOf(const std::filesystem::path& map) {
  sqlite3* database = nullptr;
  sqlite3_open_v2(map.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr);
  std::map<std::string, std::vector<std::string>> tables;
  for (auto name : rowsOf(database, "SELECT name FROM sqlite_master WHERE type = 'table'")) {
    name.pop_back();
    const std::string columns = name == "revision" ? "id, session, time_ns" : "*";
    tables[name] = rowsOf(database, "SELECT " + columns + " FROM " + name + " ORDER BY 1, 2");
  }
  sqlite3_close(database);
  return tables;
}

}  // namespace prodomos::test
