// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/error.hpp"

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::map {

/// Throws base::FileError saying in plain words what SQLite reports.
[[noreturn]] void throwDatabaseError(sqlite3* connection, const std::string& path, const std::string& during);

/// One prepared statement. Values are bound with `<<` in order, columns read with get<T>(), NULL as std::optional.
class Statement {
 public:
  Statement(sqlite3* connection, const std::string& path, std::string_view sql);
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&&) = delete;
  ~Statement();

  Statement& operator<<(std::int64_t value);
  Statement& operator<<(int value) { return *this << static_cast<std::int64_t>(value); }
  Statement& operator<<(double value);
  Statement& operator<<(std::string_view value);
  Statement& operator<<(std::span<const std::byte> value);
  template <typename T>
  Statement& operator<<(const std::optional<T>& value) {
    if (value) return *this << *value;
    ++bound_;
    return *this;  // unbound is NULL
  }

  /// True while there is a row.
  bool step();
  /// Runs a statement without rows and makes it ready to be bound again.
  void run();

  template <typename T>
  T get(int column) const;
  template <typename T>
  std::optional<T> find(int column) const {
    if (sqlite3_column_type(statement_, column) == SQLITE_NULL) return std::nullopt;
    return get<T>(column);
  }

 private:
  void check(int code) const;

  sqlite3* connection_;
  const std::string& path_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

/// A connection to a map file.
class Database {
 public:
  enum class Access { kRead, kWrite, kCreate };

  /// An empty path with kCreate: in memory.
  Database(const std::filesystem::path& path, Access access);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  const std::string& path() const { return path_; }
  Statement prepare(std::string_view sql) const { return {connection_, path_, sql}; }
  void execute(const std::string& sql) const;
  void tryToExecute(const std::string& sql) const;  ///< what may fail without harm
  std::int64_t number(std::string_view sql) const;  ///< the first column of the first row

  /// Commits with commit(), else rolls back.
  class Transaction {
   public:
    explicit Transaction(const Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction();
    void commit();

   private:
    const Database& database_;
    bool done_ = false;
  };

  /// Several reads of one state. Ends with the scope.
  class Snapshot {
   public:
    explicit Snapshot(const Database& database) : database_(database) { database_.execute("BEGIN"); }
    Snapshot(const Snapshot&) = delete;
    Snapshot& operator=(const Snapshot&) = delete;
    ~Snapshot();

   private:
    const Database& database_;
  };

 private:
  std::string path_;
  sqlite3* connection_ = nullptr;
};

}  // namespace prodomos::map
