// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/mapper/mapper.hpp"
#include "prodomos/perception/perception.hpp"
#include "prodomos/prediction/predictor.hpp"

#include "mapper/crossings.hpp"
#include "mapper/floor_tracker.hpp"
#include "mapper/graph_refiner.hpp"
#include "mapper/localizer.hpp"
#include "mapper/running_submap.hpp"
#include "mapper/surroundings.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace prodomos::mapper {

/// The line of the data: mapper.cpp carries a reading along it, mapper_looks.cpp looks at what the robot has come to
/// know, mapper_session.cpp begins, keeps and ends the session.
class Mapper::Impl {
 public:
  Impl(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log,
       perception::DebugImages* debug);

  void process(sensors::Reading reading);
  void skip(const sensors::Skipped& skipped);
  void finish(const sensors::EndOfLog& end);
  void tell(base::PredictionId id, map::Finding finding);
  ResumePoint resumePoint() const { return {report.read, waitingWhenInterrupted_}; }
  void restore(std::vector<std::pair<std::int64_t, sensors::Reading>>&& waiting);
  map::MapView view() const;
  bool meetsEarlierSessions() const { return refiner_.meetsAnother(session_.id); }

  Report report;
  base::StageTimes times;

 private:
  struct Waiting {
    std::int64_t item;
    sensors::Reading reading;
  };

  void beginSession(const sensors::SourceInfo& log, base::SessionId id, const map::MapView& before);
  void beginPerception(const map::MapView& before);
  void resume(const map::MapView& before);
  void requireOpen();

  void placeWaiting(bool all);
  void place(const sensors::Reading& reading);
  void takeSideFile(const sensors::Reading& reading);
  void integrate(const sensors::Reading& reading);
  void travelTo(const Localizer::Located& located, const sensors::Reading& reading);
  void beginTravel(const geometry::Pose3& T_travel_body, base::Time time);
  void standUpright(const geometry::Pose3& T_upright_travel);
  void passOn(map::EdgeKind kind, const geometry::Pose3& T_travel_body, base::Time time);
  map::Node nodeBelow(const geometry::Pose3& T_travel_body, base::Time time);
  map::Edge edgeBetween(const RunningSubMap& from, const map::Node& to, map::EdgeKind kind);
  /// Of the ground below the robot, above the first floor.
  double heightAt(const geometry::Pose3& T_travel_body) const {
    return (session_.T_map_travel * T_travel_body).translation().z() - clearance_;
  }

  /// The floor's where the robot is level with it, else that of the ground.
  double floorHeightAt(const geometry::Pose3& T_travel_body) const;
  /// Height of the floor below the robot, in the running sub-map.
  double floorBelow() const;
  perception::EntityMemory::SubMapPoses submapPoses() const {
    return [this](base::SubMapId id) { return refiner_.T_map_submap(id); };
  }

  void refine();
  std::vector<Passage> passages() const { return passagesOf(perception_->entities(), submapPoses()); }
  /// Of the robot's feet in the sub-map, on from its origin.
  std::vector<Eigen::Vector3d> wayInMap(base::SubMapId submap, std::vector<Eigen::Vector3d> way_in_submap) const;
  /// Does the robot stand beyond a door that it came through since the running sub-map began?
  bool hasPassedDoor();
  /// Doors may be found after they were passed: tells all ways once more what they lead through.
  void nameWays(std::span<const Passage> known);
  void nameLoops(std::span<const Passage> known);
  /// For doorways, in a finished sub-map and what lies about it.
  void lookAround(base::SubMapId submap);
  /// Within the running sub-map: who waits for its end has often passed doorways that he could have told of.
  void glance();
  /// Bets on what lies beyond, as far as the finished sub-map told anything new; everywhere, where none is named.
  void predict(std::optional<base::SubMapId> finished, const std::vector<map::Track>& tracks);
  /// What is known now; refers to what is given.
  prediction::World world(std::span<const map::Entity> entities, std::span<const map::Node> nodes,
                          std::span<const map::Track> tracks);

  void use(const sensors::Reading& reading);
  void skip(const std::string& reason) { ++report.skippedByReason[reason]; }
  void commit(map::MapChange change);
  map::Checkpoint checkpoint() const;
  void load(const map::Checkpoint& checkpoint);

  map::MapStore& store_;
  MapperConfig config_;
  perception::DebugImages* debug_;
  // False once the session is complete, or where a commit failed: then memory has gone on, and the file has not.
  bool isOpen_ = true;

  // All that follows is running state: what a checkpoint holds.
  map::Session session_;
  Localizer localizer_;
  FloorTracker floors_;
  std::deque<Waiting> waiting_;
  std::vector<std::int64_t> waitingWhenInterrupted_;
  GraphRefiner refiner_;
  Surroundings surroundings_;
  std::unique_ptr<perception::Perception> perception_;
  std::optional<prediction::Predictor> predictor_;  // its past stands in the map
  std::optional<RunningSubMap> running_;            // none until the first reading is placed
  double clearance_ = 0.0;                          // height of the body above the floor
  geometry::Pose3 T_travel_lastBody_ = geometry::Pose3::Identity();
};

}  // namespace prodomos::mapper
