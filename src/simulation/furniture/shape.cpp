// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/furniture/shape.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr std::size_t kSides = 14;  ///< of round things
constexpr std::size_t kRings = 8;

Eigen::Vector3d onCircle(std::size_t side, double radius, double z) {
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(side % kSides) / static_cast<double>(kSides);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Flat parts get normals too: a surface has them for all vertices or for none.
void addFlatNormals(Surface& part) {
  part.normals.assign(part.vertices.size(), Eigen::Vector3f::UnitZ());
  for (const auto& triangle : part.triangles) {
    const auto& a = part.vertices[triangle[0]];
    const Eigen::Vector3f normal = (part.vertices[triangle[1]] - a).cross(part.vertices[triangle[2]] - a).normalized();
    for (const auto corner : triangle) part.normals[corner] = normal;
  }
}

}  // namespace

Shape::Shape(const Thing& thing, std::uint16_t classId, std::uint16_t instance)
    : T_world_shape_(thing.T_world_thing * Eigen::Translation3d(0.0, 0.0, -thing.size.z() / 2.0)),
      size_(thing.size),
      classId_(classId),
      instance_(instance) {}

Shape::Part Shape::use(const Material& material) {
  surfaces_in_shape_.push_back({.material = material, .classId = classId_, .instance = instance_});
  return surfaces_in_shape_.size() - 1;
}

void Shape::box(Part part, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const geometry::Pose3 T_shape_box(Eigen::Translation3d((low + high) / 2.0));
  auto box = boxSurface(T_shape_box, high - low, {}, 0, 0);
  addFlatNormals(box);
  append(surfaces_in_shape_[part], box);
}

void Shape::legs(Part part, const Eigen::Vector2d& rectangle, double thickness, double bottom, double top) {
  const Eigen::Vector2d half = (rectangle - Eigen::Vector2d::Constant(thickness)) / 2.0;
  for (const double x : {-half.x(), half.x()}) {
    for (const double y : {-half.y(), half.y()}) {
      const double side = thickness / 2.0;
      box(part, {x - side, y - side, bottom}, {x + side, y + side, top});
    }
  }
}

void Shape::face(Part part, const std::vector<Eigen::Vector3d>& corners) {
  Surface face;
  const Eigen::Vector3d along = (corners[1] - corners[0]).normalized();
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners.back() - corners[0]).normalized();
  const Eigen::Vector3d up = normal.cross(along);
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d offset = corners[i] - corners[0];
    face.vertices.push_back(corners[i].cast<float>());
    face.textureCoordinates.push_back(Eigen::Vector2d(offset.dot(along), offset.dot(up)).cast<float>());
    if (i >= 2) face.triangles.push_back({0, i - 1, i});
  }
  addFlatNormals(face);
  append(surfaces_in_shape_[part], face);
}

/// Rows of `columns` points each, closed around, joined by triangles.
void Shape::addSmooth(Part part, const std::vector<Eigen::Vector3d>& ring, const std::vector<Eigen::Vector3d>& normals,
                      std::size_t columns) {
  Surface smooth;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    smooth.vertices.push_back(ring[i].cast<float>());
    smooth.normals.push_back(normals[i].normalized().cast<float>());
    const double around = std::hypot(ring[i].x(), ring[i].y()) * 2.0 * std::numbers::pi *
                          static_cast<double>(i % columns) / static_cast<double>(columns - 1);
    smooth.textureCoordinates.push_back(Eigen::Vector2d(around, ring[i].z()).cast<float>());
  }
  for (std::size_t i = 0; i + columns < ring.size(); ++i) {
    if (i % columns == columns - 1) continue;
    const auto index = [](std::size_t number) { return static_cast<std::uint32_t>(number); };
    smooth.triangles.push_back({index(i), index(i + 1), index(i + 1 + columns)});
    smooth.triangles.push_back({index(i), index(i + 1 + columns), index(i + columns)});
  }
  append(surfaces_in_shape_[part], smooth);
}

void Shape::cone(Part part, const Eigen::Vector2d& middle, double bottomRadius, double topRadius, double bottom,
                 double top) {
  const Eigen::Vector3d offset(middle.x(), middle.y(), 0.0);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  for (const auto& [radius, z] : {std::pair{bottomRadius, bottom}, std::pair{topRadius, top}}) {
    for (std::size_t side = 0; side <= kSides; ++side) {
      points.emplace_back(onCircle(side, radius, z) + offset);
      normals.emplace_back(onCircle(side, top - bottom, bottomRadius - topRadius));
    }
  }
  addSmooth(part, points, normals, kSides + 1);
  std::vector<Eigen::Vector3d> lid;
  std::vector<Eigen::Vector3d> ground;
  for (std::size_t side = 0; side < kSides; ++side) {
    lid.emplace_back(onCircle(side, topRadius, top) + offset);
    ground.emplace_back(onCircle(kSides - side, bottomRadius, bottom) + offset);
  }
  face(part, lid);
  face(part, ground);
}

void Shape::ellipsoid(Part part, const Eigen::Vector3d& middle, const Eigen::Vector3d& radii) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t ring = 0; ring <= kRings; ++ring) {
    const double latitude = std::numbers::pi * (static_cast<double>(ring) / static_cast<double>(kRings) - 0.5);
    for (std::size_t side = 0; side <= kSides; ++side) {
      const Eigen::Vector3d direction = onCircle(side, std::cos(latitude), std::sin(latitude));
      points.emplace_back(middle + direction.cwiseProduct(radii));
      normals.emplace_back(direction.cwiseQuotient(radii));
    }
  }
  addSmooth(part, points, normals, kSides + 1);
}

void Shape::leaf(Part part, const Eigen::Vector3d& root, const Eigen::Vector3d& tip, double width) {
  const Eigen::Vector3d along = tip - root;
  const Eigen::Vector3d across = along.cross(Eigen::Vector3d::UnitZ()).normalized() * width / 2.0;
  const Eigen::Vector3d low(-size_.x() / 2.0, -size_.y() / 2.0, 0.0);
  const Eigen::Vector3d high(size_.x() / 2.0, size_.y() / 2.0, size_.z());
  std::vector<Eigen::Vector3d> outline;
  // Out along one edge and back along the other.
  constexpr std::array<std::pair<double, double>, 8> kEdge{
      {{0.0, 0.15}, {0.35, 0.8}, {0.6, 1.0}, {0.85, 0.6}, {1.0, 0.0}, {0.85, -0.6}, {0.6, -1.0}, {0.35, -0.8}}};
  for (const auto& [length, side] : kEdge) {
    const Eigen::Vector3d point = root + length * along + side * across;
    outline.emplace_back(point.cwiseMax(low).cwiseMin(high));
  }
  face(part, outline);
  face(part, {outline.rbegin(), outline.rend()});
}

std::vector<Surface> Shape::surfaces() const {
  std::vector<Surface> surfaces;
  for (const auto& part : surfaces_in_shape_) {
    if (!part.triangles.empty()) surfaces.push_back(transformed(T_world_shape_, part));
  }
  return surfaces;
}

}  // namespace prodomos::simulation
