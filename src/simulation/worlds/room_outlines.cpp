// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/room_outlines.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr double kCell = 0.05;
constexpr double kLeastArea = 1.5;
constexpr double kLeastRadius = 0.4;  ///< of the largest disc in a room
constexpr double kTolerance = 0.08;   ///< of an outline on the raster against the walls
constexpr double kCornerCut = 0.4;    ///< that closed gaps make of corners between oblique walls, at most
constexpr double kSlit = 2e-4;

using Cell = std::array<int, 2>;
constexpr std::array<Cell, 4> kNeighbours{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Cells of 5 cm; each is wall, not yet seen, or of a region.
class Raster {
 public:
  static constexpr int kWall = -1;
  static constexpr int kUnseen = -2;

  explicit Raster(const Eigen::AlignedBox2d& bounds)
      : origin_(bounds.min() - Eigen::Vector2d::Constant(4.0 * kCell)),
        width_(static_cast<int>(bounds.sizes().x() / kCell) + 9),
        height_(static_cast<int>(bounds.sizes().y() / kCell) + 9),
        cells_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kUnseen) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool holds(const Cell& c) const { return c[0] >= 0 && c[1] >= 0 && c[0] < width_ && c[1] < height_; }
  int& operator[](const Cell& c) { return cells_[index(c)]; }
  int at(const Cell& c) const { return holds(c) ? cells_[index(c)] : kWall; }

  Eigen::Vector2d corner(const Cell& c) const { return origin_ + kCell * Eigen::Vector2d(c[0], c[1]); }
  Eigen::Vector2d centre(const Cell& c) const { return corner(c) + Eigen::Vector2d::Constant(kCell / 2.0); }
  Cell cellAt(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q = (p - origin_) / kCell;
    return {static_cast<int>(std::floor(q.x())), static_cast<int>(std::floor(q.y()))};
  }

  /// Closed against steps along the axes: that is how regions grow.
  void draw(const Segment& segment) {
    const Eigen::Vector2d way = segment.b - segment.a;
    const int steps = static_cast<int>(std::ceil(way.norm() / (kCell / 4.0))) + 1;
    for (int i = 0; i <= steps; ++i) {
      (*this)[cellAt(segment.a + static_cast<double>(i) / static_cast<double>(steps) * way)] = kWall;
    }
  }

  void fill(const Polygon& polygon) {
    Eigen::AlignedBox2d bounds;
    for (const auto& corner : polygon) bounds.extend(corner);
    const Cell least = cellAt(bounds.min());
    const Cell most = cellAt(bounds.max());
    for (int y = least[1]; y <= most[1]; ++y) {
      for (int x = least[0]; x <= most[0]; ++x) {
        if (holds({x, y}) && contains(polygon, centre({x, y}))) (*this)[{x, y}] = kWall;
      }
    }
  }

  /// What is at most four cells wide between walls, as the inside of a hollow wall, becomes wall.
  void closeGaps() {
    constexpr int kReach = 2;
    const auto grown = [](const Raster& raster, bool growsWalls) {
      Raster result = raster;
      for (int y = 0; y < raster.height_; ++y) {
        for (int x = 0; x < raster.width_; ++x) {
          if ((raster.at({x, y}) == kWall) == growsWalls) continue;
          if (raster.hasNear({x, y}, kReach, growsWalls)) result[{x, y}] = growsWalls ? kWall : kUnseen;
        }
      }
      return result;
    };
    *this = grown(grown(*this, true), false);
  }

  /// Gives all unseen cells that hang together with this one the region's number; how many they are.
  std::size_t flood(const Cell& start, int region) {
    std::vector<Cell> open{start};
    (*this)[start] = region;
    for (std::size_t next = 0; next < open.size(); ++next) {
      for (const auto& step : kNeighbours) {
        const Cell c{open[next][0] + step[0], open[next][1] + step[1]};
        if (at(c) != kUnseen) continue;
        (*this)[c] = region;
        open.push_back(c);
      }
    }
    return open.size();
  }

 private:
  /// Beyond the raster nothing is wall.
  bool hasNear(const Cell& c, int reach, bool isWall) const {
    for (int y = c[1] - reach; y <= c[1] + reach; ++y) {
      for (int x = c[0] - reach; x <= c[0] + reach; ++x) {
        if ((holds({x, y}) && at({x, y}) == kWall) == isWall) return true;
      }
    }
    return false;
  }

  std::size_t index(const Cell& c) const {
    return static_cast<std::size_t>(c[1]) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(c[0]);
  }

  Eigen::Vector2d origin_;
  int width_;
  int height_;
  std::vector<int> cells_;
};

bool holdsDisc(const Raster& raster, const Cell& middle, int region) {
  constexpr int kReach = static_cast<int>(kLeastRadius / kCell);
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (dx * dx + dy * dy <= kReach * kReach && raster.at({middle[0] + dx, middle[1] + dy}) != region) return false;
    }
  }
  return true;
}

bool holdsDisc(const Raster& raster, int region) {
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      if (raster.at({x, y}) == region && holdsDisc(raster, {x, y}, region)) return true;
    }
  }
  return false;
}

/// Numbers of the regions that are rooms; all others become 0, the outside.
std::vector<int> floodRooms(Raster& raster) {
  raster.flood({0, 0}, 0);
  std::vector<int> rooms;
  int last = 0;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      if (raster.at({x, y}) != Raster::kUnseen) continue;
      const std::size_t cells = raster.flood({x, y}, ++last);
      if (static_cast<double>(cells) * kCell * kCell >= kLeastArea && holdsDisc(raster, last)) rooms.push_back(last);
    }
  }
  return rooms;
}

/// The region's borders along the sides of its cells, the region on their left: the outline first, then the holes.
std::vector<Polygon> bordersOf(const Raster& raster, int region) {
  // Sides by the corner they begin at, each with its direction (an index of kNeighbours).
  std::map<Cell, std::vector<int>> sides;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      if (raster.at({x, y}) != region) continue;
      if (raster.at({x, y - 1}) != region) sides[{x, y}].push_back(0);
      if (raster.at({x + 1, y}) != region) sides[{x + 1, y}].push_back(1);
      if (raster.at({x, y + 1}) != region) sides[{x + 1, y + 1}].push_back(2);
      if (raster.at({x - 1, y}) != region) sides[{x, y + 1}].push_back(3);
    }
  }
  std::vector<Polygon> borders;
  while (!sides.empty()) {
    Polygon border;
    Cell corner = sides.begin()->first;
    int direction = -1;
    for (auto here = sides.begin(); here != sides.end(); here = sides.find(corner)) {
      // Where two cells of the region touch at a corner only, the border turns left and stays with its cell.
      auto& onward = here->second;
      const auto left = std::ranges::find(onward, (direction + 1) % 4);
      const auto taken = direction < 0 || left == onward.end() ? onward.begin() : left;
      if (*taken != direction) border.push_back(raster.corner(corner));
      direction = *taken;
      onward.erase(taken);
      if (onward.empty()) sides.erase(here);
      const auto& step = kNeighbours[static_cast<std::size_t>(direction)];
      corner = {corner[0] + step[0], corner[1] + step[1]};
    }
    borders.push_back(std::move(border));
  }
  std::stable_partition(borders.begin(), borders.end(), [](const Polygon& border) { return signedArea(border) > 0.0; });
  return borders;
}

double distanceToLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const double length = (b - a).norm();
  return length == 0.0 ? (p - a).norm() : std::abs(cross(b - a, p - a)) / length;
}

/// Douglas-Peucker between two corners; the first is kept, the last is left to the next piece.
void simplify(const Polygon& line, std::size_t first, std::size_t last, Polygon& kept) {
  double farthest = 0.0;
  std::size_t split = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance = distanceToLine(line[first], line[last], line[i]);
    if (distance > farthest) std::tie(farthest, split) = std::pair(distance, i);
  }
  if (farthest <= kTolerance) {
    kept.push_back(line[first]);
    return;
  }
  simplify(line, first, split, kept);
  simplify(line, split, last, kept);
}

Polygon simplified(const Polygon& border) {
  const auto farthest = std::ranges::max_element(
      border, {}, [&](const Eigen::Vector2d& corner) { return (corner - border.front()).squaredNorm(); });
  Polygon closed = border;
  closed.push_back(border.front());
  const auto middle = static_cast<std::size_t>(farthest - border.begin());
  Polygon kept;
  simplify(closed, 0, middle, kept);
  simplify(closed, middle, closed.size() - 1, kept);
  return kept;
}

/// A line in the plane: points p with normal · p = offset.
struct Line {
  Eigen::Vector2d normal;
  double offset;
};

/// The face of the wall that an edge on the raster follows: of those a little to its right (or left, where the border
/// was simplified) the one that goes along with it farthest.
std::optional<Line> wallFaceAlong(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::span<const Segment> walls) {
  constexpr double kSameFace = 0.005;
  constexpr double kRight = 2.0 * kCell;
  constexpr double kLeft = kCell;
  const double length = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length;
  const Eigen::Vector2d normal(-along.y(), along.x());
  // Short edges on a raster say little of a wall's direction.
  const double leastCosine = std::cos(std::min(0.05 + kCell / length, 0.4));
  struct Face {
    double overlap;
    Eigen::Vector2d way;
    Eigen::Vector2d point;  ///< on it
  };
  std::vector<Face> faces;
  for (const auto& wall : walls) {
    const Eigen::Vector2d way = wall.b - wall.a;
    if (std::abs(way.dot(along)) < leastCosine * way.norm()) continue;
    const double from = std::max(0.0, std::min((wall.a - a).dot(along), (wall.b - a).dot(along)));
    const double to = std::min(length, std::max((wall.a - a).dot(along), (wall.b - a).dot(along)));
    if (to <= from) continue;
    const double share = ((from + to) / 2.0 - (wall.a - a).dot(along)) / way.dot(along);
    const Eigen::Vector2d point = wall.a + share * way;
    const double offset = normal.dot(point - a);
    if (offset < -kRight || offset > kLeft) continue;
    const Eigen::Vector2d overlap = (to - from) * way.normalized() * (way.dot(along) < 0.0 ? -1.0 : 1.0);
    const auto same = std::ranges::find_if(faces, [&](const Face& face) {
      return std::abs(cross(face.way.normalized(), point - face.point)) < kSameFace;
    });
    if (same == faces.end()) {
      faces.push_back({to - from, overlap, point});
    } else {
      same->overlap += to - from;
      same->way += overlap;
    }
  }
  const auto best = std::ranges::max_element(faces, {}, &Face::overlap);
  if (best == faces.end()) return std::nullopt;
  const Eigen::Vector2d turned(-best->way.normalized().y(), best->way.normalized().x());
  return Line{turned, turned.dot(best->point)};
}

std::optional<Eigen::Vector2d> crossing(const Line& a, const Line& b) {
  const double sine = cross(a.normal, b.normal);
  if (std::abs(sine) < 0.2) return std::nullopt;
  return Eigen::Vector2d(a.offset * b.normal.y() - b.offset * a.normal.y(),
                         b.offset * a.normal.x() - a.offset * b.normal.x()) /
         sine;
}

Polygon withoutRepeats(const Polygon& polygon) {
  constexpr double kSame = 1e-3;
  Polygon kept;
  for (const auto& corner : polygon) {
    if (kept.empty() || (corner - kept.back()).norm() > kSame) kept.push_back(corner);
  }
  while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= kSame) kept.pop_back();
  return kept;
}

/// An edge of a border, and the line it is to lie on.
struct Side {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  Line line;
  bool isWall;
};

bool isSameLine(const Side& one, const Side& next) {
  constexpr double kSame = 0.01;
  const double offset = next.line.normal.dot(next.a) - next.line.offset;
  return one.line.normal.dot(next.line.normal) > 0.999 &&
         std::abs(one.line.normal.dot(next.a - offset * next.line.normal) - one.line.offset) < kSame;
}

/// Sides that lie on one line become one; one that only cuts the corner between two walls goes.
std::vector<Side> mergedSides(std::vector<Side> sides) {
  std::vector<Side> kept;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& before = sides[(i + sides.size() - 1) % sides.size()];
    const auto& after = sides[(i + 1) % sides.size()];
    const bool isCorner = before.isWall && after.isWall && crossing(before.line, after.line);
    if (!sides[i].isWall && (sides[i].b - sides[i].a).norm() < kCornerCut && isCorner) continue;
    if (!kept.empty() && isSameLine(kept.back(), sides[i])) {
      kept.back().b = sides[i].b;
    } else {
      kept.push_back(sides[i]);
    }
  }
  while (kept.size() > 1 && isSameLine(kept.back(), kept.front())) {
    kept.front().a = kept.back().a;
    kept.pop_back();
  }
  return kept;
}

/// Moves the edges onto the faces of the walls that they follow.
Polygon snapped(const Polygon& border, std::span<const Segment> walls) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const auto& a = border[i];
    const auto& b = border[(i + 1) % border.size()];
    const Eigen::Vector2d normal = Eigen::Vector2d(a.y() - b.y(), b.x() - a.x()).normalized();
    const auto face = wallFaceAlong(a, b, walls);
    sides.push_back({a, b, face.value_or(Line{normal, normal.dot(a)}), face.has_value()});
  }
  sides = mergedSides(std::move(sides));
  Polygon moved;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& before = sides[(i + sides.size() - 1) % sides.size()];
    const auto& side = sides[i];
    const auto met = crossing(before.line, side.line);
    const auto isNear = [&](const Eigen::Vector2d& corner) { return (*met - corner).norm() < kCornerCut; };
    if (met && (isNear(before.b) || isNear(side.a))) {
      moved.push_back(*met);
      continue;
    }
    const auto onto = [](const Line& line, const Eigen::Vector2d& corner) -> Eigen::Vector2d {
      return corner + (line.offset - line.normal.dot(corner)) * line.normal;
    };
    moved.push_back(onto(before.line, before.b));
    moved.push_back(onto(side.line, side.a));
  }
  const Polygon result = withoutRepeats(moved);
  return result.size() >= 3 && !findSelfCrossing(result) ? result : border;
}

/// A way from an edge of the outline to a corner of a hole.
struct Bridge {
  double length;
  std::size_t hole;
  std::size_t corner;    ///< of the hole
  std::size_t edge;      ///< of the outline, by its first corner
  Eigen::Vector2d foot;  ///< on that edge
};

std::vector<Bridge> bridgesByLength(const Polygon& outline, const std::vector<Polygon>& holes) {
  std::vector<Bridge> bridges;
  for (std::size_t hole = 0; hole < holes.size(); ++hole) {
    for (std::size_t corner = 0; corner < holes[hole].size(); ++corner) {
      const auto& h = holes[hole][corner];
      for (std::size_t edge = 0; edge < outline.size(); ++edge) {
        const auto& a = outline[edge];
        const Eigen::Vector2d way = outline[(edge + 1) % outline.size()] - a;
        if (way.norm() < 4.0 * kSlit || isSlit(outline, edge)) continue;
        const double margin = kSlit / way.norm();
        const double t = std::clamp((h - a).dot(way) / way.squaredNorm(), margin, 1.0 - 2.0 * margin);
        const Eigen::Vector2d foot = a + t * way;
        bridges.push_back({(h - foot).norm(), hole, corner, edge, foot});
      }
    }
  }
  std::ranges::stable_sort(bridges, {}, &Bridge::length);
  return bridges;
}

/// Along the outline to the bridge, over it, round the hole, and back beside it.
Polygon bridged(const Polygon& outline, const Polygon& hole, const Bridge& bridge) {
  const Eigen::Vector2d onward =
      (outline[(bridge.edge + 1) % outline.size()] - outline[bridge.edge]).normalized() * kSlit;
  Polygon joined(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(bridge.edge) + 1);
  joined.push_back(bridge.foot);
  for (std::size_t i = 0; i < hole.size(); ++i) joined.push_back(hole[(bridge.corner + i) % hole.size()]);
  const auto& before = joined.back();
  const auto& corner = hole[bridge.corner];
  joined.emplace_back(corner + (before - corner).normalized() * kSlit);
  joined.emplace_back(bridge.foot + onward);
  joined.insert(joined.end(), outline.begin() + static_cast<std::ptrdiff_t>(bridge.edge) + 1, outline.end());
  return joined;
}

/// The outline with all holes joined to it, the nearest first.
Polygon joined(Polygon outline, std::vector<Polygon> holes) {
  while (!holes.empty()) {
    bool found = false;
    for (const auto& bridge : bridgesByLength(outline, holes)) {
      Polygon candidate = bridged(outline, holes[bridge.hole], bridge);
      if (findSelfCrossing(candidate)) continue;
      outline = std::move(candidate);
      holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(bridge.hole));
      found = true;
      break;
    }
    if (!found) break;
  }
  return outline;
}

Polygon outlineOf(const Raster& raster, int region, std::span<const Segment> walls) {
  std::vector<Polygon> borders;
  for (const auto& border : bordersOf(raster, region)) {
    // What stands in a room and is thinner than the raster can tell, a post or a pipe, is none of its borders.
    if (signedArea(border) < 0.0 && signedArea(border) > -kTolerance) continue;
    borders.push_back(snapped(simplified(border), walls));
  }
  Polygon outline = std::move(borders.front());
  borders.erase(borders.begin());
  return joined(std::move(outline), std::move(borders));
}

}  // namespace

std::vector<Polygon> roomOutlines(std::span<const Segment> walls, std::span<const Polygon> closures) {
  Eigen::AlignedBox2d bounds;
  for (const auto& wall : walls) bounds.extend(wall.a).extend(wall.b);
  if (bounds.isEmpty()) return {};
  Raster raster(bounds);
  for (const auto& wall : walls) raster.draw(wall);
  for (const auto& closure : closures) raster.fill(closure);
  raster.closeGaps();
  std::vector<Polygon> outlines;
  for (const int region : floodRooms(raster)) outlines.push_back(outlineOf(raster, region, walls));
  return outlines;
}

}  // namespace prodomos::simulation
