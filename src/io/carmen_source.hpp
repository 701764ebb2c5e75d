// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <filesystem>
#include <memory>
#include <string_view>

namespace prodomos::io {

/// True where a log that begins with these (decompressed) bytes is one of CARMEN's.
bool isCarmenLog(std::string_view begin);

std::unique_ptr<sensors::SensorSource> openCarmenLog(const std::filesystem::path& path);

}  // namespace prodomos::io
