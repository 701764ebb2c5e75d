// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace prodomos::base {

/// Time stamps of readings: nanoseconds since 1970-01-01 UTC, exact (a stamp printed with nine decimals and read again
/// is the same stamp). Logs that start at zero keep their own zero.
using Duration = std::chrono::nanoseconds;
using Time = std::chrono::time_point<std::chrono::system_clock, Duration>;

inline Time fromNanoseconds(std::int64_t nanoseconds) {
  return Time{Duration{nanoseconds}};
}
inline std::int64_t toNanoseconds(Time time) {
  return time.time_since_epoch().count();
}
inline double seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Rounded to the nearest nanosecond.
Duration fromSeconds(double seconds);

/// Decimal seconds without going through floating point: "976052857.337530". At most nine decimals are kept.
std::optional<Time> parseSeconds(std::string_view text);

/// Decimal seconds with as many decimals as needed, at least one: "976052857.33753".
std::string toString(Time time);

}  // namespace prodomos::base
