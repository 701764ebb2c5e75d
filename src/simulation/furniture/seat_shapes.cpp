// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/furniture_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

/// Tables, chairs, sofas, beds.
namespace prodomos::simulation {

namespace {

constexpr double kSeat = 0.45;  // metres above the floor

void table(Shape& shape, FurnitureLook& look) {
  const auto top = shape.use(look.wood);
  const auto legs = shape.use(look.metal);
  const double board = shape.height() - 0.03;
  shape.box(top, {shape.back(), shape.right(), board}, {shape.front(), shape.left(), shape.height()});
  shape.legs(legs, {shape.depth() - 0.06, shape.width() - 0.06}, 0.045, 0.0, board);
  shape.box(legs, {shape.back() + 0.05, shape.right() + 0.06, board - 0.05},
            {shape.back() + 0.07, shape.left() - 0.06, board});
  shape.box(legs, {shape.front() - 0.07, shape.right() + 0.06, board - 0.05},
            {shape.front() - 0.05, shape.left() - 0.06, board});
}

/// Of two panels, or on legs; some with drawers.
void desk(Shape& shape, FurnitureLook& look) {
  const auto top = shape.use(look.wood);
  const double board = shape.height() - 0.03;
  const bool hasPanels = look.shared().uniform() < 0.5;
  const bool hasDrawers = look.shared().uniform() < 0.5;
  shape.box(top, {shape.back(), shape.right(), board}, {shape.front(), shape.left(), shape.height()});
  if (hasPanels) {
    shape.box(top, {shape.back() + 0.03, shape.right(), 0.0}, {shape.front() - 0.05, shape.right() + 0.03, board});
    shape.box(top, {shape.back() + 0.03, shape.left() - 0.03, 0.0}, {shape.front() - 0.05, shape.left(), board});
    shape.box(top, {shape.back() + 0.05, shape.right() + 0.03, 0.3}, {shape.back() + 0.07, shape.left() - 0.03, board});
  } else {
    const auto metal = shape.use(look.metal);
    for (const double side : {shape.right() + 0.05, shape.left() - 0.1}) {
      shape.box(metal, {shape.back() + 0.03, side, 0.0}, {shape.front() - 0.03, side + 0.05, 0.04});
      shape.box(metal, {-0.04, side, 0.04}, {0.04, side + 0.05, board});
    }
  }
  if (!hasDrawers) return;
  const auto body = shape.use(look.paint);
  const auto handle = shape.use(look.metal);
  const double left = shape.left() - 0.12;
  shape.box(body, {shape.back() + 0.1, left - 0.42, 0.04}, {shape.front() - 0.08, left, board - 0.06});
  for (const double z : {0.18, 0.36, 0.54}) {
    shape.box(handle, {shape.front() - 0.08, left - 0.29, z}, {shape.front() - 0.06, left - 0.13, z + 0.015});
  }
}

void chair(Shape& shape, FurnitureLook& look) {
  const bool isUpholstered = look.shared().uniform() < 0.4;
  const auto frame = shape.use(look.metal);
  const auto seat = shape.use(isUpholstered ? look.cloth : look.wood);
  shape.legs(frame, {shape.depth(), shape.width()}, 0.03, 0.0, kSeat - 0.03);
  shape.box(seat, {shape.back() + 0.03, shape.right(), kSeat - 0.03}, {shape.front(), shape.left(), kSeat});
  for (const double side : {shape.right(), shape.left() - 0.03}) {
    shape.box(frame, {shape.back(), side, kSeat}, {shape.back() + 0.03, side + 0.03, shape.height() - 0.02});
  }
  const double middle = std::lerp(kSeat, shape.height(), 0.35);
  shape.box(seat, {shape.back() + 0.005, shape.right() + 0.03, middle},
            {shape.back() + 0.03, shape.left() - 0.03, shape.height()});
}

void officeChair(Shape& shape, FurnitureLook& look) {
  const auto foot = shape.use(look.metal);
  const auto cloth = shape.use(look.cloth);
  const auto plastic = shape.use(FurnitureLook::plain({28, 28, 30}, 0.2F, 0.2F));
  shape.box(foot, {shape.back(), -0.025, 0.05}, {shape.front(), 0.025, 0.09});
  shape.box(foot, {-0.025, shape.right(), 0.05}, {0.025, shape.left(), 0.09});
  const double castor = 0.028;
  for (const Eigen::Vector2d& end : {Eigen::Vector2d(shape.back() + castor, 0.0),
                                     {shape.front() - castor, 0.0},
                                     Eigen::Vector2d(0.0, shape.right() + castor),
                                     {0.0, shape.left() - castor}}) {
    shape.ellipsoid(plastic, {end.x(), end.y(), castor}, Eigen::Vector3d::Constant(castor));
  }
  shape.cylinder(foot, {0.0, 0.0}, 0.03, 0.09, kSeat - 0.07);
  const double half = shape.width() / 2.0 - 0.06;
  shape.box(cloth, {shape.back() + 0.07, -half, kSeat - 0.07}, {shape.front() - 0.04, half, kSeat});
  shape.box(plastic, {shape.back() + 0.02, -0.04, kSeat - 0.06}, {shape.back() + 0.06, 0.04, kSeat + 0.2});
  const double middle = (kSeat + 0.12 + shape.height()) / 2.0;
  shape.ellipsoid(cloth, {shape.back() + 0.07, 0.0, middle}, {0.06, half, shape.height() - middle});
  for (const double side : {-half - 0.045, half}) {
    shape.box(plastic, {shape.back() + 0.14, side, kSeat + 0.18}, {shape.front() - 0.16, side + 0.045, kSeat + 0.21});
    shape.box(plastic, {-0.04, side, kSeat - 0.05}, {0.02, side + 0.03, kSeat + 0.18});
  }
}

void bench(Shape& shape, FurnitureLook& look) {
  const auto seat = shape.use(look.wood);
  const auto legs = shape.use(look.metal);
  const double board = shape.height() - 0.05;
  shape.box(seat, {shape.back(), shape.right(), board}, {-0.01, shape.left(), shape.height()});
  shape.box(seat, {0.01, shape.right(), board}, {shape.front(), shape.left(), shape.height()});
  for (const double side : {shape.right() + 0.12, shape.left() - 0.18}) {
    shape.box(legs, {shape.back() + 0.03, side, 0.0}, {shape.front() - 0.03, side + 0.06, board});
  }
}

/// A sofa, or an armchair where it is narrow.
void sofa(Shape& shape, FurnitureLook& look) {
  const auto body = shape.use(look.cloth);
  const auto cushion = shape.use(look.cushion);
  const auto feet = shape.use(look.wood);
  const double arm = 0.15;
  const double back = 0.2;
  shape.legs(feet, {shape.depth() - 0.1, shape.width() - 0.1}, 0.05, 0.0, 0.1);
  shape.box(body, {shape.back(), shape.right(), 0.1}, {shape.front(), shape.left(), 0.3});
  shape.box(body, {shape.back(), shape.right(), 0.3}, {shape.back() + back, shape.left(), shape.height()});
  for (const double side : {shape.right(), shape.left() - arm}) {
    shape.box(body, {shape.back() + back, side, 0.3}, {shape.front(), side + arm, std::min(0.62, shape.height())});
  }
  const double between = shape.width() - 2.0 * arm;
  const int seats = std::max(1, static_cast<int>(between / 0.6));
  for (int i = 0; i < seats; ++i) {
    const double side = shape.right() + arm + between * i / seats;
    const double end = side + between / seats;
    shape.box(cushion, {shape.back() + back, side + 0.006, 0.3}, {shape.front() + 0.0, end - 0.006, kSeat});
    shape.box(cushion, {shape.back() + back, side + 0.01, kSeat},
              {shape.back() + back + 0.12, end - 0.01, shape.height() - 0.04});
  }
}

/// Its head at the back.
void bed(Shape& shape, FurnitureLook& look) {
  const auto frame = shape.use(look.wood);
  const auto sheet = shape.use(FurnitureLook::plain({232, 232, 228}));
  const auto blanket = shape.use(look.cloth);
  shape.box(frame, {shape.back(), shape.right(), 0.0}, {shape.back() + 0.05, shape.left(), shape.height()});
  shape.box(frame, {shape.back() + 0.05, shape.right(), 0.15}, {shape.front(), shape.left(), 0.32});
  shape.legs(frame, {shape.depth(), shape.width()}, 0.07, 0.0, 0.15);
  shape.box(sheet, {shape.back() + 0.06, shape.right() + 0.02, 0.32}, {shape.front() - 0.02, shape.left() - 0.02, 0.5});
  shape.box(blanket, {shape.back() + 0.6, shape.right(), 0.36}, {shape.front(), shape.left(), 0.53});
  const int pillows = shape.width() > 1.3 ? 2 : 1;
  for (int i = 0; i < pillows; ++i) {
    const double half = std::min(0.32, shape.width() / 2.0 / pillows - 0.06);
    const double middle = shape.right() + shape.width() * (i + 0.5) / pillows;
    shape.ellipsoid(sheet, {shape.back() + 0.3, middle, 0.53}, {0.2, half, 0.08});
  }
}

void hospitalBed(Shape& shape, FurnitureLook& look) {
  const auto frame = shape.use(FurnitureLook::plain({190, 194, 196}, 0.4F, 0.7F));
  const auto board = shape.use(look.wood);
  const auto sheet = shape.use(FurnitureLook::plain({236, 238, 238}));
  const auto blanket = shape.use(look.cushion);
  shape.legs(frame, {shape.depth() - 0.2, shape.width() - 0.16}, 0.06, 0.0, 0.4);
  shape.box(frame, {shape.back() + 0.04, shape.right() + 0.04, 0.4}, {shape.front() - 0.04, shape.left() - 0.04, 0.5});
  shape.box(board, {shape.back(), shape.right() + 0.03, 0.4},
            {shape.back() + 0.04, shape.left() - 0.03, shape.height()});
  shape.box(board, {shape.front() - 0.04, shape.right() + 0.03, 0.4},
            {shape.front(), shape.left() - 0.03, shape.height() - 0.15});
  shape.box(sheet, {shape.back() + 0.05, shape.right() + 0.05, 0.5}, {shape.front() - 0.05, shape.left() - 0.05, 0.64});
  shape.box(blanket, {shape.back() + 0.75, shape.right() + 0.04, 0.5},
            {shape.front() - 0.05, shape.left() - 0.04, 0.66});
  shape.ellipsoid(sheet, {shape.back() + 0.32, 0.0, 0.67}, {0.2, 0.32, 0.07});
  for (const double side : {shape.right(), shape.left() - 0.025}) {
    for (const double z : {0.68, 0.8}) {
      shape.box(frame, {shape.back() + 0.3, side, z}, {shape.front() - 0.6, side + 0.025, z + 0.03});
    }
    for (const double x : {shape.back() + 0.3, shape.front() - 0.63}) {
      shape.box(frame, {x, side, 0.44}, {x + 0.03, side + 0.025, 0.8});
    }
  }
}

}  // namespace

std::span<const ThingShape> seatShapes() {
  static constexpr std::array<ThingShape, 13> kShapes{{
      {"desk", desk},
      {"school_desk", table},
      {"table", table},
      {"meeting_table", table},
      {"coffee_table", table},
      {"bedside_table", table},
      {"chair", chair},
      {"office_chair", officeChair},
      {"bench", bench},
      {"armchair", sofa},
      {"sofa", sofa},
      {"bed", bed},
      {"hospital_bed", hospitalBed},
  }};
  return kShapes;
}

}  // namespace prodomos::simulation
