// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/map_store.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"

#include "map/plain_sqlite.hpp"
#include "map/slow_grid.hpp"
#include "support/sample_map.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>

namespace prodomos::map {
namespace {

using test::gridFromText;
using test::PlainSqlite;
using test::toText;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

base::Time at(double seconds) {
  return base::Time{} + base::fromSeconds(seconds);
}

geometry::Pose3 somePose(double seed) {
  return geometry::fromYawPitchRoll({seed, -2 * seed, 0.5 * seed}, 0.3 * seed, 0.1 * seed, -0.2 * seed);
}

Session sessionOf(std::int64_t id, SessionState state = SessionState::kRunning) {
  return {.id = {id},
          .log = "/logs/öffice \"1\".rawlog",
          .logKind = "MRPT rawlog",
          .config = "grid:\n  resolution: 0.05\n",
          .poses = "recorded",
          .version = "0.1.0",
          .classes = {{0, "unlabeled"}, {7, "it's a \"chair\""}},
          .T_map_travel = somePose(1),
          .begin = at(-1.5),
          .end = at(1e9),
          .state = state,
          .distance = 12.25};
}

Node nodeOf(std::int64_t id, const geometry::Pose3& T_map_submap = geometry::Pose3::Identity()) {
  Node node;
  node.id = {id};
  node.session = {1};
  node.T_map_submap = T_map_submap;
  node.T_travel_submap = T_map_submap;
  return node;
}

Edge edgeOf(std::int64_t id, std::int64_t from, std::int64_t to, EdgeKind kind = EdgeKind::kTravelled) {
  Edge edge;
  edge.id = {id};
  edge.from = {from};
  edge.to = {to};
  edge.kind = kind;
  return edge;
}

Entity entityOf(std::int64_t id, std::int64_t submap) {
  Entity entity;
  entity.id = {id};
  entity.submap = {submap};
  entity.attributes = Door{.width = 0.9, .state = DoorState::kClosed};
  return entity;
}

MapChange twoNodes() {
  MapChange change;
  change.sessions = {sessionOf(1)};
  change.nodes = {nodeOf(1), nodeOf(2, geometry::toPose3({3, 4, 0}))};
  change.edges = {edgeOf(1, 1, 2)};
  return change;
}

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const base::FileError& error) {
    return error.what();
  }
  return "(no FileError)";
}

/// Flips the lowest bit of the middle byte of a blob.
void flipByte(const std::filesystem::path& path, const std::string& table, const std::string& column) {
  const PlainSqlite file(path);
  const auto hex = file.value("SELECT hex(" + column + ") FROM " + table);
  auto flipped = hex;
  char& digit = flipped.at(hex.size() / 2 / 2 * 2 + 1);
  digit = digit == '0' ? '1' : '0';
  file.query("UPDATE " + table + " SET " + column + " = x'" + flipped + "'");
}

class MapFile : public testing::Test {
 protected:
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "map.prodomos";

  void write(const MapChange& change) const {
    auto store = MapStore::create(path_);
    store.commit(change);
    store.close();
  }
};

// --- everything that is written is read

TEST_F(MapFile, HoldsNothingAtFirst) {
  MapStore::create(path_).close();
  const auto view = MapView::open(path_);
  EXPECT_EQ(view.revision(), 0);
  EXPECT_THAT(view.sessions(), IsEmpty());
  EXPECT_THAT(view.floors(), IsEmpty());
  EXPECT_THAT(view.graph().nodes(), IsEmpty());
  EXPECT_THAT(view.entities(), IsEmpty());
  EXPECT_THAT(view.predictions(), IsEmpty());
  EXPECT_THAT(view.trajectory(), IsEmpty());
  EXPECT_THAT(view.events(), IsEmpty());
  EXPECT_THAT(view.tracks(), IsEmpty());
  EXPECT_THAT(view.layersOf({1}), IsEmpty());
  EXPECT_EQ(view.findLayer<OccupancyGrid>({1}), nullptr);
}

TEST_F(MapFile, KeepsAnEmptyCommitAsARevision) {
  auto store = MapStore::create(path_);
  EXPECT_EQ(store.commit({}), 1);
  EXPECT_EQ(store.commit({}), 2);
  EXPECT_EQ(store.view().revision(), 2);
}

Entity personIn(base::SubMapId submap) {
  Entity person;
  person.id = {9};
  person.submap = submap;
  person.attributes = Human{};
  return person;
}

TEST_F(MapFile, KeepsTracksAndAddsWhatTheyDidSince) {
  auto change = twoNodes();
  Track walker{.id = {3}, .session = {1}, .className = "human", .attributes = R"({"name":"Ada"})"};
  walker.states = {{at(1), {1}, somePose(1), Eigen::Vector3d(0.5, -1.0, 0.0), R"({"joints":[]})"},
                   {at(2), {2}, somePose(2), std::nullopt, "{}"}};
  change.tracks = {walker};
  auto store = MapStore::create(path_);
  store.commit(change);
  MapChange later;
  later.entities = {personIn({2})};
  later.tracks = {{.id = {3}, .session = {1}, .className = "human", .attributes = "{}"}};
  later.tracks[0].entity = later.entities[0].id;
  later.tracks[0].states = {{at(3), {2}, somePose(3), std::nullopt, "{}"}};
  store.commit(later);
  store.close();

  const auto tracks = MapView::open(path_).tracks();
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].id, base::TrackId{3});
  EXPECT_EQ(tracks[0].session, base::SessionId{1});
  EXPECT_EQ(tracks[0].className, "human");
  EXPECT_EQ(tracks[0].attributes, "{}");
  EXPECT_EQ(tracks[0].entity, base::EntityId{9});
  ASSERT_EQ(tracks[0].states.size(), 3U);
  const auto& first = tracks[0].states[0];
  EXPECT_EQ(first.time, at(1));
  EXPECT_EQ(first.submap, base::SubMapId{1});
  EXPECT_TRUE(first.T_submap_thing.isApprox(somePose(1), 1e-12));
  ASSERT_TRUE(first.velocity_in_submap.has_value());
  EXPECT_EQ(first.velocity_in_submap->y(), -1.0);
  EXPECT_EQ(first.attributes, R"({"joints":[]})");
  EXPECT_FALSE(tracks[0].states[1].velocity_in_submap.has_value());
  EXPECT_EQ(tracks[0].states[2].time, at(3));
}

TEST_F(MapFile, KeepsSessionsAndFloors) {
  MapChange change;
  change.sessions = {sessionOf(1, SessionState::kComplete), sessionOf(2)};
  change.sessions[1].classes.clear();
  change.sessions[1].log = "";
  change.floors = {{1, 3.25}, {-2, -6.0}};
  write(change);
  const auto view = MapView::open(path_);
  ASSERT_EQ(view.sessions().size(), 2U);
  const auto& read = view.sessions()[0];
  const auto& written = change.sessions[0];
  EXPECT_EQ(read.id, written.id);
  EXPECT_EQ(read.log, written.log);
  EXPECT_EQ(read.logKind, written.logKind);
  EXPECT_EQ(read.config, written.config);
  EXPECT_EQ(read.poses, written.poses);
  EXPECT_EQ(read.version, written.version);
  EXPECT_EQ(read.classes, written.classes);
  EXPECT_TRUE(read.T_map_travel.isApprox(written.T_map_travel, 1e-12));
  EXPECT_EQ(read.begin, written.begin);
  EXPECT_EQ(read.end, written.end);
  EXPECT_EQ(read.state, SessionState::kComplete);
  EXPECT_EQ(read.distance, 12.25);
  EXPECT_EQ(view.sessions()[1].state, SessionState::kRunning);
  EXPECT_THAT(view.sessions()[1].classes, IsEmpty());
  ASSERT_EQ(view.floors().size(), 2U);
  EXPECT_EQ(view.floors()[0].number, -2);
  EXPECT_EQ(view.floors()[1].height, 3.25);
}

TEST_F(MapFile, KeepsNodesAndEdges) {
  MapChange change;
  change.sessions = {sessionOf(1), sessionOf(4)};
  change.floors = {{-1, -3.0}};
  change.entities = {entityOf(2, 1)};
  change.nodes = {nodeOf(1), nodeOf(3)};
  auto& node = change.nodes[1];
  node.session = {4};
  node.kind = SubMapKind::kPredicted;
  node.floor = -1;
  node.T_map_submap = somePose(2);
  node.T_travel_submap = somePose(-3);
  node.begin = at(5.5);
  node.end = at(7.000000001);
  node.distance = 0.1;
  node.readings = 77;
  auto edge = edgeOf(9, 3, 1, EdgeKind::kStairs);
  edge.T_from_to = somePose(0.7);
  for (int i = 0; i < 36; ++i) edge.information(i / 6, i % 6) = std::min(i / 6, i % 6) + 0.1 * std::max(i / 6, i % 6);
  edge.information(2, 2) = kNan;
  edge.information(0, 5) = edge.information(5, 0) = kNan;
  edge.cause = base::EntityId{2};
  change.edges = {edge, edgeOf(10, 1, 3, EdgeKind::kLift)};
  write(change);

  const auto view = MapView::open(path_);
  EXPECT_THAT(view.graph().nodes(), ElementsAre(base::SubMapId{1}, base::SubMapId{3}));
  const auto& read = view.graph().getNode({3});
  EXPECT_EQ(read.session, node.session);
  EXPECT_EQ(read.kind, SubMapKind::kPredicted);
  EXPECT_EQ(read.floor, -1);
  EXPECT_EQ(view.graph().getNode({1}).floor, std::nullopt);
  EXPECT_TRUE(read.T_map_submap.isApprox(node.T_map_submap, 1e-12));
  EXPECT_TRUE(read.T_travel_submap.isApprox(node.T_travel_submap, 1e-12));
  EXPECT_EQ(read.begin, node.begin);
  EXPECT_EQ(read.end, node.end);
  EXPECT_EQ(read.distance, 0.1);
  EXPECT_EQ(read.readings, 77);

  const auto& link = view.graph().getEdge({9});
  EXPECT_EQ(link.from, base::SubMapId{3});
  EXPECT_EQ(link.to, base::SubMapId{1});
  EXPECT_EQ(link.kind, EdgeKind::kStairs);
  EXPECT_TRUE(link.T_from_to.isApprox(edge.T_from_to, 1e-12));
  EXPECT_EQ(link.cause, base::EntityId{2});
  EXPECT_EQ(view.graph().getEdge({10}).cause, std::nullopt);
  for (int i = 0; i < 36; ++i) {
    const double expected = edge.information(i / 6, i % 6);
    const double found = link.information(i / 6, i % 6);
    EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected))) << i / 6 << ", " << i % 6;
  }
}

TEST_F(MapFile, KeepsTheCovariancesOfNodes) {
  MapChange change = twoNodes();
  Matrix6 covariance = Matrix6::Identity() / 3.0;
  covariance(0, 5) = covariance(5, 0) = -0.1;
  change.nodes[1].covariance = covariance;
  auto store = MapStore::create(path_);
  store.commit(change);
  EXPECT_EQ(store.view().graph().getNode({1}).covariance, std::nullopt);
  EXPECT_EQ(store.view().graph().getNode({2}).covariance, covariance);

  change.nodes[0].covariance = covariance;
  change.nodes[1].covariance = std::nullopt;
  store.commit(change);
  EXPECT_EQ(store.view().graph().getNode({1}).covariance, covariance);
  EXPECT_EQ(store.view().graph().getNode({2}).covariance, std::nullopt);
}

TEST_F(MapFile, KeepsNamesThatAreNoUtf8AsFarAsTheyCanBeRead) {
  MapChange change;
  change.sessions = {sessionOf(1)};
  change.sessions[0].classes = {{3, "caf\xE9 table"}};
  write(change);
  EXPECT_EQ(MapView::open(path_).sessions().at(0).classes.at(3), "caf\xEF\xBF\xBD table");
}

TEST_F(MapFile, KeepsEntities) {
  MapChange change = twoNodes();
  auto full = entityOf(5, 2);
  full.T_submap_entity = somePose(1.1);
  full.covariance.setConstant(0.25);
  full.covariance(1, 4) = full.covariance(4, 1) = kNan;
  full.confidence = 0.75;
  full.observations = 3;
  full.firstSeen = at(1);
  full.lastSeen = at(2);
  full.points_in_submap = {{1, 2, 3}, {4, 5, std::numeric_limits<float>::quiet_NaN()}};
  auto bare = entityOf(6, 1);
  bare.attributes = Human{.velocity = {kNan, kNan, kNan}};
  bare.confidence = kNan;
  change.entities = {full, bare};
  write(change);

  const auto view = MapView::open(path_);
  ASSERT_EQ(view.entities().size(), 2U);
  const auto& read = view.entities()[0];
  EXPECT_EQ(read.id, full.id);
  EXPECT_EQ(read.submap, full.submap);
  EXPECT_TRUE(read.T_submap_entity.isApprox(full.T_submap_entity, 1e-12));
  EXPECT_EQ(read.covariance(0, 0), 0.25);
  EXPECT_TRUE(std::isnan(read.covariance(4, 1)));
  EXPECT_EQ(read.confidence, 0.75);
  EXPECT_EQ(read.observations, 3);
  EXPECT_EQ(read.firstSeen, full.firstSeen);
  EXPECT_EQ(read.lastSeen, full.lastSeen);
  EXPECT_EQ(std::get<Door>(read.attributes).state, DoorState::kClosed);
  ASSERT_EQ(read.points_in_submap.size(), 2U);
  EXPECT_EQ(read.points_in_submap[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(std::isnan(read.points_in_submap[1].z()));
  EXPECT_TRUE(std::isnan(view.entities()[1].confidence));
  EXPECT_TRUE(std::isnan(std::get<Human>(view.entities()[1].attributes).velocity.x()));
  EXPECT_THAT(view.entities()[1].points_in_submap, IsEmpty());
  ASSERT_EQ(view.entitiesOf({2}).size(), 1U);
  EXPECT_EQ(view.entitiesOf({2})[0].id, full.id);
}

TEST_F(MapFile, KeepsPredictions) {
  MapChange change = twoNodes();
  change.entities = {entityOf(1, 1)};
  Prediction open;
  open.id = {1};
  open.cause = {1};
  open.submap = {1};
  open.node = {2};
  open.T_submap_node = geometry::toPose3({2, -1, 0.5}, 0.25);
  open.room_in_node = {{0, 1}, {kNan, -2}};
  open.probability = 0.82;
  open.expectedArea = 11.5;
  open.areas = {{.threshold = 0.5, .outline_in_node = {{-1, 2}, {0.1, 1.0 / 3.0}}},
                {.threshold = kNan, .outline_in_node = {{kNan, 1}}}};
  open.made = at(12);
  open.viewpoint_in_submap = {1.0 / 3.0, -0.5, 0.1};
  open.blocked = at(13);
  Prediction settled = open;
  settled.viewpoint_in_submap = std::nullopt;
  settled.blocked = std::nullopt;
  settled.id = {2};
  settled.areas = {};
  settled.state = PredictionState::kMerged;
  settled.settled = at(0);
  settled.mergedInto = base::SubMapId{1};
  change.predictions = {open, settled};
  write(change);

  const auto view = MapView::open(path_);
  ASSERT_EQ(view.predictions().size(), 2U);
  const auto& first = view.predictions()[0];
  EXPECT_EQ(first.cause, base::EntityId{1});
  EXPECT_EQ(first.submap, base::SubMapId{1});
  EXPECT_EQ(first.node, base::SubMapId{2});
  EXPECT_TRUE(first.T_submap_node.isApprox(open.T_submap_node));
  EXPECT_TRUE(view.T_map_node(first).isApprox(view.graph().getNode({1}).T_map_submap * open.T_submap_node));
  ASSERT_EQ(first.room_in_node.size(), 2U);
  EXPECT_EQ(first.room_in_node[0], open.room_in_node[0]);
  EXPECT_TRUE(std::isnan(first.room_in_node[1].x()));
  EXPECT_EQ(first.probability, 0.82);
  EXPECT_EQ(first.viewpoint_in_submap, open.viewpoint_in_submap);
  EXPECT_EQ(first.blocked, at(13));
  EXPECT_EQ(view.predictions()[1].viewpoint_in_submap, std::nullopt);
  EXPECT_EQ(view.predictions()[1].blocked, std::nullopt);
  EXPECT_EQ(first.expectedArea, 11.5);
  EXPECT_EQ(first.made, at(12));
  EXPECT_EQ(first.state, PredictionState::kOpen);
  EXPECT_EQ(first.settled, std::nullopt);
  EXPECT_EQ(first.mergedInto, std::nullopt);
  ASSERT_EQ(first.areas.size(), 2U);
  EXPECT_EQ(first.areas[0].threshold, 0.5);
  EXPECT_EQ(first.areas[0].outline_in_node, open.areas[0].outline_in_node);
  EXPECT_TRUE(std::isnan(first.areas[1].threshold));
  EXPECT_TRUE(std::isnan(first.areas[1].outline_in_node.at(0).x()));
  const auto& second = view.predictions()[1];
  EXPECT_THAT(second.areas, IsEmpty());
  EXPECT_EQ(second.state, PredictionState::kMerged);
  EXPECT_EQ(second.settled, at(0));
  EXPECT_EQ(second.mergedInto, base::SubMapId{1});
}

TEST_F(MapFile, KeepsEventsInTheirOrder) {
  MapChange change = twoNodes();
  change.events = {{at(5), {1}, "submap_begun", "s1", "{}"}, {at(1), {1}, "door_opened", "o1", R"({"angle": 1.5})"}};
  write(change);
  const auto events = MapView::open(path_).events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, "submap_begun");
  EXPECT_EQ(events[0].time, at(5));
  EXPECT_EQ(events[1].subject, "o1");
  EXPECT_EQ(events[1].payload, R"({"angle": 1.5})");
  EXPECT_EQ(events[1].session, base::SessionId{1});
}

TEST_F(MapFile, KeepsLayers) {
  MapChange change = twoNodes();
  const auto grid = gridFromText({"#..#", " .. "}, 0.25, {-7, 9});
  PointLayer points;
  points.insert({1, 2, 3}, {9, 8, 7});
  const OccupancyGrid nothing;
  change.layers = {{base::SubMapId{1}, &points}, {base::SubMapId{1}, &grid}, {base::SubMapId{2}, &nothing}};
  write(change);
  const auto view = MapView::open(path_);
  EXPECT_THAT(view.layersOf({1}), ElementsAre("occupancy_grid", "points")) << "in the order in which they are drawn";
  EXPECT_EQ(toText(*view.findLayer<OccupancyGrid>({1})), toText(grid));
  EXPECT_EQ(view.findLayer<OccupancyGrid>({1})->knownBox().first, (geometry::CellIndex{-7, 9}));
  ASSERT_EQ(view.findLayer<PointLayer>({1})->points().size(), 1U);
  EXPECT_TRUE(view.findLayer<OccupancyGrid>({2})->knownBox().empty());
  EXPECT_EQ(view.findLayer<PointLayer>({2}), nullptr);
  EXPECT_EQ(view.findLayer<OccupancyGrid>({3}), nullptr);
}

TEST_F(MapFile, ReplacesRowsOfTheSameId) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  const auto before = gridFromText({"#"}, 0.25);
  change.layers = {{base::SubMapId{1}, &before}};
  change.entities = {entityOf(1, 1)};
  store.commit(change);
  MapChange later;
  later.sessions = {sessionOf(1, SessionState::kComplete)};
  later.entities = {entityOf(1, 2)};
  later.edges = {edgeOf(1, 2, 1, EdgeKind::kDoor)};
  const auto after = gridFromText({"..."}, 0.25);
  later.layers = {{base::SubMapId{1}, &after}};
  store.commit(later);
  const auto view = store.view();
  EXPECT_EQ(view.sessions().size(), 1U);
  EXPECT_EQ(view.sessions()[0].state, SessionState::kComplete);
  EXPECT_THAT(view.entitiesOf({1}), IsEmpty());
  EXPECT_EQ(view.entitiesOf({2}).size(), 1U);
  EXPECT_EQ(view.graph().getEdge({1}).kind, EdgeKind::kDoor);
  EXPECT_EQ(toText(*view.findLayer<OccupancyGrid>({1})), "...\n");
}

TEST_F(MapFile, ForgetsEdgesThatWereGivenUp) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  change.nodes.push_back(nodeOf(3));
  change.edges.push_back(edgeOf(2, 2, 3, EdgeKind::kLoop));
  store.commit(change);
  EXPECT_EQ(store.view().graph().getNode({3}).place, 0);
  MapChange later;
  later.removedEdges = {{2}, {77}};
  store.commit(later);
  EXPECT_THAT(store.view().graph().edges(), ElementsAre(base::EdgeId{1}));
  EXPECT_EQ(store.view().graph().getNode({3}).place, 1) << "nothing leads there any more";
}

TEST_F(MapFile, ForgetsEntitiesThatWereGivenUp) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  change.entities = {entityOf(1, 1), entityOf(2, 1)};
  change.edges.push_back(edgeOf(2, 1, 2, EdgeKind::kDoor));
  change.edges.back().cause = base::EntityId{1};
  const auto before = store.commit(change);
  MapChange later;
  later.removedEntities = {{1}, {77}};
  store.commit(later);
  const auto view = store.view();
  EXPECT_THAT(view.entities(), ElementsAre(testing::Field(&Entity::id, base::EntityId{2})));
  EXPECT_EQ(view.graph().getEdge({2}).cause, std::nullopt) << "the way is still there";
  const auto changes = view.changesSince(before);
  EXPECT_THAT(changes.edges, ElementsAre(base::EdgeId{2}));
  EXPECT_THAT(changes.entities, IsEmpty());
}

TEST_F(MapFile, KeepsWhatAPredictionBetsOn) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  change.entities = {entityOf(1, 1)};
  Prediction bet;
  bet.id = {1};
  bet.cause = {1};
  bet.submap = {1};
  bet.node = {2};
  change.predictions = {bet};
  store.commit(change);
  MapChange later;
  later.removedEntities = {{1}};
  store.commit(later);
  const auto view = store.view();
  ASSERT_EQ(view.entities().size(), 1U);
  EXPECT_EQ(view.entities()[0].confidence, 0.0);
  EXPECT_EQ(view.predictions().size(), 1U);
}

TEST_F(MapFile, TakesPredictedNodesAwayAndKeepsObservedOnes) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  change.nodes.push_back(nodeOf(7));
  change.nodes.back().kind = SubMapKind::kPredicted;
  change.edges.push_back(edgeOf(9, 1, 7, EdgeKind::kDoor));
  store.commit(change);
  MapChange later;
  later.removedNodes = {{7}, {2}};
  store.commit(later);
  const auto view = store.view();
  EXPECT_FALSE(view.graph().hasNode({7}));
  EXPECT_FALSE(view.graph().hasEdge({9}));
  EXPECT_TRUE(view.graph().hasNode({2}));
  EXPECT_TRUE(view.graph().hasEdge({1}));
}

TEST_F(MapFile, IsTheSameInMemory) {
  auto store = MapStore::inMemory();
  store.commit(twoNodes());
  EXPECT_EQ(store.view().graph().nodes().size(), 2U);
  EXPECT_FALSE(std::filesystem::exists(":memory:"));
}

// --- places and trajectory, which the store derives

TEST_F(MapFile, NumbersThePlacesOfTheWholeGraph) {
  auto store = MapStore::create(path_);
  MapChange change;
  change.sessions = {sessionOf(1)};
  change.nodes = {nodeOf(1), nodeOf(2), nodeOf(3)};
  change.edges = {edgeOf(1, 1, 2, EdgeKind::kDoor), edgeOf(2, 2, 3)};
  store.commit(change);
  const auto places = [&] {
    std::vector<int> numbers;
    const auto view = store.view();
    for (const auto id : view.graph().nodes()) numbers.push_back(view.graph().getNode(id).place.value_or(-1));
    return numbers;
  };
  EXPECT_THAT(places(), ElementsAre(0, 1, 1));

  MapChange loop;
  loop.edges = {edgeOf(3, 3, 1, EdgeKind::kLoop)};
  store.commit(loop);
  EXPECT_THAT(places(), ElementsAre(0, 0, 0));

  MapChange refined;
  refined.nodes = {nodeOf(2, geometry::toPose3({1, 1, 1}))};
  store.commit(refined);
  EXPECT_THAT(places(), ElementsAre(0, 0, 0)) << "a node that is written again keeps its place";
}

TEST_F(MapFile, MovesTheTrajectoryWithItsSubMap) {
  auto store = MapStore::create(path_);
  MapChange change = twoNodes();
  const auto T_travel_body = somePose(0.5);
  change.trajectory = {{{1}, at(1), {1}, T_travel_body, {}}, {{1}, at(2), {2}, T_travel_body, {}}};
  store.commit(change);
  auto points = store.view().trajectory();
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].time, at(1));
  EXPECT_EQ(points[1].submap, base::SubMapId{2});
  EXPECT_TRUE(points[1].T_map_body.isApprox(T_travel_body, 1e-9)) << "not yet refined";

  const auto T_map_map = somePose(0.3);  // by which refinement moves the second sub-map
  MapChange refined;
  refined.nodes = {nodeOf(2)};
  refined.nodes[0].T_travel_submap = change.nodes[1].T_travel_submap;
  refined.nodes[0].T_map_submap = T_map_map * change.nodes[1].T_map_submap;
  refined.trajectory = {{{1}, at(3), {2}, T_travel_body, {}}};
  store.commit(refined);
  points = store.view().trajectory();
  ASSERT_EQ(points.size(), 3U);
  EXPECT_TRUE(points[0].T_map_body.isApprox(T_travel_body, 1e-9)) << "of the other sub-map";
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_TRUE(points[i].T_map_body.isApprox(T_map_map * T_travel_body, 1e-9)) << i;
    EXPECT_TRUE(points[i].T_travel_body.isApprox(T_travel_body, 1e-9)) << i;
  }
}

TEST_F(MapFile, TellsTheTrajectoryToReadersOfPlainSqlToo) {
  base::Random random(8);
  MapChange change;
  change.sessions = {sessionOf(1)};
  for (int id = 1; id <= 5; ++id) {
    change.nodes.push_back(nodeOf(id, somePose(random.uniform(-20, 20))));
    change.nodes.back().T_travel_submap = somePose(random.uniform(-20, 20));
    for (int i = 0; i < 20; ++i) {
      change.trajectory.push_back({{1}, at(20 * id + i), {id}, somePose(random.uniform(-20, 20)), {}});
    }
  }
  write(change);
  const auto points = MapView::open(path_).trajectory();
  ASSERT_EQ(points.size(), 100U);
  const auto rows = PlainSqlite(path_).query(
      "SELECT node, time_ns, x, y, z, qw, qx, qy, qz, travel_x, travel_y, travel_z, travel_qw, travel_qx, travel_qy, "
      "travel_qz FROM trajectory ORDER BY id");
  ASSERT_EQ(rows.size(), 100U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto number = [&](std::size_t column) { return std::stod(rows[i].at(column)); };
    const auto pose = [&](std::size_t c) {
      EXPECT_GE(number(c + 3), 0.0);
      const Eigen::Quaterniond rotation(number(c + 3), number(c + 4), number(c + 5), number(c + 6));
      EXPECT_NEAR(rotation.norm(), 1.0, 1e-12);
      return geometry::fromQuaternion({number(c), number(c + 1), number(c + 2)}, rotation);
    };
    const auto& node = change.nodes[i / 20];
    const auto& T_travel_body = change.trajectory[i].T_travel_body;
    const geometry::Pose3 T_map_body = node.T_map_submap * node.T_travel_submap.inverse() * T_travel_body;
    EXPECT_EQ(rows[i].at(0), std::to_string(node.id.value));
    EXPECT_TRUE(pose(2).isApprox(T_map_body, 1e-9)) << i;
    EXPECT_TRUE(pose(9).isApprox(T_travel_body, 1e-9)) << i;
    EXPECT_TRUE(points[i].T_map_body.isApprox(T_map_body, 1e-9)) << i;
    EXPECT_TRUE(points[i].T_travel_body.isApprox(T_travel_body, 1e-9)) << i;
  }
}

// --- revisions

TEST_F(MapFile, TellsWhatChangedSinceARevision) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  change.entities = {entityOf(1, 1)};
  EXPECT_EQ(store.commit(change), 1);
  MapChange second;
  second.nodes = {nodeOf(3)};
  second.entities = {entityOf(1, 2)};
  second.events = {{at(1), {1}, "submap_begun", "s3", "{}"}};
  EXPECT_EQ(store.commit(second), 2);
  MapChange third;
  third.edges = {edgeOf(2, 2, 3)};
  EXPECT_EQ(store.commit(third), 3);

  const auto view = store.view();
  EXPECT_EQ(view.revision(), 3);
  auto changes = view.changesSince(0);
  EXPECT_EQ(changes.revision, 3);
  EXPECT_EQ(changes.nodes.size(), 3U);
  changes = view.changesSince(1);
  EXPECT_THAT(changes.nodes, ElementsAre(base::SubMapId{3}));
  EXPECT_THAT(changes.edges, ElementsAre(base::EdgeId{2}));
  EXPECT_THAT(changes.entities, ElementsAre(base::EntityId{1}));
  EXPECT_EQ(changes.events.size(), 1U);
  changes = view.changesSince(2);
  EXPECT_THAT(changes.nodes, ElementsAre(base::SubMapId{3})) << "its place changed";
  EXPECT_THAT(changes.events, IsEmpty());
  changes = view.changesSince(3);
  EXPECT_EQ(changes.revision, 3);
  EXPECT_THAT(changes.nodes, IsEmpty());
  EXPECT_THAT(changes.predictions, IsEmpty());
}

TEST_F(MapFile, IsReadByOthersWhileItIsWritten) {
  auto store = MapStore::create(path_);
  store.commit(twoNodes());
  const auto early = MapView::open(path_);
  const auto other = MapView::open(path_);
  MapChange change;
  change.nodes = {nodeOf(3)};
  const auto grid = gridFromText({"#."}, 0.25);
  change.layers = {{base::SubMapId{3}, &grid}};
  store.commit(change);
  const auto late = MapView::open(path_);
  EXPECT_EQ(early.graph().nodes().size(), 2U) << "a view keeps to its revision";
  EXPECT_EQ(early.revision(), 1);
  EXPECT_EQ(other.changesSince(other.revision()).revision, 2) << "… and sees that there is a newer one";
  EXPECT_THAT(other.changesSince(other.revision()).nodes, ElementsAre(base::SubMapId{3}));
  EXPECT_EQ(late.graph().nodes().size(), 3U);
  EXPECT_EQ(toText(*late.findLayer<OccupancyGrid>({3})), "#.\n");
  store.close();
  EXPECT_EQ(late.trajectory().size(), 0U) << "readers go on when the writer is gone";
}

TEST_F(MapFile, IsOneFileWhenItIsClosed) {
  write(twoNodes());
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    files.push_back(entry.path().filename());
  EXPECT_THAT(files, ElementsAre("map.prodomos"));
}

TEST_F(MapFile, GrowsWhereItIsOpenedAgain) {
  write(twoNodes());
  auto store = MapStore::openForWriting(path_);
  MapChange change;
  change.nodes = {nodeOf(3)};
  EXPECT_EQ(store.commit(change), 2);
  store.close();
  EXPECT_EQ(MapView::open(path_).graph().nodes().size(), 3U);
}

TEST_F(MapFile, ShowsTheRunningSubMapOfAMapperBesideWhatIsCommitted) {
  auto store = MapStore::create(path_);
  store.commit(twoNodes());
  const auto running = std::make_shared<SubMap>(makeSubMap(nodeOf(3, geometry::toPose3({9, 0, 0})), {}));
  const auto view = store.view(running, edgeOf(2, 2, 3));
  EXPECT_EQ(view.graph().nodes().size(), 3U);
  EXPECT_EQ(view.graph().getNode({3}).place, 0);
  EXPECT_THAT(view.layersOf({3}), testing::IsSupersetOf({"occupancy_grid", "points"}));
  EXPECT_EQ(view.findLayer({3}, "occupancy_grid").get(), running->findLayer("occupancy_grid"));
  EXPECT_EQ(store.view().graph().nodes().size(), 2U) << "nothing of it is in the store";
}

// --- commits are whole or not at all

TEST_F(MapFile, HoldsWhatItHeldWhereACommitFails) {
  auto store = MapStore::create(path_);
  store.commit(twoNodes());
  auto notANumber = nodeOf(4);
  notANumber.T_map_submap.translation().x() = kNan;
  std::vector<MapChange> bad(3);
  bad[0].nodes = {nodeOf(3), notANumber};
  bad[1].nodes = {nodeOf(3)};
  bad[1].edges = {edgeOf(7, 3, 99)};
  bad[2].nodes = {nodeOf(3)};
  bad[2].trajectory = {{{1}, at(1), {98}, {}, {}}};
  for (auto& change : bad) {
    change.floors = {{5, 15.0}};
    change.events = {{at(1), {1}, "submap_begun", "s3", "{}"}};
    EXPECT_THROW(store.commit(change), base::Error);
    const auto view = store.view();
    EXPECT_EQ(view.revision(), 1);
    EXPECT_EQ(view.graph().nodes().size(), 2U);
    EXPECT_THAT(view.floors(), IsEmpty());
    EXPECT_THAT(view.events(), IsEmpty());
  }
  MapChange good;
  good.nodes = {nodeOf(3)};
  EXPECT_EQ(store.commit(good), 2) << "the store goes on";
}

TEST_F(MapFile, TakesNoRowThatRefersToNothing) {
  auto store = MapStore::create(path_);
  store.commit(twoNodes());
  const OccupancyGrid grid;
  auto ofNoSession = nodeOf(3);
  ofNoSession.session = {9};
  auto onNoFloor = nodeOf(3);
  onNoFloor.floor = 9;
  auto throughNoDoor = edgeOf(7, 1, 2, EdgeKind::kDoor);
  throughNoDoor.cause = base::EntityId{9};
  std::vector<MapChange> bad(6);
  bad[0].nodes = {ofNoSession};
  bad[1].nodes = {onNoFloor};
  bad[2].edges = {throughNoDoor};
  bad[3].entities = {entityOf(1, 9)};
  bad[4].layers = {{base::SubMapId{9}, &grid}};
  bad[5].events = {{at(1), {9}, "submap_begun", "s3", "{}"}};
  for (const auto& change : bad) {
    EXPECT_THAT(messageOf([&] { store.commit(change); }), HasSubstr("refers to"));
    EXPECT_EQ(store.view().revision(), 1);
  }
}

TEST_F(MapFile, ChangesRowsThatOthersReferTo) {
  auto store = MapStore::create(path_);
  const auto grid = gridFromText({"#"}, 0.25);
  auto change = twoNodes();
  change.floors = {{0, 0.0}};
  change.nodes[0].floor = change.nodes[1].floor = 0;
  change.entities = {entityOf(1, 1)};
  change.edges[0].cause = base::EntityId{1};
  change.layers = {{base::SubMapId{1}, &grid}};
  change.trajectory = {{{1}, at(1), {1}, somePose(1), {}}};
  store.commit(change);
  change.trajectory.clear();
  change.floors[0].height = 0.5;
  change.sessions[0].distance = 99.0;
  store.commit(change);
  const auto view = store.view();
  EXPECT_EQ(view.floors().at(0).height, 0.5);
  EXPECT_EQ(view.sessions().at(0).distance, 99.0);
  EXPECT_EQ(view.graph().getEdge({1}).cause, base::EntityId{1});
  EXPECT_EQ(view.trajectory().size(), 1U);
  EXPECT_NE(view.findLayer({1}, "occupancy_grid"), nullptr);
  store.close();
  EXPECT_THAT(PlainSqlite(path_).query("PRAGMA foreign_key_check"), IsEmpty());
}

TEST_F(MapFile, IsWholeFromTheMomentItIsThere) {
  folder_.write("map.prodomos.part", "left by one that was killed while it made a map here");
  const auto store = MapStore::create(path_);
  EXPECT_EQ(MapView::open(path_).revision(), 0);
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".part"));
}

TEST_F(MapFile, IsNeverOverwritten) {
  folder_.write("map.prodomos", "precious");
  EXPECT_THAT(messageOf([&] { MapStore::create(path_); }), HasSubstr(path_.string()));
  EXPECT_EQ(test::readFile(path_), "precious");
}

TEST_F(MapFile, CannotBeMadeWhereThereIsNoFolder) {
  const auto path = folder_.path() / "none" / "map.prodomos";
  EXPECT_THAT(messageOf([&] { MapStore::create(path); }), HasSubstr(path.string()));
}

// --- checkpoints

TEST_F(MapFile, KeepsTheCheckpointUntilTheSessionIsComplete) {
  auto store = MapStore::create(path_);
  auto change = twoNodes();
  change.checkpoint = Checkpoint{{1}, {std::byte{1}, std::byte{0}, std::byte{255}}};
  store.commit(change);
  EXPECT_EQ(store.findCheckpoint({1})->state, change.checkpoint->state);
  EXPECT_EQ(store.findCheckpoint({2}), std::nullopt) << "of another session";
  change.checkpoint->state.clear();
  store.commit(change);
  EXPECT_THAT(store.findCheckpoint({1})->state, IsEmpty());
  MapChange done;
  done.sessions = {sessionOf(1, SessionState::kComplete)};
  store.commit(done);
  EXPECT_EQ(store.findCheckpoint({1}), std::nullopt);
}

TEST_F(MapFile, SaysWhereACheckpointIsDamaged) {
  auto change = twoNodes();
  change.checkpoint = Checkpoint{{1}, std::vector<std::byte>(100, std::byte{7})};
  write(change);
  flipByte(path_, "checkpoint", "state");
  const auto store = MapStore::openForWriting(path_);
  EXPECT_THAT(messageOf([&] { store.findCheckpoint({1}); }), HasSubstr("checkpoint of session r1 is damaged"));
}

// --- files that are no map, or are damaged

TEST_F(MapFile, SaysWhatAFileIsThatIsNoMap) {
  const auto text = folder_.write("notes.txt", std::string(5000, 'x') + "\n");
  const auto note = folder_.write("short.txt", "hello\n");
  const auto empty = folder_.write("empty.prodomos", "");
  const auto missing = folder_.path() / "missing.prodomos";
  const auto other = folder_.path() / "other.sqlite";
  PlainSqlite(other).query("CREATE TABLE song (title TEXT)");
  for (const auto& [path, said] : {std::pair{text, "found another kind of file"},
                                   {note, "found another kind of file"},
                                   {empty, "expected a prodomos map"},
                                   {missing, "found no such file"},
                                   {other, "found another kind of SQLite file"},
                                   {folder_.path(), "found a folder"}}) {
    const auto message = messageOf([&, file = path] { MapView::open(file); });
    EXPECT_THAT(message, HasSubstr(said));
    EXPECT_THAT(message, testing::StartsWith(path.string()));
  }
  for (const auto& path : {text, note, empty, missing, other, folder_.path()}) {
    EXPECT_THROW(MapStore::openForWriting(path), base::FileError) << path;
  }
  EXPECT_EQ(PlainSqlite(other).value("SELECT count(*) FROM sqlite_master"), "1") << "left as it was";
}

/// Turns a map into what the first version of the schema would have made of it.
void makeFirstVersion(const std::filesystem::path& path) {
  PlainSqlite(path).query(
      "CREATE TABLE stored AS SELECT * FROM trajectory; DROP VIEW trajectory; DROP TABLE trajectory_point;"
      "ALTER TABLE stored RENAME TO trajectory; CREATE INDEX trajectory_by_node ON trajectory (node);"
      "ALTER TABLE node DROP COLUMN covariance; ALTER TABLE track DROP COLUMN entity; PRAGMA user_version = 1");
}

TEST_F(MapFile, OfTheFirstSchemaIsReadAndGrown) {
  auto change = twoNodes();
  change.nodes[1].T_map_submap = somePose(3);
  change.trajectory = {{{1}, at(1), {1}, somePose(1), {}}, {{1}, at(2), {2}, somePose(2), {}}};
  change.tracks = {{.id = {3}, .session = {1}, .className = "human"}};
  write(change);
  const auto written = MapView::open(path_).trajectory();
  makeFirstVersion(path_);

  const auto expectSame = [&](const MapView& view) {
    EXPECT_EQ(view.graph().getNode({1}).covariance, std::nullopt);
    const auto points = view.trajectory();
    ASSERT_EQ(points.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(points[i].time, written[i].time);
      EXPECT_EQ(points[i].submap, written[i].submap);
      EXPECT_TRUE(points[i].T_map_body.isApprox(written[i].T_map_body, 1e-9));
      EXPECT_TRUE(points[i].T_travel_body.isApprox(written[i].T_travel_body, 1e-9));
    }
  };
  expectSame(MapView::open(path_));
  EXPECT_EQ(MapView::open(path_).tracks().at(0).entity, std::nullopt);
  EXPECT_EQ(PlainSqlite(path_).value("PRAGMA user_version"), "1") << "reading changes nothing";

  const auto copy = folder_.path() / "copy.prodomos";
  std::filesystem::copy_file(path_, copy);
  MapStore::openForWriting(copy).close();
  expectSame(MapView::open(copy));
  auto store = MapStore::openForWriting(path_);
  expectSame(store.view());
  MapChange later;
  later.nodes = {change.nodes[1]};
  later.nodes[0].T_map_submap = Eigen::Translation3d(1, 2, 3) * change.nodes[1].T_map_submap;
  later.nodes[0].covariance = Matrix6::Identity();
  store.commit(later);
  EXPECT_EQ(store.view().graph().getNode({2}).covariance, Matrix6::Identity());
  EXPECT_TRUE(store.view().trajectory()[1].T_map_body.translation().isApprox(
      written[1].T_map_body.translation() + Eigen::Vector3d(1, 2, 3), 1e-9));
  store.close();
  EXPECT_EQ(PlainSqlite(path_).value("PRAGMA user_version"), "3");
  EXPECT_EQ(PlainSqlite(path_).value("PRAGMA integrity_check"), "ok");
}

TEST_F(MapFile, OfANewerSchemaIsRefused) {
  write(twoNodes());
  PlainSqlite(path_).query("PRAGMA user_version = 4");
  for (const auto& message :
       {messageOf([&] { MapView::open(path_); }), messageOf([&] { MapStore::openForWriting(path_); })}) {
    EXPECT_THAT(message, HasSubstr("expected a map of schema version 3 or older, found version 4"));
  }
}

class MapFileWithLayer : public MapFile {
 protected:
  void SetUp() override {
    auto change = twoNodes();
    const auto grid = gridFromText({"#..#"}, 0.25);
    change.layers = {{base::SubMapId{2}, &grid}};
    write(change);
  }

  std::string messageOfReading() const {
    const auto view = MapView::open(path_);
    return messageOf([&] { view.findLayer({2}, "occupancy_grid"); });
  }
  void change(const std::string& assignment) const { PlainSqlite(path_).query("UPDATE layer SET " + assignment); }
};

TEST_F(MapFileWithLayer, SaysWhichLayerIsDamaged) {
  flipByte(path_, "layer", "data");
  EXPECT_THAT(messageOfReading(), HasSubstr("layer occupancy_grid of sub-map s2 is damaged (its checksum differs)"));
}

TEST_F(MapFileWithLayer, RefusesASizeThatCannotBe) {
  for (const char* size : {"0", "1", "-1", "1000000000000000", "9223372036854775807"}) {
    change("raw_size = " + std::string(size));
    EXPECT_THAT(messageOfReading(), HasSubstr("layer occupancy_grid of sub-map s2")) << size;
  }
}

TEST_F(MapFileWithLayer, RefusesALayerOfANewerVersion) {
  change("version = 99");
  EXPECT_THAT(messageOfReading(), HasSubstr("expected version 1 or older, found version 99"));
}

TEST_F(MapFileWithLayer, ListsLayersOfUnknownTypesAndReadsTheOthers) {
  PlainSqlite(path_).query(
      "INSERT INTO layer SELECT node, 'smell', 3, codec, raw_size, crc32, data, revision FROM layer");
  {
    auto store = MapStore::openForWriting(path_);
    MapChange change;
    change.nodes = {nodeOf(2)};
    store.commit(change);
  }
  const auto view = MapView::open(path_);
  EXPECT_THAT(view.layersOf({2}), ElementsAre("occupancy_grid", "smell"));
  EXPECT_EQ(view.findLayer({2}, "smell"), nullptr);
  EXPECT_NE(view.findLayer({2}, "occupancy_grid"), nullptr);
}

TEST_F(MapFile, SaysThatAValueIsDamaged) {
  auto change = twoNodes();
  change.entities = {entityOf(1, 1)};
  write(change);
  for (const char* damage : {"UPDATE edge SET kind = 'teleport'", "UPDATE edge SET to_node = 77",
                             "UPDATE edge SET information = '[1, 2]'", "UPDATE entity SET attributes = '{'",
                             "UPDATE entity SET class = 'dragon'", "UPDATE session SET classes = 'none'"}) {
    const auto copy = folder_.path() / "copy.prodomos";
    std::filesystem::copy_file(path_, copy, std::filesystem::copy_options::overwrite_existing);
    PlainSqlite(copy).query(damage);
    EXPECT_THAT(messageOf([&] { MapView::open(copy); }), HasSubstr("the map file is damaged")) << damage;
  }
}

TEST_F(MapFile, WithRandomDamageIsReadOrRefusedButNeverCrashes) {
  auto change = twoNodes();
  change.entities = {entityOf(1, 1)};
  change.entities[0].points_in_submap = {{1, 2, 3}, {4, 5, 6}};
  const auto grid = gridFromText({"#..#", "#..#"}, 0.25);
  PointLayer points;
  for (int i = 0; i < 50; ++i) points.insert({static_cast<float>(i), 0, 0}, {});
  change.layers = {{base::SubMapId{1}, &grid}, {base::SubMapId{2}, &points}};
  change.trajectory = {{{1}, at(1), {1}, somePose(1), {}}};
  change.events = {{at(1), {1}, "submap_begun", "s1", "{}"}};
  change.checkpoint = Checkpoint{{1}, std::vector<std::byte>(100, std::byte{7})};
  write(change);
  const auto whole = test::readFile(path_);
  base::Random random(47);
  int refused = 0;
  constexpr int kRuns = 150;
  for (int run = 0; run < kRuns; ++run) {
    auto damaged = whole;
    for (int i = 0; i < 40; ++i) {
      const auto place = static_cast<std::size_t>(random.uniform(100, static_cast<double>(whole.size())));
      damaged[place] = static_cast<char>(random.integer(-128, 127));
    }
    if (run % 5 == 0) damaged.resize(static_cast<std::size_t>(random.uniform() * static_cast<double>(whole.size())));
    const auto path = folder_.write("damaged.prodomos", damaged);
    try {
      const auto view = MapView::open(path);
      for (const auto id : view.graph().nodes()) {
        for (const auto& type : view.layersOf(id)) view.findLayer(id, type);
      }
      view.trajectory();
      view.events();
      MapStore::openForWriting(path).findCheckpoint({1});
    } catch (const base::Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kRuns / 10);
}

// --- folders that cannot be written

/// Root may write anywhere; becomes nobody for a while.
class AsNobody {
 public:
  AsNobody() {
    if (wasRoot_) changed_ = seteuid(65534) == 0;
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;
  ~AsNobody() {
    if (changed_ && seteuid(0) != 0) std::abort();
  }

 private:
  bool wasRoot_ = geteuid() == 0;
  bool changed_ = false;
};

class ReadOnlyMap : public MapFile {
 protected:
  void lock() const { lock(path_); }
  void lock(const std::filesystem::path& file) const {
    using std::filesystem::perms;
    std::filesystem::permissions(file, perms::owner_read | perms::group_read | perms::others_read);
    std::filesystem::permissions(folder_.path(), perms(0555));
  }
  void TearDown() override { std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755)); }

  void expectReadable() const {
    const AsNobody nobody;
    if (access(folder_.path().c_str(), W_OK) == 0 && geteuid() == getuid())
      GTEST_SKIP() << "this user may write anywhere";
    const auto view = MapView::open(path_);
    EXPECT_EQ(view.graph().nodes().size(), 2U);
    EXPECT_THROW(MapStore::openForWriting(path_).commit({}), base::FileError);
  }
};

TEST_F(ReadOnlyMap, IsReadWhereNothingCanBeWrittenBesideIt) {
  write(twoNodes());
  lock();
  expectReadable();
}

TEST_F(ReadOnlyMap, IsReadInWalModeToo) {
  write(twoNodes());
  PlainSqlite(path_).query("PRAGMA journal_mode = WAL");
  ASSERT_FALSE(std::filesystem::exists(path_.string() + "-wal"));
  lock();
  expectReadable();
}

TEST_F(ReadOnlyMap, MayHaveANameThatMeansSomethingInAUri) {
  const auto odd = folder_.path() / "100% of #1? map.prodomos";
  {
    auto store = MapStore::create(odd);
    store.commit(twoNodes());
    store.close();
  }
  PlainSqlite(odd).query("PRAGMA journal_mode = WAL");
  lock(odd);
  const AsNobody nobody;
  EXPECT_EQ(MapView::open(odd).graph().nodes().size(), 2U);
}

}  // namespace
}  // namespace prodomos::map
