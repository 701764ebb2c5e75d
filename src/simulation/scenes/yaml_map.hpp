// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"

#include <Eigen/Core>
#include <yaml-cpp/yaml.h>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prodomos::simulation {

/// As short as it can be read back.
std::string toText(double number);
std::string toText(const Eigen::Vector2d& point);

/// Faults of one file, put in the order of its lines.
class Faults {
 public:
  explicit Faults(std::string file) : file_(std::move(file)) {}

  void add(int line, const std::string& what, const std::string& expected, const std::string& found);
  bool empty() const { return faults_.empty(); }
  std::size_t count() const { return faults_.size(); }
  /// base::UsageError
  void throwIfAny() const;

 private:
  std::string file_;
  std::vector<std::pair<int, std::string>> faults_;
};

/// One line of YAML, counted from 1.
int lineOf(const YAML::Node& node);
/// What stands there, as it is shown in faults.
std::string shown(const YAML::Node& node);

std::optional<double> parseNumber(const YAML::Node& node);
/// A list of that many numbers; none: it is something else.
std::optional<std::vector<double>> parseNumbers(const YAML::Node& node, std::size_t least, std::size_t most);
std::optional<Eigen::Vector2d> parsePoint(const YAML::Node& node);

/// Strict reading of one YAML map: what is asked for is known, all else is a fault, and so is what has another form
/// than was asked for. `name` is what faults call it: "door 'd1'".
class YamlMap {
 public:
  YamlMap(Faults& faults, const YAML::Node& node, std::string name);

  void rename(std::string name) { name_ = std::move(name); }
  const std::string& name() const { return name_; }
  int line() const { return line_; }
  int lineOf(std::string_view key) const;

  bool has(std::string_view key) const { return entries_.contains(std::string(key)); }
  /// None: it is not given.
  std::optional<YAML::Node> find(std::string_view key);
  std::optional<double> number(std::string_view key, base::Bounds bounds);
  std::optional<int> wholeNumber(std::string_view key, base::Bounds bounds);
  std::optional<bool> flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  /// Index into `choices`.
  std::optional<int> choice(std::string_view key, std::span<const std::string_view> choices);
  std::optional<Eigen::Vector2d> point(std::string_view key);
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count);
  /// The items of a list; none where it is not given.
  std::vector<YAML::Node> list(std::string_view key);

  /// Says that the key must be given, where it is not.
  bool require(std::string_view key, const std::string& expected);
  void fault(std::string_view key, const std::string& expected, const std::string& found);
  /// Keys that nobody has asked for become faults.
  void finish();

 private:
  struct Entry {
    YAML::Node value;
    int line = 0;
    bool known = false;
  };

  Faults& faults_;
  std::string name_;
  int line_ = 0;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> asked_;
};

}  // namespace prodomos::simulation
