// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/g2o_file.hpp"
#include "prodomos/map/map_store.hpp"

#include "exporter/written.hpp"
#include "localization/random_graph.hpp"

#include <gtest/gtest.h>

namespace prodomos::exporter {
namespace {

/// The same poses and measurements as a map.
std::filesystem::path writeMap(const localization::PoseGraph& graph, const std::filesystem::path& path) {
  auto store = map::MapStore::create(path);
  map::MapChange change;
  change.sessions.push_back({.id = {1}});
  for (const auto& vertex : graph.vertices) {
    map::Node node{.id = {static_cast<int>(vertex.id)}, .session = {1}};
    node.T_map_submap = node.T_travel_submap = vertex.pose;
    change.nodes.push_back(node);
  }
  for (const auto& constraint : graph.constraints) {
    change.edges.push_back({.id = {static_cast<int>(change.edges.size()) + 1},
                            .from = {static_cast<int>(constraint.from)},
                            .to = {static_cast<int>(constraint.to)},
                            .T_from_to = constraint.T_from_to,
                            .information = constraint.information});
  }
  store.commit(change);
  return path;
}

TEST(G2o, IsOptimisedToTheSameMapAsTheGraphItself) {
  auto graph = test::randomGraph<geometry::Pose3>({.vertices = 12, .loops = 10, .firstId = 1});
  const test::TemporaryFolder folder;
  const auto view = map::MapView::open(writeMap(graph, folder.path() / "map.prodomos"));
  std::ofstream(folder.path() / "map.g2o") << test::write("g2o", view);
  auto file = localization::readG2o(folder.path() / "map.g2o");
  auto& exported = std::get<localization::PoseGraph>(file.graph);
  // Nine decimals are written.
  EXPECT_NEAR(chi2(exported), chi2(graph), 1e-4 * chi2(graph));
  optimize(graph);
  optimize(exported);
  EXPECT_NEAR(chi2(exported), chi2(graph), 1e-4 * chi2(graph));
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    EXPECT_TRUE(exported.vertices[i].pose.isApprox(graph.vertices[i].pose, 1e-6)) << i;
  }
}

}  // namespace
}  // namespace prodomos::exporter
