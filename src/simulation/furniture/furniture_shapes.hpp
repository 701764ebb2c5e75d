// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulation/furniture/furniture_look.hpp"
#include "simulation/furniture/shape.hpp"

#include <span>
#include <string_view>

namespace prodomos::simulation {

/// How a kind of thing is built up.
struct ThingShape {
  std::string_view kind;
  void (*build)(Shape& shape, FurnitureLook& look);
};

// What one sits, works and sleeps on; what holds things; what hangs; and all else.
std::span<const ThingShape> seatShapes();
std::span<const ThingShape> storageShapes();
std::span<const ThingShape> wallShapes();
std::span<const ThingShape> otherShapes();

}  // namespace prodomos::simulation
