// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/graph_refiner.hpp"

#include "prodomos/mapper/config.hpp"

#include "mapper/drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prodomos::mapper {
namespace {

using geometry::Pose3;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// What a robot keeps of a stretch of its way, seen without fault.
struct Stretch {
  map::SubMap submap;
  std::optional<Pose3> T_last_submap;  ///< as its wheels tell, which drift; none of the first
  Pose3 T_world_submap;
};

constexpr double kStretch = 5.0;     // metres
constexpr double kScale = 1.02;      // what wheels tell of a metre
constexpr double kTurn = 0.02;       // radians that they turn aside on a stretch
constexpr double kSigma = 0.1;       // metres, of a stretch
constexpr double kTurnSigma = 0.02;  // radians

std::vector<Stretch> driveAroundBlock(const std::vector<Eigen::Vector2d>& path) {
  auto robot = slippingRobot();
  robot.odometryNoise = robot.wheelTurn = 0.0;
  robot.wheelScale = 1.0;
  const auto log = driveThrough(testing::corridorAroundBlock(), path, robot);
  const Pose3 T_world_odom = geometry::toPose3({path.front().x(), path.front().y(), 0.0});
  std::vector<Stretch> stretches;
  Pose3 T_world_body = Pose3::Identity();
  for (const auto& reading : log) {
    if (const auto* wheels = std::get_if<sensors::Odometry>(&reading.data)) {
      T_world_body = T_world_odom * wheels->T_odom_body;
      continue;
    }
    const bool begins =
        stretches.empty() || (stretches.back().T_world_submap.inverse() * T_world_body).translation().norm() > kStretch;
    if (begins) {
      std::optional<Pose3> T_last_submap;
      if (!stretches.empty()) {
        const auto step = geometry::toPose2(stretches.back().T_world_submap.inverse() * T_world_body);
        T_last_submap = geometry::toPose3({kScale * step.x, kScale * step.y, step.theta + kTurn});
      }
      stretches.push_back({map::makeSubMap({}, {}), T_last_submap, T_world_body});
      stretches.back().submap.node.begin = reading.time;
    }
    auto& stretch = stretches.back();
    for (auto& layer : stretch.submap.layers)
      layer->integrate({.reading = reading, .T_submap_body = stretch.T_world_submap.inverse() * T_world_body});
    stretch.submap.node.distance = kStretch;
    ++stretch.submap.node.readings;
  }
  return stretches;
}

const std::vector<Stretch>& lap() {
  static const auto kStretches = driveAroundBlock(testing::lapAroundBlock());
  return kStretches;
}

localization::LoopCloserConfig withoutLoops() {
  localization::LoopCloserConfig config;
  config.enabled = false;
  return config;
}

map::Matrix6 information(double sigma, double turnSigma) {
  map::Matrix6 matrix = map::Matrix6::Zero();
  matrix.diagonal() << Eigen::Vector3d::Constant(1.0 / (sigma * sigma)),
      Eigen::Vector3d::Constant(1.0 / (turnSigma * turnSigma));
  return matrix;
}

/// A graph and its file, fed as the mapper does.
struct MapRun {
  explicit MapRun(const localization::LoopCloserConfig& config = {}) : config(config) {
    refiner = std::make_unique<GraphRefiner>(config, store);
  }

  /// The first of a session begins at T_map_first.
  void beginSession(std::int64_t number, const Pose3& T_map_first) {
    session.id = {number};
    T_map_next = T_map_first;
    last.reset();
    refiner = std::make_unique<GraphRefiner>(config, store);
  }

  /// The sub-map is driven through and finished: what the file is told.
  map::MapChange go(const Stretch& stretch) {
    map::Node node = stretch.submap.node;
    node.id = refiner->newNodeId();
    node.session = session.id;
    node.T_map_submap = last ? refiner->T_map_submap(*last) * stretch.T_last_submap.value() : T_map_next;
    std::optional<map::Edge> edge;
    if (last) {
      edge.emplace();
      edge->id = refiner->newEdgeId();
      edge->from = *last;
      edge->to = node.id;
      edge->T_from_to = stretch.T_last_submap.value();
      edge->information = information(kSigma, kTurnSigma);
    }
    refiner->add(node, edge);
    last = node.id;
    map::SubMap finished;
    finished.node = node;
    map::MapChange change;
    for (const auto& layer : stretch.submap.layers) {
      finished.layers.push_back(layer->clone());
      change.layers.emplace_back(node.id, layer.get());
    }
    refiner->close(finished);
    return tell(std::move(change), false);
  }

  map::MapChange tell(map::MapChange change, bool all) {
    change.sessions.push_back(session);
    refiner->addTo(change, base::SubMapId{-1}, all);
    store.commit(change);
    return change;
  }

  map::MapView finish() {
    refiner->settle();
    tell({}, true);
    return store.view();
  }

  std::vector<std::byte> saved() const {
    base::ByteWriter out;
    refiner->save(out);
    return out.take();
  }

  localization::LoopCloserConfig config;
  map::MapStore store = map::MapStore::inMemory();
  std::unique_ptr<GraphRefiner> refiner;
  map::Session session;
  Pose3 T_map_next = Pose3::Identity();
  std::optional<base::SubMapId> last;
};

/// How far a sub-map lies from where it truly is, the map's first being right.
double errorOf(const MapRun& run, std::int64_t id, const Pose3& T_world_submap) {
  const Pose3 T_map_true = lap().front().T_world_submap.inverse() * T_world_submap;
  return (run.refiner->T_map_submap({id}).translation() - T_map_true.translation()).norm();
}

bool isFound(const map::Edge& edge) {
  return edge.kind == map::EdgeKind::kLoop || edge.kind == map::EdgeKind::kOverlap;
}

TEST(GraphRefiner, ClosesTheLoopOfADriveAroundABlock) {
  MapRun drifting(withoutLoops());
  MapRun run;
  for (const auto& stretch : lap()) {
    drifting.go(stretch);
    run.go(stretch);
  }
  run.finish();
  const auto end = static_cast<std::int64_t>(lap().size()) - 1;
  ASSERT_GT(end, 8);
  EXPECT_GT(errorOf(drifting, end, lap().back().T_world_submap), 0.5);
  for (std::int64_t id = 0; id <= end; ++id) {
    const auto& truth = lap()[static_cast<std::size_t>(id)].T_world_submap;
    // What lies on the far side of the block stays as uncertain as half the way there and back leaves it.
    EXPECT_LT(errorOf(run, id, truth), 0.35) << "s" << id;
    const Pose3 T_true_map = truth.inverse() * lap().front().T_world_submap;
    EXPECT_LT(geometry::rotationAngle(T_true_map * run.refiner->T_map_submap({id})), 0.05) << "s" << id;
  }
  EXPECT_LT(errorOf(run, end, lap().back().T_world_submap), 0.05) << "where the way comes back to its begin";
}

TEST(GraphRefiner, TellsTheFileAllThatItKnows) {
  MapRun run;
  for (const auto& stretch : lap()) run.go(stretch);
  const auto view = run.finish();
  ASSERT_EQ(view.graph().nodes().size(), lap().size());
  for (const auto id : view.graph().nodes()) {
    EXPECT_TRUE(view.graph().getNode(id).T_map_submap.isApprox(run.refiner->T_map_submap(id), 1e-9)) << id;
    EXPECT_TRUE(view.graph().getNode(id).covariance.has_value()) << id;
  }
  int loops = 0;
  for (const auto id : view.graph().edges()) {
    const auto& edge = view.graph().getEdge(id);
    if (!isFound(edge)) continue;
    ++loops;
    const auto& from = lap()[static_cast<std::size_t>(edge.from.value)].T_world_submap;
    const auto& to = lap()[static_cast<std::size_t>(edge.to.value)].T_world_submap;
    EXPECT_LT((edge.T_from_to.translation() - (from.inverse() * to).translation()).norm(), 0.05) << id;
  }
  EXPECT_GE(loops, 2);
  const auto more = run.tell({}, false);
  EXPECT_THAT(more.nodes, IsEmpty());
  EXPECT_THAT(more.edges, IsEmpty());
  EXPECT_THAT(more.removedEdges, IsEmpty());
}

TEST(GraphRefiner, TellsWhileItGrowsOnlyWhatHasMoved) {
  MapRun run;
  std::size_t mostMoved = 0;
  for (const auto& stretch : lap()) {
    const auto change = run.go(stretch);
    const bool isRefined = std::ranges::any_of(change.edges, isFound);
    if (!isRefined) {
      EXPECT_EQ(change.nodes.size(), 1U) << "the new one alone";
    }
    mostMoved = std::max(mostMoved, change.nodes.size());
    const auto view = run.store.view();
    for (const auto id : view.graph().nodes()) {
      const Pose3 T_told_now = view.graph().getNode(id).T_map_submap.inverse() * run.refiner->T_map_submap(id);
      EXPECT_LT(T_told_now.translation().norm(), 2e-3);
    }
  }
  EXPECT_GT(mostMoved, 5U) << "when the loop was closed";
}

TEST(GraphRefiner, DoubtsSubMapsMoreTheFartherTheyAreFromTheFirst) {
  MapRun run(withoutLoops());
  for (std::size_t i = 0; i < 6; ++i) run.go(lap()[i]);
  const auto view = run.finish();
  double before = -1.0;
  for (const auto id : view.graph().nodes()) {
    const double variance = view.graph().getNode(id).covariance.value().trace();
    EXPECT_GT(variance, before) << id;
    before = variance;
  }
  EXPECT_TRUE(view.graph().getNode({0}).covariance->isZero());
  EXPECT_NEAR(view.graph().getNode({1}).covariance.value()(0, 0), kSigma * kSigma, 1e-6);
}

TEST(GraphRefiner, KnowsSubMapsBetterOnceALoopIsClosed) {
  MapRun open(withoutLoops());
  MapRun closed;
  for (const auto& stretch : lap()) {
    open.go(stretch);
    closed.go(stretch);
  }
  const auto doubtOf = [](const map::MapView& view) {
    return view.graph().getNode(view.graph().nodes().back()).covariance.value().trace();
  };
  EXPECT_LT(doubtOf(closed.finish()), 0.2 * doubtOf(open.finish()));
}

/// Five sub-maps in a row, and what somebody took for loops.
void commitRow(map::MapStore& store, const std::vector<map::Edge>& loops) {
  map::MapChange change;
  change.sessions.emplace_back();
  for (int i = 0; i < 5; ++i) {
    map::Node node;
    node.id = {i};
    node.T_map_submap = geometry::toPose3({5.0 * i, 0.0, 0.0});
    change.nodes.push_back(node);
    if (i == 0) continue;
    map::Edge edge;
    edge.id = {i};
    edge.from = {i - 1};
    edge.to = {i};
    edge.T_from_to = geometry::toPose3({5.0, 0.0, 0.0});
    edge.information = information(kSigma, kTurnSigma);
    change.edges.push_back(edge);
  }
  change.edges.insert(change.edges.end(), loops.begin(), loops.end());
  store.commit(change);
}

map::Edge loopBetween(int id, int from, int to, const Pose3& T_from_to) {
  map::Edge loop;
  loop.id = {id};
  loop.from = {from};
  loop.to = {to};
  loop.kind = map::EdgeKind::kLoop;
  loop.T_from_to = T_from_to;
  loop.information = information(0.02, 0.01);
  return loop;
}

TEST(GraphRefiner, GivesUpAWrongLoopAndTakesItOutOfTheFile) {
  auto store = map::MapStore::inMemory();
  commitRow(store, {loopBetween(10, 0, 3, geometry::toPose3({15.05, 0.02, 0.0})),
                    loopBetween(11, 1, 4, geometry::toPose3({3.0, 4.0, 1.0}))});
  GraphRefiner refiner({}, store);
  refiner.settle();
  map::MapChange change;
  refiner.addTo(change, base::SubMapId{-1}, true);
  EXPECT_THAT(change.removedEdges, ElementsAre(base::EdgeId{11}));
  EXPECT_THAT(change.edges, IsEmpty());
  store.commit(change);
  EXPECT_TRUE(store.view().graph().hasEdge({10}));
  EXPECT_FALSE(store.view().graph().hasEdge({11}));
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT((refiner.T_map_submap({i}).translation() - Eigen::Vector3d(5.0 * i, 0, 0)).norm(), 0.1) << "s" << i;
  }
}

TEST(GraphRefiner, LeavesPosesAloneWhereItLooksForNoLoops) {
  auto store = map::MapStore::inMemory();
  commitRow(store, {loopBetween(10, 0, 3, geometry::toPose3({15.5, 0.5, 0.0}))});
  GraphRefiner refiner(withoutLoops(), store);
  refiner.settle();
  for (int i = 0; i < 5; ++i)
    EXPECT_TRUE(refiner.T_map_submap({i}).isApprox(geometry::toPose3({5.0 * i, 0, 0}), 1e-12));
}

TEST(GraphRefiner, GoesOnBitByBitFromWhereItWasSaved) {
  MapRun undisturbed;
  for (const auto& stretch : lap()) undisturbed.go(stretch);
  for (std::size_t cut = 1; cut < lap().size(); ++cut) {
    MapRun disturbed;
    for (std::size_t i = 0; i < lap().size(); ++i) {
      if (i == cut) {  // all that is left is the file, and the bytes in its checkpoint
        const auto bytes = disturbed.saved();
        disturbed.refiner = std::make_unique<GraphRefiner>(localization::LoopCloserConfig{}, disturbed.store);
        base::ByteReader in(bytes);
        disturbed.refiner->load(in);
        EXPECT_EQ(in.left(), 0U);
        EXPECT_TRUE(disturbed.saved() == bytes);
      }
      disturbed.go(lap()[i]);
    }
    EXPECT_TRUE(disturbed.saved() == undisturbed.saved()) << "cut before s" << cut;
  }
}

TEST(GraphRefiner, JoinsTwoSessionsOnceTwoLoopsAgreeHowTheyLie) {
  MapRun run;
  for (const auto& stretch : lap()) run.go(stretch);
  run.finish();
  const Pose3 T_map_stranger = geometry::toPose3({500.0, 300.0, 2.0});
  run.beginSession(1, T_map_stranger);
  EXPECT_FALSE(run.refiner->meetsAnother({1}));
  const auto first = static_cast<std::int64_t>(lap().size());
  std::int64_t id = first;
  bool hasMet = false;
  const auto another = driveAroundBlock({{19.0, 5.0}, {19.0, 12.0}, {5.0, 12.0}, {5.0, 5.0}});
  for (const auto& stretch : another) {
    const auto change = run.go(stretch);
    const auto joins = std::ranges::count_if(
        change.edges, [&](const map::Edge& edge) { return isFound(edge) && edge.from.value < first; });
    if (!hasMet) {
      EXPECT_EQ(run.refiner->meetsAnother({1}), joins > 0);
      EXPECT_NE(joins, 1) << "nobody believes a single one";
    }
    hasMet |= joins > 0;
    if (!hasMet) {
      EXPECT_TRUE(run.refiner->T_map_submap({first}).isApprox(T_map_stranger, 1e-9));
    }
    ++id;
  }
  ASSERT_TRUE(hasMet);
  const auto view = run.finish();
  EXPECT_EQ(view.graph().componentCount(), 1);
  // Where both have been they lie to each other as in the world; the block's far side is known no better than before.
  for (id = first; id < first + static_cast<std::int64_t>(another.size()); ++id)
    EXPECT_LT(errorOf(run, id, another[static_cast<std::size_t>(id - first)].T_world_submap), 0.4) << "s" << id;
}

TEST(GraphRefiner, KeepsSessionsApartThatNeverMeet) {
  MapRun run;
  for (std::size_t i = 0; i < 3; ++i) run.go(lap()[i]);
  run.finish();
  run.beginSession(1, geometry::toPose3({500.0, 300.0, 2.0}));
  for (std::size_t i = 6; i < 8; ++i) run.go(lap()[i]);
  const auto view = run.finish();
  EXPECT_FALSE(run.refiner->meetsAnother({1}));
  EXPECT_EQ(view.graph().componentCount(), 2);
}

TEST(GraphRefiner, MovesASessionAsAWhole) {
  MapRun run(withoutLoops());
  run.go(lap()[0]);
  run.go(lap()[1]);
  run.beginSession(1, geometry::toPose3({50.0, 0.0, 0.0}));
  run.go(lap()[2]);
  const Pose3 before = run.refiner->T_map_submap({1});
  const Pose3 T_after_before = geometry::fromYawPitchRoll({0.0, 0.0, 0.3}, 0.0, 0.1, -0.2);
  run.refiner->move({0}, T_after_before);
  EXPECT_TRUE(run.refiner->T_map_submap({1}).isApprox(T_after_before * before, 1e-12));
  EXPECT_TRUE(run.refiner->T_map_submap({2}).isApprox(geometry::toPose3({50.0, 0.0, 0.0}), 1e-12));
}

}  // namespace
}  // namespace prodomos::mapper
