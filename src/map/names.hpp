// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/error.hpp"

#include <array>
#include <string>
#include <string_view>

namespace prodomos::map {

/// The enumerator whose toString() is `name`; throws base::Error where there is none. Enumerators count from 0 to
/// `last`.
template <typename Enum>
Enum fromName(std::string_view name, Enum last) {
  std::string known;
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    const auto value = static_cast<Enum>(i);
    if (toString(value) == name) return value;
    known += (i == 0 ? "" : ", ") + std::string(toString(value));
  }
  throw base::Error("expected one of " + known + ", found '" + std::string(name) + "'");
}

}  // namespace prodomos::map
