// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/image.hpp"

#include <filesystem>

namespace prodomos::simulation {

/// Row 0 on top; what is transparent shows white. Throws base::FileError.
sensors::Image<sensors::Rgb> readPng(const std::filesystem::path& path);

}  // namespace prodomos::simulation
