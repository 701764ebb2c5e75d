// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/surface_tools.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace prodomos::simulation {
namespace {

/// A corner of a triangle that is being cut, with its place in the texture.
struct Corner {
  Eigen::Vector3d position;
  Eigen::Vector2d texture = Eigen::Vector2d::Zero();
};
using Face = std::vector<Corner>;

/// The part of a convex face where sign * (position[axis] - bound) ≥ 0.
Face clipped(const Face& face, int axis, double bound, double sign) {
  Face kept;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const auto& here = face[i];
    const auto& next = face[(i + 1) % face.size()];
    const double dHere = sign * (here.position[axis] - bound);
    const double dNext = sign * (next.position[axis] - bound);
    if (dHere >= 0.0) kept.push_back(here);
    if ((dHere > 0.0 && dNext < 0.0) || (dHere < 0.0 && dNext > 0.0)) {
      const double t = dHere / (dHere - dNext);
      kept.push_back(
          {here.position + t * (next.position - here.position), here.texture + t * (next.texture - here.texture)});
    }
  }
  return kept.size() < 3 ? Face{} : kept;
}

Face faceOf(const Surface& surface, const std::array<std::uint32_t, 3>& triangle) {
  Face face;
  for (const auto index : triangle) {
    Corner corner{.position = surface.vertices[index].cast<double>()};
    if (!surface.textureCoordinates.empty()) corner.texture = surface.textureCoordinates[index].cast<double>();
    face.push_back(corner);
  }
  return face;
}

void addFace(Surface& surface, const Face& face, bool textured) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const auto& corner : face) {
    surface.vertices.push_back(corner.position.cast<float>());
    if (textured) surface.textureCoordinates.push_back(corner.texture.cast<float>());
  }
  for (std::uint32_t i = 2; i < face.size(); ++i) surface.triangles.push_back({first, first + i - 1, first + i});
}

bool mayTouch(const Face& face, const Eigen::AlignedBox3d& box) {
  Eigen::AlignedBox3d bounds;
  for (const auto& corner : face) bounds.extend(corner.position);
  return bounds.intersects(box);
}

/// Roots of sets that grow together.
class Unions {
 public:
  explicit Unions(std::size_t size) : parents_(size) { std::iota(parents_.begin(), parents_.end(), 0U); }

  std::size_t root(std::size_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
  }
  void join(std::size_t a, std::size_t b) { parents_[root(b)] = root(a); }

 private:
  std::vector<std::size_t> parents_;
};

/// The same number for vertices at one place.
std::vector<std::size_t> placesOf(const std::vector<Eigen::Vector3f>& vertices) {
  constexpr double kGrid = 1e-3;
  std::map<std::array<long, 3>, std::size_t> numbers;
  std::vector<std::size_t> places;
  for (const auto& vertex : vertices) {
    const std::array<long, 3> key{std::lround(vertex.x() / kGrid), std::lround(vertex.y() / kGrid),
                                  std::lround(vertex.z() / kGrid)};
    // Rounding divides neighbours, so look next door as well.
    std::optional<std::size_t> known;
    for (long dx = -1; dx <= 1 && !known; ++dx) {
      for (long dy = -1; dy <= 1 && !known; ++dy) {
        for (long dz = -1; dz <= 1 && !known; ++dz) {
          const auto entry = numbers.find({key[0] + dx, key[1] + dy, key[2] + dz});
          if (entry != numbers.end()) known = entry->second;
        }
      }
    }
    const std::size_t number = known.value_or(numbers.size());
    if (!known) numbers.emplace(key, number);
    places.push_back(number);
  }
  return places;
}

}  // namespace

Eigen::AlignedBox3f boundsOf(const Surface& surface) {
  Eigen::AlignedBox3f bounds;
  for (const auto& triangle : surface.triangles) {
    for (const auto index : triangle) bounds.extend(surface.vertices[index]);
  }
  return bounds;
}

Eigen::AlignedBox2d planOf(const Eigen::AlignedBox3f& box) {
  return {box.min().head<2>().cast<double>(), box.max().head<2>().cast<double>()};
}

Polygon cornersOf(const Eigen::AlignedBox2d& box) {
  return {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}};
}

std::vector<Surface> connectedPieces(const Surface& surface) {
  const auto places = placesOf(surface.vertices);
  Unions unions(surface.vertices.size());
  for (const auto& [a, b, c] : surface.triangles) {
    unions.join(places[a], places[b]);
    unions.join(places[a], places[c]);
  }
  std::map<std::size_t, std::size_t> pieceOfRoot;
  std::vector<Surface> pieces;
  for (const auto& triangle : surface.triangles) {
    const auto [entry, isNew] = pieceOfRoot.try_emplace(unions.root(places[triangle[0]]), pieces.size());
    if (isNew) {
      pieces.push_back({.material = surface.material, .classId = surface.classId, .instance = surface.instance});
    }
    addFace(pieces[entry->second], faceOf(surface, triangle), !surface.textureCoordinates.empty());
  }
  return pieces;
}

Surface cutAway(const Surface& surface, const Eigen::AlignedBox3d& box) {
  const bool textured = !surface.textureCoordinates.empty();
  Surface kept{.material = surface.material, .classId = surface.classId, .instance = surface.instance};
  for (const auto& triangle : surface.triangles) {
    Face inside = faceOf(surface, triangle);
    if (!mayTouch(inside, box)) {
      addFace(kept, inside, textured);
      continue;
    }
    // Beyond each side lies a piece to keep; what is beyond none of them lies within.
    for (int axis = 0; axis < 3 && !inside.empty(); ++axis) {
      addFace(kept, clipped(inside, axis, box.min()[axis], -1.0), textured);
      inside = clipped(inside, axis, box.min()[axis], 1.0);
      addFace(kept, clipped(inside, axis, box.max()[axis], 1.0), textured);
      inside = clipped(inside, axis, box.max()[axis], -1.0);
    }
  }
  return kept;
}

std::vector<Segment> sliceAt(const Surface& surface, double z) {
  std::vector<Segment> segments;
  for (const auto& triangle : surface.triangles) {
    std::vector<Eigen::Vector2d> crossings;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = surface.vertices[triangle[i]].cast<double>();
      const Eigen::Vector3d b = surface.vertices[triangle[(i + 1) % 3]].cast<double>();
      if ((a.z() < z) == (b.z() < z)) continue;
      const Eigen::Vector3d crossing = a + (z - a.z()) / (b.z() - a.z()) * (b - a);
      crossings.emplace_back(crossing.head<2>());
    }
    if (crossings.size() == 2) segments.push_back({crossings[0], crossings[1]});
  }
  return segments;
}

}  // namespace prodomos::simulation
