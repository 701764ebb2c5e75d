// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/doorway_lines.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace prodomos::perception::doorways {

namespace {

constexpr double kStraight = 0.96;  // of the way from obstacle to obstacle over the line's middle, the direct one
constexpr double kBefore = 0.5;     // metres from the line, where the space must be wider
constexpr double kWider = 0.1;      // metres
constexpr double kApart = 0.4;      // metres between the middles of two lines

/// How far each cell is from the nearest obstacle, and which one that is.
class Clearance {
 public:
  explicit Clearance(const map::OccupancyGrid& grid) : grid_(grid), box_(grid.knownBox()) {
    cv::Mat open(box_.height(), box_.width(), CV_8U);
    for (int y = 0; y < open.rows; ++y) {
      auto* row = open.ptr<std::uint8_t>(y);
      for (int x = 0; x < open.cols; ++x) row[x] = stateAt({x, y}) == map::CellState::kOccupied ? 0 : 1;
    }
    cv::distanceTransform(open, distance_, labels_, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
    obstacles_.emplace_back();  // labels begin with 1
    for (int y = 0; y < open.rows; ++y) {
      for (int x = 0; x < open.cols; ++x) {
        if (open.at<std::uint8_t>(y, x) != 0) continue;
        const auto label = static_cast<std::size_t>(labels_.at<int>(y, x));
        if (obstacles_.size() <= label) obstacles_.resize(label + 1);
        obstacles_[label] = cv::Point(x, y);
      }
    }
  }

  int width() const { return labels_.cols; }
  int height() const { return labels_.rows; }
  bool isFree(cv::Point cell) const { return stateAt(cell) == map::CellState::kFree; }
  int label(cv::Point cell) const { return labels_.at<int>(cell); }
  cv::Point obstacle(int label) const { return obstacles_[static_cast<std::size_t>(label)]; }
  double cells(cv::Point cell) const { return distance_.at<float>(cell); }
  /// Metres; 0 outside.
  double at(const Eigen::Vector2d& point_in_submap) const {
    const auto index = grid_.cellAt(point_in_submap);
    return box_.contains(index) ? grid_.resolution() * cells({index.x - box_.first.x, index.y - box_.first.y}) : 0.0;
  }
  Eigen::Vector2d inSubmap(cv::Point cell) const {
    return {geometry::cellCentre(box_.first.x + cell.x, grid_.resolution()),
            geometry::cellCentre(box_.first.y + cell.y, grid_.resolution())};
  }

 private:
  map::CellState stateAt(cv::Point cell) const { return grid_.state({box_.first.x + cell.x, box_.first.y + cell.y}); }

  const map::OccupancyGrid& grid_;
  geometry::CellBox box_;
  cv::Mat distance_;
  cv::Mat labels_;
  std::vector<cv::Point> obstacles_;
};

/// Free neighbours that are nearest to different obstacles, one on either side of them.
std::vector<CriticalLine> straightLines(const Clearance& clearance, double leastCells, double mostCells) {
  std::vector<CriticalLine> lines;
  const auto consider = [&](cv::Point cell, cv::Point next) {
    const int label = clearance.label(cell);
    const int nextLabel = clearance.label(next);
    if (label == nextLabel || !clearance.isFree(next)) return;
    const cv::Point left = clearance.obstacle(label);
    const cv::Point right = clearance.obstacle(nextLabel);
    const double width = cv::norm(right - left);
    if (width < leastCells || width > mostCells) return;
    if (width < kStraight * (clearance.cells(cell) + clearance.cells(next))) return;
    lines.push_back({clearance.inSubmap(left), clearance.inSubmap(right)});
  };
  for (int y = 0; y + 1 < clearance.height(); ++y) {
    for (int x = 0; x + 1 < clearance.width(); ++x) {
      if (2.0 * clearance.cells({x, y}) < leastCells - 2.0 || !clearance.isFree({x, y})) continue;
      consider({x, y}, {x + 1, y});
      consider({x, y}, {x, y + 1});
    }
  }
  return lines;
}

bool widens(const Clearance& clearance, const CriticalLine& line) {
  const Eigen::Vector2d along = (line.right - line.left).normalized();
  const Eigen::Vector2d step = kBefore * Eigen::Vector2d(-along.y(), along.x());
  return 2.0 * clearance.at(line.middle() + step) > line.width() + kWider &&
         2.0 * clearance.at(line.middle() - step) > line.width() + kWider;
}

}  // namespace

std::vector<CriticalLine> criticalLines(const map::OccupancyGrid& grid, const DoorwayDetectorConfig& config) {
  if (grid.knownBox().empty()) return {};
  const Clearance clearance(grid);
  auto lines = straightLines(clearance, config.leastWidth / grid.resolution(), config.mostWidth / grid.resolution());
  std::ranges::stable_sort(lines, {}, &CriticalLine::width);
  std::vector<CriticalLine> narrowest;
  for (const auto& line : lines) {
    const bool isNew = std::ranges::none_of(
        narrowest, [&line](const CriticalLine& other) { return (other.middle() - line.middle()).norm() < kApart; });
    if (isNew && widens(clearance, line)) narrowest.push_back(line);
  }
  return narrowest;
}

}  // namespace prodomos::perception::doorways
