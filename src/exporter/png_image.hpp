// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/drawing.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace prodomos::exporter {

/// The bytes of a PNG file, row 0 on top. The same pixels give the same bytes.
std::string encodePng(const sensors::Image<map::Rgba>& pixels);

/// Pixels are indices into sixteen colours: half a byte each before compression.
using Palette = std::array<map::Rgba, 16>;
std::string encodePng(const sensors::Image<std::uint8_t>& indices, const Palette& palette);

}  // namespace prodomos::exporter
