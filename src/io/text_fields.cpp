// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text_fields.hpp"

namespace prodomos::io {

namespace {
constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}
}  // namespace

std::vector<std::string_view> splitFields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  if (separator != ' ') {
    for (std::size_t begin = 0; begin <= line.size();) {
      const auto end = std::min(line.find(separator, begin), line.size());
      fields.push_back(trimmed(line.substr(begin, end - begin)));
      begin = end + 1;
    }
    return fields;
  }
  for (auto begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlanks, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

bool isComment(std::string_view line) {
  line = trimmed(line);
  return line.empty() || line.front() == '#';
}

std::string place(const std::filesystem::path& path, std::size_t line) {
  return path.string() + ":" + std::to_string(line);
}

std::optional<std::vector<double>> parseNumbers(const std::vector<std::string_view>& fields, std::size_t first,
                                                std::size_t count) {
  if (fields.size() < first + count) return std::nullopt;
  std::vector<double> numbers;
  for (std::size_t i = first; i < first + count; ++i) {
    const auto number = parseNumber<double>(fields[i]);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace prodomos::io
