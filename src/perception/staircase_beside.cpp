// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_beside.hpp"

#include "perception/numeric.hpp"
#include "perception/staircase_lattice.hpp"
#include "perception/staircase_outline.hpp"
#include "perception/staircase_sighting.hpp"
#include "perception/staircase_steps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace prodomos::perception {

namespace {

using geometry::Pose3;
using sensors::DepthGrid;

constexpr double kUpright = 1.35;       // radians of tilt: 77 degrees and more
constexpr double kMostRoughness = 0.6;  // of an outline; its teeth decide
constexpr double kRougher = 0.2;     // than steps seen from the front: posts of rails and odd pixels are in an outline
constexpr int kLeastSteps = 4;       // three alike there may be in a row of things by chance
constexpr int kMostStep = 30;        // from the outline's middle, either way
constexpr double kUsualWidth = 1.2;  // metres, where nothing tells
constexpr double kLeastWidth = 0.6;
constexpr double kMostWidth = 2.5;
constexpr double kGap = 0.25;         // metres across, of what is seen of a flight
constexpr double kAboveTread = 0.02;  // metres, of noise
constexpr double kThickness = 0.5;    // metres of a flight below the inner corners of its steps, at most

/// The steps of a lattice along a side.
class FlightBeside {
 public:
  /// `uphill` as findSawtooths() has it.
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
    /// Something stands before the notch over it, as a rail's post does.
    bool isCovered() const { return solid >= 2 && filled > 0; }
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

/// Steps one above the other; one in between may be hidden or covered.
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
    } else if ((here.isAsked() && !here.isCovered()) || ++hidden > 1) {
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
      if (step < 0.0 || step > run.count || below < -kAboveTread || below > lattice_.rise + kThickness) continue;
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
  auto found = findLattice(points, outline.rise, false);
  if (!found || found->roughness > kMostRoughness) return std::nullopt;
  const Eigen::Vector3d direction = uphill * side.right();
  const Pose3 T_submap_flight = geometry::fromYawPitchRoll(side.pointAt({uphill * middle.x(), middle.y()}),
                                                           std::atan2(direction.y(), direction.x()), 0.0, 0.0);
  const FlightBeside flight(side, surfaces, found->lattice, T_submap_flight, uphill);
  const auto steps = flight.steps(view.T_submap_camera);
  if (!steps) return std::nullopt;
  const ProfileCheck check(view.T_submap_camera, surfaces.depth, found->lattice, T_submap_flight);
  found->roughness -= kRougher;
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
      for (const Outline& outline : findSawtooths(edge, uphill)) {
        auto sighting = flightBeside(view, surfaces, side, outline, uphill);
        if (sighting) sightings.push_back(std::move(*sighting));
      }
    }
  }
  return sightings;
}

}  // namespace prodomos::perception
