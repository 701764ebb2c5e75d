// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_outline.hpp"

#include "perception/staircase_lattice.hpp"
#include "perception/staircase_sighting.hpp"
#include "perception/staircase_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace prodomos::perception {

namespace {

using geometry::Pose3;
using sensors::DepthGrid;

constexpr double kUpright = 1.35;         // radians of tilt: 77 degrees and more
constexpr double kOnPlane = 0.03;         // metres off a side's plane, but for noise
constexpr std::size_t kLeastPoints = 24;  // of an outline
constexpr double kLeastShare = 0.15;      // of these, that belong to treads, and to risers
constexpr double kBand = 0.18;            // metres that steps stand out of their slope, both sides together
constexpr double kBin = 0.03;             // metres
constexpr double kLeastLength = 0.7;      // metres along the slope: three steps
constexpr double kGap = 0.25;             // metres along the slope
constexpr double kMostRoughness = 0.5;    // of points half a cell off
constexpr std::size_t kLeastSteps = 3;
constexpr int kMostStep = 30;        // from the outline's middle, either way
constexpr double kUsualWidth = 1.2;  // metres, where nothing tells
constexpr double kLeastWidth = 0.6;
constexpr double kMostWidth = 2.5;
constexpr double kThickness = 0.5;  // metres of a flight below the inner corners of its steps, at most
constexpr std::array kSlopes = {0.36, 0.44, 0.52, 0.60, 0.68, 0.76, 0.86, 0.98};  // rise over run, 20 to 45 degrees

/// A spot on a patch's edge, past which one looks on.
struct EdgePoint {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< metres to the right, seen from the camera, and up
  double sigma = 0.0;                               ///< metres: half a cell
  int past = 0;                                     ///< 0: above it one looks on; 1: to its right; -1: to its left
};

/// An upright patch that may be the side of a flight.
class Side {
 public:
  Side(const RgbdView& view, const Surfaces& surfaces, const PlanarPatch& patch)
      : grid_(surfaces.depth),
        T_submap_camera_(view.T_submap_camera),
        T_camera_submap_(view.T_submap_camera.inverse()),
        patch_(patch),
        right_(Eigen::Vector3d::UnitZ().cross(patch.plane_in_submap.normal).normalized()) {}

  const Eigen::Vector3d& right() const { return right_; }
  /// Upper and lateral edges. The lower ones tell nothing of steps.
  std::vector<EdgePoint> edge() const;
  Eigen::Vector3d pointAt(const Eigen::Vector2d& place) const;

  enum class Shown { kNothing, kSide, kPast };
  /// What the view shows where that spot of the plane is; nothing where it is out of the image or something hides it.
  Shown at(const Eigen::Vector3d& spot_in_submap) const;

 private:
  /// Metres before the plane; unknown depth is far behind it.
  double before(const DepthGrid::Cell& cell) const {
    constexpr double kFar = 100.0;
    if (!(cell.depth > 0.0F)) return -kFar;
    return patch_.plane_in_submap.signedDistance(T_submap_camera_ * pointOf(cell));
  }
  static double tolerance(const DepthGrid::Cell& cell) {
    return kOnPlane + 2.5 * sensors::depthSigma(static_cast<double>(cell.depth));
  }
  /// Where the cell's ray meets the plane.
  Eigen::Vector3d onPlane(const DepthGrid::Cell& cell) const;

  const DepthGrid& grid_;
  const Pose3& T_submap_camera_;
  Pose3 T_camera_submap_;
  const PlanarPatch& patch_;
  Eigen::Vector3d right_;  ///< along the plane, level
};

Eigen::Vector3d Side::onPlane(const DepthGrid::Cell& cell) const {
  const Eigen::Vector3d eye = T_submap_camera_.translation();
  const Eigen::Vector3d ray =
      T_submap_camera_.linear() * Eigen::Vector3d(static_cast<double>(cell.rayX), static_cast<double>(cell.rayY), 1.0);
  const auto& plane = patch_.plane_in_submap;
  return eye - plane.signedDistance(eye) / plane.normal.dot(ray) * ray;
}

Eigen::Vector3d Side::pointAt(const Eigen::Vector2d& place) const {
  const Eigen::Vector3d& middle = patch_.centroid_in_submap;
  return middle + (place.x() - right_.dot(middle)) * right_ + (place.y() - middle.z()) * Eigen::Vector3d::UnitZ();
}

std::vector<EdgePoint> Side::edge() const {
  std::vector<EdgePoint> points;
  for (const std::uint32_t index : patch_.cells) {
    const int x = static_cast<int>(index) % grid_.width();
    const int y = static_cast<int>(index) / grid_.width();
    for (const auto& [u, v] : {std::pair(x - 1, y), std::pair(x + 1, y), std::pair(x, y - 1), std::pair(x, y + 1)}) {
      if (u < 0 || v < 0 || u >= grid_.width() || v >= grid_.height()) continue;
      const DepthGrid::Cell& next = grid_.at(u, v);
      if (before(next) > -tolerance(next)) continue;
      const Eigen::Vector3d here = onPlane(grid_.at(x, y));
      const Eigen::Vector3d out = onPlane(next) - here;
      const double across = right_.dot(out);
      const bool isAbove = std::abs(out.z()) > std::abs(across);
      if (isAbove && out.z() < 0.0) continue;
      const Eigen::Vector3d middle = here + 0.5 * out;
      points.push_back({{right_.dot(middle), middle.z()}, 0.5 * out.norm(), isAbove ? 0 : across > 0.0 ? 1 : -1});
    }
  }
  return points;
}

Side::Shown Side::at(const Eigen::Vector3d& spot) const {
  const Eigen::Vector3d spot_in_camera = T_camera_submap_ * spot;
  if (!(spot_in_camera.z() > 0.05)) return Shown::kNothing;
  const Eigen::Vector2d pixel = grid_.camera().pixel(spot_in_camera.head<2>() / spot_in_camera.z());
  const double x = (pixel.x() + 0.5) / DepthGrid::kBlock;
  const double y = (pixel.y() + 0.5) / DepthGrid::kBlock;
  if (!(x >= 0.0 && y >= 0.0 && x < grid_.width() && y < grid_.height())) return Shown::kNothing;
  const DepthGrid::Cell& cell = grid_.at(static_cast<int>(x), static_cast<int>(y));
  const double distance = before(cell);
  if (distance > tolerance(cell)) return Shown::kNothing;
  return distance < -tolerance(cell) ? Shown::kPast : Shown::kSide;
}

/// Points of an edge along one slope. Places are turned so that x is uphill.
struct Outline {
  double rise = 0.0;  ///< over run
  std::vector<EdgePoint> points;

  double along(const EdgePoint& p) const { return (p.place.x() + rise * p.place.y()) / std::hypot(1.0, rise); }
  double above(const EdgePoint& p) const { return (p.place.y() - rise * p.place.x()) / std::hypot(1.0, rise); }
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

/// The slope that most of an edge lies along, of what may be treads (one looks on above) and risers (one looks on
/// downhill). `uphill`: 1 to the right, -1 to the left.
std::optional<Outline> findOutline(const std::vector<EdgePoint>& edge, int uphill) {
  Outline outline;
  for (const EdgePoint& p : edge) {
    if (p.past != uphill) outline.points.push_back({{uphill * p.place.x(), p.place.y()}, p.sigma, p.past});
  }
  if (outline.points.size() < kLeastPoints) return std::nullopt;
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
  std::erase_if(outline.points,
                [&](const EdgePoint& p) { return std::abs(outline.above(p) - best.first) > 0.5 * kBand; });
  keepLongestPart(outline);
  const auto& points = outline.points;
  const auto treads = static_cast<double>(std::ranges::count(points, 0, &EdgePoint::past));
  const auto count = static_cast<double>(points.size());
  const bool isSawtooth =
      points.size() >= kLeastPoints && treads > kLeastShare * count && treads < (1.0 - kLeastShare) * count;
  if (!isSawtooth || outline.along(points.back()) - outline.along(points.front()) < kLeastLength) return std::nullopt;
  return outline;
}

/// At the middle of the outline, on the side's plane, x uphill.
Pose3 flightFrame(const Side& side, const Outline& outline, int uphill) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const EdgePoint& p : outline.points) middle += p.place / static_cast<double>(outline.points.size());
  const Eigen::Vector3d direction = uphill * side.right();
  return geometry::fromYawPitchRoll(side.pointAt({uphill * middle.x(), middle.y()}),
                                    std::atan2(direction.y(), direction.x()), 0.0, 0.0);
}

std::vector<FlightPoint> inFrame(const Outline& outline) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const EdgePoint& p : outline.points) middle += p.place / static_cast<double>(outline.points.size());
  std::vector<FlightPoint> points;
  for (const EdgePoint& p : outline.points) {
    points.push_back({{p.place.x() - middle.x(), 0.0, p.place.y() - middle.y()}, p.sigma});
  }
  return points;
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
    bool isThere() const { return solid >= 2 && open >= 2 && missing + filled <= 1; }
  };
  struct Run {
    int lowest = 0;
    int count = 0;
    ProfileCheck::Count spots;
  };

  Tooth tooth(int step) const;
  Run longestRun() const;
  double width(const Run& run, const Pose3& T_submap_camera) const;

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

/// How far the flight reaches behind its side: as far as the view shows without a gap anything below its treads, be it
/// lower treads, the underside or the wall at its far end.
double FlightBeside::width(const Run& run, const Pose3& T_submap_camera) const {
  constexpr double kColumn = 0.1;
  std::array<int, static_cast<std::size_t>(kMostWidth / kColumn)> columns{};
  const Pose3 T_flight_camera = T_submap_flight_.inverse() * T_submap_camera;
  for (int v = 0; v < surfaces_.depth.height(); ++v) {
    for (int u = 0; u < surfaces_.depth.width(); ++u) {
      const DepthGrid::Cell& cell = surfaces_.depth.at(u, v);
      if (!(cell.depth > 0.0F)) continue;
      const Eigen::Vector3d p = T_flight_camera * pointOf(cell);
      const double steps = (p.x() - lattice_.riserAt(run.lowest)) / lattice_.depth;
      const double below = lattice_.treadAt(run.lowest) + steps * lattice_.rise - p.z();
      const double behind = uphill_ * p.y();
      if (steps < 0.0 || steps > run.count || below < -kOnPlane || below > lattice_.rise + kThickness) continue;
      if (behind > 0.0 && behind < kMostWidth) ++columns[static_cast<std::size_t>(behind / kColumn)];
    }
  }
  constexpr int kLeastCells = 3;
  const auto end = std::ranges::find_if(columns, [](int count) { return count < kLeastCells; });
  const double width = kColumn * static_cast<double>(end - columns.begin());
  return width < kLeastWidth || end == columns.end() ? kUsualWidth : width;
}

std::optional<FlightSteps> FlightBeside::steps(const Pose3& T_submap_camera) const {
  const Run run = longestRun();
  if (run.count < static_cast<int>(kLeastSteps)) return std::nullopt;
  const double across = uphill_ * width(run, T_submap_camera);
  FlightSteps found;
  for (int step = run.lowest; step < run.lowest + run.count; ++step) {
    const Eigen::Vector3d edge =
        T_submap_flight_ * Eigen::Vector3d(lattice_.riserAt(step), 0.0, lattice_.treadAt(step));
    found.steps.push_back({.index = step,
                           .riserCells = 1,
                           .least = std::min(0.0, across),
                           .most = std::max(0.0, across),
                           .sigma = sensors::depthSigma((edge - T_submap_camera.translation()).norm())});
  }
  found.count = run.spots;
  found.beginsThere = tooth(run.lowest - 1).missing >= 2;
  return found;
}

std::optional<StaircaseSighting> flightBeside(const RgbdView& view, const Surfaces& surfaces, const Side& side,
                                              const Outline& outline, int uphill) {
  const Pose3 T_submap_flight = flightFrame(side, outline, uphill);
  const auto found = findLattice(inFrame(outline), outline.rise, false);
  if (getenv("Q"))
    fprintf(stderr, "   outline %zu rise %.2f up %d at %.2f %.2f %.2f: lattice %d rough %.2f d %.3f h %.3f\n",
            outline.points.size(), outline.rise, uphill, T_submap_flight.translation().x(),
            T_submap_flight.translation().y(), T_submap_flight.translation().z(), found.has_value(),
            found ? found->roughness : 0, found ? found->lattice.depth : 0, found ? found->lattice.rise : 0);
  if (!found || found->roughness > kMostRoughness) return std::nullopt;
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
      const auto outline = findOutline(edge, uphill);
      auto sighting = outline ? flightBeside(view, surfaces, side, *outline, uphill) : std::nullopt;
      if (sighting) sightings.push_back(std::move(*sighting));
    }
  }
  return sightings;
}

}  // namespace prodomos::perception
