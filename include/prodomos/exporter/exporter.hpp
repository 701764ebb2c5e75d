// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"

#include <filesystem>
#include <span>
#include <string_view>

namespace prodomos::exporter {

/// A format that maps are written in. The table in src/exporter/exporters.cpp lists them all; a new one is a function
/// and a line there.
struct Exporter {
  std::string_view format;     ///< "html", as in `prodomos export MAP html`
  std::string_view extension;  ///< of the default output, ".html"; empty: a folder
  std::string_view text;       ///< one line for --help
  /// Writes the file (or several beside it: one a floor). Throws base::FileError. Same map, same bytes.
  void (*write)(const map::MapView& view, const std::filesystem::path& path);
  /// Writes people's space beside it (the social level of 002); null: the format has no place for it.
  void (*writeSocial)(const map::MapView& view, const std::filesystem::path& path) = nullptr;
};

std::span<const Exporter> exporters();
/// Null where there is no such format.
const Exporter* findExporter(std::string_view format);

}  // namespace prodomos::exporter
