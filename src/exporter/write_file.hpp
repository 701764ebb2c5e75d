// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace prodomos::exporter {

/// The whole file or nothing: written beside `path`, then renamed onto it. Throws base::FileError where that fails.
void writeFile(const std::filesystem::path& path, std::string_view bytes);

}  // namespace prodomos::exporter
