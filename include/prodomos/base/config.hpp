// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::base {

/// Where the values of a key may lie; both ends included.
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// What a configuration struct describes itself to. Each tier's struct has its defaults in its members and one function
///
///     void describe(base::ConfigVisitor& visitor, GridConfig& config) {
///       visitor.section("grid", "occupancy grid of each sub-map");
///       visitor.key("resolution", config.resolution, "m", {0.005, 1.0}, "edge length of a cell");
///       visitor.endSection();
///     }
///
/// which serves the reading of files, `--set`, and the printing of defaults alike.
class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;

  virtual void section(std::string_view name, std::string_view text) = 0;
  virtual void endSection() = 0;
  virtual void key(std::string_view name, double& value, std::string_view unit, Bounds bounds,
                   std::string_view text) = 0;
  virtual void key(std::string_view name, int& value, std::string_view unit, Bounds bounds, std::string_view text) = 0;
  virtual void key(std::string_view name, bool& value, std::string_view text) = 0;
  virtual void key(std::string_view name, std::uint64_t& value, std::string_view text) = 0;
  virtual void key(std::string_view name, std::string& value, std::string_view text) = 0;
  /// One of `choices`; `value` is the index into them.
  virtual void choice(std::string_view name, int& value, std::span<const std::string_view> choices,
                      std::string_view text) = 0;
};

/// What is read over the defaults: a YAML file (may be empty: none) or YAML text, and `section.key=value` assignments,
/// which win.
struct ConfigInput {
  std::filesystem::path file;
  std::string text;
  std::vector<std::string> assignments;
};

namespace detail {
class ConfigReader;
class ConfigWriter;
}  // namespace detail

/// Reads strictly: unknown keys, wrong types and values out of bounds are all collected, and thrown as one UsageError
/// whose lines name file, line and key.
class ConfigReading {
 public:
  explicit ConfigReading(const ConfigInput& input);
  ~ConfigReading();

  ConfigVisitor& visitor();
  void finish();  ///< throws UsageError

 private:
  std::unique_ptr<detail::ConfigReader> reader_;
};

template <typename Config>
Config readConfig(const ConfigInput& input) {
  Config config;
  ConfigReading reading(input);
  describe(reading.visitor(), config);
  reading.finish();
  return config;
}

/// YAML of every key with its value; with `explained`, unit, bounds and text as comments. readConfig() reads it back.
class ConfigWriting {
 public:
  explicit ConfigWriting(bool explained);
  ~ConfigWriting();

  ConfigVisitor& visitor();
  std::string text() const;

 private:
  std::unique_ptr<detail::ConfigWriter> writer_;
};

template <typename Config>
std::string writeConfig(Config config, bool explained) {
  ConfigWriting writing(explained);
  describe(writing.visitor(), config);
  return writing.text();
}

}  // namespace prodomos::base
