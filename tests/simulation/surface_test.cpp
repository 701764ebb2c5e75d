// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/surface.hpp"

#include "prodomos/base/error.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <string>
#include <utility>

namespace prodomos::simulation {
namespace {

/// By the divergence theorem: positive where all triangles face outwards and the surface is closed.
double volumeOf(const Surface& surface) {
  double sixfold = 0.0;
  for (const auto& triangle : surface.triangles) {
    const Eigen::Vector3d a = surface.vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d b = surface.vertices[triangle[1]].cast<double>();
    const Eigen::Vector3d c = surface.vertices[triangle[2]].cast<double>();
    sixfold += a.dot(b.cross(c));
  }
  return sixfold / 6.0;
}

Eigen::Vector3f normalOf(const Surface& surface, std::size_t triangle) {
  const auto& corners = surface.triangles[triangle];
  const Eigen::Vector3f a = surface.vertices[corners[0]];
  return (surface.vertices[corners[1]] - a).cross(surface.vertices[corners[2]] - a).normalized();
}

geometry::Pose3 somewhere() {
  return geometry::fromYawPitchRoll({3.0, -2.0, 5.0}, 0.7, -0.3, 1.1);
}

TEST(Classes, EachNameFindsItsOwnNumber) {
  std::set<std::string> names;
  for (const auto& [id, name] : classTable()) {
    EXPECT_TRUE(names.insert(name).second) << name << " stands twice";
    EXPECT_EQ(classId(name), id);
  }
  EXPECT_EQ(classId("unlabeled"), 0);
}

TEST(Classes, AnUnknownNameIsNamed) {
  try {
    classId("dor");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"dor\""), std::string::npos);
  }
}

TEST(Surface, ABoxIsClosedAndFacesOutwards) {
  const Surface box = boxSurface(somewhere(), {1.0, 2.0, 3.0}, {}, 4, 7);
  EXPECT_EQ(box.triangles.size(), 12U);
  EXPECT_EQ(box.vertices.size(), box.textureCoordinates.size());
  EXPECT_EQ(box.classId, 4);
  EXPECT_EQ(box.instance, 7);
  EXPECT_NEAR(volumeOf(box), 6.0, 1e-4);
  const Eigen::Vector3f middle = somewhere().translation().cast<float>();
  for (std::size_t i = 0; i < box.triangles.size(); ++i) {
    EXPECT_GT(normalOf(box, i).dot(box.vertices[box.triangles[i][0]] - middle), 0.0F) << "triangle " << i;
  }
}

TEST(Surface, TextureOfABoxIsInMetres) {
  const Surface box = boxSurface(geometry::Pose3::Identity(), {1.0, 2.0, 3.0}, {}, 0, 0);
  for (const auto& triangle : box.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = triangle[k];
      const auto to = triangle[(k + 1) % 3];
      EXPECT_NEAR((box.vertices[to] - box.vertices[from]).norm(),
                  (box.textureCoordinates[to] - box.textureCoordinates[from]).norm(), 1e-5);
    }
  }
}

TEST(Surface, ARectangleFacesWhereItsEdgesTurnCounterClockwise) {
  Surface surface;
  addRectangle(surface, {1.0, 1.0, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 3.0});
  ASSERT_EQ(surface.triangles.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(normalOf(surface, i).isApprox(-Eigen::Vector3f::UnitY()));
}

TEST(Surface, AppendingKeepsBothParts) {
  Surface boxes = boxSurface(geometry::Pose3::Identity(), {1.0, 1.0, 1.0}, {}, 2, 3);
  append(boxes, boxSurface(somewhere(), {1.0, 2.0, 1.0}, {}, 9, 9));
  EXPECT_EQ(boxes.triangles.size(), 24U);
  EXPECT_EQ(boxes.classId, 2);
  EXPECT_EQ(boxes.instance, 3);
  EXPECT_NEAR(volumeOf(boxes), 3.0, 1e-4);
}

TEST(Surface, MovingThereAndBackChangesNothing) {
  Surface box = boxSurface(geometry::Pose3::Identity(), {1.0, 2.0, 3.0}, {}, 0, 0);
  box.normals.assign(box.vertices.size(), Eigen::Vector3f::UnitX());
  const Surface back = transformed(somewhere().inverse(), transformed(somewhere(), box));
  for (std::size_t i = 0; i < box.vertices.size(); ++i) {
    EXPECT_NEAR((back.vertices[i] - box.vertices[i]).norm(), 0.0, 1e-5);
    EXPECT_NEAR((back.normals[i] - box.normals[i]).norm(), 0.0, 1e-5);
  }
}

TEST(Surface, NormalsTurnButDoNotMove) {
  Surface surface{.vertices = {{0.0F, 0.0F, 0.0F}}, .normals = {{1.0F, 0.0F, 0.0F}}};
  const Surface moved =
      transformed(geometry::fromYawPitchRoll({5.0, 0.0, 0.0}, std::numbers::pi / 2.0, 0.0, 0.0), std::move(surface));
  EXPECT_TRUE(moved.vertices[0].isApprox(Eigen::Vector3f(5.0F, 0.0F, 0.0F)));
  EXPECT_TRUE(moved.normals[0].isApprox(Eigen::Vector3f::UnitY(), 1e-6F));
}

}  // namespace
}  // namespace prodomos::simulation
