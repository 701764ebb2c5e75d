// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/html_images.hpp"

#include "exporter/png_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <vector>

namespace prodomos::exporter {
namespace {

using geometry::CellBox;
using geometry::CellIndex;

constexpr double kCeilingHeight = 2.0;  // metres above the floor of the sub-map
constexpr double kSureNats = 0.8;       // log-odds: more than one beam

/// Colours for programs that show the pictures as they are; the page sets its own.
Palette plainPalette() {
  Palette palette;
  palette.fill({255, 255, 255, 255});
  palette[kUnknown] = {232, 236, 240, 255};
  palette[kWall] = {44, 53, 66, 255};
  palette[kFaintWall] = {136, 147, 161, 255};
  palette[kFaintFree] = {245, 247, 249, 255};
  return palette;
}

PlanIndex planIndex(map::OccupancyGrid::Cell cell) {
  constexpr auto kSure = static_cast<int>(kSureNats * map::OccupancyGrid::kUnitsPerNat);
  switch (map::OccupancyGrid::stateOf(cell)) {
    case map::CellState::kOccupied:
      return cell >= kSure ? kWall : kFaintWall;
    case map::CellState::kFree:
      return cell <= -kSure ? kFreeWithoutPlace : kFaintFree;
    case map::CellState::kUnknown:
      break;
  }
  return kUnknown;
}

/// Which of two cells a coarser pixel shows: walls must not vanish.
int weight(std::uint8_t index) {
  if (index == kWall) return 4;
  if (index == kFaintWall) return 3;
  if (index >= kFreeWithoutPlace) return 2;
  return index == kFaintFree ? 1 : 0;
}

/// The known cells as indices, row 0 at the smallest y.
sensors::Image<std::uint8_t> indicesOf(const map::OccupancyGrid& grid, const CellBox& box) {
  sensors::Image<std::uint8_t> indices(box.width(), box.height());
  for (int y = 0; y < box.height(); ++y) {
    auto* row = indices.row(y);
    for (int x = 0; x < box.width(); ++x) row[x] = planIndex(grid.cell({box.first.x + x, box.first.y + y}));
  }
  return indices;
}

/// Cells that a door closes. Half a cell apart, so that no path over cell edges slips through.
std::vector<bool> closedCells(const CellBox& box, double resolution, const std::vector<DoorSegment>& doors) {
  std::vector<bool> closed(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
  for (const auto& door : doors) {
    const Eigen::Vector2d along = door.end_in_map - door.begin_in_map;
    const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * along.norm() / resolution)));
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d point = door.begin_in_map + along * i / steps;
      const CellIndex cell = geometry::cellAt(point.x(), point.y(), resolution);
      if (!box.contains(cell)) continue;
      closed[static_cast<std::size_t>(cell.y - box.first.y) * static_cast<std::size_t>(box.width()) +
             static_cast<std::size_t>(cell.x - box.first.x)] = true;
    }
  }
  return closed;
}

/// Cells beside a wall: where the laser grazed one, there are holes in it that no robot and no place passes.
std::vector<bool> cellsBesideWalls(const sensors::Image<std::uint8_t>& indices) {
  std::vector<bool> beside(indices.size());
  for (int y = 1; y + 1 < indices.height(); ++y) {
    for (int x = 1; x + 1 < indices.width(); ++x) {
      if (weight(indices(x, y)) < 3) continue;
      for (int i = 0; i < 9; ++i) {
        const int cell = (y + i / 3 - 1) * indices.width() + x + i % 3 - 1;
        beside[static_cast<std::size_t>(cell)] = true;
      }
    }
  }
  return beside;
}

/// Free cells take the place of the seed that is nearest over free cells; those beside walls come last.
void spreadPlaces(sensors::Image<std::uint8_t>& indices, const CellBox& box, double resolution,
                  const std::vector<PlaceSeed>& seeds, const std::vector<DoorSegment>& doors) {
  const auto closed = closedCells(box, resolution, doors);
  const auto besideWall = cellsBesideWalls(indices);
  std::vector<bool> visited(closed.size());
  std::deque<std::pair<CellIndex, std::uint8_t>> front;
  std::deque<std::pair<CellIndex, std::uint8_t>> later;
  const auto visit = [&](CellIndex cell, std::uint8_t color, bool mayWait) {
    if (cell.x < 0 || cell.y < 0 || cell.x >= box.width() || cell.y >= box.height()) return;
    const auto at =
        static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(box.width()) + static_cast<std::size_t>(cell.x);
    auto& index = indices.data()[at];
    if (visited[at] || closed[at] || weight(index) == 0 || weight(index) > 2) return;
    if (mayWait && besideWall[at]) {
      later.emplace_back(cell, color);
      return;
    }
    visited[at] = true;
    if (index == kFreeWithoutPlace) index = color;
    front.emplace_back(cell, color);
  };
  const auto spread = [&](bool mayWait) {
    while (!front.empty()) {
      const auto [cell, color] = front.front();
      front.pop_front();
      visit({cell.x + 1, cell.y}, color, mayWait);
      visit({cell.x - 1, cell.y}, color, mayWait);
      visit({cell.x, cell.y + 1}, color, mayWait);
      visit({cell.x, cell.y - 1}, color, mayWait);
    }
  };
  for (const auto& seed : seeds) {
    const CellIndex cell = geometry::cellAt(seed.position_in_map.x(), seed.position_in_map.y(), resolution);
    const int hue = ((seed.place % kPlaceHues) + kPlaceHues) % kPlaceHues;
    visit({cell.x - box.first.x, cell.y - box.first.y}, static_cast<std::uint8_t>(kFreeOfFirstPlace + hue), false);
  }
  spread(true);
  for (const auto& [cell, color] : later) visit(cell, color, false);
  spread(false);
}

/// One pixel for factor x factor cells.
sensors::Image<std::uint8_t> coarser(const sensors::Image<std::uint8_t>& indices, int factor) {
  sensors::Image<std::uint8_t> out((indices.width() + factor - 1) / factor, (indices.height() + factor - 1) / factor);
  for (int y = 0; y < indices.height(); ++y) {
    for (int x = 0; x < indices.width(); ++x) {
      auto& pixel = out(x / factor, y / factor);
      if (weight(indices(x, y)) > weight(pixel)) pixel = indices(x, y);
    }
  }
  return out;
}

/// Row 0 at the greatest y.
template <typename Pixel>
sensors::Image<Pixel> upright(const sensors::Image<Pixel>& image) {
  sensors::Image<Pixel> out(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) std::copy_n(image.row(y), image.width(), out.row(image.height() - 1 - y));
  return out;
}

/// x up, y to the left.
sensors::Image<std::uint8_t> headingUp(const sensors::Image<std::uint8_t>& image) {
  sensors::Image<std::uint8_t> out(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) out(image.height() - 1 - y, image.width() - 1 - x) = image(x, y);
  }
  return out;
}

PlacedImage placed(std::string png, CellIndex first, int width, int height, double resolution, int factor) {
  return {std::move(png), Eigen::Vector2d(first.x, first.y) * resolution, Eigen::Vector2d(width, height) * resolution,
          resolution * factor};
}

}  // namespace

std::vector<PlacedImage> planImages(const map::OccupancyGrid& grid, const std::vector<PlaceSeed>& seeds,
                                    const std::vector<DoorSegment>& doors, const std::vector<std::size_t>& mostPixels) {
  const auto box = grid.knownBox();
  if (box.empty()) return {};
  auto indices = indicesOf(grid, box);
  spreadPlaces(indices, box, grid.resolution(), seeds, doors);
  std::vector<PlacedImage> images;
  for (const auto most : mostPixels) {
    const double excess = static_cast<double>(indices.size()) / static_cast<double>(most);
    const int factor = std::max(1, static_cast<int>(std::ceil(std::sqrt(excess))));
    const auto pixels = factor > 1 ? coarser(indices, factor) : indices;
    // A last pixel that is not full reaches beyond the box.
    images.push_back(placed(encodePng(upright(pixels), plainPalette()), box.first, pixels.width() * factor,
                            pixels.height() * factor, grid.resolution(), factor));
  }
  return images;
}

std::optional<PlacedImage> thumbnailImage(const map::OccupancyGrid& grid, int mostPixels) {
  const auto box = grid.knownBox();
  if (box.empty()) return std::nullopt;
  const int factor = (std::max(box.width(), box.height()) + mostPixels - 1) / mostPixels;
  const auto indices = coarser(indicesOf(grid, box), factor);
  return placed(encodePng(headingUp(indices), plainPalette()), box.first, indices.width() * factor,
                indices.height() * factor, grid.resolution(), factor);
}

void TopView::set(const Eigen::Vector3d& position_in_map, double heightAboveFloor, map::Rgba color) {
  if (!position_in_map.allFinite() || heightAboveFloor > kCeilingHeight || color.a == 0) return;
  const CellIndex cell = geometry::cellAt(position_in_map.x(), position_in_map.y(), resolution_);
  const auto floorDivide = [](int a) { return a >= 0 ? a / kTileCells : -((kTileCells - 1 - a) / kTileCells); };
  const CellIndex key{floorDivide(cell.x), floorDivide(cell.y)};
  auto& tile = tiles_[key];
  const auto at = static_cast<std::size_t>(cell.y - key.y * kTileCells) * kTileCells +
                  static_cast<std::size_t>(cell.x - key.x * kTileCells);
  const auto height = static_cast<float>(heightAboveFloor);
  if (height < tile.heights[at]) return;
  tile.heights[at] = height;
  tile.colors[at] = color;
}

void TopView::add(const map::Drawing& drawing, const geometry::Pose3& T_map_submap) {
  for (const auto& point : drawing.points) {
    const Eigen::Vector3d position = point.position_in_submap.cast<double>();
    set(T_map_submap * position, position.z(), point.color);
  }
  for (const auto& raster : drawing.rasters) {
    // Samples no further apart than half a pixel of ours leave no holes under any rotation.
    const int perPixel = std::max(1, static_cast<int>(std::ceil(2.0 * raster.resolution / resolution_)));
    const double step = raster.resolution / perPixel;
    for (int y = 0; y < raster.pixels.height() * perPixel; ++y) {
      for (int x = 0; x < raster.pixels.width() * perPixel; ++x) {
        const Eigen::Vector2d spot = raster.corner_in_submap + Eigen::Vector2d(x + 0.5, y + 0.5) * step;
        set(T_map_submap * Eigen::Vector3d(spot.x(), spot.y(), 0.0), 0.0, raster.pixels(x / perPixel, y / perPixel));
      }
    }
  }
}

PlacedImage TopView::image(int coarserBy) const {
  CellBox tiles;
  for (const auto& [key, tile] : tiles_) tiles.add(key);
  const int width = tiles.width() * kTileCells / coarserBy;
  const int height = tiles.height() * kTileCells / coarserBy;
  sensors::Image<map::Rgba> pixels(width, height, map::Rgba{0, 0, 0, 0});
  const int perTile = kTileCells / coarserBy;
  for (const auto& [key, tile] : tiles_) {
    for (int y = 0; y < perTile; ++y) {
      for (int x = 0; x < perTile; ++x) {
        std::array<int, 4> sum{};
        int count = 0;
        for (int i = 0; i < coarserBy * coarserBy; ++i) {
          const int cellX = x * coarserBy + i % coarserBy;
          const int cellY = y * coarserBy + i / coarserBy;
          const auto& color =
              tile.colors[static_cast<std::size_t>(cellY) * kTileCells + static_cast<std::size_t>(cellX)];
          if (color.a == 0) continue;
          sum = {sum[0] + color.r, sum[1] + color.g, sum[2] + color.b, sum[3] + color.a};
          ++count;
        }
        if (count == 0) continue;
        const auto mean = [&](std::size_t i) { return static_cast<std::uint8_t>(sum[i] / count); };
        pixels((key.x - tiles.first.x) * perTile + x, (key.y - tiles.first.y) * perTile + y) = {mean(0), mean(1),
                                                                                                mean(2), mean(3)};
      }
    }
  }
  const CellIndex first{tiles.first.x * kTileCells, tiles.first.y * kTileCells};
  return placed(encodePng(upright(pixels)), first, tiles.width() * kTileCells, tiles.height() * kTileCells, resolution_,
                coarserBy);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t j) { return j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0U; };
    const unsigned group = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += kLetters[group >> shift & 63U];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  for (std::size_t i = 0; i < padding; ++i) text[text.size() - 1 - i] = '=';
  return text;
}

}  // namespace prodomos::exporter
