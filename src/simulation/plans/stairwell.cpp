// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plans/stairwell.hpp"

#include "simulation/polygons.hpp"
#include "simulation/shell/shell_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kLeastWidth = 0.9;
constexpr double kLeastLanding = 0.9;
constexpr std::array kWidths = {1.5, 1.3, 1.1, kLeastWidth};
constexpr double kRightAngle = std::numbers::pi / 2.0;

double distanceTo(const Polygon& outline, const Eigen::Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Edge edge = edgeOf(outline, i);
    const double along = std::clamp((point - edge.from).dot(edge.direction()), 0.0, edge.length());
    least = std::min(least, (point - edge.from - along * edge.direction()).norm());
  }
  return least;
}

/// Where one can walk in a room, in cells of 0.1 m.
class WalkableFloor {
 public:
  explicit WalkableFloor(const Polygon& outline) : least_(outline.front()) {
    Eigen::Vector2d most = outline.front();
    for (const auto& corner : outline) {
      least_ = least_.cwiseMin(corner);
      most = most.cwiseMax(corner);
    }
    columns_ = static_cast<std::size_t>((most.x() - least_.x()) / kCell) + 1;
    isFree_.resize(columns_ * (static_cast<std::size_t>((most.y() - least_.y()) / kCell) + 1));
    for (std::size_t i = 0; i < isFree_.size(); ++i) {
      constexpr double kFromWalls = 0.25;
      isFree_[i] = contains(outline, middleOf(i)) && distanceTo(outline, middleOf(i)) >= kFromWalls;
    }
  }

  /// Whether all points lie on one piece of the floor when flights stand on it.
  bool joins(const std::vector<Eigen::Vector2d>& points, const std::vector<Polygon>& flights) const {
    std::vector<bool> isOpen = isFree_;
    for (std::size_t i = 0; i < isOpen.size(); ++i) {
      if (!isOpen[i]) continue;
      isOpen[i] = std::ranges::none_of(flights, [&](const Polygon& flight) {
        constexpr double kFromFlights = 0.2;
        return contains(flight, middleOf(i)) || distanceTo(flight, middleOf(i)) < kFromFlights;
      });
    }
    const auto pieces = piecesOf(isOpen);
    const int first = pieceAt(pieces, points.front());
    return first != 0 && std::ranges::all_of(points, [&](const auto& at) { return pieceAt(pieces, at) == first; });
  }

 private:
  static constexpr double kCell = 0.1;

  Eigen::Vector2d middleOf(std::size_t cell) const {
    const std::size_t row = cell / columns_;
    const std::size_t column = cell % columns_;
    return least_ + kCell * Eigen::Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  }

  /// A number from 1 on for each connected piece, 0 where nobody walks.
  std::vector<int> piecesOf(const std::vector<bool>& isOpen) const {
    std::vector<int> pieces(isOpen.size(), 0);
    int count = 0;
    for (std::size_t start = 0; start < isOpen.size(); ++start) {
      if (!isOpen[start] || pieces[start] != 0) continue;
      pieces[start] = ++count;
      std::vector<std::size_t> pending{start};
      while (!pending.empty()) {
        const std::size_t cell = pending.back();
        pending.pop_back();
        const auto visit = [&](bool exists, std::size_t next) {
          if (!exists || !isOpen[next] || pieces[next] != 0) return;
          pieces[next] = count;
          pending.push_back(next);
        };
        visit(cell % columns_ > 0, cell - 1);
        visit(cell % columns_ + 1 < columns_, cell + 1);
        visit(cell >= columns_, cell - columns_);
        visit(cell + columns_ < isOpen.size(), cell + columns_);
      }
    }
    return pieces;
  }

  /// Of the nearest cell where one walks, not farther than a step.
  int pieceAt(const std::vector<int>& pieces, const Eigen::Vector2d& point) const {
    double least = 0.35;
    int piece = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const double distance = (middleOf(i) - point).norm();
      if (pieces[i] == 0 || distance >= least) continue;
      least = distance;
      piece = pieces[i];
    }
    return piece;
  }

  Eigen::Vector2d least_;
  std::size_t columns_ = 0;
  std::vector<bool> isFree_;
};

/// A free rectangle of a room, seen uphill: origin at its lower right corner, x uphill, y to the left.
struct Site {
  geometry::Pose2 pose;
  double length = 0.0;
  double width = 0.0;
};

/// Whether an edge of the polygon runs through the inside of an upright rectangle.
bool isCut(const Polygon& polygon, const Eigen::Vector2d& least, const Eigen::Vector2d& most) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Edge edge = edgeOf(polygon, i);
    const Eigen::Vector2d along = edge.to - edge.from;
    double enters = 0.0;
    double leaves = 1.0;
    for (const int axis : {0, 1}) {
      if (along[axis] == 0.0) {
        if (edge.from[axis] <= least[axis] || edge.from[axis] >= most[axis]) enters = 2.0;
        continue;
      }
      const double a = (least[axis] - edge.from[axis]) / along[axis];
      const double b = (most[axis] - edge.from[axis]) / along[axis];
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    if (enters < leaves) return true;
  }
  return false;
}

std::vector<double> coordinatesOf(const Polygon& polygon, int axis) {
  std::vector<double> values;
  for (const auto& corner : polygon) values.push_back(corner[axis]);
  std::ranges::sort(values);
  return values;
}

/// Rectangles between the corners of a polygon, in all four directions, the greatest first.
std::vector<Site> sitesIn(const Polygon& outline, double heading) {
  const Eigen::Rotation2Dd R_site_world(-heading);
  Polygon turned;
  for (const auto& corner : outline) turned.push_back(R_site_world * corner);
  const auto xs = coordinatesOf(turned, 0);
  const auto ys = coordinatesOf(turned, 1);
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> rectangles;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(1e-3);
  for (std::size_t left = 0; left < xs.size(); ++left) {
    for (std::size_t right = left + 1; right < xs.size(); ++right) {
      if (xs[right] - xs[left] < kLeastWidth) continue;
      for (std::size_t bottom = 0; bottom < ys.size(); ++bottom) {
        for (std::size_t top = bottom + 1; top < ys.size(); ++top) {
          if (ys[top] - ys[bottom] < kLeastWidth) continue;
          const Eigen::Vector2d least = Eigen::Vector2d(xs[left], ys[bottom]) + margin;
          const Eigen::Vector2d most = Eigen::Vector2d(xs[right], ys[top]) - margin;
          if (!contains(turned, (least + most) / 2.0) || isCut(turned, least, most)) continue;
          rectangles.emplace_back(least, most);
        }
      }
    }
  }
  const auto area = [](const auto& rectangle) { return (rectangle.second - rectangle.first).prod(); };
  std::ranges::stable_sort(rectangles, std::ranges::greater{}, area);
  constexpr std::size_t kMost = 8;
  if (rectangles.size() > kMost) rectangles.resize(kMost);

  std::vector<Site> sites;
  for (const auto& [least, most] : rectangles) {
    const Eigen::Vector2d size = most - least;
    const std::array<Eigen::Vector2d, 4> corners{{least, {most.x(), least.y()}, most, {least.x(), most.y()}}};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d corner = R_site_world.inverse() * corners[i];
      const double direction = geometry::normalizeAngle(heading + static_cast<double>(i) * kRightAngle);
      const int along = i % 2 == 0 ? 0 : 1;
      sites.push_back({{corner.x(), corner.y(), direction}, size[along], size[1 - along]});
    }
  }
  return sites;
}

class StairwellPlanner {
 public:
  StairwellPlanner(const Polygon& outline, const std::vector<Eigen::Vector2d>& entrances, const Climb& climb)
      : floor_(outline), entrances_(entrances), climb_(climb) {
    // Along the longest walls first.
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) edges.push_back(edgeOf(outline, i));
    std::ranges::stable_sort(edges, std::ranges::greater{}, &Edge::length);
    constexpr std::size_t kDirections = 2;
    if (edges.size() > kDirections) edges.resize(kDirections);
    for (const auto& edge : edges) {
      const auto sites = sitesIn(outline, std::atan2(edge.direction().y(), edge.direction().x()));
      sites_.insert(sites_.end(), sites.begin(), sites.end());
    }
  }

  std::optional<StairwellPlan> plan() const {
    using Layouts = std::vector<StairwellPlan> (StairwellPlanner::*)(const Site&, double) const;
    for (const Layouts layouts : {&StairwellPlanner::straight, &StairwellPlanner::twofold}) {
      for (const double width : kWidths) {
        for (const auto& site : sites_) {
          for (auto& plan : (this->*layouts)(site, width)) {
            if (canBeWalked(plan)) return std::move(plan);
          }
        }
      }
    }
    return std::nullopt;
  }

 private:
  /// One that begins at x, with its middle at y of the site.
  Staircase flight(const Site& site, double x, double y, double width, int steps, bool turnsBack, double z) const {
    const Eigen::Vector2d foot = site.pose * Eigen::Vector2d(x, y);
    return {.foot = {foot.x(), foot.y(), z},
            .direction = geometry::normalizeAngle(site.pose.theta + (turnsBack ? 2.0 * kRightAngle : 0.0)),
            .width = width,
            .stepDepth = climb_.stepDepth,
            .stepHeight = climb_.stepHeight,
            .stepCount = steps};
  }

  double runOf(int steps) const { return (steps - 1) * climb_.stepDepth; }

  std::vector<StairwellPlan> straight(const Site& site, double width) const {
    const double spare = site.length - runOf(climb_.stepCount) - 2.0 * kLeastLanding;
    if (spare < 0.0 || site.width < width) return {};
    std::vector<StairwellPlan> plans;
    for (const double x : {kLeastLanding + spare / 2.0, kLeastLanding, kLeastLanding + spare}) {
      for (const double y : {width / 2.0, site.width - width / 2.0}) {
        plans.push_back({{flight(site, x, y, width, climb_.stepCount, false, 0.0)}, std::nullopt});
      }
    }
    return plans;
  }

  std::vector<StairwellPlan> twofold(const Site& site, double width) const {
    const int lower = (climb_.stepCount + 1) / 2;
    const int upper = climb_.stepCount - lower;
    const double spare = site.length - runOf(lower) - 2.0 * kLeastLanding;
    if (spare < 0.0 || site.width < 2.0 * width) return {};
    const double depth = std::min(kLeastLanding + spare, std::max(width, kLeastLanding));
    const double edge = site.length - depth;  // Where the landing begins; it reaches up to the wall.
    const double z = lower * climb_.stepHeight;
    std::vector<StairwellPlan> plans;
    for (const double right : {0.0, site.width - 2.0 * width}) {
      for (const bool beginsRight : {true, false}) {
        const double first = right + (beginsRight ? 0.5 : 1.5) * width;
        const double second = right + (beginsRight ? 1.5 : 0.5) * width;
        const auto corner = [&](double x, double y) -> Eigen::Vector2d {
          return site.pose * Eigen::Vector2d(x, right + y);
        };
        const Landing landing{.outline = {corner(edge, 0.0), corner(site.length, 0.0), corner(site.length, 2.0 * width),
                                          corner(edge, 2.0 * width)},
                              .z = z};
        plans.push_back({{flight(site, edge - runOf(lower), first, width, lower, false, 0.0),
                          flight(site, edge, second, width, upper, true, z)},
                         landing});
      }
    }
    return plans;
  }

  bool canBeWalked(const StairwellPlan& plan) const {
    std::vector<Polygon> taken;
    for (const auto& flight : plan.flights) taken.push_back(footprintOf(flight));
    if (plan.landing) taken.push_back(plan.landing->outline);
    const auto before = [](const Staircase& stairs, double distance) -> Eigen::Vector2d {
      return distance * Eigen::Vector2d(std::cos(stairs.direction), std::sin(stairs.direction));
    };
    const auto& first = plan.flights.front();
    const auto& last = plan.flights.back();
    std::vector<Eigen::Vector2d> points = entrances_;
    points.emplace_back(first.foot.head<2>() - before(first, kLeastLanding / 2.0));
    points.emplace_back(headOf(last).head<2>() + before(last, kLeastLanding / 2.0));
    return floor_.joins(points, taken);
  }

  WalkableFloor floor_;
  std::vector<Eigen::Vector2d> entrances_;
  Climb climb_;
  std::vector<Site> sites_;
};

}  // namespace

std::optional<StairwellPlan> planStairwell(const Polygon& outline, const std::vector<Eigen::Vector2d>& entrances,
                                           const Climb& climb) {
  return StairwellPlanner(outline, entrances, climb).plan();
}

}  // namespace prodomos::simulation
