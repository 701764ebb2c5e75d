// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_outline.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace prodomos::perception {

namespace {

using sensors::DepthGrid;

constexpr std::size_t kLeastPoints = 24;  // of an outline
constexpr double kLeastShare = 0.2;       // of these, that belong to treads, and to risers
constexpr double kBand = 0.18;            // metres that steps stand out of their slope, both sides together
constexpr double kBin = 0.03;             // metres
constexpr double kLeastLength = 0.7;      // metres along the slope: three steps
constexpr double kStraight = 0.016;       // metres that a rail's edge deviates from its slope
constexpr int kMostOutlines = 3;          // of a side: there may be rails over the steps
constexpr double kGap = 0.25;             // metres along the slope
constexpr std::array kSlopes = {0.36, 0.44, 0.52, 0.60, 0.68, 0.76, 0.86, 0.98};  // rise over run, 20 to 45 degrees

Eigen::Vector3d rayOf(const DepthGrid::Cell& cell) {
  return {static_cast<double>(cell.rayX), static_cast<double>(cell.rayY), 1.0};
}

/// Calls use(index, x, y, dx, dy) for each of the cell's neighbours.
template <typename Use>
void eachNeighbour(const DepthGrid& grid, std::uint32_t cell, const Use& use) {
  const int x = static_cast<int>(cell) % grid.width();
  const int y = static_cast<int>(cell) / grid.width();
  for (const auto& [dx, dy] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
    if (x + dx < 0 || y + dy < 0 || x + dx >= grid.width() || y + dy >= grid.height()) continue;
    const int next = (y + dy) * grid.width() + x + dx;
    use(static_cast<std::size_t>(next), x, y, dx, dy);
  }
}

/// The height above a slope in whose band most points lie, and how many.
std::pair<double, int> fullestBand(const Outline& outline) {
  constexpr std::size_t kBins = 400;
  constexpr auto kWindow = static_cast<std::size_t>(kBand / kBin);
  std::array<int, kBins> counts{};
  double least = std::numeric_limits<double>::infinity();
  for (const EdgePoint& p : outline.points) least = std::min(least, outline.above(p));
  for (const EdgePoint& p : outline.points) {
    const auto bin = static_cast<std::size_t>((outline.above(p) - least) / kBin);
    if (bin < kBins) ++counts[bin];
  }
  std::pair<double, int> best{0.0, 0};
  int sum = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sum += counts[bin] - (bin >= kWindow ? counts[bin - kWindow] : 0);
    if (sum > best.second) best = {least + kBin * static_cast<double>(bin + 1) - 0.5 * kBand, sum};
  }
  return best;
}

/// The longest part without a gap.
void keepLongestPart(Outline& outline) {
  auto& points = outline.points;
  std::ranges::sort(points, {}, [&](const EdgePoint& p) { return outline.along(p); });
  auto bestBegin = points.begin();
  auto bestEnd = points.begin();
  auto first = points.begin();
  for (auto next = points.begin(); next != points.end(); ++next) {
    if (next != first && outline.along(*next) - outline.along(*std::prev(next)) > kGap) first = next;
    if (next + 1 - first <= bestEnd - bestBegin) continue;
    bestBegin = first;
    bestEnd = next + 1;
  }
  points = {bestBegin, bestEnd};
}

/// What may be treads and risers, places turned so that x is uphill.
std::vector<EdgePoint> possibleSteps(const std::vector<EdgePoint>& edge, int uphill) {
  std::vector<EdgePoint> points;
  for (const EdgePoint& p : edge) {
    if (p.past != uphill) points.push_back({{uphill * p.place.x(), p.place.y()}, p.sigma, p.past});
  }
  return points;
}

/// Takes from the points those along the slope that most of them lie along.
Outline takeOutline(std::vector<EdgePoint>& points) {
  Outline outline{0.0, std::move(points)};
  std::pair<double, int> best;
  double bestRise = 0.0;
  for (const double rise : kSlopes) {
    outline.rise = rise;
    const auto band = fullestBand(outline);
    if (band.second <= best.second) continue;
    best = band;
    bestRise = rise;
  }
  outline.rise = bestRise;
  const auto others = std::partition(outline.points.begin(), outline.points.end(), [&](const EdgePoint& p) {
    return std::abs(outline.above(p) - best.first) <= 0.5 * kBand;
  });
  points.assign(others, outline.points.end());
  outline.points.erase(others, outline.points.end());
  keepLongestPart(outline);
  return outline;
}

/// Long enough, and neither straight as a rail nor without treads or risers.
bool isSawtooth(const Outline& outline) {
  const auto& points = outline.points;
  if (points.size() < kLeastPoints) return false;
  if (outline.along(points.back()) - outline.along(points.front()) < kLeastLength) return false;
  const auto count = static_cast<double>(points.size());
  const auto treads = static_cast<double>(std::ranges::count(points, 0, &EdgePoint::past));
  if (std::min(treads, count - treads) < kLeastShare * count) return false;
  double sum = 0.0;
  double squares = 0.0;
  for (const EdgePoint& p : points) {
    sum += outline.above(p);
    squares += square(outline.above(p));
  }
  return squares / count - square(sum / count) > square(kStraight);
}

}  // namespace

/// Where the ray meets the plane.
Eigen::Vector2d Side::placeOf(const Eigen::Vector3d& ray) const {
  const Eigen::Vector3d point_in_camera = plane_in_camera_.offset / plane_in_camera_.normal.dot(ray) * ray;
  const Eigen::Vector3d off = T_camera_submap_.linear().transpose() * (point_in_camera - T_camera_submap_ * middle_);
  return {right_.dot(off), off.z()};
}

Side::Shown Side::at(int u, int v, const Eigen::Vector3d& ray) const {
  const auto depth = static_cast<double>(depth_(u, v));
  if (!(depth > 0.0)) return Shown::kPast;
  const double before = plane_in_camera_.signedDistance(depth * ray);
  const double slant = std::abs(plane_in_camera_.normal.dot(ray));
  constexpr double kOnPlane = 0.02;  // metres, but for noise
  const double tolerance = kOnPlane + 2.5 * slant * sensors::depthSigma(depth);
  if (before > tolerance) return Shown::kNothing;
  return before < -tolerance ? Shown::kPast : Shown::kSide;
}

std::vector<EdgePoint> Side::edge() const {
  constexpr int kBlock = DepthGrid::kBlock;
  constexpr int kFringe = 2;  // cells that normals leave out along edges
  std::vector<std::uint32_t> cells = patch_.cells;
  std::vector<char> isOfSide(static_cast<std::size_t>(grid_.width()) * static_cast<std::size_t>(grid_.height()), 0);
  for (const std::uint32_t cell : cells) isOfSide[cell] = 1;
  std::size_t first = 0;
  for (int ring = 0; ring < kFringe; ++ring) {
    const std::size_t end = cells.size();
    for (; first < end; ++first) {
      eachNeighbour(grid_, cells[first], [&](std::size_t next, int x, int y, int dx, int dy) {
        const DepthGrid::Cell& cell = grid_.at(x + dx, y + dy);
        if (isOfSide[next] != 0 || isTurnedAway(cell)) return;
        const int u = (x + dx) * kBlock + kBlock / 2;
        const int v = (y + dy) * kBlock + kBlock / 2;
        if (at(u, v, rayOf(cell)) != Shown::kSide) return;
        isOfSide[next] = 1;
        cells.push_back(static_cast<std::uint32_t>(next));
      });
    }
  }
  std::vector<EdgePoint> points;
  for (const std::uint32_t cell : cells) {
    eachNeighbour(grid_, cell, [&](std::size_t next, int x, int y, int dx, int dy) {
      if (isOfSide[next] == 0) addEdge(x, y, dx, dy, points);
    });
  }
  return points;
}

/// From the cell's centre to its neighbour's, pixel by pixel.
void Side::addEdge(int x, int y, int dx, int dy, std::vector<EdgePoint>& points) const {
  constexpr int kBlock = DepthGrid::kBlock;
  const Eigen::Vector3d here = rayOf(grid_.at(x, y));
  const Eigen::Vector3d next = rayOf(grid_.at(x + dx, y + dy));
  const auto shownAt = [&](int pixels) {
    return at(x * kBlock + kBlock / 2 + pixels * dx, y * kBlock + kBlock / 2 + pixels * dy,
              here + (next - here) * pixels / kBlock);
  };
  if (shownAt(kBlock) != Shown::kPast) return;
  const Eigen::Vector2d out = placeOf(next) - placeOf(here);
  const bool isAbove = std::abs(out.y()) > std::abs(out.x());
  if (isAbove && out.y() < 0.0) return;
  int pixels = 1;
  while (shownAt(pixels) == Shown::kSide) ++pixels;
  points.push_back({placeOf(here + (next - here) * (pixels - 0.5) / kBlock), 0.5 * out.norm() / kBlock,
                    isAbove         ? 0
                    : out.x() > 0.0 ? 1
                                    : -1});
}

Side::Shown Side::at(const Eigen::Vector3d& spot) const {
  const Eigen::Vector3d spot_in_camera = T_camera_submap_ * spot;
  if (!(spot_in_camera.z() > 0.05)) return Shown::kNothing;
  const Eigen::Vector3d ray = spot_in_camera / spot_in_camera.z();
  const Eigen::Vector2d pixel = grid_.camera().pixel(ray.head<2>());
  if (!(pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < depth_.width() - 0.5 &&
        pixel.y() < depth_.height() - 0.5)) {
    return Shown::kNothing;
  }
  return at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())), ray);
}

Eigen::Vector2d Outline::middle() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const EdgePoint& p : points) sum += p.place;
  return sum / static_cast<double>(points.size());
}

std::vector<Outline> findSawtooths(const std::vector<EdgePoint>& edge, int uphill) {
  std::vector<Outline> found;
  auto points = possibleSteps(edge, uphill);
  for (int i = 0; i < kMostOutlines && points.size() >= kLeastPoints; ++i) {
    Outline outline = takeOutline(points);
    if (isSawtooth(outline)) found.push_back(std::move(outline));
  }
  return found;
}

}  // namespace prodomos::perception
