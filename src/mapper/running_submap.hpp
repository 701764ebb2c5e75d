// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/stopwatch.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/mapper/config.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace prodomos::mapper {

/// The sub-map that the robot is in: what its readings have given so far, and how the robot has moved within.
class RunningSubMap {
 public:
  /// `edge` leads to it from the one before.
  RunningSubMap(const map::Node& node, const std::optional<map::Edge>& edge, const map::LayersConfig& config);

  const map::Node& node() const { return submap_.node; }
  const std::optional<map::Edge>& edge() const { return edge_; }
  /// Of the way within, in the axes of the body now: metres, radians.
  const map::Matrix6& covariance() const { return covariance_; }
  geometry::Pose3 T_submap_body(const geometry::Pose3& T_travel_body) const {
    return submap_.node.T_travel_submap.inverse() * T_travel_body;
  }

  void move(const geometry::Pose3& T_before_after, const map::Matrix6& covariance);
  /// Where it lies as its poses are refined.
  void refine(const geometry::Pose3& T_map_submap) { submap_.node.T_map_submap = T_map_submap; }
  const map::SubMap& submap() const { return submap_; }
  /// Where the robot was at each reading; positions of its body.
  std::vector<Eigen::Vector3d> wayInSubMap() const;
  /// Every so many metres within, each once: what is asked for here.
  enum class Look { kForDoorsPassed, kAround };
  bool isTimeToLook(Look look, double step);
  /// Is this reading's place a sub-map of its own (002 §II-A)?
  bool isLeftBy(const map::PlacedReading& placed, const SubMapConfig& config);
  /// False where no layer takes anything from the reading.
  bool integrate(const map::PlacedReading& placed, const geometry::Pose3& T_travel_body, base::StageTimes& times);

  /// What is committed of it once it is finished, its node and edge apart. The change refers to its layers.
  void addTo(map::MapChange& change) const;
  /// As it is now, for a view.
  std::shared_ptr<map::SubMap> clone() const;

  /// Saved as it began: before its first reading.
  void save(base::ByteWriter& out) const;
  static RunningSubMap load(base::ByteReader& in, const map::LayersConfig& config);

 private:
  map::SubMap submap_;
  std::optional<map::Edge> edge_;
  std::vector<map::TrajectoryPoint> trajectory_;
  double turned_ = 0.0;  // radians, all turns counting
  map::Matrix6 covariance_ = map::Matrix6::Zero();
  // The grid after the first half metre or so. The whole grid would not do: what a reading shows has nearly always been
  // seen a moment before.
  std::optional<map::OccupancyGrid> seenAtBegin_;
  double wayAtLastLook_ = 0.0;
  std::array<double, 2> wayAtLooks_{};  // by Look
  double turnAtLastLook_ = 0.0;
};

}  // namespace prodomos::mapper
