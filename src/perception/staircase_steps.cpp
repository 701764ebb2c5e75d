// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_steps.hpp"

#include "prodomos/geometry/pose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace prodomos::perception {

namespace {

using geometry::Pose3;

constexpr int kLeastSteps = 3;
constexpr double kMostRoughness = 0.6;
constexpr std::size_t kLeastCells = 10;  // of a step
constexpr double kLeastWidth = 0.35;     // metres of a step that must be seen
constexpr double kBin = 0.05;            // metres across
constexpr int kGapBins = 5;              // that a post or a rail may hide
constexpr double kProfile = 0.02;        // metres off the profile, but for depth noise
constexpr double kAside = 0.10;          // metres beyond a step's end, where its side shows
constexpr double kInFront = 0.35;        // metres; what hides a step stands that much nearer
constexpr int kMostStep = 40;            // from the frame's origin, either way
constexpr double kSlab = 0.22;           // metres from a ceiling to the floor above

/// What was seen of one step, in the flight's frame.
struct SeenStep {
  int index = 0;
  std::vector<double> across;  ///< y of its cells
  std::size_t riserCells = 0;
  std::size_t treadCells = 0;
  double least = 0.0;  ///< y of its right end
  double most = 0.0;   ///< y of its left end
  double front = std::numeric_limits<double>::infinity();
  double back = -std::numeric_limits<double>::infinity();
  double sigma = 0.0;  ///< of a cell's depth, the mean

  std::size_t cells() const { return riserCells + treadCells; }
};

/// A cell's place on the profile.
struct PlacedCell {
  StepPlace place;
  Eigen::Vector3d point;
  double sigma;
};

std::vector<PlacedCell> placed(std::span<const StairCell> cells, const StepLattice& lattice,
                               const Pose3& T_submap_flight) {
  const Pose3 T_flight_submap = T_submap_flight.inverse();
  std::vector<PlacedCell> onSteps;
  for (const StairCell& cell : cells) {
    const Eigen::Vector3d point = T_flight_submap * cell.point_in_submap;
    const StepPlace place = lattice.placeOf(point.x(), point.z());
    if (place.distance > kProfile + 2.0 * cell.sigma || std::abs(place.step) > kMostStep) continue;
    onSteps.push_back({place, point, cell.sigma});
  }
  return onSteps;
}

/// Looks along the profile, step by step and column by column across: a step that is there hides what is behind it.
class ProfileCheck {
 public:
  ProfileCheck(const RgbdView& view, const Surfaces& surfaces, const StepLattice& lattice, const Pose3& T_submap_flight)
      : grid_(surfaces.depth),
        lattice_(lattice),
        T_camera_flight_(view.T_submap_camera.inverse() * T_submap_flight),
        T_flight_camera_(T_camera_flight_.inverse()) {}

  struct Count {
    int there = 0;
    int free = 0;  ///< one looks through where it should be
    Count& operator+=(const Count& other) {
      there += other.there;
      free += other.free;
      return *this;
    }
  };

  Count at(int step, double y) const {
    const Eigen::Vector3d eye = T_flight_camera_.translation();
    Count count;
    if (eye.x() < lattice_.riserAt(step)) {
      count += at({lattice_.riserAt(step), y, lattice_.treadAt(step) - 0.5 * lattice_.rise});
    }
    if (eye.z() > lattice_.treadAt(step)) {
      count += at({lattice_.riserAt(step) + 0.5 * lattice_.depth, y, lattice_.treadAt(step)});
    }
    return count;
  }

 private:
  Count at(const Eigen::Vector3d& point_in_flight) const {
    const Eigen::Vector3d expected = T_camera_flight_ * point_in_flight;
    const auto* cell = grid_.cellAt(expected);
    if (cell == nullptr) return {};
    const auto depth = static_cast<double>(cell->depth);
    const double sigma = sensors::depthSigma(depth);
    const Eigen::Vector3d seen = T_flight_camera_ * pointOf(*cell);
    if (lattice_.placeOf(seen.x(), seen.z()).distance < kProfile + 2.0 * sigma &&
        (seen - point_in_flight).norm() < lattice_.depth + 2.0 * sigma) {
      return {1, 0};
    }
    return {0, depth > expected.z() + 0.5 * lattice_.depth + 2.0 * sigma ? 1 : 0};
  }

  const sensors::DepthGrid& grid_;
  const StepLattice& lattice_;
  Pose3 T_camera_flight_;
  Pose3 T_flight_camera_;
};

struct Across {
  double least = 0.0;
  double most = 0.0;
};

/// The widest row of columns in which the steps from `lowest` to `highest` are there rather than looked through.
Across widestRow(const ProfileCheck& check, int lowest, int highest) {
  constexpr int kBins = 60;  // either way
  Across best;
  int first = 0;
  int last = -10 * kBins;
  for (int bin = -kBins; bin < kBins; ++bin) {
    ProfileCheck::Count count;
    for (int step = lowest; step <= highest; ++step) count += check.at(step, (bin + 0.5) * kBin);
    const bool isThrough = count.free > count.there;
    if (isThrough) last = -10 * kBins;
    if (isThrough || count.there == 0) continue;
    if (bin - last > kGapBins) first = bin;
    last = bin;
    if ((last + 1 - first) * kBin > best.most - best.least) best = {first * kBin, (last + 1) * kBin};
  }
  return best;
}

/// Drops steps that are looked through.
void dropThoseNotThere(std::vector<SeenStep>& steps, const ProfileCheck& check, const Across& across) {
  std::erase_if(steps, [&](const SeenStep& step) {
    ProfileCheck::Count count;
    for (double y = across.least + 0.5 * kBin; y < across.most; y += kBin) count += check.at(step.index, y);
    return count.there * kBin < kLeastWidth * 0.5 || count.free > count.there;
  });
}

/// The steps that were seen, upwards.
std::vector<SeenStep> stepsOf(const std::vector<PlacedCell>& cells) {
  std::vector<SeenStep> all(2 * kMostStep + 1);
  for (const PlacedCell& c : cells) {
    SeenStep& step = all[static_cast<std::size_t>(c.place.step + kMostStep)];
    step.index = c.place.step;
    step.across.push_back(c.point.y());
    step.sigma += c.sigma;
    if (c.place.part == StepPart::kRiser) {
      ++step.riserCells;
    } else {
      ++step.treadCells;
      step.front = std::min(step.front, c.point.x());
      step.back = std::max(step.back, c.point.x());
    }
  }
  std::vector<SeenStep> seen;
  for (SeenStep& step : all) {
    if (step.cells() < kLeastCells) continue;
    std::ranges::sort(step.across);
    const std::size_t tail = step.across.size() / 100;
    step.least = step.across[tail];
    step.most = step.across[step.across.size() - 1 - tail];
    step.sigma /= static_cast<double>(step.cells());
    if (step.most - step.least >= kLeastWidth) seen.push_back(std::move(step));
  }
  return seen;
}

/// The longest run of steps one above the other; one in between may be hidden.
std::vector<SeenStep> longestRun(std::vector<SeenStep> steps) {
  std::size_t bestFirst = 0;
  std::size_t bestCount = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0 && steps[i].index - steps[i - 1].index > 2) first = i;
    if (i + 1 - first <= bestCount) continue;
    bestCount = i + 1 - first;
    bestFirst = first;
  }
  const auto begin = steps.begin() + static_cast<std::ptrdiff_t>(bestFirst);
  return {std::make_move_iterator(begin), std::make_move_iterator(begin + static_cast<std::ptrdiff_t>(bestCount))};
}

/// One flight while it is made a sighting of.
class Flight {
 public:
  Flight(const RgbdView& view, const Surfaces& surfaces, const StepLattice& lattice, const Pose3& T_submap_flight,
         std::vector<SeenStep> steps)
      : view_(view),
        surfaces_(surfaces),
        lattice_(lattice),
        T_submap_flight_(T_submap_flight),
        T_camera_flight_(view.T_submap_camera.inverse() * T_submap_flight),
        steps_(std::move(steps)) {}

  StaircaseSighting sighting(double roughness) const;

 private:
  struct Side {
    double y = 0.0;
    bool seen = false;
  };

  const sensors::DepthGrid::Cell* cellAt(const Eigen::Vector3d& point_in_flight) const {
    return surfaces_.depth.cellAt(T_camera_flight_ * point_in_flight);
  }
  double depthOf(const Eigen::Vector3d& point_in_flight) const { return (T_camera_flight_ * point_in_flight).z(); }

  Side sideTo(double sign) const;
  bool headIsSeen() const;
  bool hasLanding() const;
  bool endsAbove() const;
  void tellFoot(StaircaseSighting& sighting) const;
  void tellNewFloor(StaircaseSighting& sighting) const;
  std::optional<double> ceiling_z() const;
  /// Height in the sub-map of tread `step`.
  double tread_z(int step) const { return T_submap_flight_.translation().z() + lattice_.treadAt(step); }
  /// Of the tread that the floor would be.
  int floorStep() const { return static_cast<int>(std::lround((surfaces_.floor_z - tread_z(0)) / lattice_.rise)); }
  bool meetsFloor() const { return std::abs(surfaces_.floor_z - tread_z(floorStep())) < 0.02 + 0.15 * lattice_.rise; }

  const RgbdView& view_;
  const Surfaces& surfaces_;
  StepLattice lattice_;
  Pose3 T_submap_flight_;
  Pose3 T_camera_flight_;
  std::vector<SeenStep> steps_;
};

/// The steps' end to that side: seen where the camera sees past it, onto what is behind or a wall along the flight.
Flight::Side Flight::sideTo(double sign) const {
  std::vector<double> ends;
  double farthest = 0.0;
  for (const SeenStep& step : steps_) {
    const double end = sign > 0.0 ? step.most : step.least;
    farthest = &step == &steps_.front() ? end : sign * std::max(sign * end, sign * farthest);
    const bool tread = step.treadCells > step.riserCells;
    const Eigen::Vector3d aside(lattice_.riserAt(step.index) + (tread ? 0.5 * lattice_.depth : 0.0),
                                end + sign * kAside,
                                lattice_.treadAt(step.index) - (tread ? 0.0 : 0.5 * lattice_.rise));
    const auto* cell = cellAt(aside);
    if (cell != nullptr && static_cast<double>(cell->depth) > depthOf(aside) - kInFront) ends.push_back(end);
  }
  if (ends.size() < 2) return {farthest, false};
  const auto middle = ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2);
  std::ranges::nth_element(ends, middle);
  return {*middle, true};
}

/// A level patch goes on from the last tread, farther than a tread would.
bool Flight::hasLanding() const {
  const SeenStep& last = steps_.back();
  const Pose3 T_flight_submap = T_submap_flight_.inverse();
  return std::ranges::any_of(surfaces_.patches, [&](const PlanarPatch& patch) {
    const Eigen::Vector3d middle = T_flight_submap * patch.centroid_in_submap;
    const double ahead = middle.x() - lattice_.riserAt(last.index);
    return patch.tilt() < 0.2 && patch.plane_in_submap.normal.z() > 0.0 &&
           std::abs(middle.z() - lattice_.treadAt(last.index)) < 0.3 * lattice_.rise && ahead > 0.9 * lattice_.depth &&
           ahead < 3.0 && middle.y() > last.least - 1.0 && middle.y() < last.most + 1.0;
  });
}

/// Where the next riser would be, one looks on.
bool Flight::endsAbove() const {
  const SeenStep& last = steps_.back();
  int free = 0;
  int asked = 0;
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    for (const double up : {0.4, 0.8}) {
      const Eigen::Vector3d point(lattice_.riserAt(last.index + 1), last.least + share * (last.most - last.least),
                                  lattice_.treadAt(last.index) + up * lattice_.rise);
      const auto* cell = cellAt(point);
      if (cell == nullptr) continue;
      ++asked;
      if (static_cast<double>(cell->depth) > depthOf(point) + lattice_.depth + 2.0 * last.sigma) ++free;
    }
  }
  return asked >= 4 && free * 4 >= asked * 3;
}

bool Flight::headIsSeen() const {
  return hasLanding() || endsAbove();
}

std::optional<double> Flight::ceiling_z() const {
  std::optional<double> found;
  for (const PlanarPatch& patch : surfaces_.patches) {
    const double z = patch.centroid_in_submap.z();
    if (patch.tilt() > 0.15 || patch.plane_in_submap.normal.z() > 0.0 || patch.area < 0.3) continue;
    if (z < surfaces_.floor_z + 2.0 || z < tread_z(steps_.back().index) || (found && *found < z)) continue;
    found = z;
  }
  return found;
}

/// The foot is where the steps, continued downwards, meet the floor, should they do so at a riser; else that of the
/// lowest step that was seen.
void Flight::tellFoot(StaircaseSighting& sighting) const {
  const Side left = sideTo(1.0);
  const Side right = sideTo(-1.0);
  sighting.width = left.y - right.y;
  sighting.widthIsWhole = left.seen && right.seen;

  const int lowest = steps_.front().index;
  const int highest = steps_.back().index;
  const int floor = floorStep();
  const bool stands = meetsFloor() && floor < lowest;
  const int first = stands ? floor + 1 : lowest;
  sighting.footIsSeen = stands && first == lowest;
  sighting.descends = highest <= floor;
  const Eigen::Vector3d foot(lattice_.riserAt(first), 0.5 * (left.y + right.y), lattice_.treadAt(first - 1));
  sighting.T_submap_stairs = T_submap_flight_;
  sighting.T_submap_stairs.translation() = T_submap_flight_ * foot;
  for (const SeenStep& step : steps_) {
    sighting.steps.push_back({.z = tread_z(step.index),
                              .along = lattice_.depth * (step.index - first),
                              .depth = lattice_.depth,
                              .width = step.most - step.least});
  }

  double sigma = 0.0;
  for (const SeenStep& step : steps_) sigma += step.sigma / static_cast<double>(steps_.size());
  const double along = stands ? 0.02 + 0.5 * sigma + 0.015 * (lowest - first) : 0.5;
  const double across = sighting.widthIsWhole ? 0.03 : left.seen || right.seen ? 0.3 : 0.5;
  const double turn =
      0.01 + (0.01 + sigma) / std::max(sighting.width, kLeastWidth) / std::sqrt(static_cast<double>(steps_.size()));
  const Eigen::Matrix3d R = T_submap_flight_.linear();
  const Eigen::Vector3d variances = Eigen::Vector3d(along, across, 0.01 + 0.3 * sigma).cwiseAbs2();
  sighting.covariance.topLeftCorner<3, 3>() = R * variances.asDiagonal() * R.transpose();
  sighting.covariance(3, 3) = turn * turn;
}

void Flight::tellNewFloor(StaircaseSighting& sighting) const {
  const int lowest = steps_.front().index;
  const int highest = steps_.back().index;
  if (sighting.descends) {
    sighting.newFloor_z = tread_z(lowest - 1);
    sighting.newFloorSigma = 1.5;
    return;
  }
  sighting.headIsSeen = headIsSeen();
  sighting.newFloor_z = tread_z(highest);
  sighting.newFloorSigma = 0.03;
  if (sighting.headIsSeen) return;
  if (const auto ceiling = ceiling_z()) {
    const double steps = std::round((*ceiling + kSlab - tread_z(0)) / lattice_.rise);
    sighting.newFloor_z = tread_z(static_cast<int>(steps));
    sighting.newFloorSigma = 0.4;
  } else {
    sighting.newFloor_z = tread_z(highest + 1);
    sighting.newFloorSigma = 1.0;
  }
}

StaircaseSighting Flight::sighting(double roughness) const {
  StaircaseSighting sighting;
  sighting.time = view_.time;
  sighting.slope = lattice_.slope();
  tellFoot(sighting);
  tellNewFloor(sighting);
  sighting.evidence =
      -3.0 + static_cast<double>(steps_.size()) + 2.0 * (kMostRoughness - roughness) + (meetsFloor() ? 1.0 : -0.5);
  return sighting;
}

}  // namespace

std::optional<StaircaseSighting> confirmSteps(const RgbdView& view, const Surfaces& surfaces,
                                              std::span<const StairCell> cells, const FoundLattice& found,
                                              const Pose3& T_submap_flight) {
  if (found.roughness > kMostRoughness) return std::nullopt;
  std::vector<PlacedCell> onSteps = placed(cells, found.lattice, T_submap_flight);
  std::vector<SeenStep> steps = longestRun(stepsOf(onSteps));
  if (steps.size() < kLeastSteps) return std::nullopt;
  const ProfileCheck check(view, surfaces, found.lattice, T_submap_flight);
  const Across across = widestRow(check, steps.front().index, steps.back().index);
  std::erase_if(onSteps, [&](const PlacedCell& c) { return c.point.y() < across.least || c.point.y() > across.most; });
  steps = stepsOf(onSteps);
  dropThoseNotThere(steps, check, across);
  steps = longestRun(std::move(steps));
  if (steps.size() < kLeastSteps) return std::nullopt;
  const int lowest = steps.front().index;
  const int highest = steps.back().index;
  StaircaseSighting sighting =
      Flight(view, surfaces, found.lattice, T_submap_flight, std::move(steps)).sighting(found.roughness);
  for (const PlacedCell& c : onSteps) {
    if (c.place.step < lowest || c.place.step > highest) continue;
    sighting.points_in_submap.emplace_back((T_submap_flight * c.point).cast<float>());
  }
  return sighting;
}

}  // namespace prodomos::perception
