// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::io {

/// The fields of a line: parted by blanks, or by `separator` with the blanks around it.
std::vector<std::string_view> splitFields(std::string_view line, char separator = ' ');

/// True for a line that says nothing: empty, blank or a `#` comment.
bool isComment(std::string_view line);

/// "PATH:LINE", as errors name it.
std::string place(const std::filesystem::path& path, std::size_t line);

/// The whole field as a number; "nan" and "inf" are numbers too.
template <typename Number>
std::optional<Number> parseNumber(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  Number number{};
  const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (fault != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return number;
}

/// All fields as numbers, or nothing.
std::optional<std::vector<double>> parseNumbers(const std::vector<std::string_view>& fields, std::size_t first,
                                                std::size_t count);

}  // namespace prodomos::io
