// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/map_view.hpp"

#include <filesystem>

/// The writers of all formats, named in the table of exporters.cpp. Each throws base::FileError where it cannot write.
namespace prodomos::exporter {

using Path = std::filesystem::path;

void writeHtml(const map::MapView& view, const Path& path);
void writeSvg(const map::MapView& view, const Path& path);
void writePng(const map::MapView& view, const Path& path);
void writeGraphml(const map::MapView& view, const Path& path);
void writeDot(const map::MapView& view, const Path& path);
void writeJson(const map::MapView& view, const Path& path);
void writeGeojson(const map::MapView& view, const Path& path);
void writeNav2(const map::MapView& view, const Path& path);
/// People's space as a cost, beside what writeNav2() writes.
void writeNav2Social(const map::MapView& view, const Path& path);
void writeG2o(const map::MapView& view, const Path& path);
void writePly(const map::MapView& view, const Path& path);
void writeScene3d(const map::MapView& view, const Path& path);
void writeSimplemap(const map::MapView& view, const Path& path);
void writeTopomap(const map::MapView& view, const Path& path);

}  // namespace prodomos::exporter
