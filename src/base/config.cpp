// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/config.hpp"

#include "prodomos/base/error.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace prodomos::base {

namespace {

std::string toText(double value) {
  std::array<char, 32> buffer{};
  const auto [end, fault] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

std::string toText(Bounds bounds) {
  const bool least = bounds.least > -std::numeric_limits<double>::infinity();
  const bool most = bounds.most < std::numeric_limits<double>::infinity();
  if (least && most) return toText(bounds.least) + " to " + toText(bounds.most);
  if (least) return "at least " + toText(bounds.least);
  if (most) return "at most " + toText(bounds.most);
  return "";
}

template <typename Number>
std::optional<Number> parseWhole(const std::string& text) {
  Number number{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return number;
}

std::string joined(std::span<const std::string_view> words, const char* between) {
  std::string text;
  for (const auto word : words) text += (text.empty() ? "" : between) + std::string(word);
  return text;
}

}  // namespace

namespace detail {

class ConfigReader final : public ConfigVisitor {
 public:
  explicit ConfigReader(const ConfigInput& input) {
    if (!input.file.empty()) readFile(input.file);
    if (!input.text.empty()) readYaml("configuration", input.text);
    for (const auto& assignment : input.assignments) readAssignment(assignment);
  }

  void section(std::string_view name, std::string_view) override { prefix_ += std::string(name) + "."; }
  void endSection() override {
    prefix_.pop_back();
    prefix_.erase(prefix_.rfind('.') + 1);
  }

  void key(std::string_view name, double& value, std::string_view unit, Bounds bounds, std::string_view) override {
    readNumber(name, value, "a number", unit, bounds);
  }
  void key(std::string_view name, int& value, std::string_view unit, Bounds bounds, std::string_view) override {
    readNumber(name, value, "a whole number", unit, bounds);
  }
  void key(std::string_view name, std::uint64_t& value, std::string_view) override {
    readNumber(name, value, "a whole number of 0 or more", "", {});
  }
  void key(std::string_view name, bool& value, std::string_view) override {
    const auto* given = find(name);
    if (given == nullptr) return;
    if (given->text == "true" || given->text == "false") {
      value = given->text == "true";
    } else {
      complain(*given, name, "true or false");
    }
  }
  void key(std::string_view name, std::string& value, std::string_view) override {
    if (const auto* given = find(name)) value = given->text;
  }
  void choice(std::string_view name, int& value, std::span<const std::string_view> choices, std::string_view) override {
    const auto* given = find(name);
    if (given == nullptr) return;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (given->text == choices[i]) {
        value = static_cast<int>(i);
        return;
      }
    }
    complain(*given, name, "one of " + joined(choices, ", "));
  }

  void finish() {
    for (const auto& [name, given] : given_) {
      if (!known_.contains(name)) {
        faults_.push_back(
            {given.order, given.place + ": unknown key '" + name + "' (prodomos config prints the known ones)"});
      }
    }
    if (faults_.empty()) return;
    std::sort(faults_.begin(), faults_.end());
    std::vector<std::string> lines;
    for (auto& [order, line] : faults_) lines.push_back(std::move(line));
    throw UsageError(std::move(lines));
  }

 private:
  struct Given {
    std::string text;
    std::string place;
    int order = 0;
  };

  void readFile(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream || std::filesystem::is_directory(file)) {
      throw UsageError(expectedFound(file.string(), "a YAML configuration file", "none that can be read"));
    }
    readYaml(file.string(), {std::istreambuf_iterator<char>(stream), {}});
  }

  void readYaml(const std::string& file, const std::string& text) {
    try {
      const YAML::Node root = YAML::Load(text);
      if (root.IsNull()) return;
      if (!root.IsMap()) throw UsageError(expectedFound(file + ":1", "sections with keys", "something else"));
      collect(file, root, "");
    } catch (const YAML::Exception& fault) {
      throw UsageError(file + ":" + std::to_string(fault.mark.line + 1) + ": " + fault.msg);
    }
  }

  void collect(const std::string& file, const YAML::Node& node, const std::string& prefix) {
    for (const auto& entry : node) {
      const auto name = prefix + entry.first.Scalar();
      const auto place = file + ":" + std::to_string(entry.first.Mark().line + 1);
      if (entry.second.IsMap()) {
        collect(file, entry.second, name + ".");
      } else if (entry.second.IsScalar()) {
        if (given_.contains(name)) faults_.push_back({order_, place + ": key '" + name + "' is given twice"});
        given_[name] = {entry.second.Scalar(), place, order_++};
      } else {
        faults_.push_back({order_++, expectedFound(place + ": key '" + name + "'", "a value", "none")});
      }
    }
  }

  void readAssignment(const std::string& assignment) {
    const auto sign = assignment.find('=');
    if (sign == std::string::npos || sign == 0) {
      faults_.push_back({order_++, expectedFound("--set", "section.key=value", "'" + assignment + "'")});
      return;
    }
    const auto name = assignment.substr(0, sign);
    given_[name] = {assignment.substr(sign + 1), "--set " + name, order_++};
  }

  const Given* find(std::string_view name) {
    const auto full = prefix_ + std::string(name);
    known_.insert(full);
    const auto found = given_.find(full);
    return found == given_.end() ? nullptr : &found->second;
  }

  void complain(const Given& given, std::string_view name, const std::string& expected) {
    faults_.push_back({given.order, expectedFound(given.place + ": key '" + prefix_ + std::string(name) + "'", expected,
                                                  "'" + given.text + "'")});
  }

  template <typename Number>
  void readNumber(std::string_view name, Number& value, const std::string& kind, std::string_view unit, Bounds bounds) {
    const auto* given = find(name);
    if (given == nullptr) return;
    const auto number = parseWhole<Number>(given->text);
    if (number && static_cast<double>(*number) >= bounds.least && static_cast<double>(*number) <= bounds.most) {
      value = *number;
      return;
    }
    const auto range = toText(bounds);
    complain(*given, name,
             kind + (range.empty() ? "" : " (" + range + (unit.empty() ? "" : " " + std::string(unit)) + ")"));
  }

  std::map<std::string, Given> given_;
  std::set<std::string> known_;
  std::vector<std::pair<int, std::string>> faults_;
  std::string prefix_;
  int order_ = 0;
};

class ConfigWriter final : public ConfigVisitor {
 public:
  explicit ConfigWriter(bool explained) : explained_(explained) {}

  void section(std::string_view name, std::string_view text) override {
    if (explained_) line("# " + std::string(text));
    line(std::string(name) + ":");
    indent_ += "  ";
  }
  void endSection() override {
    indent_.resize(indent_.size() - 2);
    if (explained_ && indent_.empty()) text_ += "\n";
  }
  void key(std::string_view name, double& value, std::string_view unit, Bounds bounds, std::string_view text) override {
    put(name, toText(value), unit, toText(bounds), text);
  }
  void key(std::string_view name, int& value, std::string_view unit, Bounds bounds, std::string_view text) override {
    put(name, std::to_string(value), unit, toText(bounds), text);
  }
  void key(std::string_view name, bool& value, std::string_view text) override {
    put(name, value ? "true" : "false", "", "true or false", text);
  }
  void key(std::string_view name, std::uint64_t& value, std::string_view text) override {
    put(name, std::to_string(value), "", "", text);
  }
  void key(std::string_view name, std::string& value, std::string_view text) override {
    YAML::Emitter quoted;
    quoted << YAML::DoubleQuoted << value;
    put(name, quoted.c_str(), "", "", text);
  }
  void choice(std::string_view name, int& value, std::span<const std::string_view> choices,
              std::string_view text) override {
    put(name, std::string(choices[static_cast<std::size_t>(value)]), "", joined(choices, " | "), text);
  }

  std::string text() const { return text_; }

 private:
  void put(std::string_view name, const std::string& value, std::string_view unit, const std::string& range,
           std::string_view text) {
    if (explained_) {
      std::string note = std::string(unit) + (unit.empty() || range.empty() ? "" : ", ") + range;
      line("# " + std::string(text) + (note.empty() ? "" : " [" + note + "]"));
    }
    line(std::string(name) + ": " + value);
  }
  void line(const std::string& content) { text_ += indent_ + content + "\n"; }

  bool explained_;
  std::string indent_;
  std::string text_;
};

}  // namespace detail

ConfigReading::ConfigReading(const ConfigInput& input) : reader_(std::make_unique<detail::ConfigReader>(input)) {}
ConfigReading::~ConfigReading() = default;
ConfigVisitor& ConfigReading::visitor() {
  return *reader_;
}
void ConfigReading::finish() {
  reader_->finish();
}

ConfigWriting::ConfigWriting(bool explained) : writer_(std::make_unique<detail::ConfigWriter>(explained)) {}
ConfigWriting::~ConfigWriting() = default;
ConfigVisitor& ConfigWriting::visitor() {
  return *writer_;
}
std::string ConfigWriting::text() const {
  return writer_->text();
}

}  // namespace prodomos::base
