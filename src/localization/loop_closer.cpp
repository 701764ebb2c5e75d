// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/loop_closer.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::localization {

namespace {

constexpr double kSigmas = 3.0;
// Sub-maps are bent, and covariances too small now and then: never search less than this around.
constexpr double kLeastReach = 0.5;  // metres
constexpr double kLeastTurn = 0.1;   // radians
constexpr double kMostTurn = 0.5;
constexpr double kMostReach = 10.0;  // metres; what is known worse is found by its looks
// Viewpoints that look alike lie that near, and are turned that well.
constexpr double kAlikeReach = 1.5;  // metres
constexpr double kAlikeTurn = 0.2;   // radians
constexpr double kMostRadius = 15.0;

template <typename Candidates>
void keepBest(Candidates& candidates, int count) {
  std::ranges::stable_sort(candidates, std::ranges::less{}, [](const auto& candidate) { return candidate.rank; });
  if (candidates.size() > static_cast<std::size_t>(count)) candidates.resize(static_cast<std::size_t>(count));
}

}  // namespace

void describe(base::ConfigVisitor& visitor, LoopCloserConfig& config) {
  auto& match = config.match;
  visitor.section("loops", "where a sub-map shows what another one has shown before");
  visitor.key("enabled", config.enabled, "look for loops");
  visitor.key("near", config.near, "", {0, 1000}, "sub-maps that are tried for being near");
  visitor.key("alike", config.alike, "", {0, 1000}, "sub-maps that are tried for looking alike, wherever they are");
  visitor.key("least_way", config.leastWay, "m", {0.0, 1e6}, "travelled between two sub-maps that a loop may join");
  visitor.key("least_overlap", match.leastOverlap, "", {0.0, 1.0},
              "share of either's surface that the other must show");
  visitor.key("least_wall", match.leastWall, "m", {0.0, 1000.0}, "of wall that both must show");
  visitor.key("most_conflict", match.mostConflict, "", {0.0, 1.0},
              "share of the compared surface that may lie where the other has seen free floor");
  visitor.key("least_score", match.leastScore, "", {0.0, 1.0}, "mean likelihood at which the search gives up");
  visitor.key("least_lead", match.leastLead, "", {0.0, 1.0},
              "of the mean likelihood over that of any other place, else it cannot be told which one it is");
  visitor.key("search_resolution", match.searchResolution, "m", {0.02, 1.0}, "of the search for a pose");
  visitor.endSection();
}

LoopCloser::LoopCloser(const LoopCloserConfig& config, FindLayers findLayers)
    : config_(config), findLayers_(std::move(findLayers)) {}

void LoopCloser::add(base::SubMapId id, const MatchedLayers& layers) {
  Looks looks{.id = id, .signatures = placeSignatures(*layers.surface)};
  const auto& points = layers.surface->points();
  const auto count = static_cast<double>(std::max<std::size_t>(points.size(), 1));
  for (const auto& point : points) looks.centre_in_submap += point.position_in_submap() / count;
  double squares = 0.0;
  for (const auto& point : points)
    squares += (point.position_in_submap() - looks.centre_in_submap).squaredNorm() / count;
  looks.radius = std::min(kMostRadius, std::sqrt(2.0 * squares));
  const auto at = std::ranges::lower_bound(known_, id, {}, &Looks::id);
  known_.insert(at, std::move(looks));
}

const LoopCloser::Looks& LoopCloser::looksOf(base::SubMapId id) const {
  const auto found = std::ranges::lower_bound(known_, id, {}, &Looks::id);
  if (found == known_.end() || found->id != id) throw base::Error("expected sub-map " + toString(id) + " to be known");
  return *found;
}

bool LoopCloser::knows(base::SubMapId id) const {
  return std::ranges::binary_search(known_, id, {}, &Looks::id);
}

std::vector<Loop> LoopCloser::find(const LoopPlace& newest, std::span<const LoopPlace> others,
                                   std::span<const base::SubMapId> linked, const FindCovariance& findCovariance) const {
  std::vector<LoopPlace> open;
  for (const auto& other : others) {
    const bool isNext = other.session == newest.session && std::abs(newest.way - other.way) < config_.leastWay;
    const bool isLinked = std::ranges::find(linked, other.id) != linked.end();
    if (other.id != newest.id && !isNext && !isLinked && other.floor == newest.floor) open.push_back(other);
  }
  auto candidates = nearOnes(newest, open, findCovariance);
  const auto isCovered = [near = candidates](const Candidate& candidate) {
    const auto found = std::ranges::find(near, candidate.id, &Candidate::id);
    return found != near.end() && found->window.reach < kMostReach && found->window.turn < kMostTurn;
  };
  for (auto& candidate : alikeOnes(newest, open)) {
    if (!isCovered(candidate)) candidates.push_back(candidate);
  }
  std::vector<Loop> loops;
  const auto layers = findLayers_(newest.id);
  for (const auto& candidate : candidates) {
    if (std::ranges::find(loops, candidate.id, &Loop::from) != loops.end()) continue;
    const auto others = findLayers_(candidate.id);
    auto window = candidate.window;
    if (candidate.likeness) window.centre = alignViewpoints(*others.surface, *layers.surface, *candidate.likeness);
    if (const auto match = matchSubMaps(others, layers, window, config_.match))
      loops.push_back({candidate.id, newest.id, *match});
  }
  return loops;
}

/// Those whose surroundings overlap, were the poses off by some standard deviations.
std::vector<LoopCloser::Candidate> LoopCloser::nearOnes(const LoopPlace& newest, std::span<const LoopPlace> others,
                                                        const FindCovariance& findCovariance) const {
  const auto& looks = looksOf(newest.id);
  const Eigen::Vector2d centre = newest.T_map_submap * looks.centre_in_submap;
  std::vector<Candidate> near;
  for (const auto& other : others) {
    if (other.component != newest.component) continue;
    const auto& otherLooks = looksOf(other.id);
    const double distance = (other.T_map_submap * otherLooks.centre_in_submap - centre).norm();
    if (distance > looks.radius + otherLooks.radius + kMostReach) continue;
    near.push_back({.id = other.id,
                    .rank = distance,
                    .window = {.centre = geometry::inverse(other.T_map_submap) * newest.T_map_submap}});
  }
  // What is known of a pair costs more to tell than how far apart they lie.
  keepBest(near, 4 * config_.near);
  std::erase_if(near, [&](Candidate& candidate) {
    const Eigen::Matrix3d covariance = findCovariance(candidate.id, newest.id);
    const double sigma = std::sqrt(covariance.topLeftCorner<2, 2>().diagonal().maxCoeff());
    candidate.window.reach = std::clamp(kSigmas * sigma, kLeastReach, kMostReach);
    candidate.window.turn = std::clamp(kSigmas * std::sqrt(covariance(2, 2)), kLeastTurn, kMostTurn);
    const double reach = looks.radius + looksOf(candidate.id).radius;
    return candidate.rank > reach + candidate.window.reach;
  });
  keepBest(near, config_.near);
  return near;
}

std::vector<LoopCloser::Candidate> LoopCloser::alikeOnes(const LoopPlace& newest,
                                                         std::span<const LoopPlace> others) const {
  const auto& looks = looksOf(newest.id);
  // A part of the graph that has not met the others must find them by their looks, whatever of its own looks alike.
  std::vector<Candidate> alike;
  std::vector<Candidate> strangers;
  for (const auto& other : others) {
    const auto likeness = mostAlike(looksOf(other.id).signatures, looks.signatures);
    if (std::isinf(likeness.difference)) continue;  // one of them has seen nothing
    auto& candidates = other.component == newest.component ? alike : strangers;
    candidates.push_back({.id = other.id,
                          .rank = likeness.difference,
                          .window = {.reach = kAlikeReach, .turn = kAlikeTurn},
                          .likeness = likeness});
  }
  keepBest(alike, config_.alike);
  keepBest(strangers, config_.alike);
  alike.insert(alike.end(), strangers.begin(), strangers.end());
  return alike;
}

}  // namespace prodomos::localization
