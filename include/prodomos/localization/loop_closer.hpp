// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/config.hpp"
#include "prodomos/base/id.hpp"
#include "prodomos/localization/place_signature.hpp"
#include "prodomos/localization/submap_matcher.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace prodomos::localization {

struct LoopCloserConfig {
  bool enabled = true;
  int near = 4;           ///< sub-maps that are tried for being near
  int alike = 2;          ///< … for looking alike, wherever they are
  double leastWay = 9.0;  ///< metres travelled between two sub-maps; nearer ones are tied by the way itself
  SubMapMatcherConfig match;
};

void describe(base::ConfigVisitor& visitor, LoopCloserConfig& config);

/// A finished sub-map, as far as finding it again goes.
struct LoopPlace {
  base::SubMapId id;
  base::SessionId session;
  int component = 0;         ///< of the graph: poses of different ones say nothing about each other
  std::optional<int> floor;  ///< loops join places of one floor
  double way = 0.0;          ///< metres travelled in its session when it began
  geometry::Pose2 T_map_submap;
};

/// The other end of a loop.
struct Loop {
  base::SubMapId from;
  base::SubMapId to;
  SubMapMatch match;
};

/// Finds out where a sub-map shows what another one has shown before: candidates are those that may be near, given what
/// is known of the poses, and those that look alike; matching decides.
class LoopCloser {
 public:
  using FindLayers = std::function<MatchedLayers(base::SubMapId)>;
  /// Covariance of x, y, theta of the one sub-map in the other.
  using FindCovariance = std::function<Eigen::Matrix3d(base::SubMapId from, base::SubMapId to)>;

  LoopCloser(const LoopCloserConfig& config, FindLayers findLayers);

  /// Remembers what the sub-map looks like; its layers are asked for again when it becomes a candidate.
  void add(base::SubMapId id, const MatchedLayers& layers);
  bool knows(base::SubMapId id) const;
  /// Loops between `newest` and `others`, all of them added before, where `linked` are left out.
  std::vector<Loop> find(const LoopPlace& newest, std::span<const LoopPlace> others,
                         std::span<const base::SubMapId> linked, const FindCovariance& findCovariance) const;

 private:
  struct Looks {
    base::SubMapId id;
    Eigen::Vector2d centre_in_submap = Eigen::Vector2d::Zero();
    double radius = 0.0;  ///< metres; most of its surface lies within
    std::vector<PlaceSignature> signatures;
  };
  struct Candidate {
    base::SubMapId id;
    double rank = 0.0;  ///< the least is the best
    SearchWindow window;
    std::optional<Likeness> likeness{};  ///< where the window is to lie, for those that look alike
  };

  const Looks& looksOf(base::SubMapId id) const;
  std::vector<Candidate> nearOnes(const LoopPlace& newest, std::span<const LoopPlace> others,
                                  const FindCovariance& findCovariance) const;
  std::vector<Candidate> alikeOnes(const LoopPlace& newest, std::span<const LoopPlace> others) const;

  LoopCloserConfig config_;
  FindLayers findLayers_;
  std::vector<Looks> known_;  // ascending by id
};

}  // namespace prodomos::localization
