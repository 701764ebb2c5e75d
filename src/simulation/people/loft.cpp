// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/people/loft.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace prodomos::simulation {

namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Vector3d alongOf(const Ring& ring) {
  return ring.side.cross(ring.front).normalized();
}

/// Rings of an elliptical dome on `base`, from the top down; the pole itself is a ring of no size.
std::vector<Ring> domeOver(const Ring& base, const Vector3d& height) {
  std::vector<Ring> dome;
  for (const double elevation : {90.0, 45.0}) {
    const double angle = elevation * kPi / 180.0;
    Ring ring = base;
    ring.center += std::sin(angle) * height;
    // The pole keeps a trace of its axes: normals follow from differences.
    const double share = std::max(std::cos(angle), 1e-4);
    ring.side *= share;
    ring.front *= share;
    dome.push_back(ring);
  }
  return dome;
}

std::vector<Vector3d> pointsOf(const Ring& ring, int around) {
  const auto rounded = [&](double x) { return std::copysign(std::pow(std::abs(x), 2.0 / ring.squareness), x); };
  std::vector<Vector3d> points;
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * kPi * i / around;
    points.emplace_back(ring.center + rounded(std::cos(angle)) * ring.side + rounded(std::sin(angle)) * ring.front);
  }
  return points;
}

}  // namespace

void addLoft(Surface& surface, std::vector<Ring> rings, int around, const Domes& domes) {
  if (domes.first > 0.0) {
    const auto dome = domeOver(rings.front(), -domes.first * alongOf(rings.front()));
    rings.insert(rings.begin(), dome.begin(), dome.end());
  }
  if (domes.last > 0.0) {
    const auto dome = domeOver(rings.back(), domes.last * alongOf(rings.back()));
    rings.insert(rings.end(), dome.rbegin(), dome.rend());
  }
  const auto count = static_cast<int>(rings.size());
  std::vector<std::vector<Vector3d>> points;
  double girth = 0.0;
  for (const auto& ring : rings) {
    points.push_back(pointsOf(ring, around));
    girth = std::max(girth, kPi * (ring.side.norm() + ring.front.norm()));
  }
  const auto at = [&](int ring, int column) -> const Vector3d& {
    return points[static_cast<std::size_t>(ring)][static_cast<std::size_t>((column + around) % around)];
  };

  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  double along = 0.0;
  for (int i = 0; i < count; ++i) {
    const int before = std::max(i - 1, 0);
    const int after = std::min(i + 1, count - 1);
    if (i > 0) along += (at(i, 0) - at(i - 1, 0)).norm();
    // The first column comes again as the last one: texture begins anew there.
    for (int j = 0; j <= around; ++j) {
      const Vector3d normal = (at(i, j + 1) - at(i, j - 1)).cross(at(after, j) - at(before, j)).normalized();
      surface.vertices.push_back(at(i, j).cast<float>());
      surface.normals.push_back(normal.cast<float>());
      surface.textureCoordinates.emplace_back(static_cast<float>(girth * j / around), static_cast<float>(along));
    }
  }
  const auto columns = static_cast<std::uint32_t>(around + 1);
  for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(count); ++i) {
    for (std::uint32_t j = 0; j + 1 < columns; ++j) {
      const std::uint32_t corner = first + i * columns + j;
      surface.triangles.push_back({corner, corner + 1, corner + columns + 1});
      surface.triangles.push_back({corner, corner + columns + 1, corner + columns});
    }
  }
}

void addEllipsoid(Surface& surface, const Vector3d& center, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  int around) {
  addLoft(surface, {{center, a, b}}, around, {c.norm(), c.norm()});
}

}  // namespace prodomos::simulation
