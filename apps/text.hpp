// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace prodomos::apps {

/// "13,631"
std::string grouped(std::int64_t number);
/// With so many decimals: "41.25".
std::string fixed(double number, int decimals);
/// "3.2 MB"
std::string fileSize(std::uintmax_t bytes);
/// "1:05:09", "4:31"
std::string clockTime(double seconds);
/// "staircases", "boxes", "people"
std::string pluralOf(const std::string& noun);
/// "1 staircase", "13,631 doors"
std::string counted(std::size_t count, const std::string& noun);

}  // namespace prodomos::apps
