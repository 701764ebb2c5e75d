// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/furniture_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

/// Plants, appliances, sanitary ware, lamps and what lies in the way.
namespace prodomos::simulation {

namespace {

/// A pot with blades that hang over, or a crown on a stem.
void plant(Shape& shape, FurnitureLook& look) {
  const auto pot = shape.use(look.own().uniform() < 0.5 ? FurnitureLook::plain({150, 88, 62}) : look.paint);
  const auto green = shape.use(look.leaves());
  const double radius = 0.3 * std::min(shape.depth(), shape.width());
  const double rim = std::min(0.4, 0.35 * shape.height());
  shape.cone(pot, {0.0, 0.0}, 0.75 * radius, radius, 0.0, rim);
  const bool isTree = shape.height() > 1.0 && look.own().uniform() < 0.5;
  const double root = isTree ? 0.55 * shape.height() : rim;
  if (isTree) {
    const auto stem = shape.use(FurnitureLook::plain({92, 70, 50}));
    shape.cylinder(stem, {0.0, 0.0}, 0.02, rim, 0.8 * shape.height());
  }
  const int leaves = isTree ? 34 : 22;
  for (int i = 0; i < leaves; ++i) {
    const double angle = 2.4 * i;  // nearly the golden angle: no leaf lies on another
    const double rise = (i + 0.5) / leaves;
    // Round as a crown is: widest in the middle; blades are widest below.
    const double spread = isTree ? std::sin(std::numbers::pi * std::lerp(0.2, 0.9, rise)) : 1.0 - 0.7 * rise;
    const double reach = 0.5 * spread * look.own().uniform(0.8, 1.0);
    const double tip = std::lerp(root, shape.height(), rise);
    const double from = isTree ? std::lerp(root, 0.8 * shape.height(), rise) : rim;
    shape.leaf(green, {0.01 * std::cos(angle), 0.01 * std::sin(angle), from},
               {reach * shape.depth() * std::cos(angle), reach * shape.width() * std::sin(angle), tip},
               look.own().uniform(0.1, 0.18));
  }
}

void bin(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.own().uniform() < 0.5 ? look.paint : look.metal);
  const auto lid = shape.use(FurnitureLook::plain({24, 24, 26}, 0.1F, 0.12F));
  const double radius = std::min(shape.depth(), shape.width()) / 2.0;
  shape.cone(body, {0.0, 0.0}, 0.85 * radius, radius, 0.0, shape.height() - 0.02);
  shape.cylinder(lid, {0.0, 0.0}, 0.92 * radius, shape.height() - 0.02, shape.height());
}

/// Rises from its front to its back.
void ramp(Shape& shape, FurnitureLook& look) {
  const auto deck = shape.use(look.own().uniform() < 0.5 ? look.wood : look.metal);
  const double f = shape.front();
  const double b = shape.back();
  const double l = shape.left();
  const double r = shape.right();
  const double h = shape.height();
  shape.face(deck, {{f, r, 0.0}, {f, l, 0.0}, {b, l, h}, {b, r, h}});
  shape.face(deck, {{b, l, 0.0}, {b, r, 0.0}, {b, r, h}, {b, l, h}});
  shape.face(deck, {{f, l, 0.0}, {b, l, 0.0}, {b, l, h}});
  shape.face(deck, {{b, r, 0.0}, {f, r, 0.0}, {b, r, h}});
}

void screen(Shape& shape, FurnitureLook&) {
  const auto body = shape.use(FurnitureLook::plain({30, 30, 32}, 0.2F, 0.15F));
  const auto glass = shape.use(FurnitureLook::darkGlass());
  const double panel = 0.1;
  shape.box(body, {shape.back(), -0.12, 0.0}, {shape.front(), 0.12, 0.012});
  shape.box(body, {-0.03, -0.03, 0.012}, {0.0, 0.03, panel + 0.08});
  shape.box(body, {0.0, shape.right(), panel}, {0.035, shape.left(), shape.height()});
  shape.face(glass, {{0.036, shape.right() + 0.012, panel + 0.012},
                     {0.036, shape.left() - 0.012, panel + 0.012},
                     {0.036, shape.left() - 0.012, shape.height() - 0.012},
                     {0.036, shape.right() + 0.012, shape.height() - 0.012}});
}

void sink(Shape& shape, FurnitureLook&) {
  const auto ware = shape.use(FurnitureLook::porcelain());
  const auto tap = shape.use(FurnitureLook::chrome());
  const double rim = shape.height() - 0.08;
  const double wall = 0.03;
  shape.cone(ware, {shape.back() + 0.12, 0.0}, 0.09, 0.11, 0.0, rim - 0.14);
  shape.box(ware, {shape.back(), shape.right(), rim - 0.14}, {shape.front(), shape.left(), rim - 0.11});
  shape.box(ware, {shape.back(), shape.right(), rim - 0.11}, {shape.back() + 0.1, shape.left(), rim});
  shape.box(ware, {shape.front() - wall, shape.right(), rim - 0.11}, {shape.front(), shape.left(), rim});
  for (const double side : {shape.right(), shape.left() - wall}) {
    shape.box(ware, {shape.back() + 0.1, side, rim - 0.11}, {shape.front() - wall, side + wall, rim});
  }
  shape.cylinder(tap, {shape.back() + 0.06, 0.0}, 0.018, rim, shape.height());
  shape.box(tap, {shape.back() + 0.06, -0.012, shape.height() - 0.03},
            {shape.back() + 0.2, 0.012, shape.height() - 0.01});
}

void bathtub(Shape& shape, FurnitureLook&) {
  const auto ware = shape.use(FurnitureLook::porcelain());
  const double wall = 0.07;
  const double rim = shape.height();
  shape.box(ware, {shape.back(), shape.right(), 0.0}, {shape.front(), shape.left(), 0.15});
  shape.box(ware, {shape.back(), shape.right(), 0.15}, {shape.back() + wall, shape.left(), rim});
  shape.box(ware, {shape.front() - wall, shape.right(), 0.15}, {shape.front(), shape.left(), rim});
  for (const double side : {shape.right(), shape.left() - wall}) {
    shape.box(ware, {shape.back() + wall, side, 0.15}, {shape.front() - wall, side + wall, rim});
  }
}

void toilet(Shape& shape, FurnitureLook& look) {
  const auto ware = shape.use(FurnitureLook::porcelain());
  const auto seat = shape.use(look.own().uniform() < 0.7 ? FurnitureLook::porcelain() : look.wood);
  const double tank = shape.back() + 0.18;
  shape.box(ware, {shape.back(), shape.right(), 0.38}, {tank, shape.left(), shape.height()});
  shape.box(ware, {shape.back(), -0.1, 0.0}, {tank, 0.1, 0.38});
  const Eigen::Vector3d middle((tank + shape.front()) / 2.0, 0.0, 0.2);
  const double half = (shape.front() - tank) / 2.0;
  shape.ellipsoid(ware, middle, {half, 0.8 * shape.left(), 0.2});
  shape.ellipsoid(seat, {middle.x(), 0.0, 0.4}, {half, shape.left(), 0.025});
}

/// Two doors one above the other, their handles at one side.
void fridge(Shape& shape, FurnitureLook& look) {
  const bool isSteel = look.own().uniform() < 0.4;
  const auto body = shape.use(isSteel ? FurnitureLook::plain({170, 172, 174}, 0.7F, 0.5F) : FurnitureLook::porcelain());
  const auto handle = shape.use(FurnitureLook::chrome());
  const double split = 0.35 * shape.height();
  const double face = shape.front() - 0.03;
  shape.box(body, {shape.back(), shape.right(), 0.0}, {face - 0.05, shape.left(), shape.height()});
  shape.box(body, {face - 0.046, shape.right(), 0.04}, {face, shape.left(), split - 0.004});
  shape.box(body, {face - 0.046, shape.right(), split + 0.004}, {face, shape.left(), shape.height()});
  for (const double z : {split - 0.3, split + 0.08}) {
    shape.box(handle, {face, shape.left() - 0.06, z}, {shape.front(), shape.left() - 0.045, z + 0.22});
  }
}

/// A cube with a dark window at its front, round or not.
void machine(Shape& shape, FurnitureLook&, bool isRound) {
  const auto body = shape.use(FurnitureLook::porcelain());
  const auto glass = shape.use(FurnitureLook::darkGlass());
  const auto knobs = shape.use(FurnitureLook::plain({40, 40, 42}, 0.3F, 0.2F));
  const double face = shape.front() - 0.04;
  shape.box(body, {shape.back(), shape.right(), 0.0}, {face, shape.left(), shape.height()});
  const double high = 0.42 * shape.height();
  if (isRound) {
    shape.ellipsoid(glass, {face, 0.0, high}, {0.04, 0.17, 0.17});
  } else {
    shape.box(glass, {face, shape.right() + 0.07, high - 0.2}, {face + 0.015, shape.left() - 0.07, high + 0.12});
    shape.box(knobs, {face, shape.right() + 0.07, high + 0.16}, {shape.front(), shape.left() - 0.07, high + 0.18});
  }
  for (const double y : {-0.18, -0.06, 0.06, 0.18}) {
    shape.box(knobs, {face, y - 0.02, shape.height() - 0.09}, {face + 0.02, y + 0.02, shape.height() - 0.05});
  }
}

void stove(Shape& shape, FurnitureLook& look) {
  machine(shape, look, false);
}

void washingMachine(Shape& shape, FurnitureLook& look) {
  machine(shape, look, true);
}

void printer(Shape& shape, FurnitureLook&) {
  const auto body = shape.use(FurnitureLook::plain({214, 214, 212}, 0.2F));
  const auto dark = shape.use(FurnitureLook::plain({48, 50, 54}, 0.3F, 0.2F));
  const double split = 0.62 * shape.height();
  shape.box(body, {shape.back(), shape.right(), 0.0}, {shape.front(), shape.left(), split});
  shape.box(dark, {shape.back() + 0.05, shape.right() + 0.04, split},
            {shape.front() - 0.1, shape.left() - 0.04, split + 0.12});
  shape.box(body, {shape.back(), shape.right(), split + 0.12},
            {shape.front() - 0.04, shape.left(), shape.height() - 0.02});
  shape.box(dark, {shape.front() - 0.2, shape.right() + 0.05, shape.height() - 0.02},
            {shape.front() - 0.06, shape.right() + 0.3, shape.height()});
}

/// With a front of glass as large as a door's leaf.
void vendingMachine(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.paint);
  const auto dark = shape.use(FurnitureLook::darkGlass());
  const double face = shape.front() - 0.01;
  const double split = std::lerp(shape.right(), shape.left(), 0.28);
  shape.box(body, {shape.back(), shape.right(), 0.0}, {face, shape.left(), shape.height()});
  auto goods = look.patterned(Pattern::kBooks, {120, 60, 50}, {40, 40, 44}, 0.28);
  goods.gloss = 0.8F;
  goods.infrared = 0.1F;
  const auto window = shape.use(goods);
  shape.face(window, {{face + 0.005, split, 0.5},
                      {face + 0.005, shape.left() - 0.05, 0.5},
                      {face + 0.005, shape.left() - 0.05, shape.height() - 0.08},
                      {face + 0.005, split, shape.height() - 0.08}});
  shape.box(dark, {face, split, 0.15}, {shape.front(), shape.left() - 0.05, 0.32});
  shape.box(dark, {face, shape.right() + 0.05, 1.1}, {shape.front(), split - 0.04, 1.35});
}

void floorLamp(Shape& shape, FurnitureLook& look) {
  const auto metal = shape.use(look.metal);
  const auto shade = shape.use(FurnitureLook::plain({242, 232, 206}));
  const double radius = std::min(shape.depth(), shape.width()) / 2.0;
  shape.cylinder(metal, {0.0, 0.0}, 0.75 * radius, 0.0, 0.025);
  shape.cylinder(metal, {0.0, 0.0}, 0.012, 0.025, shape.height() - 0.28);
  shape.cone(shade, {0.0, 0.0}, radius, 0.65 * radius, shape.height() - 0.28, shape.height());
}

void ceilingLamp(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.metal);
  const auto light = shape.use(FurnitureLook::plain({255, 253, 246}, 0.0F, 0.7F));
  shape.box(body, {shape.back(), shape.right(), 0.015}, {shape.front(), shape.left(), shape.height()});
  shape.box(light, {shape.back() + 0.02, shape.right() + 0.02, 0.0},
            {shape.front() - 0.02, shape.left() - 0.02, 0.015});
}

}  // namespace

std::span<const ThingShape> otherShapes() {
  static constexpr std::array<ThingShape, 14> kShapes{{
      {"plant", plant},
      {"bin", bin},
      {"ramp", ramp},
      {"screen", screen},
      {"sink", sink},
      {"bathtub", bathtub},
      {"toilet", toilet},
      {"fridge", fridge},
      {"stove", stove},
      {"washing_machine", washingMachine},
      {"printer", printer},
      {"vending_machine", vendingMachine},
      {"floor_lamp", floorLamp},
      {"ceiling_lamp", ceilingLamp},
  }};
  return kShapes;
}

}  // namespace prodomos::simulation
