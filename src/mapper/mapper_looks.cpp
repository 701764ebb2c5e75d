// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/mapper_impl.hpp"

#include <map>

namespace prodomos::mapper {

namespace {

constexpr double kWayStep = 0.1;     // metres between spots of a way
constexpr double kDoorStep = 0.25;   // metres travelled between two looks whether a door was passed
constexpr double kBeyondDoor = 0.4;  // metres from a door, where the next sub-map may begin
constexpr double kLeastWay = 1.5;    // metres; shorter sub-maps show too little to be found again

}  // namespace

/// The running sub-map is complete: where it shows what was seen before, all poses become better.
void Mapper::Impl::refine() {
  const auto timing = times.measure("refine");
  refiner_.close(running_->submap());
  running_->refine(refiner_.T_map_submap(running_->node().id));
}

std::vector<Eigen::Vector3d> Mapper::Impl::wayInMap(base::SubMapId submap,
                                                    std::vector<Eigen::Vector3d> way_in_submap) const {
  for (auto& body : way_in_submap) body.z() -= clearance_;
  way_in_submap.insert(way_in_submap.begin(), Eigen::Vector3d::Zero());
  for (auto& foot : way_in_submap) foot = refiner_.T_map_submap(submap) * foot;
  return way_in_submap;
}

bool Mapper::Impl::hasPassedDoor() {
  if (running_->node().distance < kLeastWay || !running_->isTimeToLook(RunningSubMap::Look::kForDoorsPassed, kDoorStep))
    return false;
  const auto way = wayInMap(running_->node().id, running_->wayInSubMap());
  const auto crossed = doorCrossed(way, passages());
  return crossed && crossed->beyond >= kBeyondDoor;
}

void Mapper::Impl::nameWays(std::span<const Passage> known) {
  std::map<base::SubMapId, std::vector<Eigen::Vector3d>> ways_in_submap;
  store_.view().visitTrajectory([&](const map::TrajectoryPoint& point) {
    if (point.session != session_.id) return;
    const geometry::Pose3 T_submap_travel = refiner_.node(point.submap).T_travel_submap.inverse();
    const Eigen::Vector3d spot = (T_submap_travel * point.T_travel_body).translation();
    auto& way = ways_in_submap[point.submap];
    if (way.empty() || (spot - way.back()).norm() >= kWayStep) way.push_back(spot);
  });
  for (auto& edge : refiner_.waysOf(session_.id)) {
    if (edge.kind == map::EdgeKind::kLoop) continue;
    auto way = wayInMap(edge.from, ways_in_submap[edge.from]);
    way.push_back(refiner_.T_map_submap(edge.to).translation());
    nameWay(edge, way, known);
    refiner_.rename(edge);
  }
}

void Mapper::Impl::nameLoops(std::span<const Passage> known) {
  for (auto& edge : refiner_.waysOf(session_.id)) {
    if (edge.kind != map::EdgeKind::kLoop) continue;
    // The straight line between its ends is free.
    const std::vector<Eigen::Vector3d> line = {refiner_.T_map_submap(edge.from).translation(),
                                               refiner_.T_map_submap(edge.to).translation()};
    nameWay(edge, line, known);
    refiner_.rename(edge);
  }
}

void Mapper::Impl::lookAround(base::SubMapId submap) {
  if (!config_.perception.enabled || !config_.perception.doorways.enabled) return;
  const auto timing = times.measure("doorways");
  const auto around = surroundings_.of(submap, running_->submap());
  if (around) perception_->lookAround(*around, submapPoses());
}

void Mapper::Impl::glance() {
  lookAround(running_->node().id);
  const auto timing = times.measure("predict");
  const auto entities = perception_->entities();
  const auto nodes = refiner_.nodes();
  predictor_->glance(world(entities, nodes, {}), running_->node().id);
}

prediction::World Mapper::Impl::world(std::span<const map::Entity> entities, std::span<const map::Node> nodes,
                                      std::span<const map::Track> tracks) {
  return {.now = session_.end,
          .session = session_.id,
          .entities = entities,
          .nodes = nodes,
          .gridsNear = [this](const auto& spot) { return surroundings_.gridsNear(spot, running_->submap()); },
          .newNodeId = [this] { return refiner_.newNodeId(); },
          .newEdgeId = [this] { return refiner_.newEdgeId(); },
          .tracks = tracks};
}

void Mapper::Impl::predict(std::optional<base::SubMapId> finished, const std::vector<map::Track>& tracks) {
  const auto timing = times.measure("predict");
  const auto entities = perception_->entities();
  const auto nodes = refiner_.nodes();
  predictor_->update(world(entities, nodes, tracks), finished);
  report.refused = predictor_->refused();
}

}  // namespace prodomos::mapper
