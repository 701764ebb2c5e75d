// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// How much false loops bend a map. Puts a finished map together again from its edges, sub-map after sub-map as the
/// mapper does: each new one with its loops, poses refined, all loops weighed anew in the end. First with the loops
/// that the map has, then with false ones among them: between any two sub-maps, at any pose within some metres, as sure
/// of themselves as true ones.
///
///     false_loops intel.prodomos intel.relations --share 0.3 --seeds 5
///
/// With --alike 3 three false loops each agree with each other, as where two stretches of corridor look the same; with
/// --shift 1 each is off by a metre only, as where the doors of a corridor look the same.

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/relations.hpp"
#include "prodomos/localization/pose_graph.hpp"
#include "prodomos/map/map_view.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <numbers>
#include <vector>

namespace prodomos {
namespace {

using geometry::Pose3;
using localization::PoseConstraint;
using localization::PoseGraph;

struct Options {
  std::string map;
  std::string relations;
  double share = 0.3;  ///< of all loops that are false
  int alike = 1;       ///< false loops that agree with each other
  double reach = 5.0;  ///< metres within which the ends of a false loop lie, on either axis
  double shift = 0.0;  ///< metres from the truth; 0: anywhere within reach, turned anyhow
  int seeds = 5;
};

/// A finished map as a graph, at the poses as travelled.
struct Built {
  std::vector<map::Node> nodes;
  std::vector<PoseConstraint> travelled;  ///< by the node that they lead to
  std::vector<PoseConstraint> loops;
  std::vector<map::TrajectoryPoint> trajectory;
};

struct Outcome {
  evaluation::RelationScore score;
  int falseKept = 0;
  int trueLost = 0;
};

Built read(const std::string& path) {
  const auto view = map::MapView::open(path);
  if (view.sessions().size() != 1)
    throw base::FileError(base::expectedFound(path, "one session", std::to_string(view.sessions().size())));
  Built built{.trajectory = view.trajectory()};
  for (const auto id : view.graph().nodes()) built.nodes.push_back(view.graph().getNode(id));
  for (const auto id : view.graph().edges()) {
    const auto& edge = view.graph().getEdge(id);
    const bool isLoop = edge.kind == map::EdgeKind::kLoop || edge.kind == map::EdgeKind::kOverlap;
    (isLoop ? built.loops : built.travelled)
        .push_back({edge.from.value, edge.to.value, edge.T_from_to, edge.information, isLoop});
  }
  if (built.loops.empty()) throw base::FileError(base::expectedFound(path, "loops", "none"));
  return built;
}

/// How the first two sub-maps of a lie are said to lie to each other.
Pose3 lieAbout(const map::Node& from, const map::Node& to, const Options& options, base::Random& random) {
  const double heading = random.uniform(-std::numbers::pi, std::numbers::pi);
  if (options.shift > 0.0) {
    const Eigen::Vector3d shift(options.shift * std::cos(heading), options.shift * std::sin(heading), 0.0);
    return from.T_map_submap.inverse() * to.T_map_submap * Eigen::Translation3d(shift);
  }
  const double x = random.uniform(-options.reach, options.reach);
  const double y = random.uniform(-options.reach, options.reach);
  return geometry::toPose3({.x = x, .y = y, .theta = heading});
}

/// Loops that are not true; each `alike` of them tell the same lie about neighbouring sub-maps.
std::vector<PoseConstraint> falseLoops(const Built& built, const Options& options, std::uint64_t seed) {
  base::Random random(seed);
  const double perTrue = options.share / (1.0 - options.share);
  const auto count = static_cast<std::size_t>(perTrue * static_cast<double>(built.loops.size()));
  const auto any = [&](std::size_t size) {
    return static_cast<std::size_t>(random.integer(0, static_cast<int>(size) - 1));
  };
  const auto alike = static_cast<std::size_t>(options.alike);
  const auto wayFrom = [&](std::size_t first, std::size_t i) -> Pose3 {
    return built.nodes[first].T_travel_submap.inverse() * built.nodes[first + i].T_travel_submap;
  };
  std::vector<PoseConstraint> loops;
  while (loops.size() < count) {
    const auto from = any(built.nodes.size() - alike + 1);
    const auto to = any(built.nodes.size() - alike + 1);
    if (to <= from + alike) continue;  // those of one stretch of the way are tied already
    const auto T_first = lieAbout(built.nodes[from], built.nodes[to], options, random);
    for (std::size_t i = 0; i < alike && loops.size() < count; ++i) {
      loops.push_back({.from = built.nodes[from + i].id.value,
                       .to = built.nodes[to + i].id.value,
                       .T_from_to = wayFrom(from, i).inverse() * T_first * wayFrom(to, i),
                       .information = built.loops[any(built.loops.size())].information,
                       .isDoubtful = true});
    }
  }
  return loops;
}

/// A sub-map begins where the edge that leads to it says.
void begin(PoseGraph& graph, const map::Node& node, const Built& built) {
  auto pose = node.T_travel_submap;
  for (const auto& edge : built.travelled) {
    if (edge.to != node.id.value) continue;
    pose = std::ranges::find(graph.vertices, edge.from, &localization::PoseVertex::id)->pose * edge.T_from_to;
    graph.constraints.push_back(edge);
  }
  graph.vertices.push_back({node.id.value, pose});
}

/// As the mapper does while the robot travels: the loops of a sub-map are found when it is finished.
PoseGraph grow(const Built& built, const std::vector<PoseConstraint>& loops, std::vector<double>& weights) {
  PoseGraph graph;
  for (const auto& node : built.nodes) {
    begin(graph, node, built);
    const auto before = graph.constraints.size();
    std::ranges::copy_if(loops, std::back_inserter(graph.constraints),
                         [&](const auto& loop) { return std::max(loop.from, loop.to) == node.id.value; });
    if (graph.constraints.size() > before) localization::optimize(graph, {.isIncremental = true});
  }
  weights = localization::optimize(graph).weights;
  return graph;
}

/// The trajectory moves with the sub-maps.
std::vector<evaluation::TimedPose> bodyPoses(const Built& built, const PoseGraph& graph) {
  std::map<std::int64_t, Pose3> T_map_travel;
  for (std::size_t i = 0; i < built.nodes.size(); ++i) {
    T_map_travel[built.nodes[i].id.value] = graph.vertices[i].pose * built.nodes[i].T_travel_submap.inverse();
  }
  std::vector<evaluation::TimedPose> poses;
  for (const auto& point : built.trajectory)
    poses.push_back({point.time, T_map_travel.at(point.submap.value) * point.T_travel_body});
  return poses;
}

Outcome build(const Built& built, const std::vector<PoseConstraint>& lies,
              const std::vector<evaluation::Relation>& relations, bool isGullible = false) {
  auto loops = built.loops;
  loops.insert(loops.end(), lies.begin(), lies.end());
  for (auto& loop : loops) loop.isDoubtful = !isGullible;
  std::vector<double> weights;
  const auto graph = grow(built, loops, weights);
  const auto isLie = [&](const PoseConstraint& loop) {
    return std::ranges::any_of(lies, [&](const auto& lie) {
      return lie.from == loop.from && lie.to == loop.to && lie.T_from_to.isApprox(loop.T_from_to, 0.0);
    });
  };
  Outcome outcome{.score = evaluation::scoreOf(evaluation::relationErrors(bodyPoses(built, graph), relations))};
  if (outcome.score.translation.count == 0) throw base::Error("no relation joins times of the map's trajectory");
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const bool isKept = weights[i] >= 0.5;
    const bool isTrue = !isLie(graph.constraints[i]);
    if (isKept && !isTrue) ++outcome.falseKept;
    if (!isKept && isTrue) ++outcome.trueLost;
  }
  return outcome;
}

void print(const char* name, std::size_t lies, const Outcome& outcome, const Outcome& plain) {
  const auto& [translation, rotation, shifted, turned] = outcome.score;
  std::printf("%-8s %6zu %6d %6d %10.4f %10.3f %8.3f %8.3f\n", name, lies, outcome.falseKept, outcome.trueLost,
              translation.mean, rotation.mean, translation.mean / plain.score.translation.mean,
              rotation.mean / plain.score.rotation.mean);
}

void run(const Options& options) {
  const auto built = read(options.map);
  const auto relations = evaluation::readRelations(options.relations);
  const auto plain = build(built, {}, relations);
  std::printf("%zu sub-maps, %zu loops of the map, %.0f %% of all loops false, %d alike\n", built.nodes.size(),
              built.loops.size(), 100.0 * options.share, options.alike);
  std::printf("%-8s %6s %6s %6s %10s %10s %8s %8s\n", "", "false", "kept", "lost", "metres", "degrees", "factor",
              "factor");
  print("none", 0, plain, plain);
  const auto believed = falseLoops(built, options, 1);
  print("believed", believed.size(), build(built, believed, relations, true), plain);
  for (int seed = 1; seed <= options.seeds; ++seed) {
    const auto lies = falseLoops(built, options, static_cast<std::uint64_t>(seed));
    print(("seed " + std::to_string(seed)).c_str(), lies.size(), build(built, lies, relations), plain);
  }
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  CLI::App program("how much false loops bend a map");
  prodomos::Options options;
  program.add_option("MAP", options.map, "a finished map, poses estimated")->required();
  program.add_option("RELATIONS", options.relations, "true relations between poses")->required();
  program.add_option("--share", options.share, "of all loops that are false")
      ->check(CLI::Range(0.0, 0.95))
      ->capture_default_str();
  program.add_option("--alike", options.alike, "false loops that agree with each other")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  program.add_option("--reach", options.reach, "metres between the ends of a false loop")->capture_default_str();
  program.add_option("--shift", options.shift, "metres that a false loop is off; 0: it may say anything")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  program.add_option("--seeds", options.seeds, "how many runs")->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    prodomos::run(options);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "false_loops: %s\n", fault.what());
    return 1;
  }
  return 0;
}
