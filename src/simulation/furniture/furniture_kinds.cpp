// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/furniture.hpp"

#include <algorithm>
#include <array>

namespace prodomos::simulation {

std::span<const ThingKind> thingKinds() {
  using Size = Eigen::Vector3d;
  constexpr bool kHangs = true;
  // Depth, width and height of the smallest and the largest; what stands on something or hangs: its bottom.
  static const std::array kKinds{
      ThingKind{"desk", "table", Size(0.7, 1.2, 0.72), Size(0.8, 1.7, 0.75)},
      ThingKind{"school_desk", "table", Size(0.5, 1.2, 0.70), Size(0.55, 1.3, 0.76)},
      ThingKind{"table", "table", Size(0.8, 1.2, 0.72), Size(1.0, 1.8, 0.76)},
      ThingKind{"meeting_table", "table", Size(1.1, 2.0, 0.72), Size(1.3, 3.2, 0.75)},
      ThingKind{"coffee_table", "table", Size(0.5, 0.8, 0.38), Size(0.7, 1.2, 0.45)},
      ThingKind{"bedside_table", "table", Size(0.38, 0.4, 0.45), Size(0.45, 0.5, 0.6)},
      ThingKind{"chair", "chair", Size(0.46, 0.42, 0.8), Size(0.52, 0.48, 0.95)},
      ThingKind{"office_chair", "chair", Size(0.58, 0.58, 0.95), Size(0.64, 0.64, 1.1)},
      ThingKind{"bench", "chair", Size(0.4, 1.2, 0.45), Size(0.45, 1.8, 0.48)},
      ThingKind{"armchair", "sofa", Size(0.75, 0.75, 0.75), Size(0.9, 0.95, 0.9)},
      ThingKind{"sofa", "sofa", Size(0.8, 1.5, 0.75), Size(0.95, 2.2, 0.88)},
      ThingKind{"bed", "bed", Size(2.0, 0.95, 0.7), Size(2.1, 1.7, 1.0)},
      ThingKind{"hospital_bed", "bed", Size(2.05, 0.95, 0.95), Size(2.15, 1.0, 1.1)},
      ThingKind{"cupboard", "cupboard", Size(0.4, 0.8, 1.6), Size(0.55, 1.2, 2.1)},
      ThingKind{"low_cupboard", "cupboard", Size(0.4, 0.8, 0.7), Size(0.5, 1.6, 1.1)},
      ThingKind{"wardrobe", "cupboard", Size(0.55, 1.0, 1.9), Size(0.62, 1.8, 2.2)},
      ThingKind{"lockers", "cupboard", Size(0.45, 0.9, 1.75), Size(0.5, 2.4, 1.95)},
      ThingKind{"filing_cabinet", "cupboard", Size(0.5, 0.4, 0.7), Size(0.6, 0.5, 1.35)},
      ThingKind{"shelf", "shelf", Size(0.3, 0.8, 1.6), Size(0.38, 1.2, 2.1)},
      ThingKind{"storage_shelf", "shelf", Size(0.4, 0.9, 1.6), Size(0.55, 1.6, 2.1)},
      ThingKind{"wall_bars", "shelf", Size(0.12, 0.9, 2.0), Size(0.15, 1.0, 2.15)},
      ThingKind{"counter", "counter", Size(0.65, 1.6, 1.0), Size(0.8, 2.8, 1.15)},
      ThingKind{"kitchen_counter", "counter", Size(0.6, 1.2, 0.88), Size(0.62, 2.4, 0.92)},
      ThingKind{"lab_bench", "counter", Size(0.75, 1.5, 0.88), Size(0.85, 2.2, 0.92)},
      ThingKind{"whiteboard", "board", Size(0.03, 1.5, 1.0), Size(0.05, 2.4, 1.2), 0.9, kHangs},
      ThingKind{"blackboard", "board", Size(0.04, 2.4, 1.1), Size(0.06, 3.6, 1.2), 0.85, kHangs},
      ThingKind{"noticeboard", "board", Size(0.02, 0.8, 0.9), Size(0.04, 1.8, 1.25), 0.8, kHangs},
      ThingKind{"partition", "board", Size(0.04, 1.2, 1.2), Size(0.06, 1.8, 1.6)},
      ThingKind{"poster", "poster", Size(0.006, 0.4, 0.6), Size(0.01, 0.75, 1.0), 1.1, kHangs},
      ThingKind{"tall_poster", "poster", Size(0.006, 0.8, 1.8), Size(0.01, 1.0, 2.0), 0.12, kHangs},
      ThingKind{"sign", "sign", Size(0.01, 0.18, 0.12), Size(0.02, 0.4, 0.3), 1.5, kHangs},
      ThingKind{"wall_panel", "board", Size(0.02, 0.75, 1.85), Size(0.05, 1.0, 2.1), 0.1, kHangs},
      ThingKind{"window", "window", Size(0.05, 0.8, 1.1), Size(0.07, 1.7, 1.5), 0.9, kHangs},
      ThingKind{"tall_window", "window", Size(0.05, 0.8, 1.9), Size(0.07, 1.3, 2.1), 0.1, kHangs},
      ThingKind{"curtain", "curtain", Size(0.08, 0.4, 2.0), Size(0.12, 0.7, 2.2), 0.1, kHangs},
      ThingKind{"fuse_box", "appliance", Size(0.1, 0.4, 0.5), Size(0.16, 0.7, 0.9), 1.0, kHangs},
      ThingKind{"radiator", "appliance", Size(0.08, 0.6, 0.5), Size(0.12, 1.6, 0.6), 0.14, kHangs},
      ThingKind{"tv", "screen", Size(0.05, 0.9, 0.55), Size(0.08, 1.4, 0.85), 1.1, kHangs},
      ThingKind{"screen", "screen", Size(0.16, 0.5, 0.38), Size(0.2, 0.62, 0.48), 0.75},
      ThingKind{"plant", "plant", Size(0.35, 0.35, 0.6), Size(0.7, 0.7, 1.6)},
      ThingKind{"bin", "bin", Size(0.25, 0.25, 0.3), Size(0.38, 0.38, 0.7)},
      ThingKind{"box", "box", Size(0.3, 0.3, 0.25), Size(0.55, 0.6, 0.5)},
      ThingKind{"box_pile", "box", Size(0.75, 0.6, 0.6), Size(1.3, 1.1, 1.2)},
      ThingKind{"ramp", "ramp", Size(1.2, 0.9, 0.12), Size(2.2, 1.3, 0.3)},
      ThingKind{"cart", "cart", Size(0.5, 0.75, 0.9), Size(0.6, 1.0, 1.1)},
      ThingKind{"sink", "sink", Size(0.42, 0.48, 0.85), Size(0.5, 0.6, 0.9)},
      ThingKind{"bathtub", "sink", Size(0.7, 1.5, 0.55), Size(0.8, 1.75, 0.6)},
      ThingKind{"toilet", "toilet", Size(0.62, 0.37, 0.76), Size(0.7, 0.42, 0.84)},
      ThingKind{"fridge", "appliance", Size(0.6, 0.6, 1.5), Size(0.68, 0.7, 1.9)},
      ThingKind{"stove", "appliance", Size(0.6, 0.6, 0.88), Size(0.62, 0.62, 0.92)},
      ThingKind{"washing_machine", "appliance", Size(0.58, 0.6, 0.84), Size(0.62, 0.6, 0.86)},
      ThingKind{"printer", "appliance", Size(0.55, 0.55, 0.9), Size(0.65, 0.8, 1.15)},
      ThingKind{"vending_machine", "appliance", Size(0.7, 0.8, 1.75), Size(0.85, 1.0, 1.9)},
      ThingKind{"floor_lamp", "lamp", Size(0.32, 0.32, 1.4), Size(0.42, 0.42, 1.7)},
      ThingKind{"ceiling_lamp", "lamp", Size(0.3, 1.15, 0.06), Size(0.6, 1.25, 0.08), 2.6},
  };
  return kKinds;
}

const ThingKind* findThingKind(std::string_view name) {
  const auto kinds = thingKinds();
  const auto kind = std::ranges::find(kinds, name, &ThingKind::name);
  return kind == kinds.end() ? nullptr : &*kind;
}

}  // namespace prodomos::simulation
