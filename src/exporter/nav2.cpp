// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/map/fused_grid.hpp"

#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <string>

namespace prodomos::exporter {
namespace {

// Explorers take exactly these three; grey values break them. With free_thresh 0.196, unknown (205 = 0.19608 occupied)
// does not turn free.
char grey(map::CellState state) {
  switch (state) {
    case map::CellState::kFree:
      return static_cast<char>(254);
    case map::CellState::kOccupied:
      return static_cast<char>(0);
    case map::CellState::kUnknown:
      break;
  }
  return static_cast<char>(205);
}

std::string pgm(const map::OccupancyGrid& grid, const geometry::CellBox& box) {
  std::string bytes = "P5\n" + std::to_string(box.width()) + ' ' + std::to_string(box.height()) + "\n255\n";
  for (int y = box.last.y; y >= box.first.y; --y) {
    for (int x = box.first.x; x <= box.last.x; ++x) bytes += grey(grid.state({x, y}));
  }
  return bytes;
}

std::string yaml(const map::OccupancyGrid& grid, const geometry::CellBox& box, const std::string& image) {
  const double resolution = grid.resolution();
  return "image: " + inQuotes(image) + "\nmode: trinary\nresolution: " + brief(resolution) + "\norigin: [" +
         fixed(box.first.x * resolution) + ", " + fixed(box.first.y * resolution) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

/// "out/map" of "out/map.yaml"; a dot that starts no extension of ours belongs to the name.
Path stemOf(Path path) {
  const auto extension = path.extension();
  return extension == ".yaml" || extension == ".yml" || extension == ".pgm" ? path.replace_extension() : path;
}

Path withSuffix(Path path, const std::string& suffix) {
  return path += suffix;
}

}  // namespace

void writeNav2(const map::MapView& view, const Path& path) {
  const auto floors = floorsOf(view);
  bool written = false;
  for (const auto floor : floors) {
    const auto grid = map::fuseGrids(view, floor);
    const auto box = grid.knownBox();
    if (box.empty()) continue;
    const auto stem = floors.size() == 1 ? stemOf(path) : withSuffix(stemOf(path), "_floor" + std::to_string(*floor));
    const auto image = withSuffix(stem, ".pgm");
    writeFile(image, pgm(grid, box));
    writeFile(withSuffix(stem, ".yaml"), yaml(grid, box, image.filename().string()));
    written = true;
  }
  if (!written) throw base::FileError(base::expectedFound(path.string(), "a map with cells to write", "none"));
}

}  // namespace prodomos::exporter
