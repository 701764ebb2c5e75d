// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/free_floor.hpp"

#include "prediction/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

namespace prodomos::prediction {

namespace {

using geometry::CellBox;
using geometry::CellIndex;
using map::CellState;

constexpr double kCell = Surroundings::kCell;

CellIndex cellOf(const Eigen::Vector2d& point_in_here) {
  return geometry::cellAt(point_in_here.x(), point_in_here.y(), kCell);
}

/// Those that a density can claim at any threshold.
CellBox boxAbout(const Eigen::Vector2d& middle_in_here, double reach) {
  const auto& window = Surroundings::kBox;
  const auto low = cellOf(middle_in_here - Eigen::Vector2d::Constant(reach));
  const auto high = cellOf(middle_in_here + Eigen::Vector2d::Constant(reach));
  return {{std::max(low.x, window.first.x), std::max(low.y, window.first.y)},
          {std::min(high.x, window.last.x), std::min(high.y, window.last.y)}};
}

/// Rounded, halves away from zero: the same to both sides.
int ratio(int numerator, int denominator) {
  const int half = numerator < 0 ? -denominator : denominator;
  return (2 * numerator + half) / (2 * denominator);
}

/// Whether the straight line to the cell passes open ones alone, and slips through between no two others.
template <typename IsOpen>
bool isSeen(CellIndex eye, CellIndex cell, const IsOpen& isOpen) {
  const int steps = std::max(std::abs(cell.x - eye.x), std::abs(cell.y - eye.y));
  CellIndex last = eye;
  for (int i = 1; i <= steps; ++i) {
    const CellIndex next{eye.x + ratio((cell.x - eye.x) * i, steps), eye.y + ratio((cell.y - eye.y) * i, steps)};
    if (!isOpen(next)) return false;
    if (next.x != last.x && next.y != last.y && !isOpen({next.x, last.y}) && !isOpen({last.x, next.y})) return false;
    last = next;
  }
  return true;
}

/// What lies ahead of an opening.
class View {
 public:
  View(const Surroundings& around, const Lookout& lookout, const CellBox& reach)
      : around_(around),
        margin_(static_cast<int>(std::lround(lookout.wall / kCell))),
        begin_(static_cast<int>(std::ceil(lookout.wall / kCell - 1e-9))),
        half_(static_cast<int>(std::ceil(lookout.width / 2.0 / kCell - 1e-9))),
        box_{{std::max(reach.first.x, begin_), reach.first.y}, reach.last},
        solid_({{begin_, reach.first.y - margin_}, {reach.last.x + margin_, reach.last.y + margin_}}, 0),
        ownFloor_(box_, 0) {
    findSolid();
    findOwnFloor();
  }

  const CellBox& box() const { return box_; }

  bool isClaimable(CellIndex cell) const {
    return around_.state(cell) == CellState::kUnknown && !isNearSolid(cell) && isInSight(cell);
  }

 private:
  /// Walls, and rooms that are taken.
  void findSolid() {
    const auto& box = solid_.box();
    for (int y = box.first.y; y <= box.last.y; ++y) {
      for (int x = box.first.x; x <= box.last.x; ++x) {
        *solid_.find({x, y}) = around_.state(CellIndex{x, y}) == CellState::kOccupied ? 1 : 0;
      }
    }
    for (const auto& room : around_.taken_here) solid_.fill(room, 1, kCell);
  }

  /// What was seen through the opening while it stood open.
  void findOwnFloor() {
    CellSet free(box_, 0);
    for (int y = box_.first.y; y <= box_.last.y; ++y) {
      for (int x = box_.first.x; x <= box_.last.x; ++x) {
        *free.find({x, y}) = around_.state(CellIndex{x, y}) == CellState::kFree ? 1 : 0;
      }
    }
    for (int y = -half_; y < half_; ++y) {
      for (const auto cell : takePiece(free, {begin_, y})) {
        if (auto* own = ownFloor_.find(cell)) *own = 1;
      }
    }
  }

  bool isNearSolid(CellIndex cell) const {
    for (int y = cell.y - margin_; y <= cell.y + margin_; ++y) {
      for (int x = cell.x - margin_; x <= cell.x + margin_; ++x) {
        if (solid_.at({x, y}) != 0) return true;
      }
    }
    return false;
  }

  /// From the middle of the opening, of its two middle cells from that on the same side.
  bool isInSight(CellIndex cell) const {
    const auto isOpen = [this](CellIndex passed) {
      if (solid_.at(passed) != 0) return false;
      return around_.state(passed) == CellState::kUnknown || ownFloor_.at(passed) != 0;
    };
    const CellIndex eye{begin_, cell.y < 0 ? -1 : 0};
    return isOpen(eye) && isSeen(eye, cell, isOpen);
  }

  const Surroundings& around_;
  int margin_;  // cells
  int begin_;   // the first column beyond the wall
  int half_;    // cells, of the opening's width
  CellBox box_;
  CellSet solid_;
  CellSet ownFloor_;
};

/// Outlines by threshold within a piece.
std::vector<map::PredictedArea> areasWithin(Piece piece, const Claims& claims, double leastArea) {
  std::vector<map::PredictedArea> areas;
  for (const double threshold : kThresholds) {
    CellSet above(claims.box(), 0);
    for (const auto cell : piece) *above.find(cell) = claims.at(cell) > threshold ? 1 : 0;
    const auto pieces = piecesOf(above);
    if (pieces.empty()) break;
    piece = withoutHoles(pieces.front());
    if (static_cast<double>(piece.size()) * kCell * kCell < leastArea) break;
    areas.push_back({threshold, outlineOf(piece, kCell)});
  }
  return areas;
}

}  // namespace

Claims claimsAhead(const Surroundings& around, const Lookout& lookout, const geometry::SkewNormal& density,
                   const geometry::CellMap<float>* room, double leastProbability) {
  const View view(around, lookout, boxAbout(density.centre(), density.reach(kThresholds.front())));
  const auto& box = view.box();
  Claims claims(box, 0.0F);
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const CellIndex cell{x, y};
      if (room != nullptr && room->at(cell) < leastProbability) continue;
      const double relative = density.relativeDensity(geometry::centreOf(cell, kCell));
      if (relative > kThresholds.front() && view.isClaimable(cell)) *claims.find(cell) = static_cast<float>(relative);
    }
  }
  return claims;
}

void addClaimsAbout(const Eigen::Vector2d& position_in_here, const Surroundings& around,
                    const geometry::SkewNormal& density, Claims& claims) {
  const auto isOpen = [&around](CellIndex cell) { return around.state(cell) != CellState::kOccupied; };
  const auto isBesideWall = [&isOpen](CellIndex cell) {
    for (int y = cell.y - 1; y <= cell.y + 1; ++y) {
      for (int x = cell.x - 1; x <= cell.x + 1; ++x) {
        if (!isOpen({x, y})) return true;
      }
    }
    return false;
  };
  const auto box = boxAbout(position_in_here, density.reach(kThresholds.front()));
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      float* claim = claims.find({x, y});
      if (claim == nullptr || around.state(CellIndex{x, y}) != CellState::kUnknown) continue;
      const auto relative = static_cast<float>(density.relativeDensity(geometry::centreOf({x, y}, kCell)));
      if (relative <= *claim || isBesideWall({x, y})) continue;
      if (isSeen(cellOf(position_in_here), {x, y}, isOpen)) *claim = relative;
    }
  }
}

bool isWayFree(const Surroundings& around, const Eigen::Vector2d& from_in_here, const Eigen::Vector2d& to_in_here) {
  return isSeen(cellOf(from_in_here), cellOf(to_in_here),
                [&around](CellIndex cell) { return around.state(cell) != CellState::kOccupied; });
}

std::vector<std::vector<map::PredictedArea>> areasOf(const Claims& claims, double leastArea) {
  CellSet claimed(claims.box(), 0);
  const auto& box = claims.box();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      *claimed.find({x, y}) = claims.at({x, y}) > kThresholds.front() ? 1 : 0;
    }
  }
  std::vector<std::vector<map::PredictedArea>> areas;
  for (auto& piece : piecesOf(claimed)) {
    auto within = areasWithin(std::move(piece), claims, leastArea);
    if (!within.empty()) areas.push_back(std::move(within));
  }
  return areas;
}

}  // namespace prodomos::prediction
