// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/sensing/patterns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace prodomos::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kEncodingSteps = 4096;

std::uint32_t hash(std::uint32_t value) {
  value ^= value >> 16;
  value *= 0x7feb352dU;
  value ^= value >> 15;
  value *= 0x846ca68bU;
  return value ^ (value >> 16);
}

std::uint32_t hash(int x, int y, std::uint32_t seed) {
  return hash(static_cast<std::uint32_t>(x) * 0x9e3779b1U + static_cast<std::uint32_t>(y) * 0x85ebca77U +
              seed * 0xc2b2ae3dU);
}

/// In [0, 1), of a cell.
float chance(int x, int y, std::uint32_t seed) {
  return static_cast<float>(hash(x, y, seed) >> 8) * 0x1.0p-24F;
}

int cellOf(float value) {
  const int cell = static_cast<int>(value);
  return static_cast<float>(cell) > value ? cell - 1 : cell;
}

/// Without the exactness of std::lerp at its ends, which costs more than the rest of a pattern.
float mix(float a, float b, float share) {
  return a + share * (b - a);
}

Vector3f mix(const Vector3f& a, const Vector3f& b, float share) {
  return a + share * (b - a);
}

/// Share of the pixel [x - footprint/2, x + footprint/2] that lies in [low, high].
float band(float x, float low, float high, float footprint) {
  const float half = std::max(footprint, 1e-5F) / 2.0F;
  return std::max(0.0F, std::min(high, x + half) - std::max(low, x - half)) / (2.0F * half);
}

/// How much is left of detail of that size.
float clarity(float size, float footprint) {
  return std::clamp(1.5F - footprint / size, 0.0F, 1.0F);
}

/// Smooth noise in [-1, 1], one lump per unit.
float noise(float x, float y, std::uint32_t seed) {
  const int x0 = cellOf(x);
  const int y0 = cellOf(y);
  const auto ease = [](float t) { return t * t * (3.0F - 2.0F * t); };
  const float tx = ease(x - static_cast<float>(x0));
  const float ty = ease(y - static_cast<float>(y0));
  const float upper = mix(chance(x0, y0, seed), chance(x0 + 1, y0, seed), tx);
  const float lower = mix(chance(x0, y0 + 1, seed), chance(x0 + 1, y0 + 1, seed), tx);
  return 2.0F * mix(upper, lower, ty) - 1.0F;
}

/// Noise of lumps of that size, metres, gone where pixels are larger.
float grain(const Vector2f& point, float size, float footprint, std::uint32_t seed) {
  const float left = clarity(size, footprint);
  return left <= 0.0F ? 0.0F : left * noise(point.x() / size, point.y() / size, seed);
}

/// Lines of words, dark on light: share of ink. `pitch` from line to line.
float text(const Vector2f& point, float pitch, float footprint, std::uint32_t seed) {
  const int line = cellOf(point.y() / pitch);
  const float withinLine = point.y() - static_cast<float>(line) * pitch;
  const float ink = band(withinLine, 0.3F * pitch, 0.75F * pitch, footprint);
  const int letter = cellOf(point.x() / (0.5F * pitch));
  const bool gap = chance(letter / 2, line, seed) < 0.16F;
  const float shade = 0.55F + 0.35F * clarity(0.5F * pitch, footprint) * (chance(letter, line, seed + 1) - 0.5F);
  return gap ? (1.0F - clarity(pitch, footprint)) * 0.5F * ink : shade * ink;
}

Vector3f plain(const Material& material, const PatternSample& at) {
  const float dirt = 0.025F * grain(at.point, 0.7F, at.footprint, material.seed) +
                     0.012F * grain(at.point, 0.012F, at.footprint, material.seed + 1);
  return linearColor(material.color) * (1.0F + dirt);
}

Vector3f speckle(const Material& material, const PatternSample& at) {
  const float size = 0.01F * static_cast<float>(material.scale);
  const float fine = grain(at.point, size, at.footprint, material.seed);
  const float coarse = grain(at.point, 3.0F * size, at.footprint, material.seed + 1);
  const float share = std::clamp(0.3F + 0.5F * fine * std::abs(fine) + 0.25F * coarse, 0.0F, 1.0F);
  return mix(linearColor(material.color), linearColor(material.accent), share);
}

/// Boards side by side, their grain along the second coordinate.
Vector3f wood(const Material& material, const PatternSample& at) {
  const auto width = static_cast<float>(material.scale);
  const int board = cellOf(at.point.x() / width);
  const std::uint32_t seed = hash(board, 0, material.seed);
  const float x = at.point.x();
  const float y = at.point.y();
  const float bend = 0.05F * noise(1.5F * x, 0.7F * y, seed);
  const float rings = clarity(0.02F, at.footprint) * noise(45.0F * (x + bend), 1.1F * y, seed + 1);
  const float fibres = clarity(0.004F, at.footprint) * noise(260.0F * x, 6.0F * y, seed + 2);
  const float share = std::clamp(0.35F + 0.3F * rings + 0.12F * fibres, 0.0F, 1.0F);
  const float tint = 1.0F + 0.12F * (chance(board, 1, material.seed) - 0.5F);
  const float withinBoard = x - static_cast<float>(board) * width;
  const float joint = band(withinBoard, 0.0F, 0.002F, at.footprint);
  return mix(linearColor(material.color), linearColor(material.accent), share) * (tint * (1.0F - 0.6F * joint));
}

Vector3f tiles(const Material& material, const PatternSample& at) {
  const auto edge = static_cast<float>(material.scale);
  const float joint = std::min(0.02F * edge, 0.006F);
  const int column = cellOf(at.point.x() / edge);
  const int row = cellOf(at.point.y() / edge);
  const float x = at.point.x() - static_cast<float>(column) * edge;
  const float y = at.point.y() - static_cast<float>(row) * edge;
  const float inside = band(x, joint, edge, at.footprint) * band(y, joint, edge, at.footprint);
  const float fade = clarity(edge, at.footprint);
  const float tint = 1.0F + fade * 0.08F * (chance(column, row, material.seed) - 0.5F) +
                     0.03F * grain(at.point, 0.06F, at.footprint, material.seed + 1);
  return mix(linearColor(material.accent), linearColor(material.color) * tint, inside);
}

Vector3f carpet(const Material& material, const PatternSample& at) {
  const float size = 0.01F * static_cast<float>(material.scale);
  const float loops = grain(at.point, size, at.footprint, material.seed);
  const float worn = grain(at.point, 0.5F, at.footprint, material.seed + 1);
  const float share = std::clamp(0.4F + 0.4F * loops + 0.1F * worn, 0.0F, 1.0F);
  return mix(linearColor(material.color), linearColor(material.accent), share);
}

Vector3f fabric(const Material& material, const PatternSample& at) {
  const float size = 0.01F * static_cast<float>(material.scale);
  const float folds = noise(at.point.x() / 0.06F, at.point.y() / 0.25F, material.seed);
  const float weave = grain(at.point, size, at.footprint, material.seed + 1);
  const float share = std::clamp(0.25F + 0.25F * weave, 0.0F, 1.0F);
  return mix(linearColor(material.color), linearColor(material.accent), share) * (1.0F + 0.12F * folds);
}

/// A title, a picture and text below, on coloured paper.
Vector3f poster(const Material& material, const PatternSample& at) {
  const float x = at.point.x() / std::max(at.extent.x(), 0.01F);
  const float y = at.point.y() / std::max(at.extent.y(), 0.01F);
  Vector3f paper = linearColor(material.color);
  const Vector3f ink = linearColor(material.accent);
  constexpr float kMargin = 0.07F;
  if (x < kMargin || x > 1.0F - kMargin || y < kMargin || y > 0.96F) return paper;
  const float pitch = 0.035F * at.extent.x();
  if (y > 0.84F) return mix(paper, ink, text(at.point, 2.4F * pitch, at.footprint, material.seed));
  const float pictureBottom = 0.35F + 0.2F * chance(0, 0, material.seed);
  const float split = chance(1, 0, material.seed) < 0.5F ? 1.0F : 0.55F;
  if (y > pictureBottom && y < 0.81F && x < split) {
    const float hills = 0.6F + 0.1F * noise(5.0F * x, 0.0F, material.seed + 2);
    const float lumps = 0.5F + 0.5F * noise(6.0F * x, 9.0F * y, material.seed + 3);
    return y > hills ? mix(paper, ink, 0.3F + 0.25F * lumps)
                     : mix(ink, Vector3f(0.12F, 0.25F, 0.06F), 0.3F + 0.5F * lumps);
  }
  return mix(paper, Vector3f::Constant(0.03F), text(at.point, pitch, at.footprint, material.seed + 4));
}

/// Cork in a frame with sheets pinned to it, some of them coloured.
Vector3f noticeboard(const Material& material, const PatternSample& at) {
  constexpr float kFrame = 0.025F;
  constexpr float kCellWidth = 0.27F;
  constexpr float kCellHeight = 0.36F;
  const Vector2f& p = at.point;
  const float inside = band(p.x(), kFrame, at.extent.x() - kFrame, at.footprint) *
                       band(p.y(), kFrame, at.extent.y() - kFrame, at.footprint);
  Vector3f color = linearColor(material.color) * (1.0F + 0.15F * grain(p, 0.006F, at.footprint, material.seed));
  const int column = cellOf(p.x() / kCellWidth);
  const int row = cellOf(p.y() / kCellHeight);
  const auto draw = [&](std::uint32_t what) { return chance(column, row, material.seed + what); };
  if (draw(1) < 0.72F) {
    const float width = 0.15F + 0.08F * draw(2);
    const float height = 0.2F + 0.12F * draw(3);
    const float left = static_cast<float>(column) * kCellWidth + (kCellWidth - width) * draw(4);
    const float bottom = static_cast<float>(row) * kCellHeight + (kCellHeight - height) * draw(5);
    const float share =
        band(p.x(), left, left + width, at.footprint) * band(p.y(), bottom, bottom + height, at.footprint);
    const Vector3f paper = draw(6) < 0.7F
                               ? Vector3f(0.85F, 0.85F, 0.82F)
                               : Vector3f(0.5F + 0.4F * draw(7), 0.5F + 0.4F * draw(8), 0.25F + 0.4F * draw(9));
    const Vector2f onSheet = p - Vector2f(left, bottom);
    const bool written =
        onSheet.x() > 0.02F && onSheet.x() < width - 0.02F && onSheet.y() > 0.03F && onSheet.y() < height - 0.03F;
    const float ink = written ? text(onSheet, 0.012F, at.footprint, material.seed + hash(column, row, 10)) : 0.0F;
    color = mix(color, paper * (1.0F - 0.9F * ink), share);
  }
  return mix(linearColor(material.accent), color, inside);
}

/// Spines of books in rows, dark above them.
Vector3f books(const Material& material, const PatternSample& at) {
  const float shelf = std::min(static_cast<float>(material.scale), std::max(at.extent.y(), 0.05F));
  constexpr float kSlot = 0.035F;
  const int row = cellOf(at.point.y() / shelf);
  const float y = at.point.y() - static_cast<float>(row) * shelf;
  const int slot = cellOf(at.point.x() / kSlot);
  const std::uint32_t seed = hash(row, slot, material.seed);
  const float top = shelf * (0.62F + 0.3F * chance(0, 1, seed));
  const float x = at.point.x() - static_cast<float>(slot) * kSlot;
  const Vector3f hue(chance(0, 2, seed), chance(0, 3, seed), chance(0, 4, seed));
  const float shade = 0.1F + 0.5F * chance(0, 6, seed);
  const Vector3f cloth = shade * mix(Vector3f::Constant(hue.mean()), hue, 0.7F);
  const Vector3f cover = mix(linearColor(material.color), cloth, 0.85F);
  const float label = band(y, 0.7F * top, 0.8F * top, at.footprint) * (chance(0, 5, seed) < 0.6F ? 0.6F : 0.0F);
  const float share = band(y, 0.0F, top, at.footprint) * band(x, 0.002F, kSlot, at.footprint);
  return mix(linearColor(material.accent) * 0.15F, mix(cover, Vector3f::Constant(0.8F), label), share);
}

/// Out of a window: houses and trees below, clouds above.
Vector3f sky(const Material& material, const PatternSample& at) {
  const float y = at.point.y() / std::max(at.extent.y(), 0.01F);
  const float horizon = 0.3F + 0.12F * noise(at.point.x() / 0.4F, 0.0F, material.seed) +
                        0.03F * noise(at.point.x() / 0.05F, 0.0F, material.seed + 1);
  const float clouds = 0.5F + 0.5F * noise(at.point.x() / 0.5F, at.point.y() / 0.2F, material.seed + 2);
  const Vector3f heaven = mix(linearColor(material.color), Vector3f::Ones(), 0.3F + 0.4F * clouds);
  const Vector3f ground =
      linearColor(material.accent) * (0.6F + 0.4F * noise(at.point.x() / 0.08F, y / 0.05F, material.seed + 3));
  return mix(ground, heaven, band(y, horizon, 1e6F, std::max(at.footprint, 0.01F)));
}

sensors::Image<sensors::Rgb> halved(const sensors::Image<sensors::Rgb>& image) {
  sensors::Image<sensors::Rgb> half(std::max(1, image.width() / 2), std::max(1, image.height() / 2));
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      Vector3f sum = Vector3f::Zero();
      for (const int dy : {0, 1}) {
        for (const int dx : {0, 1}) {
          sum += linearColor(image(std::min(2 * x + dx, image.width() - 1), std::min(2 * y + dy, image.height() - 1)));
        }
      }
      half(x, y) = encodedColor(sum / 4.0F);
    }
  }
  return half;
}

Vector3f bilinear(const sensors::Image<sensors::Rgb>& image, const Vector2f& coordinates) {
  const float x = (coordinates.x() - std::floor(coordinates.x())) * static_cast<float>(image.width()) - 0.5F;
  const float y = (1.0F - (coordinates.y() - std::floor(coordinates.y()))) * static_cast<float>(image.height()) - 0.5F;
  const int x0 = cellOf(x);
  const int y0 = cellOf(y);
  const auto at = [&](int column, int row) {
    return linearColor(image((column + image.width()) % image.width(), (row + image.height()) % image.height()));
  };
  const float tx = x - static_cast<float>(x0);
  const float ty = y - static_cast<float>(y0);
  return mix(mix(at(x0, y0), at(x0 + 1, y0), tx), mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), tx), ty);
}

}  // namespace

Eigen::Vector3f linearColor(sensors::Rgb color) {
  static const auto kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = std::pow(static_cast<float>(i) / 255.0F, 2.2F);
    return table;
  }();
  return {kTable[color.r], kTable[color.g], kTable[color.b]};
}

sensors::Rgb encodedColor(const Eigen::Vector3f& linear) {
  static const auto kTable = [] {
    std::array<std::uint8_t, kEncodingSteps + 1> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const float value = std::pow(static_cast<float>(i) / kEncodingSteps, 1.0F / 2.2F);
      table[i] = static_cast<std::uint8_t>(std::lround(255.0F * value));
    }
    return table;
  }();
  const auto encoded = [&](float value) {
    return kTable[static_cast<std::size_t>(std::clamp(value, 0.0F, 1.0F) * kEncodingSteps)];
  };
  return {encoded(linear.x()), encoded(linear.y()), encoded(linear.z())};
}

MipMap::MipMap(const sensors::Image<sensors::Rgb>& image) {
  levels_.push_back(image);
  while (!levels_.back().empty() && levels_.back().size() > 1) levels_.push_back(halved(levels_.back()));
}

Eigen::Vector3f MipMap::sample(const Eigen::Vector2f& coordinates, float footprint) const {
  if (levels_.front().empty()) return Vector3f::Constant(0.5F);
  const auto pixels = footprint * static_cast<float>(std::max(levels_.front().width(), levels_.front().height()));
  const float level = std::clamp(std::log2(std::max(pixels, 1.0F)), 0.0F, static_cast<float>(levels_.size() - 1));
  const auto lower = static_cast<std::size_t>(level);
  Vector3f fine = bilinear(levels_[lower], coordinates);
  if (lower + 1 >= levels_.size() || level <= 0.0F) return fine;
  return mix(fine, bilinear(levels_[lower + 1], coordinates), level - static_cast<float>(lower));
}

Eigen::Vector3f patternColor(const Material& material, const PatternSample& sample) {
  switch (material.pattern) {
    case Pattern::kPlain:
      return plain(material, sample);
    case Pattern::kSpeckle:
      return speckle(material, sample);
    case Pattern::kWood:
      return wood(material, sample);
    case Pattern::kTiles:
      return tiles(material, sample);
    case Pattern::kCarpet:
      return carpet(material, sample);
    case Pattern::kFabric:
      return fabric(material, sample);
    case Pattern::kPoster:
      return poster(material, sample);
    case Pattern::kNoticeboard:
      return noticeboard(material, sample);
    case Pattern::kBooks:
      return books(material, sample);
    case Pattern::kSky:
      return sky(material, sample);
    case Pattern::kImage:
      break;
  }
  return linearColor(material.color);
}

}  // namespace prodomos::simulation
