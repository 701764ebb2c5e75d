// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/fused_grid.hpp"

#include "prodomos/map/map_store.hpp"

#include "map/slow_grid.hpp"
#include "support/sample_map.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace prodomos::map {
namespace {

using test::gridFromText;
using test::toText;

/// Sub-maps of one grid each.
class FusedGrid : public testing::Test {
 protected:
  void add(const std::vector<std::string_view>& drawn, const geometry::Pose2& T_map_submap, std::optional<int> floor,
           SubMapKind kind = SubMapKind::kObserved) {
    Node node;
    node.id = {++count_};
    node.session = {1};
    node.kind = kind;
    node.floor = floor;
    node.T_map_submap = geometry::toPose3(T_map_submap, floor.value_or(0) * 3.0);
    const auto grid = gridFromText(drawn, 1.0);
    MapChange change;
    change.sessions = {{.id = node.session}};
    if (floor) change.floors = {{*floor, *floor * 3.0}};
    change.nodes = {node};
    change.layers = {{node.id, &grid}};
    store_.commit(change);
  }

  std::string fused(std::optional<int> floor = std::nullopt) const { return toText(fuseGrids(store_.view(), floor)); }

 private:
  MapStore store_ = MapStore::inMemory();
  std::int64_t count_ = 0;
};

TEST_F(FusedGrid, OfNothingIsEmpty) {
  EXPECT_EQ(fused(), "");
  EXPECT_EQ(fused(3), "");
}

TEST_F(FusedGrid, LaysSubMapsWhereTheyLieInTheMap) {
  add({"#..#"}, {0, 0, 0}, 0);
  add({"#..#"}, {4, 1, std::numbers::pi / 2}, 0);
  EXPECT_EQ(fused(),
            "   #\n"
            "   .\n"
            "   .\n"
            "   #\n"
            "#..#\n");
}

TEST_F(FusedGrid, AddsWhatIsSeenTwice) {
  add({"#."}, {0, 0, 0}, 0);
  add({".."}, {0, 0, 0}, 0);
  add({"#"}, {0, 0, 0}, 0);
  EXPECT_EQ(fused(), "#.\n") << "one hit counts for two misses";
}

TEST_F(FusedGrid, HoldsOneFloorAndWhatBelongsToNone) {
  add({"#"}, {0, 0, 0}, 0);
  add({"#"}, {2, 0, 0}, 1);
  add({"."}, {4, 0, 0}, std::nullopt);
  EXPECT_EQ(fused(0), "#   .\n");
  EXPECT_EQ(fused(1), "# .\n");
  EXPECT_EQ(fused(2), ".\n");
  EXPECT_EQ(fused(), "# # .\n");
}

TEST_F(FusedGrid, HoldsNothingPredicted) {
  add({"."}, {0, 0, 0}, 0);
  add({"#"}, {1, 0, 0}, 0, SubMapKind::kPredicted);
  EXPECT_EQ(fused(), ".\n");
}

}  // namespace
}  // namespace prodomos::map
