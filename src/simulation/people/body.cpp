// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people/body.hpp"

#include "simulation/people/loft.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace prodomos::simulation {

namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using geometry::Pose3;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kAroundTrunk = 16;
constexpr int kAroundLimb = 10;

/// A cross section of the trunk: above the hip joints, half axes, and how far its middle lies ahead of the spine.
struct TrunkSection {
  double z;
  double halfWidth;
  double halfDepth;
  double ahead;
};

constexpr std::array kManTrunk = {
    TrunkSection{0.020, 0.171, 0.122, -0.010}, TrunkSection{0.060, 0.166, 0.117, -0.004},
    TrunkSection{0.110, 0.157, 0.108, 0.004},  TrunkSection{0.180, 0.151, 0.104, 0.008},
    TrunkSection{0.270, 0.157, 0.111, 0.008},  TrunkSection{0.350, 0.166, 0.118, 0.006},
    TrunkSection{0.410, 0.172, 0.117, 0.002},  TrunkSection{0.455, 0.182, 0.102, -0.006},
    TrunkSection{0.492, 0.172, 0.080, -0.012}, TrunkSection{0.517, 0.130, 0.067, -0.014},
    TrunkSection{0.543, 0.085, 0.061, -0.009}, TrunkSection{0.560, 0.066, 0.061, -0.002},
};
constexpr std::array kWomanTrunk = {
    TrunkSection{0.020, 0.178, 0.124, -0.014}, TrunkSection{0.060, 0.170, 0.117, -0.006},
    TrunkSection{0.110, 0.152, 0.104, 0.004},  TrunkSection{0.180, 0.132, 0.094, 0.008},
    TrunkSection{0.260, 0.139, 0.104, 0.012},  TrunkSection{0.340, 0.152, 0.126, 0.020},
    TrunkSection{0.410, 0.160, 0.112, 0.008},  TrunkSection{0.455, 0.171, 0.092, -0.006},
    TrunkSection{0.492, 0.161, 0.073, -0.012}, TrunkSection{0.517, 0.120, 0.062, -0.014},
    TrunkSection{0.543, 0.078, 0.056, -0.009}, TrunkSection{0.560, 0.060, 0.055, -0.003},
};
/// Of the trousers' seat.
constexpr std::array kSeat = {
    TrunkSection{-0.080, 0.060, 0.066, -0.018}, TrunkSection{-0.045, 0.128, 0.098, -0.018},
    TrunkSection{0.000, 0.166, 0.116, -0.014},  TrunkSection{0.060, 0.161, 0.111, -0.004},
    TrunkSection{0.118, 0.150, 0.103, 0.004},
};

/// A cross section of a limb: 0 at its root, 1 at elbow or knee, 2 at its end; half axes across and along the bend.
struct LimbSection {
  double t;
  double halfWidth;
  double halfDepth;
  double ahead;
};

constexpr std::array kArm = {
    LimbSection{0.00, 0.052, 0.056, 0.0}, LimbSection{0.20, 0.050, 0.054, 0.0}, LimbSection{0.50, 0.043, 0.046, 0.0},
    LimbSection{0.82, 0.039, 0.042, 0.0}, LimbSection{1.00, 0.038, 0.040, 0.0}, LimbSection{1.20, 0.039, 0.041, 0.0},
    LimbSection{1.50, 0.034, 0.036, 0.0}, LimbSection{1.80, 0.026, 0.029, 0.0}, LimbSection{2.00, 0.021, 0.027, 0.0},
};
constexpr std::array kLeg = {
    LimbSection{0.00, 0.083, 0.092, -0.004}, LimbSection{0.25, 0.081, 0.088, 0.000},
    LimbSection{0.55, 0.072, 0.078, 0.002},  LimbSection{0.85, 0.061, 0.065, 0.002},
    LimbSection{1.00, 0.058, 0.062, 0.002},  LimbSection{1.15, 0.056, 0.061, -0.004},
    LimbSection{1.35, 0.057, 0.064, -0.010}, LimbSection{1.65, 0.052, 0.057, -0.006},
    LimbSection{1.88, 0.051, 0.056, -0.004}, LimbSection{1.98, 0.053, 0.060, -0.004},
};

/// Joins what is lofted: all lengths are those of kModelHeight, times `scale`.
class Tailor {
 public:
  Tailor(const Posture& posture, const Look& look, double height)
      : posture_(posture), look_(look), height_(height), scale_(height / kModelHeight) {}

  void addTrunk(Surface& top, Surface& inner, Surface& trousers, Surface& belt) const;
  void addNeck(Surface& skin) const;
  void addArm(Side side, Surface& skin, Surface& top) const;
  void addHand(Side side, Surface& skin) const;
  void addLeg(Side side, Surface& trousers) const;
  void addShoe(Side side, Surface& shoe, Surface& sole) const;
  Pose3 T_floor_head() const { return posture_.T_floor_head; }
  double scale() const { return scale_; }

 private:
  Pose3 spineAt(double z) const;
  Ring trunkRing(const TrunkSection& section, double ease) const;
  Ring limbRing(const Limb& limb, const LimbSection& section, double girth, double ease) const;
  std::vector<Ring> limbRings(const Limb& limb, std::span<const LimbSection> sections, double from, double to,
                              double girth, double ease) const;
  std::span<const TrunkSection> trunk() const {
    return look_.female ? std::span<const TrunkSection>(kWomanTrunk) : std::span<const TrunkSection>(kManTrunk);
  }
  std::vector<Ring> shoulderRings(Side side, double girth, double ease) const;
  bool longSleeves() const { return look_.top != Top::kTShirt; }
  bool tucked() const { return look_.top == Top::kShirt; }
  /// How far cloth stands off, metres.
  double ease() const { return look_.top == Top::kJacket ? 0.016 : (look_.top == Top::kSweater ? 0.010 : 0.005); }

  const Posture& posture_;
  const Look& look_;
  double height_;
  double scale_;
};

double smoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The frame of the spine at that height above the hip joints: it bends between pelvis and chest.
Pose3 Tailor::spineAt(double z) const {
  const double spine = (kProportions.neckHeight - kProportions.hipHeight) * height_;
  const double share = smoothStep((z / spine - 0.15) / 0.6);
  const Pose3& pelvis = posture_.T_floor_pelvis;
  const Pose3& chest = posture_.T_floor_chest;
  Pose3 T_floor_spine = Pose3::Identity();
  T_floor_spine.linear() =
      Eigen::Quaterniond(pelvis.linear()).slerp(share, Eigen::Quaterniond(chest.linear())).toRotationMatrix();
  T_floor_spine.translation() =
      (1.0 - share) * (pelvis * Vector3d(0.0, 0.0, z)) + share * (chest * Vector3d(0.0, 0.0, z - spine));
  return T_floor_spine;
}

Ring Tailor::trunkRing(const TrunkSection& section, double ease) const {
  const Pose3 T_floor_section = spineAt(section.z * scale_);
  // The neck and the shoulders do not grow with the belly.
  const double girth = std::lerp(look_.girth, 1.0, smoothStep((section.z - 0.4) / 0.1)) * scale_;
  return {T_floor_section * Vector3d(section.ahead * scale_, 0.0, 0.0),
          -(section.halfWidth * girth + ease) * T_floor_section.linear().col(1),
          (section.halfDepth * girth + ease) * T_floor_section.linear().col(0), 2.4};
}

void Tailor::addTrunk(Surface& top, Surface& inner, Surface& trousers, Surface& belt) const {
  std::vector<Ring> seat;
  seat.reserve(kSeat.size());
  for (const auto& section : kSeat) seat.push_back(trunkRing(section, 0.003));
  addLoft(trousers, seat, kAroundTrunk, {0.03 * scale_, 0.0});

  std::vector<Ring> coat;
  for (const auto& section : trunk()) {
    if (tucked() && section.z < 0.1) continue;
    // Cloth lies on the shoulders.
    const double loose = section.z < 0.04 ? ease() + 0.008 : ease();
    coat.push_back(trunkRing(section, section.z > 0.5 ? 0.004 : loose));
  }
  addLoft(top, coat, kAroundTrunk, {tucked() ? 0.0 : 0.004, 0.0});
  if (tucked()) {
    addLoft(belt, {trunkRing({0.095, 0.153, 0.105, 0.004}, 0.008), trunkRing({0.130, 0.151, 0.104, 0.005}, 0.008)},
            kAroundTrunk, {0.003, 0.003});
  }

  // A placket down the front, or the gap of an open jacket; and a collar.
  const double halfGap = look_.top == Top::kJacket ? 0.045 : 0.016;
  const bool opens = look_.top == Top::kJacket || look_.top == Top::kShirt;
  std::vector<Ring> strip;
  for (const auto& section : trunk()) {
    if (!opens || section.z < (tucked() ? 0.1 : 0.0) || section.z > 0.53) continue;
    Ring ring = trunkRing(section, section.z > 0.5 ? 0.004 : ease());
    const Vector3d front = ring.front.normalized();
    ring.center += ring.front - 0.006 * front;
    ring.front = 0.009 * front;
    ring.side = halfGap * scale_ * ring.side.normalized();
    strip.push_back(ring);
  }
  if (opens) addLoft(inner, strip, 8, {0.002, 0.002});
  TrunkSection neckline = trunk().back();
  std::vector<Ring> collar{trunkRing(neckline, 0.005)};
  neckline.z += 0.02;
  neckline.ahead += 0.004;
  collar.push_back(trunkRing(neckline, 0.003));
  addLoft(inner, collar, kAroundTrunk);
}

void Tailor::addNeck(Surface& skin) const {
  const Pose3& chest = posture_.T_floor_chest;
  const Pose3& head = posture_.T_floor_head;
  const double radius = (look_.female ? 0.050 : 0.058) * scale_;
  const auto ring = [&](const Pose3& frame, double x, double z, double factor) {
    return Ring{frame * Vector3d(x * scale_, 0.0, z * scale_), -factor * radius * frame.linear().col(1),
                factor * 1.05 * radius * frame.linear().col(0)};
  };
  addLoft(skin,
          {ring(chest, -0.008, -0.01, 0.92), ring(chest, 0.002, 0.03, 0.96), ring(head, 0.010, 0.07, 0.96),
           ring(head, 0.014, 0.11, 0.95)},
          14, {0.01, 0.01});
}

/// Near its joint a limb is a curve (a quadratic Bezier through it), not a kink.
Ring Tailor::limbRing(const Limb& limb, const LimbSection& section, double girth, double ease) const {
  constexpr double kBend = 0.28;
  const Vector3d upper = limb.middle - limb.root;
  const Vector3d lower = limb.end - limb.middle;
  const double u = section.t - 1.0;
  Vector3d center = limb.middle + u * (u < 0.0 ? upper : lower);
  Vector3d tangent = u < 0.0 ? upper : lower;
  if (std::abs(u) < kBend) {
    const double s = (u + kBend) / (2.0 * kBend);
    center = limb.middle - kBend * (1.0 - s) * (1.0 - s) * upper + kBend * s * s * lower;
    tangent = (1.0 - s) * upper + s * lower;
  }
  tangent.normalize();
  const Vector3d hinge = limb.rootHinge + std::min(section.t, 1.0) * (limb.hinge - limb.rootHinge);
  const Vector3d front = tangent.cross(hinge).normalized();
  return {center + section.ahead * scale_ * front, (section.halfWidth * girth * scale_ + ease) * front.cross(tangent),
          (section.halfDepth * girth * scale_ + ease) * front, 2.0};
}

std::vector<Ring> Tailor::limbRings(const Limb& limb, std::span<const LimbSection> sections, double from, double to,
                                    double girth, double ease) const {
  const auto at = [&](double t) {
    const auto next = std::ranges::upper_bound(sections, t, {}, &LimbSection::t);
    if (next == sections.end()) return sections.back();
    const auto& a = *std::prev(next);
    const double share = (t - a.t) / (next->t - a.t);
    return LimbSection{t, std::lerp(a.halfWidth, next->halfWidth, share),
                       std::lerp(a.halfDepth, next->halfDepth, share), std::lerp(a.ahead, next->ahead, share)};
  };
  std::vector<Ring> rings{limbRing(limb, at(from), girth, ease)};
  for (const auto& section : sections) {
    if (section.t > from && section.t < to) rings.push_back(limbRing(limb, section, girth, ease));
  }
  rings.push_back(limbRing(limb, at(to), girth, ease));
  return rings;
}

/// From within the trunk over the shoulder, where the loft turns from sideways to along the arm.
std::vector<Ring> Tailor::shoulderRings(Side side, double girth, double ease) const {
  const Limb& arm = posture_.arms[side];
  const Vector3d along = (arm.middle - arm.root).normalized();
  const Vector3d front = along.cross(arm.rootHinge);
  const Vector3d left = posture_.T_floor_chest.linear().col(1);
  const Vector3d outward = signOf(side) * (left - left.dot(front) * front).normalized();
  const auto ring = [&](double inward, double sideways, double height, double depth) {
    const Vector3d tangent = (sideways * outward + (1.0 - sideways) * along).normalized();
    return Ring{arm.root - inward * scale_ * outward, (height * girth * scale_ + ease) * front.cross(tangent),
                (depth * girth * scale_ + ease) * front};
  };
  return {ring(0.080, 1.0, 0.020, 0.030), ring(0.040, 0.9, 0.033, 0.048), ring(0.010, 0.6, 0.040, 0.054),
          ring(0.002, 0.25, 0.045, 0.054)};
}

void Tailor::addArm(Side side, Surface& skin, Surface& top) const {
  const Limb& arm = posture_.arms[side];
  const double girth = (look_.female ? 0.88 : 1.0) * look_.girth;
  addLoft(skin, limbRings(arm, kArm, longSleeves() ? 1.75 : 0.55, 2.0, girth, 0.0), kAroundLimb);
  const double loose = std::min(ease(), 0.010) + (longSleeves() ? 0.004 : 0.007);
  std::vector<Ring> sleeve = shoulderRings(side, girth, loose);
  const auto tube = limbRings(arm, kArm, 0.2, longSleeves() ? 1.93 : 0.72, girth, loose);
  sleeve.insert(sleeve.end(), tube.begin(), tube.end());
  addLoft(top, sleeve, kAroundLimb);
}

void Tailor::addHand(Side side, Surface& skin) const {
  const Limb& arm = posture_.arms[side];
  const Vector3d along = (arm.end - arm.middle).normalized();
  // Palms face the thighs of arms that hang, and down where forearms are level.
  const double level = 1.0 - std::max(-along.z(), 0.0);
  const AngleAxisd turn(signOf(side) * level * 75.0 * kDegree, along);
  const Vector3d across = turn * arm.hinge;
  const Vector3d thumbwards = across.cross(-along);
  const auto ring = [&](double x, double y, double thickness, double width) {
    return Ring{arm.end + scale_ * (x * along + y * thumbwards), scale_ * thickness * across,
                scale_ * width * thumbwards, 2.3};
  };
  addLoft(skin,
          {ring(-0.005, 0.0, 0.021, 0.027), ring(0.045, 0.002, 0.018, 0.038), ring(0.085, 0.001, 0.015, 0.042),
           ring(0.135, -0.002, 0.012, 0.035), ring(0.165, -0.004, 0.009, 0.025)},
          8, {0.0, 0.010});
  addLoft(skin, {ring(0.02, 0.020, 0.013, 0.014), ring(0.055, 0.042, 0.012, 0.013), ring(0.09, 0.052, 0.009, 0.010)}, 6,
          {0.0, 0.010});
}

void Tailor::addLeg(Side side, Surface& trousers) const {
  addLoft(trousers, limbRings(posture_.legs[side], kLeg, 0.0, 1.98, look_.girth, 0.004), kAroundLimb + 2,
          {0.07 * scale_, 0.003});
}

/// Along the foot: half width and height of the shoe; ahead of the ball it bends.
void Tailor::addShoe(Side side, Surface& shoe, Surface& sole) const {
  struct ShoeSection {
    double x;
    double halfWidth;
    double height;
  };
  constexpr std::array kShoe = {ShoeSection{-0.055, 0.027, 0.062}, ShoeSection{-0.030, 0.035, 0.080},
                                ShoeSection{0.005, 0.037, 0.090},  ShoeSection{0.050, 0.039, 0.078},
                                ShoeSection{0.095, 0.045, 0.060},  ShoeSection{0.126, 0.047, 0.050},
                                ShoeSection{0.160, 0.043, 0.042},  ShoeSection{0.188, 0.030, 0.034}};
  constexpr double kBall = 0.126;
  constexpr double kSole = 0.018;
  const Foot& foot = posture_.feet[side];
  const auto rings = [&](double height, double wider) {
    std::vector<Ring> all;
    all.reserve(kShoe.size());
    for (const auto& section : kShoe) {
      Pose3 T_floor_ball = foot.T_floor_sole;
      T_floor_ball.translate(Vector3d(kBall * scale_, 0.0, 0.0));
      if (section.x > kBall) T_floor_ball.rotate(AngleAxisd(-foot.toeBend, Vector3d::UnitY()));
      const double top = std::min(section.height, height) * scale_;
      all.push_back({T_floor_ball * Vector3d((section.x - kBall) * scale_, 0.0, top / 2.0),
                     (section.halfWidth * scale_ + wider) * T_floor_ball.linear().col(1),
                     top / 2.0 * T_floor_ball.linear().col(2), 2.8});
    }
    return all;
  };
  addLoft(shoe, rings(1.0, 0.0), 10, {0.012 * scale_, 0.014 * scale_});
  addLoft(sole, rings(kSole, 0.004), 8, {0.016 * scale_, 0.018 * scale_});
}

}  // namespace

std::vector<Surface> bodyOf(const Posture& posture, const Look& look, double height) {
  const Tailor tailor(posture, look, height);
  Pose3 T_floor_head = tailor.T_floor_head();
  Head head = headOf(look);
  for (Surface* part : {&head.skin, &head.hair, &head.lips, &head.eyes, &head.irises}) {
    for (auto& vertex : part->vertices) vertex *= static_cast<float>(tailor.scale());
    *part = transformed(T_floor_head, std::move(*part));
  }

  Surface skin = std::move(head.skin);
  Surface top;
  Surface inner;
  Surface trousers;
  Surface belt;
  Surface shoes;
  Surface soles;
  tailor.addNeck(skin);
  tailor.addTrunk(top, inner, trousers, belt);
  for (const Side side : kSides) {
    tailor.addArm(side, skin, top);
    tailor.addHand(side, skin);
    tailor.addLeg(side, trousers);
    tailor.addShoe(side, shoes, soles);
  }

  const Material lips{.color = {168, 92, 84}};
  const Material white{.color = {205, 200, 194}};
  const Material iris{.color = {42, 34, 30}};
  std::vector<Surface> body;
  const auto add = [&](Surface& surface, const Material& material) {
    if (surface.triangles.empty()) return;
    surface.material = material;
    body.push_back(std::move(surface));
  };
  add(skin, look.skinMaterial);
  add(head.hair, look.hairMaterial);
  add(head.lips, lips);
  add(head.eyes, white);
  add(head.irises, iris);
  add(top, look.topMaterial);
  add(inner, look.innerMaterial);
  add(trousers, look.trousersMaterial);
  add(belt, look.beltMaterial);
  add(shoes, look.shoeMaterial);
  add(soles, look.soleMaterial);
  return body;
}

}  // namespace prodomos::simulation
