// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_outline.hpp"

#include "perception/numeric.hpp"
#include "perception/staircase_lattice.hpp"
#include "perception/staircase_sighting.hpp"
#include "perception/staircase_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace prodomos::perception {

namespace {

using geometry::Pose3;
using sensors::DepthGrid;

constexpr double kUpright = 1.35;         // radians of tilt: 77 degrees and more
constexpr double kOnPlane = 0.02;         // metres off a side's plane, but for noise
constexpr std::size_t kLeastPoints = 24;  // of an outline
constexpr double kLeastShare = 0.2;       // of these, that belong to treads, and to risers
constexpr double kBand = 0.18;            // metres that steps stand out of their slope, both sides together
constexpr double kBin = 0.03;             // metres
constexpr double kLeastLength = 0.7;      // metres along the slope: three steps
constexpr double kStraight = 0.016;       // metres that a rail's edge deviates from its slope
constexpr int kMostOutlines = 3;          // of a side: there may be rails over the steps
constexpr double kGap = 0.25;             // metres along the slope
constexpr double kMostRoughness = 0.6;    // of points half a cell off
constexpr int kLeastSteps = 4;            // three alike there may be in a row of things by chance
constexpr int kMostStep = 30;             // from the outline's middle, either way
constexpr double kUsualWidth = 1.2;       // metres, where nothing tells
constexpr double kLeastWidth = 0.6;
constexpr double kMostWidth = 2.5;
constexpr double kThickness = 0.5;  // metres of a flight below the inner corners of its steps, at most
constexpr std::array kSlopes = {0.36, 0.44, 0.52, 0.60, 0.68, 0.76, 0.86, 0.98};  // rise over run, 20 to 45 degrees

/// A spot on a patch's edge, past which one looks on.
struct EdgePoint {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< metres to the right, seen from the camera, and up
  double sigma = 0.0;                               ///< metres: half a pixel
  int past = 0;                                     ///< 0: above it one looks on; 1: to its right; -1: to its left
};

/// An upright patch that may be the side of a flight. Its steps are small: one looks at pixels, not at cells.
class Side {
 public:
  Side(const RgbdView& view, const Surfaces& surfaces, const PlanarPatch& patch)
      : depth_(view.frame.depth),
        grid_(surfaces.depth),
        patch_(patch),
        T_camera_submap_(view.T_submap_camera.inverse()),
        plane_in_camera_(geometry::transformed(T_camera_submap_, patch.plane_in_submap)),
        right_(Eigen::Vector3d::UnitZ().cross(patch.plane_in_submap.normal).normalized()),
        middle_(patch.centroid_in_submap) {}

  const Eigen::Vector3d& right() const { return right_; }
  Eigen::Vector3d pointAt(const Eigen::Vector2d& place) const {
    return middle_ + place.x() * right_ + place.y() * Eigen::Vector3d::UnitZ();
  }
  /// Upper and lateral edges. The lower ones tell nothing of steps.
  std::vector<EdgePoint> edge() const;

  enum class Shown { kNothing, kSide, kPast };
  /// What the view shows where that spot of the plane is; nothing where it is out of the image or something hides it.
  Shown at(const Eigen::Vector3d& spot_in_submap) const;

 private:
  Shown at(int u, int v, const Eigen::Vector3d& ray) const;
  Eigen::Vector2d placeOf(const Eigen::Vector3d& ray) const;
  /// As the treads behind the side are.
  bool isTurnedAway(const DepthGrid::Cell& cell) const {
    constexpr double kCosine = 0.4;
    const Eigen::Vector3d normal = normalOf(cell);
    return !normal.isZero() && normal.dot(plane_in_camera_.normal) < kCosine;
  }
  void addEdge(int x, int y, int dx, int dy, std::vector<EdgePoint>& points) const;

  const sensors::Image<float>& depth_;
  const DepthGrid& grid_;
  const PlanarPatch& patch_;
  Pose3 T_camera_submap_;
  geometry::Plane plane_in_camera_;
  Eigen::Vector3d right_;  ///< along the plane, level
  Eigen::Vector3d middle_;
};

Eigen::Vector3d rayOf(const DepthGrid::Cell& cell) {
  return {static_cast<double>(cell.rayX), static_cast<double>(cell.rayY), 1.0};
}

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
  const double tolerance = kOnPlane + 2.5 * slant * sensors::depthSigma(depth);
  if (before > tolerance) return Shown::kNothing;
  return before < -tolerance ? Shown::kPast : Shown::kSide;
}

/// Calls use(index, x, y, dx, dy) for each of the cell's neighbours.
template <typename Use>
void eachNeighbour(const DepthGrid& grid, std::uint32_t cell, const Use& use) {
  const int x = static_cast<int>(cell) % grid.width();
  const int y = static_cast<int>(cell) / grid.width();
  for (const auto& [dx, dy] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
    if (x + dx < 0 || y + dy < 0 || x + dx >= grid.width() || y + dy >= grid.height()) continue;
    use(static_cast<std::size_t>((y + dy) * grid.width() + x + dx), x, y, dx, dy);
  }
}

std::vector<EdgePoint> Side::edge() const {
  constexpr int kBlock = DepthGrid::kBlock;
  constexpr int kFringe = 2;  // cells that normals leave out along edges
  std::vector<std::uint32_t> cells = patch_.cells;
  std::vector<char> isOfSide(static_cast<std::size_t>(grid_.width() * grid_.height()), 0);
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

/// Points of an edge along one slope. Places are turned so that x is uphill.
struct Outline {
  double rise = 0.0;  ///< over run
  std::vector<EdgePoint> points;

  double along(const EdgePoint& p) const { return (p.place.x() + rise * p.place.y()) / std::hypot(1.0, rise); }
  double above(const EdgePoint& p) const { return (p.place.y() - rise * p.place.x()) / std::hypot(1.0, rise); }
  Eigen::Vector2d middle() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const EdgePoint& p : points) sum += p.place;
    return sum / static_cast<double>(points.size());
  }
};

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
  auto best = std::ranges::subrange(points.begin(), points.begin());
  auto first = points.begin();
  for (auto next = points.begin(); next != points.end(); ++next) {
    if (next != first && outline.along(*next) - outline.along(*std::prev(next)) > kGap) first = next;
    if (next + 1 - first > best.end() - best.begin()) best = {first, next + 1};
  }
  points = {best.begin(), best.end()};
}

/// Of upper edges and of those that one looks past downhill: what may be treads and risers. `uphill`: 1 to the right,
/// -1 to the left.
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
  const auto others = std::ranges::partition(
      outline.points, [&](const EdgePoint& p) { return std::abs(outline.above(p) - best.first) <= 0.5 * kBand; });
  points.assign(others.begin(), others.end());
  outline.points.erase(others.begin(), others.end());
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

/// The steps of a lattice along a side.
class FlightBeside {
 public:
  /// `uphill` as findOutline() has it.
  FlightBeside(const Side& side, const Surfaces& surfaces, const StepLattice& lattice, const Pose3& T_submap_flight,
               int uphill)
      : side_(side), surfaces_(surfaces), lattice_(lattice), T_submap_flight_(T_submap_flight), uphill_(uphill) {}

  std::optional<FlightSteps> steps(const Pose3& T_submap_camera) const;

 private:
  /// Spots of the triangle between a tread and its riser, where the side must be, and of the one between its riser and
  /// the tread below, where one must look on.
  struct Tooth {
    int solid = 0;
    int missing = 0;
    int open = 0;
    int filled = 0;

    bool isAsked() const { return solid + missing + open + filled > 0; }
    bool isThere() const { return solid >= 2 && open >= 2; }
  };
  struct Run {
    int lowest = 0;
    int count = 0;
    ProfileCheck::Count spots;
  };

  Tooth tooth(int step) const;
  Run longestRun() const;
  double width(const Run& run, const Pose3& T_flight_camera) const;
  int mostBelow(int step, const Eigen::Vector3d& eye) const;

  const Side& side_;
  const Surfaces& surfaces_;
  const StepLattice& lattice_;
  const Pose3& T_submap_flight_;
  int uphill_;
};

FlightBeside::Tooth FlightBeside::tooth(int step) const {
  Tooth tooth;
  for (const auto& [far, near] : {std::pair(0.2, 0.2), std::pair(0.2, 0.5), std::pair(0.5, 0.2)}) {
    const auto shownAt = [&](double along, double down) {
      const Eigen::Vector3d spot(lattice_.riserAt(step) + along * lattice_.depth, 0.0,
                                 lattice_.treadAt(step) - down * lattice_.rise);
      return side_.at(T_submap_flight_ * spot);
    };
    const Side::Shown below = shownAt(far, near);
    const Side::Shown above = shownAt(-far, 1.0 - near);
    tooth.solid += below == Side::Shown::kSide ? 1 : 0;
    tooth.missing += below == Side::Shown::kPast ? 1 : 0;
    tooth.open += above == Side::Shown::kPast ? 1 : 0;
    tooth.filled += above == Side::Shown::kSide ? 1 : 0;
  }
  return tooth;
}

/// Steps one above the other; one in between may be hidden.
FlightBeside::Run FlightBeside::longestRun() const {
  Run best;
  Run run;
  int hidden = 0;
  for (int step = -kMostStep; step <= kMostStep; ++step) {
    const Tooth here = tooth(step);
    if (here.isThere()) {
      if (run.count == 0) run.lowest = step;
      run.count = step + 1 - run.lowest;
      run.spots += {here.solid + here.open, here.missing + here.filled};
      hidden = 0;
      if (run.count > best.count) best = run;
    } else if (here.isAsked() || ++hidden > 1) {
      run = {};
    }
  }
  return best;
}

/// How far the flight reaches behind its side: as far as one sees treads or the underside without a gap; else as usual,
/// but no farther than the wall behind it.
double FlightBeside::width(const Run& run, const Pose3& T_flight_camera) const {
  constexpr double kFacing = 0.7;
  constexpr double kEnd = 0.02;  // of the points, that may lie beyond
  std::vector<double> steps;
  std::vector<double> walls;
  for (int v = 0; v < surfaces_.depth.height(); ++v) {
    for (int u = 0; u < surfaces_.depth.width(); ++u) {
      const DepthGrid::Cell& cell = surfaces_.depth.at(u, v);
      if (!(cell.depth > 0.0F)) continue;
      const Eigen::Vector3d p = T_flight_camera * pointOf(cell);
      const double step = (p.x() - lattice_.riserAt(run.lowest)) / lattice_.depth;
      const double below = lattice_.treadAt(run.lowest) + step * lattice_.rise - p.z();
      const double behind = uphill_ * p.y();
      if (step < 0.0 || step > run.count || below < -kOnPlane || below > lattice_.rise + kThickness) continue;
      if (behind < 0.0 || behind > kMostWidth) continue;
      const bool isWall = std::abs(T_flight_camera.linear().row(1).dot(normalOf(cell))) > kFacing;
      (isWall ? walls : steps).push_back(behind);
    }
  }
  std::ranges::sort(steps);
  const auto gap = std::ranges::adjacent_find(steps, [](double a, double b) { return b - a > kGap; });
  const auto count = static_cast<double>(std::distance(steps.begin(), gap == steps.end() ? gap : gap + 1));
  const double seen = count > 0.0 ? steps[static_cast<std::size_t>((1.0 - kEnd) * count)] : 0.0;
  if (seen > kLeastWidth) return seen;
  std::erase_if(walls, [](double behind) { return behind < kLeastWidth; });
  return walls.empty() ? kUsualWidth : std::min(kUsualWidth, median(std::move(walls)));
}

/// How many steps there may be below that one: none where one sees nothing there, or a landing or wall.
int FlightBeside::mostBelow(int step, const Eigen::Vector3d& eye) const {
  constexpr int kUnseen = 2;
  const Tooth below = tooth(step - 1);
  // Where treads are seen from above, spots before a riser may show the tread.
  const bool isFromBelow = eye.z() < lattice_.treadAt(step - 1);
  return below.missing >= 2 || (isFromBelow && below.filled >= 2) ? 0 : kUnseen;
}

std::optional<FlightSteps> FlightBeside::steps(const Pose3& T_submap_camera) const {
  const Run run = longestRun();
  if (run.count < kLeastSteps) return std::nullopt;
  const Pose3 T_flight_camera = T_submap_flight_.inverse() * T_submap_camera;
  const double across = uphill_ * width(run, T_flight_camera);
  FlightSteps found;
  for (int step = run.lowest; step < run.lowest + run.count; ++step) {
    const Eigen::Vector3d edge(lattice_.riserAt(step), 0.0, lattice_.treadAt(step));
    found.steps.push_back({.index = step,
                           .riserCells = 1,
                           .least = std::min(0.0, across),
                           .most = std::max(0.0, across),
                           .sigma = sensors::depthSigma((edge - T_flight_camera.translation()).norm())});
  }
  found.count = run.spots;
  found.mostBelow = mostBelow(run.lowest, T_flight_camera.translation());
  return found;
}

std::optional<StaircaseSighting> flightBeside(const RgbdView& view, const Surfaces& surfaces, const Side& side,
                                              const Outline& outline, int uphill) {
  const Eigen::Vector2d middle = outline.middle();
  std::vector<FlightPoint> points;
  for (const EdgePoint& p : outline.points) {
    points.push_back({{p.place.x() - middle.x(), 0.0, p.place.y() - middle.y()}, p.sigma});
  }
  const auto found = findLattice(points, outline.rise, false);
  if (!found || found->roughness > kMostRoughness) return std::nullopt;
  const Eigen::Vector3d direction = uphill * side.right();
  const Pose3 T_submap_flight = geometry::fromYawPitchRoll(side.pointAt({uphill * middle.x(), middle.y()}),
                                                           std::atan2(direction.y(), direction.x()), 0.0, 0.0);
  const FlightBeside flight(side, surfaces, found->lattice, T_submap_flight, uphill);
  const auto steps = flight.steps(view.T_submap_camera);
  if (!steps) return std::nullopt;
  const ProfileCheck check(view.T_submap_camera, surfaces.depth, found->lattice, T_submap_flight);
  auto sighting = sightingOf(view, surfaces, *found, T_submap_flight, *steps, check);
  sighting.widthIsWhole = false;
  return sighting;
}

}  // namespace

std::vector<StaircaseSighting> findFlightsBeside(const RgbdView& view, const Surfaces& surfaces) {
  std::vector<StaircaseSighting> sightings;
  for (const PlanarPatch& patch : surfaces.patches) {
    if (patch.tilt() < kUpright) continue;
    const Side side(view, surfaces, patch);
    const auto edge = side.edge();
    for (const int uphill : {1, -1}) {
      auto points = possibleSteps(edge, uphill);
      for (int i = 0; i < kMostOutlines && points.size() >= kLeastPoints; ++i) {
        const Outline outline = takeOutline(points);
        auto sighting = isSawtooth(outline) ? flightBeside(view, surfaces, side, outline, uphill) : std::nullopt;
        if (sighting) sightings.push_back(std::move(*sighting));
      }
    }
  }
  return sightings;
}

}  // namespace prodomos::perception
