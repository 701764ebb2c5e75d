// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/map_store.hpp"

#include "map/plain_sqlite.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// docs/map-file.md is a promise to those who read maps without our code: it is held to its word here.
namespace prodomos::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string documentation() {
  return test::readFile(std::filesystem::path(__FILE__).parent_path() / "../../docs/map-file.md");
}

/// The blocks of SQL, in the order in which they stand there.
std::vector<std::string> documentedQueries() {
  const auto text = documentation();
  const std::string begin = "```sql\n";
  std::vector<std::string> queries;
  for (auto at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    const auto from = at + begin.size();
    queries.push_back(text.substr(from, text.find("```", from) - from));
  }
  return queries;
}

/// s0 and s1 are one place; behind a closed door s2; behind an open one s3. The robot goes from s0 to s1 and back.
class MapQueries : public testing::Test {
 protected:
  void SetUp() override {
    if (documentation().empty()) GTEST_SKIP() << "needs docs/map-file.md beside the tests";
    MapChange change;
    change.sessions = {{.id = {1}}};
    for (int i = 0; i < 4; ++i) {
      Node node;
      node.id = {i};
      node.session = {1};
      node.distance = 5.0 + i;
      node.T_map_submap = node.T_travel_submap = geometry::toPose3({4.0 * i, 0.0, 0.0});
      change.nodes.push_back(node);
    }
    for (int i = 1; i <= 2; ++i) {
      Entity door;
      door.id = {i};
      door.submap = {1};
      door.attributes = Door{.width = 0.9, .state = i == 1 ? DoorState::kClosed : DoorState::kOpen};
      change.entities.push_back(door);
    }
    const auto join = [&](int id, int from, int to, EdgeKind kind, std::optional<base::EntityId> door) {
      Edge edge;
      edge.id = {id};
      edge.from = {from};
      edge.to = {to};
      edge.kind = kind;
      edge.cause = door;
      change.edges.push_back(edge);
    };
    join(1, 0, 1, EdgeKind::kTravelled, std::nullopt);
    join(2, 1, 2, EdgeKind::kDoor, base::EntityId{1});
    join(3, 3, 1, EdgeKind::kDoor, base::EntityId{2});
    for (const auto& [second, submap, x] : {std::tuple{10, 0, 0.1}, {11, 0, 0.9}, {12, 1, 4.0}, {13, 1, 0.5}}) {
      change.trajectory.push_back(
          {{1}, base::Time{} + std::chrono::seconds(second), {submap}, geometry::toPose3({x, 0, 0}), {}});
    }
    auto store = MapStore::create(path_);
    store.commit(change);
    store.close();
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "map.prodomos";
};

TEST_F(MapQueries, GivePlacesWithTheirSubMaps) {
  EXPECT_THAT(test::PlainSqlite(path_).query(documentedQueries().at(0)),
              ElementsAre(ElementsAre("0", "2", "11.0", "s0 s1"), ElementsAre("1", "1", "7.0", "s2"),
                          ElementsAre("2", "1", "8.0", "s3")));
}

TEST_F(MapQueries, GiveWhenTheRobotWasWhere) {
  EXPECT_THAT(test::PlainSqlite(path_).query(documentedQueries().at(1)),
              ElementsAre(ElementsAre("s0", "10.0", "11.0", "2"), ElementsAre("s1", "13.0", "13.0", "1")));
}

TEST_F(MapQueries, GiveWhatCanBeReachedWithoutAClosedDoor) {
  EXPECT_THAT(test::PlainSqlite(path_).query(documentedQueries().at(2)),
              ElementsAre(ElementsAre("s0", "0", "0.0", "0.0"), ElementsAre("s1", "0", "4.0", "0.0"),
                          ElementsAre("s3", "2", "12.0", "0.0")));
}

TEST_F(MapQueries, KnowTheFileByItsNumbers) {
  const test::PlainSqlite file(path_);
  EXPECT_EQ(file.value("PRAGMA application_id"), std::to_string(0x7072646D));
  EXPECT_EQ(file.value("PRAGMA user_version"), "3");
  EXPECT_EQ(file.value("PRAGMA integrity_check"), "ok");
}

TEST_F(MapQueries, CanNameEveryTableAndColumnByItsDocumentation) {
  const auto text = documentation();
  const test::PlainSqlite file(path_);
  for (const auto& table :
       file.query("SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite_%'")) {
    const auto heading = text.find("### " + table[0]);
    const auto shared = text.find("### track, track_state");
    const auto begin = heading == std::string::npos ? shared : heading;
    const auto section =
        text.substr(begin, std::min(text.find("\n### ", begin + 1), text.find("\n## ", begin)) - begin);
    EXPECT_THAT(section, HasSubstr(table[0]));
    for (const auto& column : file.query("SELECT name FROM pragma_table_info('" + table[0] + "')")) {
      const bool isPose =
          column[0].size() <= 2 && std::string("x y z qx qy qz qw").find(column[0]) != std::string::npos;
      const bool isTravelPose = column[0].starts_with("travel_");
      const std::string named = isPose ? "pose" : isTravelPose ? "`travel_`" : "`" + column[0] + "`";
      EXPECT_THAT(section, HasSubstr(named)) << table[0] << "." << column[0];
    }
  }
}

}  // namespace
}  // namespace prodomos::map
