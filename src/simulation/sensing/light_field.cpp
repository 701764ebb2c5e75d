// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/sensing/light_field.hpp"

#include "simulation/sensing/parallel_rows.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace prodomos::simulation {
namespace {

using Eigen::Vector3f;

constexpr int kStep = 4;               // pixels from sample to sample
constexpr float kReach = 7.0F;         // of a lamp, metres
constexpr float kLeastLight = 0.004F;  // what a lamp adds below this casts no shadow worth a ray
constexpr float kLift = 0.004F;        // of a ray's start off its surface, metres
constexpr float kLampSize = 0.2F;      // around a lamp, metres: its own housing throws no shadow
constexpr float kClose = 0.7F;         // metres: what stands nearer takes ambient light away
constexpr int kAmbientRays = 4;        // of each sample; four neighbours have other ones and are then smoothed

/// Of a lamp that shines downwards, at a point in direction `to_lamp` (unit): 1 is two metres below it.
float brightness(const Vector3f& toLamp, float distance) {
  const float share = distance * distance / (kReach * kReach);
  const float window = 1.0F - share * share;
  if (window <= 0.0F) return 0.0F;
  const float lobe = 0.3F + 0.7F * std::max(0.0F, toLamp.z());
  return 4.6F * lobe * window * window / (0.6F + distance * distance);
}

/// Directions around the z-axis, spread over a half-sphere by the cosine; `turn` in [0, 1) makes others of them.
std::array<Vector3f, kAmbientRays> ambientDirections(float turn) {
  std::array<Vector3f, kAmbientRays> directions;
  for (int i = 0; i < kAmbientRays; ++i) {
    const float share = (static_cast<float>(i) + 0.5F) / kAmbientRays;
    const float angle = 6.2831853F * (static_cast<float>(i) * 0.618034F + turn);
    const float flat = std::sqrt(share);
    directions[static_cast<std::size_t>(i)] = {flat * std::cos(angle), flat * std::sin(angle), std::sqrt(1.0F - share)};
  }
  return directions;
}

Eigen::Matrix3f frameOf(const Vector3f& normal) {
  Eigen::Matrix3f axes;
  const Vector3f first = normal.unitOrthogonal();
  axes << first, normal.cross(first), normal;
  return axes;
}

/// How far two points belong to one surface; never 0, so that a point without its like takes what there is.
float likeness(const LitPoint& a, const LitPoint& b) {
  const float aside = (a.point - b.point).dot(b.normal);
  const float alike = std::max(0.0F, a.normal.dot(b.normal));
  return 1e-4F + alike * alike * alike / (1.0F + 2500.0F * aside * aside);
}

/// Weighted.
class Mean {
 public:
  void add(const Light& light, float weight) {
    lamps_ += weight * light.lamps;
    openness_ += weight * light.openness;
    weights_ += weight;
  }
  Light light() const { return {.lamps = lamps_ / weights_, .openness = openness_ / weights_}; }

 private:
  Vector3f lamps_ = Vector3f::Zero();
  float openness_ = 0.0F;
  float weights_ = 0.0F;
};

}  // namespace

LightField::LightField(const RayScene& scene, const std::vector<Eigen::Vector3d>& lamps, int width, int height,
                       const std::function<std::optional<LitPoint>(int, int)>& seenAt, int threads)
    : columns_((width + kStep - 1) / kStep),
      rows_((height + kStep - 1) / kStep),
      samples_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const int x = std::min(column * kStep + kStep / 2, width - 1);
      const int y = std::min(row * kStep + kStep / 2, height - 1);
      if (const auto place = seenAt(x, y)) sample(column, row) = {.place = *place, .isEmpty = false};
    }
  }
  const std::vector<Vector3f> near = lampsInReach(lamps);
  forRows(rows_, threads, [&](int row) {
    lightRow(scene, near, row);
    closeRow(scene, row);
  });
  std::vector<Sample> smoothed = samples_;
  forRows(rows_, threads, [&](int row) { smoothRow(row, smoothed); });
  samples_ = std::move(smoothed);
}

std::vector<Vector3f> LightField::lampsInReach(const std::vector<Eigen::Vector3d>& lamps) const {
  Eigen::AlignedBox3f seen;
  for (const Sample& sample : samples_) {
    if (!sample.isEmpty) seen.extend(sample.place.point);
  }
  std::vector<Vector3f> near;
  for (const auto& lamp : lamps) {
    if (!seen.isEmpty() && seen.exteriorDistance(lamp.cast<float>()) < kReach) near.push_back(lamp.cast<float>());
  }
  return near;
}

void LightField::lightRow(const RayScene& scene, const std::vector<Vector3f>& lamps, int row) {
  std::vector<Ray> rays;
  std::vector<int> columns;
  std::vector<float> light;
  std::vector<std::uint8_t> dark;
  for (const Vector3f& lamp : lamps) {
    rays.clear();
    columns.clear();
    light.clear();
    for (int column = 0; column < columns_; ++column) {
      if (sample(column, row).isEmpty) continue;
      const LitPoint& at = sample(column, row).place;
      const Vector3f way = lamp - at.point;
      if (way.squaredNorm() > kReach * kReach || at.normal.dot(way) <= 0.0F) continue;
      const float distance = way.norm();
      const float bright = brightness(way / distance, distance);
      if (bright * at.normal.dot(way) / distance < kLeastLight) continue;
      rays.push_back({at.point + kLift * at.normal, way / distance, std::max(0.0F, distance - kLampSize)});
      columns.push_back(column);
      light.push_back(bright);
    }
    dark.resize(rays.size());
    scene.areOccluded(rays, dark);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (dark[i] == 0) sample(columns[i], row).light.lamps += light[i] * rays[i].direction;
    }
  }
}

void LightField::closeRow(const RayScene& scene, int row) {
  std::vector<Ray> rays;
  for (int column = 0; column < columns_; ++column) {
    if (sample(column, row).isEmpty) continue;
    const LitPoint& at = sample(column, row).place;
    const float turn = static_cast<float>(2 * (row % 2) + column % 2) / 16.0F;
    const Eigen::Matrix3f axes = frameOf(at.normal);
    for (const Vector3f& direction : ambientDirections(turn)) {
      rays.push_back({at.point + kLift * at.normal, axes * direction, kClose});
    }
  }
  std::vector<std::uint8_t> closed(rays.size());
  scene.areOccluded(rays, closed, RayOrder::kAny);
  auto first = closed.begin();
  for (int column = 0; column < columns_; ++column) {
    if (sample(column, row).isEmpty) continue;
    const auto open = std::count(first, first + kAmbientRays, std::uint8_t{0});
    sample(column, row).light.openness = static_cast<float>(open) / kAmbientRays;
    first += kAmbientRays;
  }
}

void LightField::smoothRow(int row, std::vector<Sample>& smoothed) const {
  for (int column = 0; column < columns_; ++column) {
    const Sample& middle = sample(column, row);
    Mean mean;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Sample& near = sample(std::clamp(column + dx, 0, columns_ - 1), std::clamp(row + dy, 0, rows_ - 1));
        const float weight = (dx == 0 ? 0.5F : 0.25F) * (dy == 0 ? 0.5F : 0.25F);
        mean.add(near.light, weight * likeness(near.place, middle.place));
      }
    }
    smoothed[index(column, row)].light = mean.light();
  }
}

Light LightField::at(float x, float y, const LitPoint& place) const {
  const float column = (x - kStep / 2.0F) / kStep;
  const float row = (y - kStep / 2.0F) / kStep;
  const auto column0 = static_cast<int>(std::floor(column));
  const auto row0 = static_cast<int>(std::floor(row));
  Mean mean;
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      const Sample& near = sample(std::clamp(column0 + dx, 0, columns_ - 1), std::clamp(row0 + dy, 0, rows_ - 1));
      const float alongX = 1.0F - std::abs(column - static_cast<float>(column0 + dx));
      const float alongY = 1.0F - std::abs(row - static_cast<float>(row0 + dy));
      mean.add(near.light, (0.01F + alongX * alongY) * likeness(near.place, place));
    }
  }
  return mean.light();
}

}  // namespace prodomos::simulation
