// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace prodomos::simulation {

/// Sides of a body, as indices: pose estimators name the right one first.
enum Side { kRight = 0, kLeft = 1 };
inline constexpr std::array kSides{kRight, kLeft};
/// +1 to the left, -1 to the right: the sign of y in a body's frames.
constexpr double signOf(Side side) {
  return side == kLeft ? 1.0 : -1.0;
}

/// How a foot stands or swings.
struct Foot {
  geometry::Pose3 T_floor_sole = geometry::Pose3::Identity();  ///< below the ankle on the sole; x-axis to the toes
  double toeBend = 0.0;  ///< radians that the toes are bent up against the sole, so that they stay level
};

/// Of one moment.
struct Stride {
  geometry::Pose2 pose;                                ///< of the body on the floor
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s
  double steps = 0.0;                                  ///< taken so far; whole where the person stands
  double stepLength = 0.0;                             ///< metres at this speed; 0 where the person stands
  std::array<Foot, 2> feet;                            ///< by Side
};

/// A person's way on foot. Positions are those of the way, averaged over kSmoothing to either side, so that one starts,
/// stops and turns corners as people do; the heading turns in that time. Feet stand still between steps: the n-th step
/// is set down where the body will be while it stands on it.
class Gait {
 public:
  /// Of a person that checkPerson() accepts.
  explicit Gait(const Person& person);

  Stride at(double time) const;

 private:
  /// x, y, heading, steps taken, length of a step.
  using Progress = Eigen::Matrix<double, 5, 1>;
  /// A stretch of the way: all runs evenly from `first` to `last`.
  struct Leg {
    double begin = 0.0;
    double end = 0.0;
    Progress first = Progress::Zero();
    Progress last = Progress::Zero();
    double steps = 0.0;  ///< that it takes, those for turning first included
    double turningSteps = 0.0;

    bool moves() const { return first.head<2>() != last.head<2>(); }
    Progress at(double time) const;
  };
  /// From standing to standing; begins and ends with both feet side by side.
  struct Walk {
    double begin = 0.0;
    double end = 0.0;
    int firstStep = 0;
    int endStep = 0;
  };

  void addLegs(const Person& person);
  void joinWalks();
  void numberSteps(std::size_t firstLeg, std::size_t endLeg);
  Progress rawAt(double time) const;
  Progress smoothedAt(double time) const;
  geometry::Pose2 poseAt(double time) const;
  double timeOfStep(const Walk& walk, double steps) const;
  geometry::Pose2 footprint(int step) const;
  bool beginsWalk(int step) const;
  double strideShare(int step) const;
  Foot carryingFoot(int step, double phase) const;
  Foot steppingFoot(int step, double phase) const;

  double height_;
  std::vector<Leg> legs_;
  std::vector<Walk> walks_;
};

}  // namespace prodomos::simulation
