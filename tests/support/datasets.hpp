// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace prodomos::test {

/// Where a data set lies, "laser/intel.rawlog": under $PRODOMOS_DATASETS, else where the build was told. None: the test
/// skips, loudly.
///
///     const auto log = test::dataset("laser/intel.rawlog");
///     if (!log) GTEST_SKIP() << "needs laser/intel.rawlog";
inline std::optional<std::filesystem::path> dataset(std::string_view name) {
  const char* given = std::getenv("PRODOMOS_DATASETS");
  const auto path = std::filesystem::path(given != nullptr ? given : PRODOMOS_DATASETS_DEFAULT) / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace prodomos::test
