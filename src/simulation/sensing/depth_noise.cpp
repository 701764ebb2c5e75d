// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/depth_noise.hpp"

#include "simulation/sensing/parallel_rows.hpp"
#include "simulation/sensing/pixel_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace prodomos::simulation {
namespace {

using sensors::Image;

/// Clamped to the picture.
template <typename Pixel>
const Pixel& near(const Image<Pixel>& image, int x, int y) {
  return image(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
}

/// To the next whole number; far quicker than std::round where the machine's baseline has no instruction for it.
int rounded(float value) {
  return static_cast<int>(value + (value < 0.0F ? -0.5F : 0.5F));
}

/// Normal noise with σ = 1 that neighbours share: the mean of a window around each pixel, scaled.
Image<float> sharedNoise(int width, int height, int window, const PixelNoise& noise, int threads) {
  const int reach = window / 2;
  const int size = 2 * reach + 1;
  Image<float> along(width, height + 2 * reach);
  forRows(along.height(), threads, [&](int row) {
    float sum = 0.0F;
    std::vector<float> white(static_cast<std::size_t>(width + 2 * reach));
    for (int x = 0; x < width + 2 * reach; ++x) white[static_cast<std::size_t>(x)] = noise.normal(x, row);
    for (int x = 0; x < size - 1; ++x) sum += white[static_cast<std::size_t>(x)];
    for (int x = 0; x < width; ++x) {
      sum += white[static_cast<std::size_t>(x + size - 1)];
      along(x, row) = sum;
      sum -= white[static_cast<std::size_t>(x)];
    }
  });
  Image<float> shared(width, height);
  forRows(height, threads, [&](int y) {
    float* out = shared.row(y);
    for (int dy = 0; dy < size; ++dy) {
      const float* in = along.row(y + dy);
      for (int x = 0; x < width; ++x) out[x] += in[x] / static_cast<float>(size);
    }
  });
  return shared;
}

/// A device's own distortion: smooth waves of many lengths, worked out at every eighth pixel.
class Warp {
 public:
  Warp(int width, int height, const DepthNoise& noise)
      : columns_(width / kStep + 2),
        rows_(height / kStep + 2),
        steps_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    base::Random random(noise.device, "depth warp");
    for (int wave = 0; wave < kWaves; ++wave) {
      // Lengths from an eighth of the picture's width to all of it.
      const double length = width * std::pow(8.0, random.uniform(-1.0, 0.0));
      const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double amplitude = noise.warp * std::sqrt(2.0 / kWaves);
      const double turn = 2.0 * std::numbers::pi * kStep / length;
      for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
          const double along = column * std::cos(direction) + row * std::sin(direction);
          at(column, row) += static_cast<float>(amplitude * std::sin(turn * along + phase));
        }
      }
    }
  }

  float operator()(int x, int y) const {
    const int column = x / kStep;
    const int row = y / kStep;
    const float tx = static_cast<float>(x % kStep) / kStep;
    const float ty = static_cast<float>(y % kStep) / kStep;
    const float upper = at(column, row) + tx * (at(column + 1, row) - at(column, row));
    const float lower = at(column, row + 1) + tx * (at(column + 1, row + 1) - at(column, row + 1));
    return upper + ty * (lower - upper);
  }

 private:
  static constexpr int kStep = 8;
  static constexpr int kWaves = 24;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  float& at(int column, int row) { return steps_[index(column, row)]; }
  const float& at(int column, int row) const { return steps_[index(column, row)]; }

  int columns_;
  int rows_;
  std::vector<float> steps_;
};

/// One picture's measurement.
class Measurement {
 public:
  Measurement(const Rendering& rendering, const CameraModel& camera, const DepthNoise& noise, std::uint64_t seed,
              int threads)
      : seen_(rendering),
        noise_(noise),
        stepsMetres_(static_cast<float>(noise.focalLength * noise.baseline * noise.stepsPerPixel)),
        shift_(static_cast<float>(camera.intrinsics.fx * noise.baseline)),
        jitter_(seed),
        disparityNoise_(sharedNoise(width(), height(), noise.window, PixelNoise(seed + 1), threads)),
        lossNoise_(sharedNoise(width(), height(), noise.window, PixelNoise(seed + 2), threads)),
        warp_(width(), height(), noise),
        disparities_(width(), height()) {
    forRows(height(), threads, [&](int y) {
      for (int x = 0; x < width(); ++x) {
        const float z = seen_.depth(x, y);
        disparities_(x, y) = z > 0.0F ? stepsMetres_ / z : 0.0F;
      }
    });
  }

  int width() const { return seen_.depth.width(); }
  int height() const { return seen_.depth.height(); }

  void measureRow(int y, Image<float>& depth) const {
    const std::vector<bool> unlit = unlitPixels(y);
    for (int x = 0; x < width(); ++x) {
      if (!unlit[static_cast<std::size_t>(x)]) depth(x, y) = measured(x, y);
    }
  }

 private:
  struct Pixel {
    int x = 0;
    int y = 0;
  };

  float disparity(int x, int y) const { return near(disparities_, x, y); }

  /// Those that the projector, on the camera's right, does not reach: on its picture they would lie behind one farther
  /// right. One pixel of tolerance keeps flat surfaces whole.
  std::vector<bool> unlitPixels(int y) const {
    std::vector<bool> unlit(static_cast<std::size_t>(width()));
    float leftmost = std::numeric_limits<float>::infinity();
    for (int x = width() - 1; x >= 0; --x) {
      const float z = seen_.depth(x, y);
      if (z <= 0.0F) continue;
      const float projected = static_cast<float>(x) - shift_ / z;
      unlit[static_cast<std::size_t>(x)] = projected > leftmost + 1.0F;
      leftmost = std::min(leftmost, projected);
    }
    return unlit;
  }

  /// Where the pixel really looks: a pixel or so beside, its neighbours with it.
  Pixel source(int x, int y) const {
    constexpr int kCell = 2;
    const std::uint64_t bits = jitter_.bits(x / kCell, y / kCell);
    const auto sigma = static_cast<float>(noise_.lateralSigma);
    const auto offset = [&](std::uint64_t part) {
      // Sum of two bytes: a triangle of σ 104.5.
      const auto sum = static_cast<float>((part & 0xffU) + ((part >> 8) & 0xffU)) - 255.0F;
      return rounded(sigma * sum / 104.5F);
    };
    return {std::clamp(x + offset(bits), 0, width() - 1), std::clamp(y + offset(bits >> 16), 0, height() - 1)};
  }

  /// The correlation window decides for what most of it shows, so that corners go round and thin things are lost. In
  /// the middle of a flat surface that is the pixel itself.
  Pixel majority(const Pixel& at) const {
    const int reach = noise_.window / 2;
    const float middle = disparity(at.x, at.y);
    constexpr float kBend = 2.0F;
    const auto bend = [&](int dx, int dy) {
      return std::abs(disparity(at.x + dx, at.y + dy) + disparity(at.x - dx, at.y - dy) - 2.0F * middle);
    };
    if (bend(reach, 0) < kBend && bend(0, reach) < kBend) return at;
    std::array<std::pair<float, Pixel>, 9> window;
    std::size_t i = 0;
    for (const int dy : {-reach, 0, reach}) {
      for (const int dx : {-reach, 0, reach}) {
        const Pixel pixel{std::clamp(at.x + dx, 0, width() - 1), std::clamp(at.y + dy, 0, height() - 1)};
        window[i++] = {disparity(pixel.x, pixel.y), pixel};
      }
    }
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::nth_element(window.begin(), window.begin() + 4, window.end(), less);
    return window[4].second;
  }

  /// Whether enough light comes back, and not too much; patches of a window's size are lost together.
  bool isLost(const Pixel& at, float luck) const {
    const float z = seen_.depth(at.x, at.y);
    const float signal = seen_.infrared(at.x, at.y) / (z * z);
    const float strictness = std::max(0.4F, 1.0F + 0.2F * luck);
    return signal < static_cast<float>(noise_.leastSignal) * strictness ||
           signal > static_cast<float>(noise_.mostSignal) ||
           seen_.cosine(at.x, at.y) < static_cast<float>(noise_.leastCosine) * strictness;
  }

  float measured(int x, int y) const {
    const Pixel at = majority(source(x, y));
    const float exact = disparity(at.x, at.y);
    if (exact <= 0.0F || isLost(at, lossNoise_(x, y))) return 0.0F;
    const float error = static_cast<float>(noise_.disparitySigma) * disparityNoise_(x, y) + warp_(x, y);
    const auto offset = static_cast<float>(noise_.stepOffset);
    const float step = static_cast<float>(rounded(exact + error - offset)) + offset;
    if (step <= 0.0F) return 0.0F;
    const float z = stepsMetres_ / step;
    if (z < static_cast<float>(noise_.leastRange) || z > static_cast<float>(noise_.mostRange)) return 0.0F;
    return static_cast<float>(rounded(z * 1000.0F)) / 1000.0F;
  }

  const Rendering& seen_;
  const DepthNoise& noise_;
  float stepsMetres_;  ///< disparity steps times depth
  float shift_;        ///< between projector and camera, in the camera's pixels, times depth
  PixelNoise jitter_;
  Image<float> disparityNoise_;
  Image<float> lossNoise_;
  Warp warp_;
  Image<float> disparities_;  ///< exact ones, in steps; 0 where nothing is
};

}  // namespace

Image<float> noisyDepth(const Rendering& rendering, const CameraModel& camera, const DepthNoise& noise,
                        base::Random& random, int threads) {
  const auto seed = static_cast<std::uint64_t>(random.uniform() * 0x1.0p53);
  const Measurement measurement(rendering, camera, noise, seed, threads);
  Image<float> depth(measurement.width(), measurement.height());
  forRows(measurement.height(), threads, [&](int y) { measurement.measureRow(y, depth); });
  return depth;
}

}  // namespace prodomos::simulation
