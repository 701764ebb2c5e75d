// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/furniture_look.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace prodomos::simulation {

namespace {

template <typename Value, std::size_t kCount>
const Value& oneOf(const std::array<Value, kCount>& values, base::Random& random) {
  return values[static_cast<std::size_t>(random.integer(0, static_cast<int>(kCount) - 1))];
}

sensors::Rgb scaled(sensors::Rgb color, double factor) {
  const auto part = [&](std::uint8_t value) { return static_cast<std::uint8_t>(std::min(255.0, value * factor)); };
  return {part(color.r), part(color.g), part(color.b)};
}

/// Dark things swallow the light of a depth sensor.
float infraredOf(sensors::Rgb color) {
  const float brightness = static_cast<float>(color.r + color.g + color.b) / (3.0F * 255.0F);
  return 0.12F + 0.75F * brightness;
}

std::uint32_t patternSeed(base::Random& random) {
  return static_cast<std::uint32_t>(random.integer(0, 1 << 30));
}

Material drawWood(base::Random& random) {
  constexpr std::array<sensors::Rgb, 5> kWoods{
      {{214, 188, 146}, {188, 146, 98}, {150, 104, 66}, {98, 64, 42}, {62, 44, 36}}};
  constexpr std::array<sensors::Rgb, 4> kLacquers{{{234, 233, 228}, {200, 200, 198}, {120, 124, 128}, {42, 42, 44}}};
  Material material;
  if (random.uniform() < 0.6) {
    material.color = oneOf(kWoods, random);
    material.accent = scaled(material.color, 0.72);
    material.pattern = Pattern::kWood;
    material.scale = 4.0;  // one board
    material.gloss = 0.1F;
  } else {
    material.color = oneOf(kLacquers, random);
    material.gloss = random.uniform() < 0.3 ? 0.5F : 0.1F;
  }
  material.infrared = infraredOf(material.color);
  material.seed = patternSeed(random);
  return material;
}

Material drawPaint(base::Random& random) {
  constexpr std::array<sensors::Rgb, 7> kPaints{
      {{205, 206, 204}, {168, 172, 176}, {92, 98, 104}, {46, 78, 122}, {124, 44, 40}, {74, 104, 80}, {214, 186, 92}}};
  const auto color = oneOf(kPaints, random);
  return FurnitureLook::plain(color, 0.25F, infraredOf(color));
}

Material drawMetal(base::Random& random) {
  const double drawn = random.uniform();
  if (drawn < 0.4) return FurnitureLook::chrome();
  if (drawn < 0.7) return FurnitureLook::plain({150, 152, 155}, 0.3F, 0.6F);
  return FurnitureLook::plain({34, 34, 36}, 0.2F, 0.2F);
}

Material drawCloth(base::Random& random) {
  constexpr std::array<sensors::Rgb, 8> kCloths{{{30, 30, 33},
                                                 {26, 28, 36},
                                                 {40, 62, 112},
                                                 {118, 38, 40},
                                                 {92, 92, 96},
                                                 {62, 88, 66},
                                                 {170, 152, 126},
                                                 {52, 46, 44}}};
  Material material;
  material.color = oneOf(kCloths, random);
  material.accent = scaled(material.color, 1.35);
  material.pattern = Pattern::kFabric;
  material.infrared = infraredOf(material.color);
  material.seed = patternSeed(random);
  return material;
}

}  // namespace

FurnitureLook::FurnitureLook(std::uint64_t seed, std::string_view group, std::string_view thing)
    : shared_(seed, "look of " + std::string(group)), own_(seed, "look of " + std::string(thing)) {
  wood = drawWood(shared_);
  paint = drawPaint(shared_);
  metal = drawMetal(shared_);
  cloth = drawCloth(shared_);
  cushion = cloth;
  cushion.color = scaled(cloth.color, 1.2);
}

Material FurnitureLook::plain(sensors::Rgb color, float gloss, float infrared) {
  return {.color = color, .gloss = gloss, .infrared = infrared};
}

Material FurnitureLook::porcelain() {
  return plain({240, 240, 238}, 0.6F, 0.85F);
}

Material FurnitureLook::chrome() {
  return plain({196, 198, 202}, 0.9F, 0.5F);
}

Material FurnitureLook::darkGlass() {
  return plain({14, 15, 18}, 0.85F, 0.06F);
}

Material FurnitureLook::glass() {
  return {.color = {150, 186, 222}, .accent = {84, 100, 74}, .pattern = Pattern::kSky, .gloss = 0.3F, .infrared = 0.0F};
}

Material FurnitureLook::patterned(Pattern pattern, sensors::Rgb color, sensors::Rgb accent, double scale) {
  return {.color = color, .accent = accent, .pattern = pattern, .scale = scale, .seed = patternSeed(own_)};
}

Material FurnitureLook::poster() {
  constexpr std::array<sensors::Rgb, 5> kPapers{
      {{236, 234, 226}, {222, 226, 234}, {238, 214, 120}, {60, 84, 134}, {180, 60, 52}}};
  constexpr std::array<sensors::Rgb, 5> kInks{
      {{32, 60, 120}, {150, 34, 36}, {24, 24, 26}, {224, 222, 210}, {40, 100, 60}}};
  const auto paper = oneOf(kPapers, own_);
  auto material = patterned(Pattern::kPoster, paper, oneOf(kInks, own_), 1.0);
  material.gloss = own_.uniform() < 0.4 ? 0.4F : 0.0F;
  return material;
}

Material FurnitureLook::leaves() {
  constexpr std::array<sensors::Rgb, 4> kGreens{{{52, 98, 44}, {74, 124, 58}, {40, 78, 48}, {110, 138, 70}}};
  const auto green = oneOf(kGreens, own_);
  auto material = patterned(Pattern::kSpeckle, green, scaled(green, 0.7), 1.0);
  material.infrared = 0.7F;
  return material;
}

}  // namespace prodomos::simulation
