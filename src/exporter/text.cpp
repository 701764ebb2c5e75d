// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/text.hpp"

#include <array>
#include <charconv>
#include <limits>

namespace prodomos::exporter {

std::string fixed(double value, int decimals) {
  // The sign, the digits of the greatest double, the point, the decimals.
  std::array<char, std::numeric_limits<double>::max_exponent10 + 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end.ptr);
  const bool negativeZero = text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos;
  return negativeZero ? text.substr(1) : text;
}

std::string brief(double value, int decimals) {
  std::string text = fixed(value, decimals);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string xml(std::string_view text) {
  std::string escaped;
  for (const char character : text) {
    switch (character) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(character) < ' ' ? '?' : character;
    }
  }
  return escaped;
}

std::string inQuotes(std::string_view text) {
  std::string escaped = "\"";
  for (const char character : text) {
    if (character == '"' || character == '\\') escaped += '\\';
    escaped += static_cast<unsigned char>(character) < ' ' ? '?' : character;
  }
  return escaped + '"';
}

std::string fileName(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);
  return std::string(path.substr(path.find_last_of('/') + 1));
}

}  // namespace prodomos::exporter
