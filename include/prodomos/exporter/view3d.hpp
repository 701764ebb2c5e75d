// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"

#include <filesystem>

/// Maps in three dimensions, as people look at them.
namespace prodomos::exporter {

/// A PNG of the whole map from above and aside, in pixels. Needs no display. Throws base::FileError where the file
/// cannot be written, base::Error where the machine cannot draw.
void renderScreenshot(const map::MapView& view, const std::filesystem::path& png, int width, int height);

/// A window, until it is closed. With `follow`, what another process adds to the file shows within a second. Throws
/// base::FileError where the file is no map, base::Error where there is no display or the build has no window.
void showWindow(const std::filesystem::path& map, bool follow);

}  // namespace prodomos::exporter
