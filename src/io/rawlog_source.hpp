// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include "io/input_file.hpp"

#include <memory>
#include <string_view>

namespace prodomos::io {

/// True where a log that begins with these (decompressed) bytes is an MRPT rawlog.
bool isRawlog(std::string_view begin);

/// A rawlog of either flavour.
std::unique_ptr<sensors::SensorSource> openRawlog(const std::filesystem::path& path);

}  // namespace prodomos::io
