// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/color_noise.hpp"

#include "simulation/sensing/parallel_rows.hpp"
#include "simulation/sensing/patterns.hpp"
#include "simulation/sensing/pixel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace prodomos::simulation {
namespace {

using sensors::Image;
using sensors::Rgb;

std::uint8_t shifted(std::uint8_t level, float error) {
  return static_cast<std::uint8_t>(std::clamp(static_cast<float>(level) + error + 0.5F, 0.0F, 255.0F));
}

/// Roughly normal, σ = 1, of twelve bits: three numbers of four bits each.
float roughNormal(std::uint64_t bits) {
  const auto sum = static_cast<float>((bits & 15U) + ((bits >> 4) & 15U) + ((bits >> 8) & 15U));
  return (sum - 22.5F) / 7.984F;  // √(3 · (16² - 1) / 12)
}

/// The mean along the way, in light rather than in levels.
Rgb meanAlong(const Image<Rgb>& color, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const int steps = 1 + std::min(32, static_cast<int>((to - from).norm()));
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < steps; ++i) {
    const double share = steps > 1 ? static_cast<double>(i) / (steps - 1) : 0.0;
    const Eigen::Vector2d at = from + share * (to - from);
    sum += linearColor(color(std::clamp(static_cast<int>(std::lround(at.x())), 0, color.width() - 1),
                             std::clamp(static_cast<int>(std::lround(at.y())), 0, color.height() - 1)));
  }
  return encodedColor(sum / static_cast<float>(steps));
}

}  // namespace

Image<Rgb> noisyColor(const Image<Rgb>& color, const ColorNoise& noise, base::Random& random, int threads) {
  const PixelNoise bits(static_cast<std::uint64_t>(random.uniform() * 0x1.0p53));
  const auto common = static_cast<float>(noise.brightnessSigma);
  const auto single = static_cast<float>(noise.channelSigma);
  Image<Rgb> noisy(color.width(), color.height());
  forRows(color.height(), threads, [&](int y) {
    for (int x = 0; x < color.width(); ++x) {
      const std::uint64_t drawn = bits.bits(x, y);
      const float all = common * roughNormal(drawn);
      const Rgb& pixel = color(x, y);
      noisy(x, y) = {shifted(pixel.r, all + single * roughNormal(drawn >> 12)),
                     shifted(pixel.g, all + single * roughNormal(drawn >> 24)),
                     shifted(pixel.b, all + single * roughNormal(drawn >> 36))};
    }
  });
  return noisy;
}

Image<Rgb> motionBlurred(const Rendering& rendering, const CameraModel& camera, const geometry::Pose3& T_end_begin,
                         int threads) {
  const geometry::Pose3 T_begin_end = T_end_begin.inverse();
  Image<Rgb> blurred = rendering.color.clone();
  forRows(blurred.height(), threads, [&](int y) {
    for (int x = 0; x < blurred.width(); ++x) {
      const double z = rendering.depth(x, y);
      const Eigen::Vector2d pixel(x, y);
      const Eigen::Vector3d point_in_begin = T_begin_end * (z * directionThrough(camera, pixel));
      if (z <= 0.0 || point_in_begin.z() <= 0.0) continue;
      blurred(x, y) = meanAlong(rendering.color, pixel, project(camera, point_in_begin));
    }
  });
  return blurred;
}

}  // namespace prodomos::simulation
