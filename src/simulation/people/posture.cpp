// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people/posture.hpp"

#include "prodomos/base/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::simulation {

namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using geometry::Pose3;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
/// Length of a step, and speed, that swing arms and hips as below; as shares of height.
constexpr double kPlainStep = 0.39;
constexpr double kPlainSpeed = 0.65;  // 1/s
/// Knees are never quite straight.
constexpr double kLegReach = 0.998;
/// In steps: the hips are lowest a little before both feet carry.
constexpr double kBobPhase = 0.07;

/// Angles of an arm in the chest's frame, radians.
struct ArmAngles {
  double swing = 0.0;      ///< forward
  double abduction = 0.0;  ///< outward
  double turn = 0.0;       ///< of the bent forearm, inward
  double elbow = 0.0;      ///< 0: straight
};

ArmAngles between(const ArmAngles& a, const ArmAngles& b, double share) {
  return {std::lerp(a.swing, b.swing, share), std::lerp(a.abduction, b.abduction, share),
          std::lerp(a.turn, b.turn, share), std::lerp(a.elbow, b.elbow, share)};
}

/// How this person holds itself, and its slow unrest.
struct Manner {
  explicit Manner(std::uint64_t look) {
    base::Random random(look, "manner of a person");
    for (double& phase : phases) phase = random.uniform(0.0, 2.0 * kPi);
    for (double& period : periods) period = random.uniform(4.0, 11.0);
    standingArms = random.integer(0, 4);
    handsOnDesk = random.uniform() < 0.5;
    lean = random.uniform(-6.0, 9.0) * kDegree;
    feetAhead = random.uniform(-0.08, 0.12);
    armSwing = random.uniform(18.0, 27.0) * kDegree;
  }

  /// Of several independent ones, in [-1, 1].
  double unrest(std::size_t which, double time) const {
    const double second = std::sin(2.0 * kPi * time / (0.37 * periods[which]) + phases[(which + 1) % kCount]);
    return 0.7 * std::sin(2.0 * kPi * time / periods[which] + phases[which]) + 0.3 * second;
  }

  static constexpr std::size_t kCount = 5;
  std::array<double, kCount> phases{};
  std::array<double, kCount> periods{};
  int standingArms = 0;
  bool handsOnDesk = false;
  double lean = 0.0;
  double feetAhead = 0.0;
  double armSwing = 0.0;
};

/// The joint between two bones whose outer ends are given, bent towards `pole`; an end out of reach is drawn near.
Limb bentLimb(const Vector3d& root, const Vector3d& end, double upper, double lower, const Vector3d& pole,
              double hingeSign) {
  const Vector3d reach = end - root;
  const double length = std::clamp(reach.norm(), std::abs(upper - lower) + 1e-3, 0.999 * (upper + lower));
  const Vector3d along = reach.normalized();
  const Vector3d aside = (pole - pole.dot(along) * along).normalized();
  const double foot = (length * length + upper * upper - lower * lower) / (2.0 * length);
  const double bulge = std::sqrt(std::max(upper * upper - foot * foot, 0.0));
  const Vector3d hinge = hingeSign * aside.cross(along);
  return {root, root + foot * along + bulge * aside, root + length * along, hinge, hinge};
}

Vector3d shoulder(const Posture& posture, Side side, double height) {
  return posture.T_floor_chest * Vector3d(0.0, signOf(side) * kProportions.halfShoulders * height,
                                          (kProportions.shoulderHeight - kProportions.neckHeight) * height);
}

Vector3d hip(const Posture& posture, Side side, double height) {
  return posture.T_floor_pelvis * Vector3d(0.0, signOf(side) * kProportions.halfHips * height, 0.0);
}

Vector3d ankle(const Foot& foot, double height) {
  return foot.T_floor_sole * Vector3d(0.0, 0.0, kProportions.ankleHeight * height);
}

/// Flesh at the shoulder goes with the chest, however the elbow is turned.
void settleShoulder(Limb& arm, const Posture& posture) {
  const Vector3d along = (arm.middle - arm.root).normalized();
  const Vector3d left = posture.T_floor_chest.linear().col(1);
  arm.rootHinge = (left - left.dot(along) * along).normalized();
}

Limb swungArm(const Posture& posture, Side side, const ArmAngles& angles, double height) {
  const Eigen::Matrix3d R_floor_upper =
      posture.T_floor_chest.linear() * AngleAxisd(signOf(side) * angles.abduction, Vector3d::UnitX()) *
      AngleAxisd(-angles.swing, Vector3d::UnitY()) * AngleAxisd(-signOf(side) * angles.turn, Vector3d::UnitZ());
  const Eigen::Matrix3d R_floor_lower = R_floor_upper * AngleAxisd(-angles.elbow, Vector3d::UnitY());
  Limb arm;
  arm.root = shoulder(posture, side, height);
  arm.middle = arm.root - kProportions.upperArm * height * R_floor_upper.col(2);
  arm.end = arm.middle - kProportions.forearm * height * R_floor_lower.col(2);
  arm.hinge = R_floor_upper.col(1);
  settleShoulder(arm, posture);
  return arm;
}

Limb bentLeg(const Posture& posture, Side side, double height) {
  const Foot& foot = posture.feet[side];
  const Vector3d pole = posture.T_floor_pelvis.linear().col(0) + foot.T_floor_sole.linear().col(0);
  return bentLimb(hip(posture, side, height), ankle(foot, height), kProportions.thigh * height,
                  kProportions.shank * height, pole, 1.0);
}

/// Pelvis to head: the spine bends evenly between pelvis and chest.
void addSpine(Posture& posture, const Eigen::Matrix3d& R_pelvis_chest, const Eigen::Matrix3d& R_chest_head,
              double height) {
  const double spine = (kProportions.neckHeight - kProportions.hipHeight) * height;
  const Eigen::Matrix3d R_floor_chest = posture.T_floor_pelvis.linear() * R_pelvis_chest;
  posture.T_floor_chest.linear() = R_floor_chest;
  posture.T_floor_chest.translation() = posture.T_floor_pelvis.translation() +
                                        0.38 * spine * posture.T_floor_pelvis.linear().col(2) +
                                        0.62 * spine * R_floor_chest.col(2);
  posture.T_floor_head.linear() = R_floor_chest * R_chest_head;
  posture.T_floor_head.translation() = posture.T_floor_chest.translation();
}

/// The hips swing up and down once a step, highest over the leg that carries; no higher than both legs reach.
double hipHeight(const Posture& posture, double vigour, double steps, double height) {
  constexpr double kSoftness = 0.012;  // metres
  const double length = kLegReach * (kProportions.thigh + kProportions.shank) * height;
  const double upright = kProportions.ankleHeight * height + length;
  const double bob = 0.0125 * height * std::min(vigour, 1.0) * (1.0 + std::cos(2.0 * kPi * (steps + kBobPhase)));
  double sum = std::exp(bob / kSoftness);
  for (const Side side : kSides) {
    const Vector3d hip_in_pelvis = hip(posture, side, height);
    const Vector3d foot = ankle(posture.feet[side], height);
    const double aside = (foot - hip_in_pelvis).head<2>().norm();
    const double above = std::sqrt(std::max(length * length - aside * aside, 0.25 * length * length));
    const double level = hip_in_pelvis.z() - posture.T_floor_pelvis.translation().z();
    sum += std::exp((upright - std::min(foot.z() + above - level, upright + 0.1)) / kSoftness);
  }
  return upright - kSoftness * std::log(sum);
}

ArmAngles standingArm(const Manner& manner, Side side) {
  const ArmAngles hanging{3.0 * kDegree, 8.0 * kDegree, 15.0 * kDegree, 14.0 * kDegree};
  const ArmAngles holding{22.0 * kDegree, 6.0 * kDegree, 28.0 * kDegree, 112.0 * kDegree};
  const ArmAngles clasped{16.0 * kDegree, 9.0 * kDegree, 52.0 * kDegree, 58.0 * kDegree};
  if (manner.standingArms == 1) return clasped;
  if (manner.standingArms == 2 && side == kRight) return holding;
  return hanging;
}

/// Arms go with the other side's leg.
ArmAngles walkingArm(const Manner& manner, Side side, const Stride& stride, double vigour) {
  const double swing = -signOf(side) * std::cos(kPi * stride.steps);
  return {(4.0 * kDegree + manner.armSwing * swing) * vigour, 7.0 * kDegree, 18.0 * kDegree,
          (20.0 + 12.0 * swing) * kDegree};
}

Posture uprightPosture(const Person& person, double time) {
  const Manner manner(person.look);
  const Stride stride = Gait(person).at(time);
  const double height = person.height;
  // Who turns back on the spot takes steps, but does not swing.
  const double vigour =
      std::min({stride.stepLength / (kPlainStep * height), stride.velocity.norm() / (kPlainSpeed * height), 1.4});
  const double rest = std::max(1.0 - vigour, 0.0);
  const double swing = std::cos(kPi * stride.steps);
  const double weight = std::sin(kPi * stride.steps);  // +1 on the left foot

  Posture posture{.pose = stride.pose, .velocity = stride.velocity, .feet = stride.feet};
  const double sway = 0.012 * vigour * weight + 0.007 * rest * manner.unrest(0, time);
  posture.T_floor_pelvis = geometry::toPose3(stride.pose * geometry::Pose2{0.0, sway * height, 0.0});
  posture.T_floor_pelvis.rotate(AngleAxisd(-5.0 * kDegree * vigour * swing, Vector3d::UnitZ()) *
                                AngleAxisd(2.5 * kDegree * vigour * weight, Vector3d::UnitX()));
  posture.T_floor_pelvis.translation().z() = hipHeight(posture, vigour, stride.steps, height);

  const double twist = (7.0 * vigour * swing + 3.0 * rest * manner.unrest(1, time)) * kDegree;
  const double lean = (1.0 + 2.0 * vigour) * kDegree;
  const double look = ((4.0 + 14.0 * rest) * manner.unrest(2, time) - 4.0 * vigour * swing) * kDegree;
  const double nod = (2.0 + 5.0 * rest * manner.unrest(3, time)) * kDegree - lean;
  addSpine(posture,
           (AngleAxisd(twist, Vector3d::UnitZ()) * AngleAxisd(-2.5 * kDegree * vigour * weight, Vector3d::UnitX()) *
            AngleAxisd(lean, Vector3d::UnitY()))
               .toRotationMatrix(),
           (AngleAxisd(look, Vector3d::UnitZ()) * AngleAxisd(nod, Vector3d::UnitY())).toRotationMatrix(), height);
  for (const Side side : kSides) {
    const ArmAngles angles =
        between(standingArm(manner, side), walkingArm(manner, side, stride, vigour), std::min(vigour, 1.0));
    posture.arms[side] = swungArm(posture, side, angles, height);
    posture.legs[side] = bentLeg(posture, side, height);
  }
  return posture;
}

/// Feet below the knees or somewhat ahead of them or behind.
Foot seatedFoot(const Pose3& T_floor_root, const Manner& manner, Side side, double height) {
  const double drop = kSeatedHipHeight - (kProportions.ankleHeight + kProportions.shank) * height;
  const double thigh = kProportions.thigh * height;
  const double ahead = std::sqrt(thigh * thigh - drop * drop) + manner.feetAhead + 0.02 * signOf(side);
  const geometry::Pose2 print{ahead, signOf(side) * (kProportions.halfHips * height + 0.04),
                              signOf(side) * 10.0 * kDegree};
  return {.T_floor_sole = T_floor_root * geometry::toPose3(print)};
}

Limb seatedArm(const Posture& posture, const Pose3& T_floor_root, const Manner& manner, Side side, double time,
               double height) {
  const double sign = signOf(side);
  const double play = 0.01 * manner.unrest(side, 3.0 * time);
  const Vector3d wrist = manner.handsOnDesk ? Vector3d(0.36 + play, sign * (0.13 + play), 0.79)
                                            : Vector3d(0.27 + play, sign * 0.12, kSeatedHipHeight + 0.10);
  const Vector3d pole = T_floor_root.linear() * Vector3d(-1.0, 0.7 * sign, -0.6);
  Limb arm = bentLimb(shoulder(posture, side, height), T_floor_root * wrist, kProportions.upperArm * height,
                      kProportions.forearm * height, pole, -1.0);
  settleShoulder(arm, posture);
  return arm;
}

Posture seatedPosture(const Person& person, double time) {
  const Manner manner(person.look);
  const Vector3d seat(person.way.front().position.x(), person.way.front().position.y(), 0.0);
  Posture posture;
  posture.pose = {seat.x(), seat.y(), person.heading};
  const Pose3 T_floor_root = geometry::toPose3(posture.pose);
  posture.T_floor_pelvis = T_floor_root;
  posture.T_floor_pelvis.translation().z() = kSeatedHipHeight;
  const double twist = 4.0 * kDegree * manner.unrest(1, time);
  const double lean = manner.lean + 2.0 * kDegree * manner.unrest(0, time);
  const double look = 22.0 * kDegree * manner.unrest(2, time);
  const double nod = 6.0 * kDegree + 6.0 * kDegree * manner.unrest(3, time) - lean;
  addSpine(posture, (AngleAxisd(twist, Vector3d::UnitZ()) * AngleAxisd(lean, Vector3d::UnitY())).toRotationMatrix(),
           (AngleAxisd(look, Vector3d::UnitZ()) * AngleAxisd(nod, Vector3d::UnitY())).toRotationMatrix(),
           person.height);
  for (const Side side : kSides) {
    posture.feet[side] = seatedFoot(T_floor_root, manner, side, person.height);
    posture.legs[side] = bentLeg(posture, side, person.height);
    posture.arms[side] = seatedArm(posture, T_floor_root, manner, side, time, person.height);
  }
  return posture;
}

}  // namespace

Posture postureOf(const Person& person, double time) {
  return person.sits ? seatedPosture(person, time) : uprightPosture(person, time);
}

}  // namespace prodomos::simulation
