// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sqlite3.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace prodomos::test {

/// A map file as anybody opens it who has SQLite and none of our code.
class PlainSqlite {
 public:
  explicit PlainSqlite(const std::filesystem::path& path) {
    if (sqlite3_open(path.c_str(), &connection_) != SQLITE_OK) throw std::runtime_error("cannot open " + path.string());
  }
  PlainSqlite(const PlainSqlite&) = delete;
  PlainSqlite& operator=(const PlainSqlite&) = delete;
  ~PlainSqlite() { sqlite3_close_v2(connection_); }

  /// All rows; NULL as "NULL". Throws what SQLite says.
  std::vector<std::vector<std::string>> query(const std::string& sql) const {
    std::vector<std::vector<std::string>> rows;
    const auto add = [](void* to, int count, char** values, char**) {
      auto& row = static_cast<std::vector<std::vector<std::string>>*>(to)->emplace_back();
      for (int i = 0; i < count; ++i) row.emplace_back(values[i] == nullptr ? "NULL" : values[i]);
      return 0;
    };
    char* fault = nullptr;
    if (sqlite3_exec(connection_, sql.c_str(), add, &rows, &fault) != SQLITE_OK) {
      const std::string said = fault == nullptr ? "fault" : fault;
      sqlite3_free(fault);
      throw std::runtime_error(said + " in: " + sql);
    }
    return rows;
  }

  /// The one value of a query for one.
  std::string value(const std::string& sql) const { return query(sql).at(0).at(0); }

 private:
  sqlite3* connection_ = nullptr;
};

}  // namespace prodomos::test
