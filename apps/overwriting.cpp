// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "overwriting.hpp"

#include "prodomos/base/error.hpp"

namespace prodomos::apps {

namespace fs = std::filesystem;

void requireOtherFile(const std::string& option, const fs::path& output, const fs::path& input,
                      const std::string& what) {
  std::error_code unknown;
  // Links are seen through by the first, files that are not there yet by the second.
  if (fs::equivalent(output, input, unknown) ||
      fs::weakly_canonical(output, unknown) == fs::weakly_canonical(input, unknown)) {
    throw base::UsageError(base::expectedFound(option, "another file than " + what, output.string()));
  }
}

}  // namespace prodomos::apps
