// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/surfaces.hpp"

#include "perception/staircase_lattice.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace prodomos::perception {

/// A cell of the depth grid that may show a step.
struct StairCell {
  Eigen::Vector3d point_in_submap = Eigen::Vector3d::Zero();
  double sigma = 0.0;  ///< of its depth, metres
};

/// Looks at spots of a lattice's profile whether the view shows it there.
class ProfileCheck {
 public:
  ProfileCheck(const geometry::Pose3& T_submap_camera, const sensors::DepthGrid& grid, const StepLattice& lattice,
               const geometry::Pose3& T_submap_flight);

  /// Spots that face the camera and that nothing far nearer hides.
  struct Count {
    int there = 0;
    int other = 0;  ///< one looks through where it should be, or something else is in its place

    int asked() const { return there + other; }
    double share() const { return asked() > 0 ? static_cast<double>(there) / asked() : 0.0; }
    Count& operator+=(const Count& count);
  };

  Count riser(int step, double y) const;
  /// `tolerance`: metres that it may lie higher or lower, beside noise.
  Count tread(int step, double y, double tolerance = 0.0) const;
  /// Measured depth less expected one, metres; none where depth is not known.
  std::optional<double> depthBehind(const Eigen::Vector3d& point_in_flight) const;

 private:
  /// Does the edge of that step hide the spot from the camera?
  bool isBehind(int step, const Eigen::Vector3d& spot_in_flight) const;
  Count at(const Eigen::Vector3d& spot_in_flight, const Eigen::Vector3d& normal, double tolerance) const;

  const sensors::DepthGrid& grid_;
  StepLattice lattice_;
  geometry::Pose3 T_camera_flight_;
  geometry::Pose3 T_flight_camera_;
};

/// What was seen of one step, in the flight's frame.
struct SeenStep {
  int index = 0;
  std::size_t riserCells = 0;
  std::size_t treadCells = 0;
  double least = 0.0;  ///< y of its right end
  double most = 0.0;   ///< y of its left end
  double sigma = 0.0;  ///< of a cell's depth, the mean
};

/// Steps one above the other, upwards.
struct FlightSteps {
  std::vector<SeenStep> steps;
  std::vector<Eigen::Vector3d> points_in_flight;
  ProfileCheck::Count count;
  /// Steps below the lowest that may be there unseen; 0: one sees that there is none.
  int mostBelow = std::numeric_limits<int>::max();
};

/// The steps of a lattice one by one: enough of them in a row, each at its place and as wide as a step, with nothing
/// but a step, a floor or what is hidden before the first and after the last.
std::optional<FlightSteps> findSteps(std::span<const StairCell> cells, const StepLattice& lattice,
                                     const geometry::Pose3& T_submap_flight, const ProfileCheck& check);

}  // namespace prodomos::perception
