// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/g2o_file.hpp"

#include "prodomos/base/error.hpp"

#include "localization/random_graph.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace prodomos::localization {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kUnit3 = " 1 0 0 1 0 1";
const std::string kUnit6 = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";

class G2o : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    std::ofstream(path_) << text;
    return path_;
  }

  std::string refusal(const std::string& text) {
    try {
      readG2o(write(text));
    } catch (const base::FileError& error) {
      return error.what();
    }
    return "none";
  }

  std::string written() const { return test::readFile(path_); }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "graph.g2o";
};

TEST_F(G2o, ReadsPlanarGraphs) {
  const auto file =
      readG2o(write("VERTEX_SE2 3 1.5 -2 0.25\n"
                    "VERTEX_SE2 7 0 0 1e-3\n"
                    "FIX 3\n"
                    "EDGE_SE2 3 7 1 2 0.5 10 1 2 20 3 30\n"));
  EXPECT_TRUE(file.hasPoses);
  const auto& graph = std::get<PlanarPoseGraph>(file.graph);
  ASSERT_EQ(graph.vertices.size(), 2U);
  EXPECT_EQ(graph.vertices[0].id, 3);
  EXPECT_TRUE(graph.vertices[0].isFixed);
  EXPECT_FALSE(graph.vertices[1].isFixed);
  EXPECT_EQ(graph.vertices[0].pose, (Pose2{1.5, -2.0, 0.25}));
  ASSERT_EQ(graph.constraints.size(), 1U);
  EXPECT_EQ(graph.constraints[0].T_from_to, (Pose2{1.0, 2.0, 0.5}));
  EXPECT_EQ(graph.constraints[0].information, (Eigen::Matrix3d() << 10, 1, 2, 1, 20, 3, 2, 3, 30).finished());
}

TEST_F(G2o, TakesVerticesFromEdgesWhereThereAreNone) {
  const auto file =
      readG2o(write("# odometry alone\n\nEDGE_SE2 9 4 1 0 0" + kUnit3 + "\nEDGE_SE2 4 -2 1 0 0" + kUnit3));
  EXPECT_FALSE(file.hasPoses);
  std::vector<std::int64_t> ids;
  for (const auto& vertex : std::get<PlanarPoseGraph>(file.graph).vertices) ids.push_back(vertex.id);
  EXPECT_THAT(ids, ElementsAre(-2, 4, 9));
}

TEST_F(G2o, CountsTheQuaternionsVectorPartNotDoubled) {
  // A quarter turn too many about z, and half a metre: g2o's error is (0.5, 0, 0, 0, 0, sin 45°).
  const auto file =
      readG2o(write("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
                    "VERTEX_SE3:QUAT 1 1.5 0 0 0 0 0.70710678118654752 0.70710678118654752\n"
                    "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 100 0 0 0 0 7 100 0 0 0 0 100 0 0 0 40 0 0 40 0 40\n"));
  const auto& graph = std::get<PoseGraph>(file.graph);
  const double sine = std::sqrt(0.5);
  EXPECT_NEAR(chi2(graph), 100 * 0.25 + 2 * 7 * 0.5 * sine + 40 * 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(graph.constraints[0].information(5, 5), 10.0);
  EXPECT_DOUBLE_EQ(graph.constraints[0].information(0, 5), 3.5);
}

TEST_F(G2o, MakesGraphsThatReadBackTheSame) {
  auto graph = test::randomGraph<Pose3>({.vertices = 12, .loops = 8});
  graph.vertices[3].isFixed = true;
  writeG2o(toG2o(graph), path_);
  const auto back = std::get<PoseGraph>(readG2o(path_).graph);
  ASSERT_EQ(back.vertices.size(), graph.vertices.size());
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    EXPECT_EQ(back.vertices[i].id, graph.vertices[i].id);
    EXPECT_EQ(back.vertices[i].isFixed, i == 3);
    EXPECT_TRUE(back.vertices[i].pose.isApprox(graph.vertices[i].pose, 1e-14));
  }
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    EXPECT_TRUE(back.constraints[i].T_from_to.isApprox(graph.constraints[i].T_from_to, 1e-14));
    EXPECT_TRUE(back.constraints[i].information.isApprox(graph.constraints[i].information, 1e-14));
  }
  EXPECT_NEAR(chi2(back), chi2(graph), 1e-9 * chi2(graph));

  const auto flat = test::randomGraph<Pose2>({.vertices = 12, .loops = 8});
  writeG2o(toG2o(flat), path_);
  EXPECT_EQ(chi2(std::get<PlanarPoseGraph>(readG2o(path_).graph)), chi2(flat));
}

TEST_F(G2o, KeepsEdgesFixesAndParametersToTheLetter) {
  const std::string others =
      "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n# made by hand\nFIX 1\nEDGE_SE3:QUAT 1 2  1.0 0 0 0 0 0 1" + kUnit6 + "\n";
  auto file = readG2o(write("VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 2 5 0 0 0 0 0 1\n" + others));
  auto& graph = std::get<PoseGraph>(file.graph);
  optimize(graph);
  writeG2o(file, path_);
  EXPECT_EQ(written(), "VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 2 1 0 0 0 0 0 1\n" + others);
}

TEST_F(G2o, NamesTheLineThatIsWrong) {
  const std::string two = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  const std::string edge = "EDGE_SE2 0 1 1 0 0" + kUnit3 + "\n";
  const std::string at = path_.string();
  EXPECT_EQ(refusal(two + edge), "none");
  EXPECT_THAT(refusal(two + edge + "EDGE_SE2 0 5 1 0 0" + kUnit3),
              AllOf(HasSubstr(at + ":4: "), HasSubstr("vertex 5")));
  EXPECT_THAT(refusal(two + "VERTEX_SE2 0 1 1 1\n" + edge), AllOf(HasSubstr(at + ":3: "), HasSubstr("line 1")));
  EXPECT_THAT(refusal(two + "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n"),
              AllOf(HasSubstr(at + ":3: "), HasSubstr("positive definite")));
  EXPECT_THAT(refusal(two + "EDGE_SE2 0 1 1 0 nan" + kUnit3), AllOf(HasSubstr(at + ":3: "), HasSubstr("`nan`")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 inf 0 0\n"), AllOf(HasSubstr(at + ":1: "), HasSubstr("`inf`")));
  EXPECT_THAT(refusal(two + "EDGE_SE2 0 1 1 0 0 1 0 0\n"),
              AllOf(HasSubstr(at + ":3: "), HasSubstr("12 fields"), HasSubstr("found 9")));
  EXPECT_THAT(refusal(two + edge + "VERTEX_XY 4 1 1\n"), AllOf(HasSubstr(at + ":4: "), HasSubstr("`VERTEX_XY`")));
  EXPECT_THAT(refusal(two + "EDGE_SE2 0 0 1 0 0" + kUnit3), AllOf(HasSubstr(at + ":3: "), HasSubstr("itself")));
  EXPECT_THAT(refusal(two + "EDGE_SE2 0 x 1 0 0" + kUnit3), AllOf(HasSubstr(at + ":3: "), HasSubstr("`x`")));
  EXPECT_THAT(refusal(two + edge + "FIX 8\n"), AllOf(HasSubstr(at + ":4: "), HasSubstr("vertex 8")));
  EXPECT_THAT(refusal(two + "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1" + kUnit6),
              AllOf(HasSubstr(at + ":3: "), HasSubstr("either")));
  EXPECT_THAT(refusal("EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 0" + kUnit6),
              AllOf(HasSubstr(at + ":1: "), HasSubstr("quaternion")));
  EXPECT_THAT(refusal(two), AllOf(HasSubstr(at + ": "), HasSubstr("no edge")));
  EXPECT_THAT(refusal(""), HasSubstr("no edge"));
}

TEST_F(G2o, SaysWhichFileCannotBeReadOrWritten) {
  EXPECT_THROW(readG2o(folder_.path() / "none.g2o"), base::FileError);
  EXPECT_THROW(readG2o(folder_.path()), base::FileError);
  const auto file = toG2o(test::randomGraph<Pose2>({}));
  EXPECT_THROW(writeG2o(file, folder_.path() / "none" / "graph.g2o"), base::FileError);
  EXPECT_THROW(writeG2o(file, folder_.path()), base::FileError);
  EXPECT_FALSE(std::filesystem::exists(folder_.path().string() + ".part"));
}

}  // namespace
}  // namespace prodomos::localization
