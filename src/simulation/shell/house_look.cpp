// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/shell/house_look.hpp"

#include "prodomos/base/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>

namespace prodomos::simulation {

namespace {

using sensors::Rgb;

constexpr std::array<Rgb, 7> kWallColors{{{226, 222, 210},
                                          {214, 219, 221},
                                          {232, 226, 196},
                                          {206, 217, 205},
                                          {222, 208, 200},
                                          {203, 212, 224},
                                          {236, 234, 230}}};
constexpr std::array<Rgb, 5> kDadoColors{
    {{142, 170, 160}, {168, 150, 118}, {120, 146, 176}, {190, 160, 110}, {150, 150, 156}}};
constexpr std::array<Rgb, 5> kWoodColors{
    {{168, 118, 72}, {196, 152, 98}, {120, 78, 46}, {214, 180, 130}, {150, 92, 60}}};
constexpr std::array<Rgb, 6> kPaintColors{
    {{120, 136, 150}, {92, 118, 160}, {106, 140, 112}, {176, 84, 66}, {240, 238, 232}, {200, 170, 96}}};
// All of them darker than any wall: a frame must stand out.
constexpr std::array<Rgb, 5> kFrameColors{{{96, 98, 102}, {64, 60, 58}, {140, 96, 60}, {104, 74, 52}, {70, 90, 124}}};
constexpr std::array<Rgb, 4> kStoneColors{{{188, 184, 176}, {164, 160, 156}, {198, 186, 166}, {150, 154, 160}}};
constexpr std::array<Rgb, 5> kCarpetColors{
    {{86, 96, 116}, {112, 104, 98}, {84, 108, 98}, {128, 92, 84}, {98, 98, 102}}};

template <std::size_t kCount>
Rgb pick(const std::array<Rgb, kCount>& colors, base::Random& random) {
  return colors[static_cast<std::size_t>(random.integer(0, static_cast<int>(kCount) - 1))];
}

Rgb scaled(const Rgb& color, double factor) {
  const auto channel = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(value * factor), 0L, 255L));
  };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

std::uint32_t patternSeed(base::Random& random) {
  return static_cast<std::uint32_t>(random.integer(0, 1 << 30));
}

Material speckled(const Rgb& color, double contrast, base::Random& random) {
  return {.color = color,
          .accent = scaled(color, 1.0 - contrast),
          .pattern = Pattern::kSpeckle,
          .scale = 0.02,
          .seed = patternSeed(random)};
}

Material wooden(const Rgb& color, base::Random& random) {
  return {.color = color,
          .accent = scaled(color, 0.72),
          .pattern = Pattern::kWood,
          .scale = 0.12,
          .seed = patternSeed(random),
          .gloss = 0.15F,
          .infrared = 0.7F};
}

Material tiled(const Rgb& color, double size, base::Random& random) {
  return {.color = color,
          .accent = scaled(color, 0.7),
          .pattern = Pattern::kTiles,
          .scale = size,
          .seed = patternSeed(random),
          .gloss = 0.25F};
}

Material carpeted(const Rgb& color, base::Random& random) {
  return {.color = color,
          .accent = scaled(color, 0.75),
          .pattern = Pattern::kCarpet,
          .scale = 0.02,
          .seed = patternSeed(random),
          .infrared = 0.55F};
}

Material painted(const Rgb& color, base::Random& random) {
  return {.color = color,
          .accent = scaled(color, 0.94),
          .pattern = Pattern::kSpeckle,
          .scale = 0.05,
          .seed = patternSeed(random),
          .gloss = 0.2F};
}

Material leafOf(base::Random& random) {
  return random.uniform() < 0.55 ? wooden(pick(kWoodColors, random), random)
                                 : painted(pick(kPaintColors, random), random);
}

bool isOneOf(std::string_view label, std::initializer_list<std::string_view> labels) {
  return std::ranges::find(labels, label) != labels.end();
}

bool isWet(std::string_view label) {
  return isOneOf(label, {"BATHROOM", "WASHROOM", "KITCHEN", "TOILET", "WC"});
}

bool isSoft(std::string_view label) {
  return label.find("OFFICE") != std::string_view::npos || label.find("CONFERENCE") != std::string_view::npos ||
         isOneOf(label, {"LIBRARY", "LIVING ROOM", "BEDROOM", "RECEPTION", "CUBICULE", "OPENSPACE"});
}

}  // namespace

HouseLook::HouseLook(const Building& building, std::uint64_t seed) : building_(building), seed_(seed) {
  base::Random random(seed, "look of a house");
  corridorWall_ = speckled(pick(kWallColors, random), 0.05, random);
  dado_ = painted(pick(kDadoColors, random), random);
  const bool isSchool = std::ranges::any_of(building.rooms, [](const Room& room) { return room.label == "CLASSROOM"; });
  hasDado_ = random.uniform() < 0.5 && isSchool;
  dadoHeight_ = random.uniform(1.05, 1.4);
  ceiling_ = tiled({238, 238, 234}, 0.6, random);
  ceiling_.gloss = 0.0F;
  ceiling_.accent = {214, 214, 210};
  skirtingHeight_ = random.uniform(0.07, 0.10);
  frameWidth_ = random.uniform(0.05, 0.08);
  frameDepth_ = random.uniform(0.01, 0.02);
  frame_ = painted(pick(kFrameColors, random), random);
  skirting_ = random.uniform() < 0.5 ? frame_ : painted({118, 112, 104}, random);
  stairs_ = speckled(pick(kStoneColors, random), 0.3, random);
  handrail_ = random.uniform() < 0.5 ? painted(pick(kWoodColors, random), random) : metal();
  roomLeaf_ = leafOf(random);
  hallLeaf_ = leafOf(random);
}

Material HouseLook::wall(const Room& room) const {
  if (room.use != RoomUse::kRoom) return corridorWall_;
  base::Random random(seed_, "walls of " + room.id);
  const bool asCorridor = random.uniform() < 0.5;
  const Material own = speckled(pick(kWallColors, random), 0.05, random);
  return asCorridor ? corridorWall_ : own;
}

std::optional<Material> HouseLook::dado(const Room& room) const {
  const bool isPainted = room.use == RoomUse::kCorridor || room.use == RoomUse::kStairs || room.label == "CLASSROOM";
  if (!hasDado_ || !isPainted) return std::nullopt;
  return dado_;
}

Material HouseLook::floor(const Room& room) const {
  // Rooms of one kind have one floor.
  const std::string kind = room.use == RoomUse::kCorridor ? "corridors" : room.label;
  base::Random random(seed_, "floor of " + kind);
  const double chance = random.uniform();
  if (isWet(room.label)) return tiled(pick(kStoneColors, random), 0.2, random);
  if (room.label == "GYM") return wooden({206, 164, 108}, random);
  if (isSoft(room.label) && chance < 0.7) return carpeted(pick(kCarpetColors, random), random);
  if (room.use == RoomUse::kRoom && chance < 0.45) return wooden(pick(kWoodColors, random), random);
  if (chance < 0.75) return tiled(pick(kStoneColors, random), random.uniform(0.3, 0.6), random);
  return speckled(pick(kStoneColors, random), 0.2, random);
}

Material HouseLook::metal() const {
  return {.color = {176, 178, 182}, .accent = {150, 152, 158}, .gloss = 0.6F, .infrared = 0.5F};
}

Material HouseLook::glass() const {
  return {.color = {96, 116, 124}, .accent = {80, 98, 106}, .gloss = 0.8F, .infrared = 0.05F};
}

DoorLook HouseLook::door(std::size_t index) const {
  const Door& door = building_.doors[index];
  base::Random random(seed_, "look of door " + door.id);
  DoorLook look{.frameWidth = frameWidth_, .frameDepth = frameDepth_, .recess = random.uniform(0.0, 0.12)};
  const double chance = random.uniform();
  const bool isOdd = random.uniform() < 0.15;
  look.leverLength = random.uniform(0.11, 0.14);
  const Material odd = leafOf(random);
  look.leaf = isOdd ? odd : door.leaves == 2 ? hallLeaf_ : roomLeaf_;
  look.leaf.seed = patternSeed(random);
  look.hasKickPlate = chance < 0.2;
  look.hasWindow = door.leaves == 2 ? chance > 0.4 : chance > 0.75;
  if (isLiftDoor(building_, door)) {
    look.leaf = metal();
    look.hasKickPlate = look.hasWindow = false;
  }
  return look;
}

}  // namespace prodomos::simulation
