// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/furniture_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

/// What hangs on walls.
namespace prodomos::simulation {

namespace {

/// Four boards around the front.
void frame(Shape& shape, Shape::Part part, double board) {
  const double low = shape.right() + board;
  const double high = shape.left() - board;
  shape.box(part, {shape.back(), shape.right(), 0.0}, {shape.front(), low, shape.height()});
  shape.box(part, {shape.back(), high, 0.0}, {shape.front(), shape.left(), shape.height()});
  shape.box(part, {shape.back(), low, 0.0}, {shape.front(), high, board});
  shape.box(part, {shape.back(), low, shape.height() - board}, {shape.front(), high, shape.height()});
}

/// A rectangle that looks to the front, its texture from its lower corner on.
void sheet(Shape& shape, const Material& material, double x, double margin) {
  const double low = shape.right() + margin;
  const double high = shape.left() - margin;
  const double top = shape.height() - margin;
  shape.face(shape.use(material), {{x, low, margin}, {x, high, margin}, {x, high, top}, {x, low, top}});
}

void board(Shape& shape, FurnitureLook& look, const Material& writing) {
  constexpr double kBoard = 0.025;
  const auto rim = shape.use(look.metal);
  frame(shape, rim, kBoard);
  sheet(shape, writing, shape.front() - 0.008, kBoard);
}

void whiteboard(Shape& shape, FurnitureLook& look) {
  board(shape, look, FurnitureLook::plain({240, 241, 240}, 0.7F, 0.85F));
}

void blackboard(Shape& shape, FurnitureLook& look) {
  const auto green = look.shared().uniform() < 0.6;
  const auto color = green ? sensors::Rgb{36, 62, 50} : sensors::Rgb{34, 36, 38};
  board(shape, look, look.patterned(Pattern::kSpeckle, color, {52, 76, 66}, 30.0));
}

void noticeboard(Shape& shape, FurnitureLook& look) {
  const auto edge = shape.use(look.wood);
  frame(shape, edge, 0.01);
  const bool felt = look.own().uniform() < 0.4;
  const auto ground = felt ? look.cloth.color : sensors::Rgb{176, 134, 88};
  sheet(shape, look.patterned(Pattern::kNoticeboard, ground, look.metal.color, 1.0), shape.front() - 0.004, 0.0);
}

void poster(Shape& shape, FurnitureLook& look) {
  const auto paper = look.poster();
  shape.box(shape.use(FurnitureLook::plain(paper.color)), {shape.back(), shape.right(), 0.0},
            {shape.front() - 0.001, shape.left(), shape.height()});
  sheet(shape, paper, shape.front(), 0.0);
}

/// Of an escape route, of a room, of a ban.
void sign(Shape& shape, FurnitureLook& look) {
  constexpr std::array<sensors::Rgb, 4> kColors{{{30, 130, 70}, {36, 80, 160}, {228, 228, 226}, {190, 40, 36}}};
  const auto color = kColors[static_cast<std::size_t>(look.own().integer(0, 3))];
  const auto plate = FurnitureLook::plain(color, 0.4F);
  shape.box(shape.use(plate), {shape.back(), shape.right(), 0.0},
            {shape.front() - 0.002, shape.left(), shape.height()});
  const auto mark =
      shape.use(FurnitureLook::plain(color.r > 200 ? sensors::Rgb{40, 40, 42} : sensors::Rgb{236, 236, 234}));
  const double half = 0.3 * shape.width();
  for (const double z : {0.25, 0.6}) {
    shape.box(mark, {shape.front() - 0.002, -half, z * shape.height()},
              {shape.front(), half, (z + 0.15) * shape.height()});
  }
}

/// Cladding of a door's size: no frame, no handle, and it ends above the floor.
void wallPanel(Shape& shape, FurnitureLook& look) {
  const auto panel = shape.use(look.shared().uniform() < 0.6 ? look.wood : look.paint);
  const double middle = shape.height() * look.shared().uniform(0.4, 0.6);
  shape.box(panel, {shape.back(), shape.right(), 0.0}, {shape.front(), shape.left(), middle - 0.003});
  shape.box(panel, {shape.back(), shape.right(), middle + 0.003}, {shape.front(), shape.left(), shape.height()});
}

void window(Shape& shape, FurnitureLook& look) {
  constexpr double kFrame = 0.06;
  const auto bright = FurnitureLook::plain({228, 228, 224}, 0.3F);
  const auto rim = shape.use(look.shared().uniform() < 0.6 ? bright : look.paint);
  frame(shape, rim, kFrame);
  auto glass = FurnitureLook::glass();
  glass.seed = static_cast<std::uint32_t>(look.own().integer(0, 1 << 30));
  sheet(shape, glass, shape.front() - 0.035, kFrame);
  const auto handle = shape.use(FurnitureLook::chrome());
  const bool hasTwoCasements = shape.width() > 1.2;
  if (hasTwoCasements) {
    shape.box(rim, {shape.back(), -0.03, kFrame}, {shape.front() - 0.01, 0.03, shape.height() - kFrame});
  }
  const double middle = shape.height() / 2.0;
  const double low = hasTwoCasements ? -0.01 : shape.left() - kFrame + 0.02;
  shape.box(handle, {shape.front() - 0.01, low, middle - 0.06}, {shape.front(), low + 0.02, middle + 0.06});
}

void curtain(Shape& shape, FurnitureLook& look) {
  const auto cloth = shape.use(look.cushion);
  const double radius = shape.depth() / 2.0;
  const int folds = std::max(1, static_cast<int>(shape.width() / (1.5 * radius)));
  for (int i = 0; i < folds; ++i) {
    const double y = folds == 1 ? 0.0 : std::lerp(shape.right() + radius, shape.left() - radius, i / (folds - 1.0));
    shape.cylinder(cloth, {0.0, y}, radius, 0.0, shape.height());
  }
}

void fuseBox(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.paint);
  const auto lock = shape.use(FurnitureLook::plain({30, 30, 32}, 0.3F, 0.2F));
  shape.box(body, {shape.back(), shape.right(), 0.0}, {shape.front() - 0.02, shape.left(), shape.height()});
  shape.box(body, {shape.front() - 0.02, shape.right() + 0.02, 0.02},
            {shape.front() - 0.008, shape.left() - 0.02, shape.height() - 0.02});
  const double middle = shape.height() / 2.0;
  shape.box(lock, {shape.front() - 0.008, shape.left() - 0.07, middle - 0.02},
            {shape.front(), shape.left() - 0.04, middle + 0.02});
}

void radiator(Shape& shape, FurnitureLook&) {
  const auto enamel = shape.use(FurnitureLook::plain({232, 231, 226}, 0.3F));
  const int ribs = std::max(2, static_cast<int>(shape.width() / 0.08));
  const double pitch = shape.width() / ribs;
  for (int i = 0; i < ribs; ++i) {
    const double side = shape.right() + pitch * i;
    shape.box(enamel, {shape.back() + 0.02, side + 0.01, 0.0}, {shape.front(), side + pitch - 0.01, shape.height()});
  }
  for (const double z : {0.05, shape.height() - 0.1}) {
    shape.box(enamel, {shape.back(), shape.right(), z}, {shape.front() - 0.02, shape.left(), z + 0.05});
  }
}

void television(Shape& shape, FurnitureLook&) {
  const auto body = shape.use(FurnitureLook::plain({22, 22, 24}, 0.3F, 0.12F));
  const auto glass = FurnitureLook::darkGlass();
  shape.box(body, {shape.back(), shape.right(), 0.0}, {shape.front() - 0.002, shape.left(), shape.height()});
  sheet(shape, glass, shape.front(), 0.015);
}

/// Between desks; it stands on feet.
void partition(Shape& shape, FurnitureLook& look) {
  const auto cloth = shape.use(look.cloth);
  const auto rim = shape.use(look.metal);
  shape.box(cloth, {shape.back() + 0.005, shape.right() + 0.02, 0.1},
            {shape.front() - 0.005, shape.left() - 0.02, shape.height() - 0.02});
  shape.box(rim, {shape.back(), shape.right(), shape.height() - 0.02}, {shape.front(), shape.left(), shape.height()});
  for (const double side : {shape.right(), shape.left() - 0.02}) {
    shape.box(rim, {shape.back(), side, 0.0}, {shape.front(), side + 0.02, shape.height() - 0.02});
  }
}

}  // namespace

std::span<const ThingShape> wallShapes() {
  static constexpr std::array<ThingShape, 14> kShapes{{
      {"whiteboard", whiteboard},
      {"blackboard", blackboard},
      {"noticeboard", noticeboard},
      {"partition", partition},
      {"poster", poster},
      {"tall_poster", poster},
      {"sign", sign},
      {"wall_panel", wallPanel},
      {"window", window},
      {"tall_window", window},
      {"curtain", curtain},
      {"fuse_box", fuseBox},
      {"radiator", radiator},
      {"tv", television},
  }};
  return kShapes;
}

}  // namespace prodomos::simulation
