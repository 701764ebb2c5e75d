// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace prodomos::apps {

std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number);
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > (number < 0 ? 1 : 0); at -= 3) {
    digits.insert(static_cast<std::size_t>(at), ",");
  }
  return digits;
}

std::string fixed(double number, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, number);
  return text.data();
}

std::string fileSize(std::uintmax_t bytes) {
  constexpr double kMega = 1e6;
  const auto size = static_cast<double>(bytes);
  return size < kMega ? fixed(size / 1e3, 1) + " kB" : fixed(size / kMega, 1) + " MB";
}

std::string clockTime(double seconds) {
  const auto total = std::llround(seconds);
  const auto twoDigits = [](long long number) { return (number < 10 ? "0" : "") + std::to_string(number); };
  const auto minutes = total / 60;
  if (minutes < 60) return std::to_string(minutes) + ":" + twoDigits(total % 60);
  return std::to_string(minutes / 60) + ":" + twoDigits(minutes % 60) + ":" + twoDigits(total % 60);
}

std::string pluralOf(const std::string& noun) {
  if (noun == "person") return "people";
  const bool hisses = noun.ends_with("x") || noun.ends_with("s") || noun.ends_with("ch");
  return noun + (hisses ? "es" : "s");
}

std::string counted(std::size_t count, const std::string& noun) {
  return grouped(static_cast<std::int64_t>(count)) + ' ' + (count == 1 ? noun : pluralOf(noun));
}

}  // namespace prodomos::apps
