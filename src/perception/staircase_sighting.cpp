// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_sighting.hpp"

#include "prodomos/geometry/pose.hpp"

#include "perception/numeric.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prodomos::perception {

namespace {

using geometry::Pose3;

constexpr double kLeastWidth = 0.35;  // metres, for how well a flight's direction is known
constexpr double kAside = 0.10;       // metres beyond a step's end, where its side shows
constexpr double kInFront = 0.35;     // metres; what hides a step stands that much nearer
constexpr double kSlab = 0.22;        // metres from a ceiling to the floor above

/// One flight while it is made a sighting of.
class Flight {
 public:
  Flight(const Surfaces& surfaces, const StepLattice& lattice, const Pose3& T_submap_flight, const FlightSteps& flight,
         const ProfileCheck& check)
      : surfaces_(surfaces),
        lattice_(lattice),
        T_submap_flight_(T_submap_flight),
        steps_(flight.steps),
        mostBelow_(flight.mostBelow),
        check_(check) {}

  void tellFoot(StaircaseSighting& sighting) const;
  void tellNewFloor(StaircaseSighting& sighting) const;
  bool meetsFloor() const {
    return std::abs(surfaces_.floor_z - heightOfTread(floorStep())) < 0.02 + 0.15 * lattice_.rise;
  }

 private:
  struct Side {
    double y = 0.0;
    bool seen = false;
  };

  Side sideTo(double sign) const;
  bool headIsSeen() const;
  bool hasLanding() const;
  bool endsAbove() const;
  std::optional<double> ceilingHeight() const;
  /// Height in the sub-map of tread `step`.
  double heightOfTread(int step) const { return T_submap_flight_.translation().z() + lattice_.treadAt(step); }
  /// Of the tread that the floor would be.
  int floorStep() const {
    return static_cast<int>(std::lround((surfaces_.floor_z - heightOfTread(0)) / lattice_.rise));
  }

  const Surfaces& surfaces_;
  const StepLattice& lattice_;
  const Pose3& T_submap_flight_;
  const std::vector<SeenStep>& steps_;
  int mostBelow_;
  const ProfileCheck& check_;
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
    const auto behind = check_.depthBehind(aside);
    if (behind && *behind > -kInFront) ends.push_back(end);
  }
  if (ends.size() < 2) return {farthest, false};
  return {median(std::move(ends)), true};
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
      const auto behind = check_.depthBehind(point);
      if (!behind) continue;
      ++asked;
      if (*behind > lattice_.depth + 2.0 * last.sigma) ++free;
    }
  }
  return asked >= 4 && free * 4 >= asked * 3;
}

bool Flight::headIsSeen() const {
  return hasLanding() || endsAbove();
}

std::optional<double> Flight::ceilingHeight() const {
  std::optional<double> found;
  for (const PlanarPatch& patch : surfaces_.patches) {
    const double z = patch.centroid_in_submap.z();
    if (patch.tilt() > 0.15 || patch.plane_in_submap.normal.z() > 0.0 || patch.area < 0.3) continue;
    if (z < surfaces_.floor_z + 2.0 || z < heightOfTread(steps_.back().index) || (found && *found < z)) continue;
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
  const bool stands = meetsFloor() && floor < lowest && lowest - floor - 1 <= mostBelow_;
  const int first = stands ? floor + 1 : lowest;
  sighting.footIsSeen = stands && first == lowest;
  sighting.descends = highest <= floor;
  const Eigen::Vector3d foot(lattice_.riserAt(first), 0.5 * (left.y + right.y), lattice_.treadAt(first - 1));
  sighting.T_submap_stairs = T_submap_flight_;
  sighting.T_submap_stairs.translation() = T_submap_flight_ * foot;
  for (const SeenStep& step : steps_) {
    sighting.steps.push_back({.z = heightOfTread(step.index),
                              .along = lattice_.depth * (step.index - first),
                              .depth = lattice_.depth,
                              .width = step.most - step.least});
  }

  double sigma = 0.0;
  for (const SeenStep& step : steps_) sigma += step.sigma / static_cast<double>(steps_.size());
  const double along = stands || mostBelow_ == 0 ? 0.02 + 0.5 * sigma + 0.015 * (lowest - first) : 0.5;
  const double across = sighting.widthIsWhole ? 0.03 : left.seen || right.seen ? 0.3 : 0.5;
  const double turn =
      0.01 + (0.01 + sigma) / std::max(sighting.width, kLeastWidth) / std::sqrt(static_cast<double>(steps_.size()));
  const Eigen::Matrix3d axes = T_submap_flight_.linear();
  const Eigen::Vector3d variances = Eigen::Vector3d(along, across, 0.01 + 0.3 * sigma).cwiseAbs2();
  sighting.covariance.topLeftCorner<3, 3>() = axes * variances.asDiagonal() * axes.transpose();
  sighting.covariance(3, 3) = turn * turn;
}

void Flight::tellNewFloor(StaircaseSighting& sighting) const {
  const int lowest = steps_.front().index;
  const int highest = steps_.back().index;
  if (sighting.descends) {
    sighting.newFloor_z = heightOfTread(lowest - 1);
    sighting.newFloorSigma = 1.5;
    return;
  }
  sighting.headIsSeen = headIsSeen();
  sighting.newFloor_z = heightOfTread(highest);
  sighting.newFloorSigma = 0.03;
  if (sighting.headIsSeen) return;
  if (const auto ceiling = ceilingHeight()) {
    const double steps = std::round((*ceiling + kSlab - heightOfTread(0)) / lattice_.rise);
    sighting.newFloor_z = heightOfTread(static_cast<int>(steps));
    // The more of it is out of sight, the likelier there is a landing in between.
    sighting.newFloorSigma = 0.15 + 0.35 * std::max(sighting.newFloor_z - heightOfTread(highest), 0.0);
  } else {
    sighting.newFloor_z = heightOfTread(highest + 1);
    sighting.newFloorSigma = 1.0;
  }
}

/// Metres by which two rises and a tread together are longer than anybody's pace (Blondel 1675; builders keep to 0.6 to
/// 0.65 m): boxes piled up like steps are so. Low and narrow steps there are.
double overlong(const StepLattice& lattice) {
  constexpr double kLongestPace = 0.72;
  return std::max(0.0, 2.0 * lattice.rise + lattice.depth - kLongestPace);
}

/// Log-odds. Three steps may be a sofa's; the more steps, the better they fit and the surer the floor they stand on,
/// the less else it can be.
double evidenceOf(const FlightSteps& flight, const FoundLattice& found, bool meetsFloor) {
  const auto steps = static_cast<double>(flight.steps.size());
  return -4.0 + std::min(steps, 8.0) + 4.0 * (flight.count.share() - 0.8) + 4.0 * (0.4 - found.roughness) -
         50.0 * overlong(found.lattice) + (meetsFloor ? 1.0 : -1.0);
}

}  // namespace

StaircaseSighting sightingOf(const RgbdView& view, const Surfaces& surfaces, const FoundLattice& found,
                             const Pose3& T_submap_flight, const FlightSteps& steps, const ProfileCheck& check) {
  const Flight flight(surfaces, found.lattice, T_submap_flight, steps, check);
  StaircaseSighting sighting;
  sighting.time = view.time;
  sighting.slope = found.lattice.slope();
  flight.tellFoot(sighting);
  flight.tellNewFloor(sighting);
  sighting.evidence = evidenceOf(steps, found, flight.meetsFloor());
  for (const Eigen::Vector3d& point : steps.points_in_flight) {
    sighting.points_in_submap.emplace_back((T_submap_flight * point).cast<float>());
  }
  return sighting;
}

}  // namespace prodomos::perception
