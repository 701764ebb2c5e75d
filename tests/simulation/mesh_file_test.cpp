// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/mesh_file.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/surface_tools.hpp"
#include "tiny_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::simulation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string faultOf(const std::filesystem::path& path) {
  try {
    readMesh(path);
  } catch (const base::FileError& error) {
    return error.what();
  }
  return "none";
}

TEST(MeshFile, LengthsAreScaledByItsUnit) {
  const test::TemporaryFolder folder;
  const auto mesh = folder.write("m.dae", test::collada({{"walls", test::block({0, 0, 0}, {400, 300, 250})}},
                                                        R"(<unit meter="0.01" name="centimeter"/>)"));
  const auto parts = readMesh(mesh);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].name, "walls");
  EXPECT_TRUE(parts[0].texture.empty());
  EXPECT_TRUE(boundsOf(parts[0].surface).sizes().isApprox(Eigen::Vector3f(4.0F, 3.0F, 2.5F), 1e-5F));
}

TEST(MeshFile, TheUpAxisIsPassedOverAsGazeboDoes) {
  const test::TemporaryFolder folder;  // test::collada() says Y_UP
  const auto parts = readMesh(folder.write("m.dae", test::collada({{"walls", test::block({0, 0, 0}, {9, 3, 2})}})));
  EXPECT_NEAR(boundsOf(parts[0].surface).sizes().z(), 2.0F, 1e-5F);
}

TEST(MeshFile, TrianglesKeepTheirFront) {
  const test::TemporaryFolder folder;
  const auto parts = readMesh(folder.write("m.dae", test::collada({{"floor", test::level(0.0)}})));
  const auto& surface = parts[0].surface;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto& v = surface.vertices;
    EXPECT_GT((v[b] - v[a]).cross(v[c] - v[a]).z(), 0.0F);
  }
}

TEST(MeshFile, ABlankBeforeAColourIsNoFault) {
  const test::TemporaryFolder folder;
  std::string text = test::collada({{"floor", test::level(0.0)}});
  text.insert(
      text.find("<library_geometries>"),
      "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"c\"><phong><emission>"
      "<color>\t 0.3 0.3 0.3 1</color></emission></phong></technique></profile_COMMON></effect></library_effects>");
  EXPECT_EQ(faultOf(folder.write("m.dae", text)), "none");
}

TEST(MeshFile, WithoutAUnitThereIsNoTellingItsSize) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(faultOf(folder.write("m.dae", test::collada({{"floor", test::level(0.0)}}, ""))),
              AllOf(HasSubstr("m.dae: expected the mesh's unit"), HasSubstr("found none")));
  EXPECT_THAT(faultOf(folder.write("m.dae", test::collada({{"floor", test::level(0.0)}}, R"(<unit meter="0"/>)"))),
              HasSubstr("found meter=\"0\""));
}

TEST(MeshFile, ASizeThatNoBuildingHasIsRefused) {
  const test::TemporaryFolder folder;
  const test::Parts parts{{"floor", test::level(0.0)}};
  EXPECT_THAT(faultOf(folder.write("m.dae", test::collada(parts, R"(<unit meter="0.001"/>)"))),
              HasSubstr("expected a part of a building, 2 to 500 m long, found 0.01 m"));
  EXPECT_THAT(faultOf(folder.write("m.dae", test::collada(parts, R"(<unit meter="100"/>)"))),
              HasSubstr("found 1e+03 m"));
}

TEST(MeshFile, FaultsAreOneLineThatNamesTheFile) {
  const test::TemporaryFolder folder;
  const std::string whole = test::collada({{"floor", test::level(0.0)}});
  EXPECT_THAT(faultOf(folder.path() / "gone.dae"), HasSubstr("gone.dae: expected a COLLADA mesh, found no such file"));
  const std::string cut = faultOf(folder.write("cut.dae", whole.substr(0, whole.size() / 2)));
  EXPECT_THAT(cut, AllOf(HasSubstr("cut.dae: expected a COLLADA mesh"), HasSubstr("at byte"), Not(HasSubstr("\n"))));
  EXPECT_THAT(faultOf(folder.write("other.dae", "<svg/>")), HasSubstr("found <svg>"));
  const std::string empty = faultOf(folder.write("empty.dae", test::collada({})));
  EXPECT_THAT(empty, AllOf(HasSubstr("empty.dae: expected"), Not(HasSubstr("\n"))));
}

TEST(MeshFile, IndicesBeyondTheVerticesAreAFault) {
  const test::TemporaryFolder folder;
  std::string text = test::collada({{"floor", test::level(0.0)}});
  text.replace(text.find("<p>0 1 2"), 8, "<p>0 1 9");
  EXPECT_THAT(faultOf(folder.write("m.dae", text)), AllOf(HasSubstr("m.dae: expected"), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace prodomos::simulation
