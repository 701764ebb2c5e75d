// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"

#include <filesystem>

namespace prodomos::exporter {

struct HtmlOptions {
  /// The page loads itself anew every so many seconds, and keeps what its reader looks at; 0: it does not. For a map
  /// that is being written, its page written again as the map grows.
  double followSeconds = 0.0;
};

/// One page that needs no network, described in docs/page.md. Throws base::FileError. Same map, same bytes.
void writeHtml(const map::MapView& view, const std::filesystem::path& path, const HtmlOptions& options);

}  // namespace prodomos::exporter
