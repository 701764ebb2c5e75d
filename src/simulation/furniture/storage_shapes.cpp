// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/furniture_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

/// Cupboards, shelves, counters, boxes.
namespace prodomos::simulation {

namespace {

constexpr double kSlit = 0.004;    // metres between fronts
constexpr double kHandle = 0.025;  // metres that handles stand out

int countOf(double length, double each) {
  return std::max(1, static_cast<int>(std::lround(length / each)));
}

/// One front as a door has it: its handle at one side, at about the middle.
void leafFront(Shape& shape, Shape::Part front, Shape::Part handle, double from, double to, double bottom, double top,
               bool handleAtStart) {
  const double face = shape.front() - kHandle;
  shape.box(front, {face - 0.018, from + kSlit, bottom}, {face, to - kSlit, top});
  const double y = handleAtStart ? from + 0.04 : to - 0.052;
  const double middle = (bottom + top) / 2.0;
  const double half = std::min(0.08, (top - bottom) / 4.0);
  shape.box(handle, {face, y, middle - half}, {shape.front(), y + 0.012, middle + half});
}

/// Fronts in pairs, as those of wardrobes are.
void fronts(Shape& shape, FurnitureLook& look, double from, double to, double bottom, double top) {
  auto lighter = look.wood;
  lighter.seed += 1;
  const auto front = shape.use(lighter);
  const auto handle = shape.use(look.metal);
  const int count = countOf(to - from, 0.48);
  for (int i = 0; i < count; ++i) {
    const double begin = std::lerp(from, to, static_cast<double>(i) / count);
    const double end = std::lerp(from, to, static_cast<double>(i + 1) / count);
    leafFront(shape, front, handle, begin, end, bottom, top, i % 2 == 1);
  }
}

void cupboard(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.wood);
  const double face = shape.front() - kHandle - 0.02;
  shape.box(body, {shape.back(), shape.right(), 0.0}, {face, shape.left(), shape.height()});
  fronts(shape, look, shape.right(), shape.left(), 0.06, shape.height() - 0.02);
}

void lockers(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(FurnitureLook::plain({150, 154, 158}, 0.2F, 0.6F));
  const auto front = shape.use(look.paint);
  const auto dark = shape.use(FurnitureLook::plain({30, 30, 32}, 0.0F, 0.15F));
  const double face = shape.front() - kHandle - 0.02;
  shape.box(body, {shape.back(), shape.right(), 0.0}, {face, shape.left(), shape.height()});
  const int columns = countOf(shape.width(), 0.32);
  for (int i = 0; i < columns; ++i) {
    const double from = std::lerp(shape.right(), shape.left(), static_cast<double>(i) / columns);
    const double to = std::lerp(shape.right(), shape.left(), static_cast<double>(i + 1) / columns);
    leafFront(shape, front, dark, from, to, 0.1, shape.height() - 0.02, false);
    for (const double z : {0.24, 0.27, 0.3}) {
      const double top = shape.height() - z;
      shape.box(dark, {shape.front() - kHandle, from + 0.07, top},
                {shape.front() - kHandle + 0.002, to - 0.07, top + 0.008});
    }
  }
}

void filingCabinet(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.paint);
  const auto handle = shape.use(look.metal);
  const double face = shape.front() - kHandle - 0.02;
  shape.box(body, {shape.back(), shape.right(), 0.0}, {face, shape.left(), shape.height()});
  const int drawers = countOf(shape.height(), 0.33);
  for (int i = 0; i < drawers; ++i) {
    const double bottom = 0.03 + (shape.height() - 0.05) * i / drawers;
    const double top = 0.03 + (shape.height() - 0.05) * (i + 1) / drawers;
    shape.box(body, {face, shape.right() + kSlit, bottom + kSlit}, {face + 0.02, shape.left() - kSlit, top - kSlit});
    shape.box(handle, {face + 0.02, -0.07, top - 0.09}, {shape.front(), 0.07, top - 0.075});
  }
}

/// Sides, boards, and a back where it has one. Calls `fill` with bottom and top of each compartment.
template <typename Fill>
void boards(Shape& shape, Shape::Part part, double pitch, Fill fill) {
  constexpr double kBoard = 0.02;
  const int count = countOf(shape.height(), pitch);
  const double rise = (shape.height() - kBoard) / count;
  for (int i = 0; i <= count; ++i) {
    const double z = rise * i;
    shape.box(part, {shape.back(), shape.right() + kBoard, z}, {shape.front(), shape.left() - kBoard, z + kBoard});
    if (i < count) fill(z + kBoard, z + rise);
  }
}

/// Of books.
void shelf(Shape& shape, FurnitureLook& look) {
  const auto wood = shape.use(look.wood);
  for (const double side : {shape.right(), shape.left() - 0.02}) {
    shape.box(wood, {shape.back(), side, 0.0}, {shape.front(), side + 0.02, shape.height()});
  }
  shape.box(wood, {shape.back(), shape.right() + 0.02, 0.0},
            {shape.back() + 0.01, shape.left() - 0.02, shape.height()});
  boards(shape, wood, 0.36, [&](double bottom, double top) {
    const double fullness = look.own().uniform(0.0, 1.3);
    if (fullness < 0.25) return;
    const auto books = shape.use(look.patterned(Pattern::kBooks, {90, 80, 70}, {60, 54, 50}, top - bottom));
    const double end = std::lerp(shape.right() + 0.02, shape.left() - 0.02, std::min(1.0, fullness));
    shape.box(books, {shape.back() + 0.01, shape.right() + 0.02, bottom},
              {shape.front() - 0.05, end, std::lerp(bottom, top, 0.92)});
  });
}

Material cardboard(FurnitureLook& look) {
  return look.patterned(Pattern::kSpeckle, {176, 138, 92}, {158, 122, 80}, 0.6);
}

/// Of metal, with boxes of cardboard and plastic.
void storageShelf(Shape& shape, FurnitureLook& look) {
  const auto metal = shape.use(look.paint);
  const auto carton = shape.use(cardboard(look));
  const auto plastic = shape.use(look.cushion);
  shape.legs(metal, {shape.depth(), shape.width()}, 0.035, 0.0, shape.height());
  boards(shape, metal, 0.48, [&](double bottom, double top) {
    for (double y = shape.right() + 0.05; y < shape.left() - 0.25;) {
      const double wide = look.own().uniform(0.18, 0.45);
      const double high = look.own().uniform(0.3, 0.85) * (top - bottom);
      const bool isThere = look.own().uniform() < 0.75;
      const bool isCarton = look.own().uniform() < 0.6;
      const double end = std::min(y + wide, shape.left() - 0.05);
      if (isThere) {
        shape.box(isCarton ? carton : plastic, {shape.back() + 0.03, y, bottom},
                  {shape.front() - look.own().uniform(0.02, 0.1), end, bottom + high});
      }
      y = end + 0.03;
    }
  });
}

void wallBars(Shape& shape, FurnitureLook& look) {
  const auto wood = shape.use(look.wood);
  for (const double side : {shape.right(), shape.left() - 0.03}) {
    shape.box(wood, {shape.back(), side, 0.0}, {shape.front() - 0.02, side + 0.03, shape.height()});
  }
  for (double z = 0.15; z < shape.height() - 0.05; z += 0.15) {
    shape.box(wood, {shape.front() - 0.045, shape.right(), z}, {shape.front(), shape.left(), z + 0.035});
  }
}

void counter(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.paint);
  const auto top = shape.use(look.wood);
  const double board = shape.height() - 0.04;
  shape.box(body, {shape.back() + 0.05, shape.right() + 0.03, 0.0}, {shape.front() - 0.06, shape.left() - 0.03, board});
  shape.box(top, {shape.back(), shape.right(), board}, {shape.front(), shape.left(), shape.height()});
}

void kitchenCounter(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.wood);
  const auto top = shape.use(look.patterned(Pattern::kSpeckle, {120, 118, 116}, {70, 70, 72}, 0.8));
  const double board = shape.height() - 0.04;
  const double face = shape.front() - kHandle - 0.02;
  shape.box(body, {shape.back(), shape.right(), 0.08}, {face, shape.left(), board});
  fronts(shape, look, shape.right(), shape.left(), 0.1, board - 0.01);
  shape.box(top, {shape.back(), shape.right(), board}, {shape.front(), shape.left(), shape.height()});
}

void carton(Shape& shape, FurnitureLook& look) {
  const auto box = shape.use(cardboard(look));
  const auto tape = shape.use(FurnitureLook::plain({196, 176, 130}, 0.4F));
  const double top = shape.height() - 0.001;
  shape.box(box, {shape.back() + 0.001, shape.right(), 0.0}, {shape.front() - 0.001, shape.left(), top});
  shape.box(tape, {shape.back(), -0.025, 0.0}, {shape.front(), 0.025, shape.height()});
}

/// Like steps: the farther back, the higher.
void boxPile(Shape& shape, FurnitureLook& look) {
  const int rows = countOf(shape.depth(), 0.4);
  for (int row = 0; row < rows; ++row) {
    const double back = std::lerp(shape.back(), shape.front(), static_cast<double>(row) / rows);
    const double front = std::lerp(shape.back(), shape.front(), static_cast<double>(row + 1) / rows);
    const int layers = rows - row;
    for (int layer = 0; layer < layers; ++layer) {
      const auto box = shape.use(cardboard(look));
      const double slack = look.own().uniform(0.0, 0.08) * shape.width();
      const double inset = look.own().uniform(0.0, 0.04);
      shape.box(
          box, {back + inset, shape.right() + slack, shape.height() * layer / rows},
          {front - 0.005, shape.left() - (0.08 * shape.width() - slack), shape.height() * (layer + 1) / rows - 0.002});
    }
  }
}

void cart(Shape& shape, FurnitureLook& look) {
  const auto frame = shape.use(look.metal);
  const auto tray = shape.use(look.paint);
  const auto wheels = shape.use(FurnitureLook::plain({26, 26, 28}, 0.1F, 0.15F));
  shape.legs(frame, {shape.depth(), shape.width()}, 0.03, 0.1, shape.height());
  for (const double z : {0.16, shape.height() / 2.0, shape.height() - 0.12}) {
    shape.box(tray, {shape.back() + 0.01, shape.right() + 0.01, z},
              {shape.front() - 0.01, shape.left() - 0.01, z + 0.05});
  }
  for (const double x : {shape.back() + 0.05, shape.front() - 0.05}) {
    for (const double y : {shape.right() + 0.05, shape.left() - 0.05}) {
      shape.ellipsoid(wheels, {x, y, 0.05}, {0.05, 0.02, 0.05});
    }
  }
}

}  // namespace

std::span<const ThingShape> storageShapes() {
  static constexpr std::array<ThingShape, 14> kShapes{{
      {"cupboard", cupboard},
      {"low_cupboard", cupboard},
      {"wardrobe", cupboard},
      {"lockers", lockers},
      {"filing_cabinet", filingCabinet},
      {"shelf", shelf},
      {"storage_shelf", storageShelf},
      {"wall_bars", wallBars},
      {"counter", counter},
      {"kitchen_counter", kitchenCounter},
      {"lab_bench", kitchenCounter},
      {"box", carton},
      {"box_pile", boxPile},
      {"cart", cart},
  }};
  return kShapes;
}

}  // namespace prodomos::simulation
