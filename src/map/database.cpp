// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map/database.hpp"

#include <utility>

namespace prodomos::map {

void throwDatabaseError(sqlite3* connection, const std::string& path, const std::string& during) {
  const int code = connection == nullptr ? SQLITE_NOMEM : sqlite3_errcode(connection);
  const std::string said = connection == nullptr ? "out of memory" : sqlite3_errmsg(connection);
  const int extended = connection == nullptr ? 0 : sqlite3_extended_errcode(connection);
  if (code == SQLITE_NOTADB) throw base::FileError(base::expectedFound(path, "a prodomos map", "another kind of file"));
  if (code == SQLITE_CORRUPT) throw base::FileError(path + ": the map file is damaged (" + said + ")");
  if (code == SQLITE_FULL || extended == SQLITE_IOERR_WRITE) {
    throw base::FileError(path + ": no room left on the disk while " + during +
                          "; what was committed before is whole, and --resume goes on from there");
  }
  if (code == SQLITE_CANTOPEN || code == SQLITE_READONLY || code == SQLITE_PERM) {
    throw base::FileError(path + ": cannot be opened or written while " + during + " (" + said + ")");
  }
  if (extended == SQLITE_CONSTRAINT_FOREIGNKEY) {
    throw base::FileError(path + ": expected each row to refer to others of the map, found one that refers to nothing");
  }
  if (code == SQLITE_BUSY) throw base::FileError(path + ": another process is writing to the map");
  throw base::FileError(path + ": " + said + " while " + during);
}

Statement::Statement(sqlite3* connection, const std::string& path, std::string_view sql)
    : connection_(connection), path_(path) {
  check(sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr));
}

Statement::Statement(Statement&& other) noexcept
    : connection_(other.connection_),
      path_(other.path_),
      statement_(std::exchange(other.statement_, nullptr)),
      bound_(other.bound_) {}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
    const char* sql = statement_ == nullptr ? nullptr : sqlite3_sql(statement_);
    const std::string verb = sql == nullptr                              ? "reading"
                             : std::string(sql).substr(0, 6) == "SELECT" ? "reading"
                                                                         : "writing";
    throwDatabaseError(connection_, path_, verb);
  }
}

Statement& Statement::operator<<(std::int64_t value) {
  check(sqlite3_bind_int64(statement_, ++bound_, value));
  return *this;
}

Statement& Statement::operator<<(double value) {
  check(sqlite3_bind_double(statement_, ++bound_, value));
  return *this;
}

Statement& Statement::operator<<(std::string_view value) {
  check(sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::operator<<(std::span<const std::byte> value) {
  check(sqlite3_bind_blob64(statement_, ++bound_, value.data(), value.size(), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_);
  check(code);
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  check(sqlite3_reset(statement_));
  check(sqlite3_clear_bindings(statement_));
  bound_ = 0;
}

template <>
std::int64_t Statement::get<std::int64_t>(int column) const {
  return sqlite3_column_int64(statement_, column);
}
template <>
int Statement::get<int>(int column) const {
  return sqlite3_column_int(statement_, column);
}
template <>
double Statement::get<double>(int column) const {
  return sqlite3_column_double(statement_, column);
}
template <>
std::string Statement::get<std::string>(int column) const {
  const auto* text = sqlite3_column_text(statement_, column);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}
template <>
std::vector<std::byte> Statement::get<std::vector<std::byte>>(int column) const {
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(statement_, column));
  return {bytes, bytes + sqlite3_column_bytes(statement_, column)};
}

Database::Database(const std::filesystem::path& path, Access access)
    : path_(path.empty() ? ":memory:" : path.string()) {
  const int flags = access == Access::kRead    ? SQLITE_OPEN_READONLY
                    : access == Access::kWrite ? SQLITE_OPEN_READWRITE
                                               : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const auto open = [&](const std::string& name, int more) {
    if (sqlite3_open_v2(name.c_str(), &connection_, flags | more, nullptr) == SQLITE_OK) return;
    const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> closer(connection_, sqlite3_close);
    throwDatabaseError(connection_, path_, "opening");
  };
  open(path_, 0);
  sqlite3_extended_result_codes(connection_, 0);
  sqlite3_busy_timeout(connection_, 10'000);
  if (access == Access::kRead) {
    // A finished map in a folder that cannot be written: SQLite's WAL mode wants to make its side files there.
    const int code = sqlite3_exec(connection_, "SELECT count(*) FROM sqlite_master", nullptr, nullptr, nullptr);
    if ((code == SQLITE_CANTOPEN || code == SQLITE_READONLY) && !std::filesystem::exists(path_ + "-wal")) {
      sqlite3_close(connection_);
      std::string uri = "file:";
      for (const char c : path_) {
        uri += c == '?' ? "%3f" : c == '#' ? "%23" : c == '%' ? "%25" : std::string(1, c);
      }
      open(uri + "?immutable=1", SQLITE_OPEN_URI);
    }
  }
}

Database::~Database() {
  sqlite3_close_v2(connection_);
}

void Database::execute(const std::string& sql) const {
  if (sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throwDatabaseError(connection_, path_, "writing");
  }
}

void Database::tryToExecute(const std::string& sql) const {
  sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr);
}

std::int64_t Database::number(std::string_view sql) const {
  auto statement = prepare(sql);
  return statement.step() ? statement.get<std::int64_t>(0) : 0;
}

Database::Transaction::~Transaction() {
  if (!done_) sqlite3_exec(database_.connection_, "ROLLBACK", nullptr, nullptr, nullptr);
}

void Database::Transaction::commit() {
  database_.execute("COMMIT");
  done_ = true;
}

Database::Snapshot::~Snapshot() {
  sqlite3_exec(database_.connection_, "COMMIT", nullptr, nullptr, nullptr);
}

}  // namespace prodomos::map
