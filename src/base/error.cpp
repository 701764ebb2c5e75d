// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

namespace prodomos::base {

namespace {
std::string joinLines(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}
}  // namespace

UsageError::UsageError(std::vector<std::string> faults) : Error(joinLines(faults)), faults_(std::move(faults)) {}

std::string expectedFound(const std::string& place, const std::string& expected, const std::string& found) {
  return place + ": expected " + expected + ", found " + found;
}

}  // namespace prodomos::base
