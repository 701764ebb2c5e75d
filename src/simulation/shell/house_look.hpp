// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

/// Colours and fittings of a house by seed: one taste for all of it, and a little of their own for rooms and doors.
namespace prodomos::simulation {

/// How one door is made.
struct DoorLook {
  double frameWidth = 0.06;   ///< of the boards around its opening, metres
  double frameDepth = 0.015;  ///< how far they stand out of the wall
  double recess = 0.05;       ///< of the leaf behind the wall's face on the corridor's side
  Material leaf;
  bool hasKickPlate = false;
  bool hasWindow = false;
  double leverLength = 0.12;
};

class HouseLook {
 public:
  HouseLook(const Building& building, std::uint64_t seed);

  Material wall(const Room& room) const;
  /// Of the lower part of its walls, where they are of two colours.
  std::optional<Material> dado(const Room& room) const;
  Material floor(const Room& room) const;
  Material ceiling() const { return ceiling_; }
  Material skirting() const { return skirting_; }
  Material frame() const { return frame_; }
  Material stairs() const { return stairs_; }
  Material handrail() const { return handrail_; }
  Material metal() const;
  Material glass() const;
  DoorLook door(std::size_t index) const;

  double dadoHeight() const { return dadoHeight_; }
  double skirtingHeight() const { return skirtingHeight_; }

 private:
  const Building& building_;
  std::uint64_t seed_;
  Material corridorWall_;
  Material dado_;
  Material ceiling_;
  Material skirting_;
  Material frame_;
  Material stairs_;
  Material handrail_;
  Material roomLeaf_;
  Material hallLeaf_;
  bool hasDado_ = false;
  double dadoHeight_ = 1.2;
  double skirtingHeight_ = 0.08;
  double frameWidth_ = 0.06;
  double frameDepth_ = 0.015;
};

}  // namespace prodomos::simulation
