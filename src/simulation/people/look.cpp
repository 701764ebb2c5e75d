// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people/look.hpp"

#include "prodomos/base/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace prodomos::simulation {

namespace {

using sensors::Rgb;

constexpr std::array<Rgb, 6> kSkins{
    {{236, 196, 172}, {224, 178, 150}, {205, 156, 125}, {172, 122, 92}, {128, 86, 62}, {92, 62, 46}}};
constexpr std::array<Rgb, 6> kHairs{
    {{28, 23, 20}, {46, 33, 25}, {78, 54, 36}, {118, 84, 52}, {168, 136, 88}, {140, 138, 134}}};
constexpr std::array<Rgb, 12> kTops{{{196, 52, 48},
                                     {38, 66, 122},
                                     {74, 128, 178},
                                     {46, 92, 62},
                                     {214, 178, 72},
                                     {122, 122, 126},
                                     {36, 36, 42},
                                     {222, 222, 218},
                                     {112, 62, 104},
                                     {148, 92, 58},
                                     {92, 148, 140},
                                     {206, 132, 146}}};
constexpr std::array<Rgb, 6> kTrousers{
    {{42, 56, 88}, {66, 84, 118}, {34, 34, 38}, {74, 74, 78}, {142, 124, 96}, {72, 60, 50}}};
constexpr std::array<Rgb, 4> kShoes{{{34, 30, 28}, {88, 60, 40}, {206, 204, 200}, {58, 62, 72}}};

template <std::size_t kCount>
Rgb oneOf(const std::array<Rgb, kCount>& colors, base::Random& random) {
  return colors[static_cast<std::size_t>(random.integer(0, static_cast<int>(kCount) - 1))];
}

Rgb scaled(const Rgb& color, double factor) {
  const auto channel = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(value * factor), 0L, 255L));
  };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

/// Dark cloth sends back less of a depth sensor's light, too.
float infraredOf(const Rgb& color) {
  const auto brightness = static_cast<float>(color.r + color.g + color.b) / (3.0F * 255.0F);
  return 0.25F + 0.6F * brightness;
}

Material clothOf(const Rgb& color, base::Random& random) {
  Material cloth{.color = color, .accent = scaled(color, 0.82)};
  cloth.pattern = random.uniform() < 0.7 ? Pattern::kFabric : Pattern::kPlain;
  cloth.scale = 0.012;
  cloth.seed = static_cast<std::uint32_t>(random.integer(0, 1 << 30));
  cloth.infrared = infraredOf(color);
  return cloth;
}

Material plain(const Rgb& color, float gloss, float infrared) {
  return {.color = color, .accent = scaled(color, 0.85), .gloss = gloss, .infrared = infrared};
}

}  // namespace

Look lookOf(std::uint64_t seed) {
  base::Random random(seed, "look of a person");
  Look look;
  look.female = random.uniform() < 0.5;
  look.girth = std::clamp(random.normal(1.0, 0.07), 0.88, 1.2);
  look.top = static_cast<Top>(random.integer(0, 3));
  const double hair = random.uniform();
  if (look.female) {
    look.hair = hair < 0.4 ? Hair::kLong : (hair < 0.75 ? Hair::kPonytail : Hair::kFull);
  } else {
    look.hair = hair < 0.6 ? Hair::kShort : (hair < 0.85 ? Hair::kFull : Hair::kShaved);
  }
  look.skinMaterial = plain(oneOf(kSkins, random), 0.05F, 0.7F);
  look.hairMaterial = plain(oneOf(kHairs, random), 0.1F, 0.3F);
  look.hairMaterial.pattern = Pattern::kSpeckle;
  look.hairMaterial.scale = 0.01;
  look.topMaterial = clothOf(scaled(oneOf(kTops, random), random.uniform(0.8, 1.1)), random);
  const Rgb inner = look.top == Top::kJacket ? oneOf(kTops, random) : scaled(look.topMaterial.color, 0.8);
  look.innerMaterial = clothOf(inner, random);
  look.trousersMaterial = clothOf(scaled(oneOf(kTrousers, random), random.uniform(0.85, 1.15)), random);
  look.beltMaterial = plain({48, 36, 28}, 0.2F, 0.3F);
  look.shoeMaterial = plain(oneOf(kShoes, random), 0.15F, 0.4F);
  look.soleMaterial = plain(random.uniform() < 0.5 ? Rgb{225, 222, 215} : Rgb{40, 38, 36}, 0.0F, 0.4F);
  return look;
}

}  // namespace prodomos::simulation
