// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace prodomos::apps {

/// Throws base::UsageError where `output`, which `option` gives, is `input`: a file that is read, or about to be made.
/// `what` names the input: "the map itself".
void requireOtherFile(const std::string& option, const std::filesystem::path& output,
                      const std::filesystem::path& input, const std::string& what);

}  // namespace prodomos::apps
