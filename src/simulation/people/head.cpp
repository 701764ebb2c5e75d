// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people/body.hpp"
#include "simulation/people/loft.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace prodomos::simulation {

namespace {

using Eigen::Vector3d;

constexpr int kAround = 14;
constexpr double kChin = 0.043;         // above the neck's base
constexpr double kHeadHeight = 0.2275;  // chin to crown

/// A level section of the head: share of its height above the chin, half its width, where it begins and ends along x.
struct Section {
  double level;
  double halfWidth;
  double face;
  double nape;
};

constexpr std::array kHeadSections = {
    Section{0.00, 0.022, 0.104, 0.050},  Section{0.05, 0.036, 0.109, 0.020},  Section{0.13, 0.051, 0.108, -0.010},
    Section{0.22, 0.060, 0.108, -0.035}, Section{0.34, 0.067, 0.107, -0.062}, Section{0.44, 0.071, 0.105, -0.078},
    Section{0.51, 0.073, 0.103, -0.084}, Section{0.60, 0.075, 0.109, -0.088}, Section{0.72, 0.076, 0.106, -0.089},
    Section{0.83, 0.070, 0.092, -0.080}, Section{0.91, 0.056, 0.070, -0.060}, Section{0.97, 0.034, 0.042, -0.032},
};

Ring ringOf(const Section& section) {
  return {{(section.face + section.nape) / 2.0, 0.0, kChin + section.level * kHeadHeight},
          {0.0, -section.halfWidth, 0.0},
          {(section.face - section.nape) / 2.0, 0.0, 0.0},
          2.2};
}

std::vector<Ring> ringsOf(const auto& sections) {
  std::vector<Ring> rings;
  rings.reserve(sections.size());
  for (const Section& section : sections) rings.push_back(ringOf(section));
  return rings;
}

/// Hair is a head somewhat larger. Below the hairline it begins behind the face: the head comes through in front.
std::vector<Section> hairSections(Hair style) {
  const double thickness =
      style == Hair::kShaved ? 0.003 : (style == Hair::kShort || style == Hair::kPonytail ? 0.010 : 0.016);
  std::vector<Section> sections;
  if (style == Hair::kLong) {
    sections = {{-0.36, 0.046, -0.055, -0.102},
                {-0.22, 0.064, -0.035, -0.112},
                {-0.05, 0.074, 0.000, -0.108},
                {0.15, 0.079, 0.012, -0.102},
                {0.32, 0.082, 0.018, -0.102}};
  }
  const double nape = style == Hair::kLong ? 0.4 : 0.2;
  for (const Section& head : kHeadSections) {
    if (head.level < nape) continue;
    const double hairline = head.level < 0.45 ? 0.000 : (head.level < 0.65 ? 0.030 : 0.062);
    const bool covered = head.level > 0.8;
    sections.push_back(
        {head.level, head.halfWidth + thickness, covered ? head.face + thickness : hairline, head.nape - thickness});
  }
  return sections;
}

void addPonytail(Surface& hair) {
  const auto ring = [](double x, double level, double radius, const Vector3d& along) {
    const Vector3d side(0.0, -radius, 0.0);
    return Ring{{x, 0.0, kChin + level * kHeadHeight}, side, along.cross(side).normalized() * 0.8 * radius};
  };
  addLoft(hair,
          {ring(-0.090, 0.62, 0.016, {-1.0, 0.0, 0.1}), ring(-0.118, 0.60, 0.024, {-0.8, 0.0, -0.6}),
           ring(-0.132, 0.45, 0.030, {-0.2, 0.0, -1.0}), ring(-0.126, 0.15, 0.032, {0.1, 0.0, -1.0}),
           ring(-0.112, -0.15, 0.022, {0.1, 0.0, -1.0})},
          8, {0.0, 0.03});
}

void addNose(Surface& skin) {
  const auto ring = [](double level, double x, double halfWidth, double depth) {
    return Ring{{x, 0.0, kChin + level * kHeadHeight}, {0.0, -halfWidth, 0.0}, {depth, 0.0, 0.0}};
  };
  addLoft(skin,
          {ring(0.33, 0.105, 0.015, 0.012), ring(0.36, 0.109, 0.017, 0.019), ring(0.45, 0.104, 0.010, 0.014),
           ring(0.56, 0.102, 0.007, 0.006)},
          8, {0.006, 0.002});
}

}  // namespace

Head headOf(const Look& look) {
  Head head;
  addLoft(head.skin, ringsOf(kHeadSections), kAround, {0.004, 0.007});
  addNose(head.skin);
  addLoft(head.hair, ringsOf(hairSections(look.hair)), kAround, {0.01, 0.008});
  if (look.hair == Hair::kPonytail) addPonytail(head.hair);

  const auto height = [](double level) { return kChin + level * kHeadHeight; };
  for (const double side : {-1.0, 1.0}) {
    addEllipsoid(head.skin, {0.008, side * 0.077, height(0.45)}, {0.0, -0.007, 0.0}, {0.016, 0.0, 0.0},
                 {0.0, 0.0, 0.029}, 6);
    addEllipsoid(head.eyes, {0.0945, side * 0.031, height(0.515)}, {0.0, -0.014, 0.0}, {0.006, side * -0.004, 0.0},
                 {0.0, 0.0, 0.006}, 6);
    addEllipsoid(head.irises, {0.0975, side * 0.030, height(0.515)}, {0.0, -0.0075, 0.0}, {0.0045, 0.0, 0.0},
                 {0.0, 0.0, 0.0065}, 6);
    addEllipsoid(head.hair, {0.1, side * 0.033, height(0.585)}, {0.0, -0.019, 0.0}, {0.006, side * -0.005, 0.0},
                 {0.0, 0.0, 0.0045}, 6);
  }
  addEllipsoid(head.lips, {0.1035, 0.0, height(0.205)}, {0.0, -0.023, 0.0}, {0.007, 0.0, 0.0}, {0.0, 0.0, 0.0075}, 6);
  return head;
}

}  // namespace prodomos::simulation
