// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/time.hpp"

#include <charconv>
#include <cmath>

namespace prodomos::base {

namespace {
constexpr std::int64_t kPerSecond = 1'000'000'000;
}

Duration fromSeconds(double seconds) {
  return Duration{std::llround(seconds * static_cast<double>(kPerSecond))};
}

std::optional<Time> parseSeconds(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  const auto point = text.find('.');
  const auto whole = text.substr(0, point);
  auto decimals = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);

  std::int64_t seconds = 0;
  const auto [end, fault] = std::from_chars(whole.data(), whole.data() + whole.size(), seconds);
  if (whole.empty() || fault != std::errc{} || end != whole.data() + whole.size() || seconds < 0 ||
      seconds > 9'000'000'000) {
    return std::nullopt;
  }

  std::int64_t nanoseconds = 0;
  std::int64_t unit = kPerSecond;
  for (const char digit : decimals) {
    if (digit < '0' || digit > '9') return std::nullopt;
    unit /= 10;
    nanoseconds += unit * (digit - '0');
  }
  const std::int64_t total = seconds * kPerSecond + nanoseconds;
  return fromNanoseconds(negative ? -total : total);
}

std::string toString(Time time) {
  const std::int64_t total = toNanoseconds(time);
  const std::uint64_t magnitude = total < 0 ? 0 - static_cast<std::uint64_t>(total) : static_cast<std::uint64_t>(total);
  std::string decimals = std::to_string(magnitude % kPerSecond);
  decimals.insert(0, 9 - decimals.size(), '0');
  decimals.erase(std::max<std::size_t>(1, decimals.find_last_not_of('0') + 1));
  return (total < 0 ? "-" : "") + std::to_string(magnitude / kPerSecond) + "." + decimals;
}

}  // namespace prodomos::base
