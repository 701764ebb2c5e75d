// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::localization {

namespace {

constexpr double kSoftness = 1.5;  // cells; standard deviation of the likelihood around a surface
constexpr int kSoftCells = 3;      // beyond it there is nothing

/// The points under one direction of the body, as offsets in cells from wherever the body is.
using TurnedPoints = std::vector<geometry::CellIndex>;

/// A square of poses of one direction: 2^level by 2^level cells from (x, y) on.
struct Branch {
  int direction = 0;
  int x = 0;
  int y = 0;
  int bound = 0;  // sum of likelihoods that no pose of it exceeds
};

class Search {
 public:
  Search(std::span<const Eigen::Vector2d> points, const LikelihoodField& field, const SearchWindow& window,
         const std::optional<geometry::Pose2>& apart, double margin)
      : points_(points), field_(field), window_(window), apart_(apart), margin_(margin) {
    double farthest = 1.0;
    for (const auto& point : points) farthest = std::max(farthest, point.norm());
    // The farthest point then moves by a cell from one direction to the next.
    const double step = field.resolution() / farthest;
    directions_ = static_cast<int>(std::ceil(window.turn / step));
    step_ = directions_ > 0 ? window.turn / directions_ : 0.0;
    centre_ = geometry::cellAt(window.centre.x, window.centre.y, field.resolution());
    reach_ = static_cast<int>(std::ceil(window.reach / field.resolution()));
    for (int i = -directions_; i <= directions_; ++i) turned_.push_back(turn(window.centre.theta + i * step_));
  }

  std::optional<FoundPose> run(double leastScore) {
    if (points_.empty()) return std::nullopt;
    const double most = LikelihoodField::kMost * static_cast<double>(points_.size());
    constexpr double kRounding = 1e-6;  // a score that was found must be found again
    best_.bound = static_cast<int>(std::ceil(leastScore * most - kRounding)) - 1;
    int level = field_.levels() - 1;
    while (level > 0 && (1 << level) > 2 * reach_ + 1) --level;
    std::vector<Branch> roots;
    for (int direction = 0; direction < static_cast<int>(turned_.size()); ++direction) {
      for (int y = -reach_; y <= reach_; y += 1 << level) {
        for (int x = -reach_; x <= reach_; x += 1 << level) roots.push_back(bounded({direction, x, y, 0}, level));
      }
    }
    explore(std::move(roots), level);
    if (!found_) return std::nullopt;
    return FoundPose{poseOf(best_), best_.bound / most};
  }

 private:
  TurnedPoints turn(double theta) const {
    TurnedPoints turned;
    turned.reserve(points_.size());
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    // Offsets are rounded from the middle of the cell that the body is in.
    const double half = 0.5 * field_.resolution();
    for (const auto& point : points_) {
      turned.push_back(geometry::cellAt(half + c * point.x() - s * point.y(), half + s * point.x() + c * point.y(),
                                        field_.resolution()));
    }
    return turned;
  }

  geometry::Pose2 poseOf(const Branch& leaf) const {
    return {geometry::cellCentre(centre_.x + leaf.x, field_.resolution()),
            geometry::cellCentre(centre_.y + leaf.y, field_.resolution()),
            geometry::normalizeAngle(window_.centre.theta + (leaf.direction - directions_) * step_)};
  }

  Branch bounded(Branch branch, int level) const {
    for (const auto& offset : turned_[static_cast<std::size_t>(branch.direction)]) {
      branch.bound += field_.at(level, centre_.x + branch.x + offset.x, centre_.y + branch.y + offset.y);
    }
    return branch;
  }

  bool isLeftOut(const Branch& leaf) const {
    if (!apart_) return false;
    const auto pose = poseOf(leaf);
    return std::hypot(pose.x - apart_->x, pose.y - apart_->y) < margin_ &&
           std::abs(geometry::normalizeAngle(pose.theta - apart_->theta)) < margin_;
  }

  void explore(std::vector<Branch> branches, int level) {
    // Stable: of equal ones the first counts, whatever the library's sort does.
    std::ranges::stable_sort(branches, std::ranges::greater{}, &Branch::bound);
    for (const auto& branch : branches) {
      if (branch.bound <= best_.bound) return;
      if (level == 0) {
        if (isLeftOut(branch)) continue;
        best_ = branch;
        found_ = true;
        return;
      }
      const int half = 1 << (level - 1);
      std::vector<Branch> parts;
      for (const int y : {branch.y, branch.y + half}) {
        for (const int x : {branch.x, branch.x + half}) {
          if (x <= reach_ && y <= reach_) parts.push_back(bounded({branch.direction, x, y, 0}, level - 1));
        }
      }
      explore(std::move(parts), level - 1);
    }
  }

  std::span<const Eigen::Vector2d> points_;
  const LikelihoodField& field_;
  const SearchWindow& window_;
  const std::optional<geometry::Pose2>& apart_;
  double margin_;
  int directions_ = 0;  // to each side
  double step_ = 0.0;
  geometry::CellIndex centre_;
  int reach_ = 0;
  std::vector<TurnedPoints> turned_;
  Branch best_;
  bool found_ = false;
};

}  // namespace

LikelihoodField::LikelihoodField(const map::SurfaceLayer& surface, double resolution, int levels)
    : resolution_(resolution) {
  Raster finest;
  for (const auto& point : surface.points()) {
    const auto cell = geometry::cellAt(point.x, point.y, resolution);
    finest.box.add({cell.x - kSoftCells, cell.y - kSoftCells});
    finest.box.add({cell.x + kSoftCells, cell.y + kSoftCells});
  }
  if (!finest.box.empty()) {
    finest.values.assign(static_cast<std::size_t>(finest.box.width()) * static_cast<std::size_t>(finest.box.height()),
                         0);
  }
  for (const auto& point : surface.points()) {
    const auto cell = geometry::cellAt(point.x, point.y, resolution);
    for (int dy = -kSoftCells; dy <= kSoftCells; ++dy) {
      for (int dx = -kSoftCells; dx <= kSoftCells; ++dx) {
        const double squared = (dx * dx + dy * dy) / (kSoftness * kSoftness);
        const auto value = static_cast<std::uint8_t>(std::lround(kMost * std::exp(-0.5 * squared)));
        auto& there = finest.values[static_cast<std::size_t>(cell.y + dy - finest.box.first.y) *
                                        static_cast<std::size_t>(finest.box.width()) +
                                    static_cast<std::size_t>(cell.x + dx - finest.box.first.x)];
        there = std::max(there, value);
      }
    }
  }
  levels_.push_back(std::move(finest));
  for (int level = 1; level < levels; ++level) levels_.push_back(coarser(levels_.back(), 1 << (level - 1)));
}

/// Each value becomes the greatest of itself and those `width` cells to the right, up, and both.
LikelihoodField::Raster LikelihoodField::coarser(const Raster& finer, int width) {
  Raster raster;
  if (finer.box.empty()) return raster;
  raster.box = {{finer.box.first.x - width, finer.box.first.y - width}, finer.box.last};
  raster.values.resize(static_cast<std::size_t>(raster.box.width()) * static_cast<std::size_t>(raster.box.height()));
  const auto at = [&](int x, int y) -> std::uint8_t {
    if (!finer.box.contains({x, y})) return 0;
    return finer.values[static_cast<std::size_t>(y - finer.box.first.y) * static_cast<std::size_t>(finer.box.width()) +
                        static_cast<std::size_t>(x - finer.box.first.x)];
  };
  auto value = raster.values.begin();
  for (int y = raster.box.first.y; y <= raster.box.last.y; ++y) {
    for (int x = raster.box.first.x; x <= raster.box.last.x; ++x) {
      *value++ = std::max({at(x, y), at(x + width, y), at(x, y + width), at(x + width, y + width)});
    }
  }
  return raster;
}

std::optional<FoundPose> searchPose(std::span<const Eigen::Vector2d> points_in_body, const LikelihoodField& field,
                                    const SearchWindow& window, double leastScore,
                                    const std::optional<geometry::Pose2>& apart, double margin) {
  return Search(points_in_body, field, window, apart, margin).run(leastScore);
}

}  // namespace prodomos::localization
