// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/polygons.hpp"

// Of one of Boost's headers about another one.
#define BOOST_ALLOW_DEPRECATED_HEADERS

#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/buffer.hpp>
#include <boost/geometry/algorithms/correct.hpp>
#include <boost/geometry/algorithms/difference.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/algorithms/union.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/strategies/agnostic/buffer_distance_symmetric.hpp>
#include <boost/geometry/strategies/cartesian/buffer_end_flat.hpp>
#include <boost/geometry/strategies/cartesian/buffer_join_miter.hpp>
#include <boost/geometry/strategies/cartesian/buffer_point_square.hpp>
#include <boost/geometry/strategies/cartesian/buffer_side_straight.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace prodomos::simulation {

namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Area = bg::model::polygon<Point>;
using Areas = bg::model::multi_polygon<Area>;

Area toBoost(const Polygon& polygon) {
  Area area;
  for (const auto& corner : polygon) area.outer().emplace_back(corner.x(), corner.y());
  bg::correct(area);
  return area;
}

Polygon fromBoost(const Area& area) {
  Polygon polygon;
  for (const auto& point : area.outer()) polygon.emplace_back(point.x(), point.y());
  if (!polygon.empty()) polygon.pop_back();  // Boost's rings are closed,
  std::ranges::reverse(polygon);             // and clockwise.
  return polygon;
}

std::vector<Polygon> outlinesOf(const Areas& areas) {
  std::vector<Polygon> outlines;
  for (const auto& area : areas) outlines.push_back(fromBoost(area));
  std::ranges::stable_sort(outlines, std::ranges::greater{}, signedArea);
  return outlines;
}

/// Whether the middle one of three corners says nothing: it stands beside the line from a to c, or behind its end.
bool isSpare(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, double tolerance) {
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d bc = c - b;
  const double doubledArea = std::abs(ab.x() * bc.y() - ab.y() * bc.x());
  // Of a needle the legs lie on each other, and a and c may be one point: the longer leg is the base.
  const double base = std::max({ab.norm(), bc.norm(), (c - a).norm()});
  return doubledArea <= tolerance * base;
}

double distanceToSegment(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& point) {
  const Eigen::Vector2d span = to - from;
  const double share = span.squaredNorm() > 0.0 ? (point - from).dot(span) / span.squaredNorm() : 0.0;
  return (point - from - std::clamp(share, 0.0, 1.0) * span).norm();
}

/// Heights at which a scan line meets a corner or a crossing of edges, ascending.
std::vector<double> eventsOf(const std::vector<Edge>& edges) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    heights.push_back(edges[i].from.y());
    const Eigen::Vector2d along = edges[i].to - edges[i].from;
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Eigen::Vector2d other = edges[j].to - edges[j].from;
      const double cross = along.x() * other.y() - along.y() * other.x();
      if (cross == 0.0) continue;
      const Eigen::Vector2d apart = edges[j].from - edges[i].from;
      const double onFirst = (apart.x() * other.y() - apart.y() * other.x()) / cross;
      const double onSecond = (apart.x() * along.y() - apart.y() * along.x()) / cross;
      if (onFirst > 0.0 && onFirst < 1.0 && onSecond > 0.0 && onSecond < 1.0) {
        heights.push_back(edges[i].from.y() + onFirst * along.y());
      }
    }
  }
  std::ranges::sort(heights);
  constexpr double kSame = 1e-7;
  const auto isSame = [](double a, double b) { return b - a < kSame; };
  heights.erase(std::unique(heights.begin(), heights.end(), isSame), heights.end());
  return heights;
}

double xAt(const Edge& edge, double y) {
  return std::lerp(edge.from.x(), edge.to.x(), (y - edge.from.y()) / (edge.to.y() - edge.from.y()));
}

}  // namespace

Edge edgeOf(const Polygon& polygon, std::size_t i) {
  return {polygon[i], polygon[(i + 1) % polygon.size()]};
}

Polygon cleaned(Polygon polygon, double tolerance) {
  bool changed = true;
  while (changed && polygon.size() >= 3) {
    changed = false;
    for (std::size_t i = 0; i < polygon.size() && polygon.size() >= 3; ++i) {
      const std::size_t n = polygon.size();
      if (!isSpare(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n], tolerance)) continue;
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  if (polygon.size() < 3) return {};
  if (signedArea(polygon) < 0.0) std::ranges::reverse(polygon);
  return polygon;
}

Polygon simplified(const Polygon& polygon, double tolerance) {
  std::vector<std::size_t> kept(polygon.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  // How far the corners between a kept one's neighbours stand off the edge that would join these.
  const auto offset = [&](std::size_t k) {
    const std::size_t from = kept[(k + kept.size() - 1) % kept.size()];
    const std::size_t to = kept[(k + 1) % kept.size()];
    double greatest = 0.0;
    for (std::size_t i = (from + 1) % polygon.size(); i != to; i = (i + 1) % polygon.size()) {
      greatest = std::max(greatest, distanceToSegment(polygon[from], polygon[to], polygon[i]));
    }
    return greatest;
  };
  while (kept.size() > 3) {
    std::size_t least = 0;
    for (std::size_t k = 1; k < kept.size(); ++k) {
      if (offset(k) < offset(least)) least = k;
    }
    if (offset(least) > tolerance) break;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(least));
  }
  Polygon fewer;
  for (const std::size_t i : kept) fewer.push_back(polygon[i]);
  return findSelfCrossing(fewer) ? polygon : fewer;
}

std::vector<Polygon> inset(const Polygon& polygon, double distance) {
  constexpr double kMitreLimit = 5.0;
  Areas moved;
  bg::buffer(toBoost(polygon), moved, bg::strategy::buffer::distance_symmetric(-distance),
             bg::strategy::buffer::side_straight(), bg::strategy::buffer::join_miter(kMitreLimit),
             bg::strategy::buffer::end_flat(), bg::strategy::buffer::point_square());
  return outlinesOf(moved);
}

double overlapArea(const Polygon& a, const Polygon& b) {
  Areas common;
  bg::intersection(toBoost(a), toBoost(b), common);
  return bg::area(common);
}

Difference difference(const Polygon& a, const Polygon& b) {
  Areas rest;
  bg::difference(toBoost(a), toBoost(b), rest);
  const bool hasHole = std::ranges::any_of(rest, [](const Area& area) { return !area.inners().empty(); });
  return {outlinesOf(rest), hasHole};
}

std::vector<Polygon> united(const std::vector<Polygon>& polygons) {
  // Neighbours that share an edge but for rounding must overlap to become one.
  constexpr double kSeam = 1e-4;
  Areas all;
  for (const auto& polygon : polygons) {
    for (const auto& grown : inset(polygon, -kSeam)) {
      Areas sum;
      bg::union_(all, toBoost(grown), sum);
      all = std::move(sum);
    }
  }
  std::vector<Polygon> outlines;
  for (const auto& outline : outlinesOf(all)) {
    for (auto& shrunk : inset(outline, kSeam)) outlines.push_back(cleaned(std::move(shrunk), kSeam));
  }
  return outlines;
}

std::vector<std::array<Eigen::Vector2d, 3>> triangulate(const Polygon& outline, const std::vector<Polygon>& holes) {
  // Between two events no edges cross: the area there is a row of trapezoids.
  std::vector<Edge> edges;
  std::vector<std::size_t> ringOf;  // 0: outline
  const auto addRing = [&](const Polygon& ring, std::size_t number) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges.push_back(edgeOf(ring, i));
      ringOf.push_back(number);
    }
  };
  addRing(outline, 0);
  for (std::size_t i = 0; i < holes.size(); ++i) addRing(holes[i], i + 1);

  std::vector<std::array<Eigen::Vector2d, 3>> triangles;
  const auto heights = eventsOf(edges);
  for (std::size_t row = 0; row + 1 < heights.size(); ++row) {
    const double bottom = heights[row];
    const double top = heights[row + 1];
    const double middle = (bottom + top) / 2.0;
    std::vector<std::size_t> met;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if ((edges[i].from.y() > middle) != (edges[i].to.y() > middle)) met.push_back(i);
    }
    std::ranges::sort(met, {}, [&](std::size_t i) { return std::pair(xAt(edges[i], middle), i); });
    std::vector<bool> inside(holes.size() + 1, false);
    for (std::size_t k = 0; k + 1 < met.size(); ++k) {
      inside[ringOf[met[k]]] = !inside[ringOf[met[k]]];
      if (!inside[0] || std::find(inside.begin() + 1, inside.end(), true) != inside.end()) continue;
      const Edge& left = edges[met[k]];
      const Edge& right = edges[met[k + 1]];
      const Eigen::Vector2d a(xAt(left, bottom), bottom);
      const Eigen::Vector2d b(xAt(right, bottom), bottom);
      const Eigen::Vector2d c(xAt(right, top), top);
      const Eigen::Vector2d d(xAt(left, top), top);
      if (b.x() > a.x()) triangles.push_back({a, b, c});
      if (c.x() > d.x()) triangles.push_back({a, c, d});
    }
  }
  return triangles;
}

}  // namespace prodomos::simulation
