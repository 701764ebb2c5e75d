// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/palette.hpp"

#include <array>
#include <cmath>

namespace prodomos::exporter {

map::Rgba placeColor(std::optional<int> place) {
  // Dark enough for white text, apart for those who do not see red or green; none is the green of predictions.
  static constexpr std::array<map::Rgba, 12> kColors = {{{31, 119, 180, 255},
                                                         {203, 75, 22, 255},
                                                         {108, 80, 168, 255},
                                                         {0, 139, 139, 255},
                                                         {184, 50, 94, 255},
                                                         {133, 107, 0, 255},
                                                         {70, 90, 115, 255},
                                                         {160, 82, 45, 255},
                                                         {62, 76, 190, 255},
                                                         {170, 60, 160, 255},
                                                         {88, 110, 30, 255},
                                                         {0, 110, 170, 255}}};
  if (!place) return kMutedColor;
  return kColors.at(static_cast<std::size_t>(std::abs(*place)) % kColors.size());
}

map::Rgba withAlpha(map::Rgba color, double opacity) {
  color.a = static_cast<std::uint8_t>(std::lround(opacity * 255.0));
  return color;
}

std::string hex(map::Rgba color) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const int part : {color.r, color.g, color.b}) {
    text += kDigits.at(static_cast<std::size_t>(part / 16));
    text += kDigits.at(static_cast<std::size_t>(part % 16));
  }
  return text;
}

}  // namespace prodomos::exporter
