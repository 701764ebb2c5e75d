// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/pose.hpp"
#include "prodomos/sensors/reading.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace prodomos::simulation {

/// How colour varies over a surface. All but kImage are made from texture coordinates in metres.
enum class Pattern { kPlain, kSpeckle, kWood, kTiles, kCarpet, kFabric, kPoster, kNoticeboard, kBooks, kSky, kImage };

struct Material {
  sensors::Rgb color{200, 200, 200};
  sensors::Rgb accent{120, 120, 120};  ///< the pattern's second colour
  Pattern pattern = Pattern::kPlain;
  double scale = 1.0;      ///< of the pattern, metres; of a poster or board its width
  std::uint32_t seed = 0;  ///< of the pattern
  float gloss = 0.0F;      ///< 0 matt … 1 mirror-like: a highlight, and loss of depth where the projector glares
  float infrared = 0.8F;   ///< share of a depth sensor's light that comes back; dark cloth 0.15, glass 0
  int texture = -1;        ///< of kImage: index into Building::textures
};

/// Triangles of one material, one class and one thing.
struct Surface {
  std::vector<Eigen::Vector3f> vertices;                ///< metres
  std::vector<Eigen::Vector2f> textureCoordinates;      ///< as many: metres, of kImage 0 … 1; or none
  std::vector<Eigen::Vector3f> normals;                 ///< as many, for round things; or none: flat triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  Material material;
  std::uint16_t classId = 0;   ///< of classTable()
  std::uint16_t instance = 0;  ///< of the thing, counted over the building; 0 = none
};

/// Classes of label images, the same for every building: 0 "unlabeled", then "wall", "floor", "door", ….
const sensors::ClassTable& classTable();
/// Throws base::Error where there is no such class.
std::uint16_t classId(std::string_view name);

/// A box without its bottom or with it, middle at the origin of `T_world_box`; texture coordinates in metres.
Surface boxSurface(const geometry::Pose3& T_world_box, const Eigen::Vector3d& size, const Material& material,
                   std::uint16_t classId, std::uint16_t instance);
/// Adds a rectangle spanned by two edges from a corner, its front where they turn counter-clockwise.
void addRectangle(Surface& surface, const Eigen::Vector3d& corner, const Eigen::Vector3d& along,
                  const Eigen::Vector3d& up);
/// Adds the triangles of `part`; material, class and instance stay.
void append(Surface& surface, const Surface& part);
Surface transformed(const geometry::Pose3& T_a_b, Surface surface_in_b);

}  // namespace prodomos::simulation
