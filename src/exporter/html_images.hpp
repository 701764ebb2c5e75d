// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/fused_grid.hpp"
#include "prodomos/map/map_view.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The pictures that lie within the web page.
namespace prodomos::exporter {

/// A picture of a rectangle of a plane.
struct PlacedImage {
  std::string png;         ///< the bytes of the file
  Eigen::Vector2d corner;  ///< the least x and y, metres
  Eigen::Vector2d size;    ///< along x and y, metres
  double pixel = 0.0;      ///< edge length of one, metres
};

/// What the sixteen colours of plans and thumbnails stand for. The page sets the colours themselves (palette.js).
enum PlanIndex : std::uint8_t { kUnknown, kWall, kFaintWall, kFaintFree, kFreeWithoutPlace, kFreeOfFirstPlace };
constexpr int kPlaceHues = 11;  ///< then they repeat

/// Where cells of one floor belong to: from the origins of the sub-maps over free cells, not through doors.
struct PlaceSeed {
  Eigen::Vector2d position_in_map;
  int place = 0;
};
struct DoorSegment {
  Eigen::Vector2d begin_in_map;
  Eigen::Vector2d end_in_map;
};

/// y up; one for each limit of `mostPixels`, coarser than the grid where that has more cells. Empty where nothing is
/// known.
std::vector<PlacedImage> planImages(const map::OccupancyGrid& grid, const std::vector<PlaceSeed>& seeds,
                                    const std::vector<DoorSegment>& doors, const std::vector<std::size_t>& mostPixels);

/// A sub-map's own grid, x up and y to the left, at most `mostPixels` wide and high.
std::optional<PlacedImage> thumbnailImage(const map::OccupancyGrid& grid, int mostPixels);

/// Collects what layers draw, seen from above, in tiles: memory grows with the area covered.
class TopView {
 public:
  explicit TopView(double resolution) : resolution_(resolution) {}

  /// Of two things in one pixel the higher stays, up to the height of a door: ceilings hide nothing.
  void add(const map::Drawing& drawing, const geometry::Pose3& T_map_submap);
  bool empty() const { return tiles_.empty(); }
  /// y up; each pixel is the mean over `coarser` x `coarser` of those collected.
  PlacedImage image(int coarser) const;

 private:
  static constexpr int kTileCells = 256;
  static constexpr std::size_t kPixelsOfTile = std::size_t{kTileCells} * kTileCells;
  struct Tile {
    std::vector<map::Rgba> colors = std::vector<map::Rgba>(kPixelsOfTile, map::Rgba{0, 0, 0, 0});
    std::vector<float> heights = std::vector<float>(kPixelsOfTile, -std::numeric_limits<float>::infinity());
  };
  void set(const Eigen::Vector3d& position_in_map, double heightAboveFloor, map::Rgba color);

  double resolution_;
  std::map<geometry::CellIndex, Tile> tiles_;
};

std::string base64(std::string_view bytes);

}  // namespace prodomos::exporter
