// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/flights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace prodomos::simulation {
namespace {

constexpr double kSameHeight = 0.02;

/// One level face, seen from above.
struct Tread {
  double z = 0.0;
  Eigen::AlignedBox2d plan;
};

/// Ascending in height; faces at one height are one tread.
std::vector<Tread> treadsOf(const Surface& piece) {
  std::vector<Tread> faces;
  for (const auto& triangle : piece.triangles) {
    Eigen::AlignedBox3f bounds;
    for (const auto index : triangle) bounds.extend(piece.vertices[index]);
    if (bounds.sizes().z() > 0.01F) continue;
    faces.push_back({static_cast<double>(bounds.center().z()), planOf(bounds)});
  }
  std::ranges::stable_sort(faces, {}, &Tread::z);
  std::vector<Tread> treads;
  for (const auto& face : faces) {
    if (treads.empty() || face.z > treads.back().z + kSameHeight) {
      treads.push_back(face);
    } else {
      treads.back().plan.extend(face.plan);
    }
  }
  return treads;
}

double middleOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

std::optional<Flight> flightOf(const Surface& piece) {
  const auto treads = treadsOf(piece);
  if (treads.size() < 3) return std::nullopt;
  // Uphill: the axis along which the second tread lies from the first, as stairs in walls along the axes do.
  const Eigen::Vector2d way = treads[1].plan.center() - treads[0].plan.center();
  const int axis = std::abs(way.x()) > std::abs(way.y()) ? 0 : 1;
  const int across = 1 - axis;
  const double sign = way[axis] < 0.0 ? -1.0 : 1.0;
  const auto front = [&](const Tread& tread) { return sign > 0.0 ? tread.plan.min()[axis] : -tread.plan.max()[axis]; };
  std::vector<double> depths;
  std::vector<double> heights;
  std::vector<double> widths{treads[0].plan.sizes()[across]};
  for (std::size_t i = 1; i < treads.size(); ++i) {
    depths.push_back(front(treads[i]) - front(treads[i - 1]));
    heights.push_back(treads[i].z - treads[i - 1].z);
    widths.push_back(treads[i].plan.sizes()[across]);
    if (depths.back() <= 0.0) return std::nullopt;
  }
  Flight flight;
  auto& stairs = flight.stairs;
  stairs.stepHeight = middleOf(heights);
  stairs.stepDepth = middleOf(depths);
  stairs.width = middleOf(widths);
  stairs.direction = axis == 0 ? (sign > 0.0 ? 0.0 : std::numbers::pi) : sign * std::numbers::pi / 2.0;
  // The first riser stands before the first tread; where the mesh has none, the first tread is the floor.
  const double bottom = static_cast<double>(boundsOf(piece).min().z());
  const bool hasFirstRiser = treads[0].z - bottom > kSameHeight;
  const auto& first = hasFirstRiser ? treads[0] : treads[1];
  stairs.stepCount = static_cast<int>(treads.size()) - (hasFirstRiser ? 0 : 1);
  stairs.foot.z() = hasFirstRiser ? bottom : treads[0].z;
  stairs.foot[axis] = sign * front(first);
  stairs.foot[across] = first.plan.center()[across];

  for (const auto& tread : treads) flight.extent.extend(tread.plan);
  flight.steps = flight.extent;
  const double end = sign * (front(treads.back()) + stairs.stepDepth);
  (sign > 0.0 ? flight.steps.max() : flight.steps.min())[axis] = end;
  return flight;
}

}  // namespace prodomos::simulation
