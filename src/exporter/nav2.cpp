// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/map/fused_grid.hpp"

#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/social.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <cmath>
#include <optional>
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

/// `greyOf` a cell; the first row is the northernmost.
template <typename GreyOf>
std::string pgm(const geometry::CellBox& box, const GreyOf& greyOf) {
  std::string bytes = "P5\n" + std::to_string(box.width()) + ' ' + std::to_string(box.height()) + "\n255\n";
  for (int y = box.last.y; y >= box.first.y; --y) {
    for (int x = box.first.x; x <= box.last.x; ++x) bytes += greyOf(geometry::CellIndex{x, y});
  }
  return bytes;
}

/// How pixels are read.
struct Scale {
  const char* mode;
  const char* occupied;
  const char* free;
};
constexpr Scale kStates{"trinary", "0.65", "0.196"};
constexpr Scale kCosts{"scale", "1.0", "0.0"};  // 255 is 0, 0 is 100

std::string yaml(double resolution, const geometry::CellBox& box, const std::string& image, const Scale& scale) {
  return "image: " + inQuotes(image) + "\nmode: " + scale.mode + "\nresolution: " + brief(resolution) + "\norigin: [" +
         fixed(box.first.x * resolution) + ", " + fixed(box.first.y * resolution) +
         ", 0.0]\nnegate: 0\noccupied_thresh: " + scale.occupied + "\nfree_thresh: " + scale.free + "\n";
}

/// "out/map" of "out/map.yaml"; a dot that starts no extension of ours belongs to the name.
Path stemOf(Path path) {
  const auto extension = path.extension();
  return extension == ".yaml" || extension == ".yml" || extension == ".pgm" ? path.replace_extension() : path;
}

Path withSuffix(Path path, const std::string& suffix) {
  return path += suffix;
}

/// Of those with a known cell: `write(floor, grid, stem of its files)`. False: there is none.
template <typename Write>
bool forEachFloor(const map::MapView& view, const Path& path, const Write& write) {
  const auto floors = floorsOf(view);
  bool written = false;
  for (const auto floor : floors) {
    const auto grid = map::fuseGrids(view, floor);
    if (grid.knownBox().empty()) continue;
    write(floor, grid, floors.size() == 1 ? stemOf(path) : withSuffix(stemOf(path), "_floor" + std::to_string(*floor)));
    written = true;
  }
  return written;
}

}  // namespace

void writeNav2(const map::MapView& view, const Path& path) {
  if (!forEachFloor(view, path, [](std::optional<int>, const map::OccupancyGrid& grid, const Path& stem) {
        const auto box = grid.knownBox();
        const auto image = withSuffix(stem, ".pgm");
        writeFile(image, pgm(box, [&grid](auto cell) { return grey(grid.state(cell)); }));
        writeFile(withSuffix(stem, ".yaml"), yaml(grid.resolution(), box, image.filename().string(), kStates));
      })) {
    throw base::FileError(base::expectedFound(path.string(), "a map with cells to write", "none"));
  }
}

void writeNav2Social(const map::MapView& view, const Path& path) {
  forEachFloor(view, path, [&view](std::optional<int> floor, const map::OccupancyGrid& grid, const Path& stem) {
    const auto costs = socialCosts(view, floor, grid);
    const auto greyOf = [&costs](auto cell) {
      return static_cast<char>(std::lround(255.0F * (1.0F - costs.at(cell))));
    };
    const auto image = withSuffix(stem, "_social.pgm");
    writeFile(image, pgm(costs.box(), greyOf));
    writeFile(withSuffix(stem, "_social.yaml"),
              yaml(grid.resolution(), costs.box(), image.filename().string(), kCosts));
  });
}

}  // namespace prodomos::exporter
