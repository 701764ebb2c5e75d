// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenes/yaml_map.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace prodomos::simulation {

namespace {

std::string joined(const auto& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

std::string rangeOf(base::Bounds bounds) {
  const bool least = std::isfinite(bounds.least);
  const bool most = std::isfinite(bounds.most);
  if (least && most) return " of " + toText(bounds.least) + " to " + toText(bounds.most);
  if (least) return " of at least " + toText(bounds.least);
  if (most) return " of at most " + toText(bounds.most);
  return "";
}

bool isWithin(double number, base::Bounds bounds) {
  return number >= bounds.least && number <= bounds.most;
}

}  // namespace

std::string toText(double number) {
  std::array<char, 32> buffer{};
  const auto [end, fault] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), end};
}

std::string toText(const Eigen::Vector2d& point) {
  const auto rounded = [](double number) { return toText(std::round(number * 1000.0) / 1000.0); };
  return "[" + rounded(point.x()) + ", " + rounded(point.y()) + "]";
}

void Faults::add(int line, const std::string& what, const std::string& expected, const std::string& found) {
  const auto place = file_ + ":" + std::to_string(line) + ": " + what;
  faults_.emplace_back(line, base::expectedFound(place, expected, found));
}

void Faults::throwIfAny() const {
  if (faults_.empty()) return;
  auto ordered = faults_;
  std::ranges::stable_sort(ordered, {}, &std::pair<int, std::string>::first);
  std::vector<std::string> lines;
  lines.reserve(ordered.size());
  for (auto& [line, text] : ordered) lines.push_back(std::move(text));
  throw base::UsageError(std::move(lines));
}

int lineOf(const YAML::Node& node) {
  return node.Mark().line + 1;
}

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (node.IsMap()) return "keys with values";
  if (!node.IsSequence()) return "nothing";
  const auto isScalar = [](const YAML::Node& item) { return item.IsScalar(); };
  if (node.size() > 6 || !std::all_of(node.begin(), node.end(), isScalar)) {
    return "a list of " + std::to_string(node.size());
  }
  std::vector<std::string> items;
  items.reserve(node.size());
  for (const auto& item : node) items.push_back(item.Scalar());
  return "[" + joined(items) + "]";
}

std::optional<double> parseNumber(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  const auto& text = node.Scalar();
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double number = 0.0;
  const auto [end, fault] = std::from_chars(begin, text.data() + text.size(), number);
  if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<std::vector<double>> parseNumbers(const YAML::Node& node, std::size_t least, std::size_t most) {
  if (!node.IsSequence() || node.size() < least || node.size() > most) return std::nullopt;
  std::vector<double> numbers;
  for (const auto& item : node) {
    const auto number = parseNumber(item);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<Eigen::Vector2d> parsePoint(const YAML::Node& node) {
  const auto numbers = parseNumbers(node, 2, 2);
  if (!numbers) return std::nullopt;
  return Eigen::Vector2d((*numbers)[0], (*numbers)[1]);
}

YamlMap::YamlMap(Faults& faults, const YAML::Node& node, std::string name)
    : faults_(faults), name_(std::move(name)), line_(simulation::lineOf(node)) {
  if (!node.IsMap()) {
    faults_.add(line_, name_, "keys with values", shown(node));
    return;
  }
  for (const auto& entry : node) {
    const int line = simulation::lineOf(entry.first);
    if (!entry.first.IsScalar()) {
      faults_.add(line, name_, "a word as key", shown(entry.first));
    } else if (!entries_.emplace(entry.first.Scalar(), Entry{entry.second, line}).second) {
      faults_.add(line, name_ + ", key '" + entry.first.Scalar() + "'", "each key once", "it again");
    }
  }
}

int YamlMap::lineOf(std::string_view key) const {
  const auto entry = entries_.find(std::string(key));
  return entry == entries_.end() ? line_ : entry->second.line;
}

std::optional<YAML::Node> YamlMap::find(std::string_view key) {
  if (std::ranges::find(asked_, key) == asked_.end()) asked_.emplace_back(key);
  const auto entry = entries_.find(std::string(key));
  if (entry == entries_.end()) return std::nullopt;
  entry->second.known = true;
  return entry->second.value;
}

std::optional<double> YamlMap::number(std::string_view key, base::Bounds bounds) {
  const auto node = find(key);
  if (!node) return std::nullopt;
  const auto number = parseNumber(*node);
  if (number && isWithin(*number, bounds)) return number;
  fault(key, "a number" + rangeOf(bounds), shown(*node));
  return std::nullopt;
}

std::optional<int> YamlMap::wholeNumber(std::string_view key, base::Bounds bounds) {
  const auto node = find(key);
  if (!node) return std::nullopt;
  const auto number = parseNumber(*node);
  if (number && isWithin(*number, bounds) && *number == std::floor(*number)) return static_cast<int>(*number);
  fault(key, "a whole number" + rangeOf(bounds), shown(*node));
  return std::nullopt;
}

std::optional<bool> YamlMap::flag(std::string_view key) {
  static constexpr std::array<std::string_view, 2> kChoices{"false", "true"};
  const auto chosen = choice(key, kChoices);
  if (!chosen) return std::nullopt;
  return *chosen == 1;
}

std::optional<std::string> YamlMap::text(std::string_view key) {
  const auto node = find(key);
  if (!node) return std::nullopt;
  if (node->IsScalar() && !node->Scalar().empty()) return node->Scalar();
  fault(key, "a word", shown(*node));
  return std::nullopt;
}

std::optional<int> YamlMap::choice(std::string_view key, std::span<const std::string_view> choices) {
  const auto node = find(key);
  if (!node) return std::nullopt;
  if (node->IsScalar()) {
    const auto chosen = std::ranges::find(choices, node->Scalar());
    if (chosen != choices.end()) return static_cast<int>(chosen - choices.begin());
  }
  fault(key, "one of " + joined(choices), shown(*node));
  return std::nullopt;
}

std::optional<Eigen::Vector2d> YamlMap::point(std::string_view key) {
  const auto given = numbers(key, 2);
  if (!given) return std::nullopt;
  return Eigen::Vector2d((*given)[0], (*given)[1]);
}

std::optional<std::vector<double>> YamlMap::numbers(std::string_view key, std::size_t count) {
  const auto node = find(key);
  if (!node) return std::nullopt;
  auto numbers = parseNumbers(*node, count, count);
  if (!numbers) fault(key, "a list of " + std::to_string(count) + " numbers", shown(*node));
  return numbers;
}

std::vector<YAML::Node> YamlMap::list(std::string_view key) {
  const auto node = find(key);
  if (!node) return {};
  if (!node->IsSequence()) {
    fault(key, "a list", shown(*node));
    return {};
  }
  return {node->begin(), node->end()};
}

bool YamlMap::require(std::string_view key, const std::string& expected) {
  find(key);
  if (has(key)) return true;
  fault(key, expected, "nothing");
  return false;
}

void YamlMap::fault(std::string_view key, const std::string& expected, const std::string& found) {
  faults_.add(lineOf(key), name_ + ", key '" + std::string(key) + "'", expected, found);
}

void YamlMap::finish() {
  for (const auto& [key, entry] : entries_) {
    if (!entry.known) faults_.add(entry.line, name_, "one of the keys " + joined(asked_), "'" + key + "'");
  }
}

}  // namespace prodomos::simulation
