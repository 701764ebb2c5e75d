// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/graph_bytes.hpp"

#include <gtest/gtest.h>

namespace prodomos::mapper {
namespace {

const geometry::Pose3 kPose = geometry::fromYawPitchRoll({1.0 / 3.0, -7e5, 1e-300}, 3.1, -0.2, 0.1);

TEST(GraphBytes, BringBackMatricesPosesAndTimesBitByBit) {
  Eigen::Matrix<double, 2, 3> matrix;
  matrix << 1.0 / 3.0, -0.0, 1e300, 5e-324, -2.5, 7.0;
  base::ByteWriter out;
  saveMatrix(out, matrix);
  savePose(out, kPose);
  saveTime(out, base::fromNanoseconds(1'234'567'890'123'456'789));
  base::ByteReader in(out.bytes());
  Eigen::Matrix<double, 2, 3> again;
  loadMatrix(in, again);
  EXPECT_EQ(again, matrix);
  EXPECT_TRUE(std::signbit(again(0, 1)));
  EXPECT_EQ(loadPose(in).matrix(), kPose.matrix());
  EXPECT_EQ(base::toNanoseconds(loadTime(in)), 1'234'567'890'123'456'789);
  EXPECT_EQ(in.left(), 0U);
}

TEST(GraphBytes, BringBackNodes) {
  for (const std::optional<int> floor : {std::optional<int>(-2), std::optional<int>()}) {
    map::Node node;
    node.id = {17};
    node.session = {3};
    node.kind = map::SubMapKind::kPredicted;
    node.floor = floor;
    node.T_map_submap = kPose;
    node.T_travel_submap = kPose.inverse();
    node.begin = base::fromNanoseconds(5);
    node.end = base::fromNanoseconds(-7);
    node.distance = 6.1;
    node.readings = 147;
    base::ByteWriter out;
    saveNode(out, node);
    base::ByteReader in(out.bytes());
    const auto again = loadNode(in);
    EXPECT_EQ(in.left(), 0U);
    EXPECT_EQ(again.id, node.id);
    EXPECT_EQ(again.session, node.session);
    EXPECT_EQ(again.kind, node.kind);
    EXPECT_EQ(again.floor, node.floor);
    EXPECT_EQ(again.T_map_submap.matrix(), node.T_map_submap.matrix());
    EXPECT_EQ(again.T_travel_submap.matrix(), node.T_travel_submap.matrix());
    EXPECT_EQ(again.begin, node.begin);
    EXPECT_EQ(again.end, node.end);
    EXPECT_EQ(again.distance, node.distance);
    EXPECT_EQ(again.readings, node.readings);
  }
}

TEST(GraphBytes, BringBackEdges) {
  map::Edge edge;
  edge.id = {4};
  edge.from = {2};
  edge.to = {9};
  edge.kind = map::EdgeKind::kOverlap;
  edge.cause = base::EntityId{7};
  edge.T_from_to = kPose;
  edge.information = map::Matrix6::Random();
  base::ByteWriter out;
  saveEdge(out, edge);
  base::ByteReader in(out.bytes());
  const auto again = loadEdge(in);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_EQ(again.id, edge.id);
  EXPECT_EQ(again.from, edge.from);
  EXPECT_EQ(again.to, edge.to);
  EXPECT_EQ(again.kind, edge.kind);
  EXPECT_EQ(again.cause, edge.cause);
  EXPECT_EQ(again.T_from_to.matrix(), edge.T_from_to.matrix());
  EXPECT_EQ(again.information, edge.information);
}

TEST(GraphBytes, AreRefusedWhereTheyAreCut) {
  base::ByteWriter out;
  saveNode(out, {});
  const auto bytes = out.take();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    base::ByteReader in(std::span<const std::byte>(bytes).first(size));
    EXPECT_ANY_THROW(loadNode(in)) << size;
  }
}

}  // namespace
}  // namespace prodomos::mapper
