// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/running_submap.hpp"

#include "mapper/pose_bytes.hpp"

namespace prodomos::mapper {

namespace {

// A robot that is parked leaves no sub-map; memory, and what a kill can cost, are bounded all the same.
constexpr int kMostReadings = 50'000;

}  // namespace

RunningSubMap::RunningSubMap(const map::Node& node, const std::optional<map::Edge>& edge,
                             const map::LayersConfig& config)
    : submap_(map::makeSubMap(node, config)), edge_(edge) {}

void RunningSubMap::move(const geometry::Pose3& T_before_after) {
  submap_.node.distance += T_before_after.translation().norm();
  turned_ += geometry::rotationAngle(T_before_after);
}

bool RunningSubMap::isLeftBy(const map::PlacedReading& placed, const SubMapConfig& config) {
  const double way = submap_.node.distance;
  if (way >= config.maxDistance || submap_.node.readings >= kMostReadings) return true;
  if (way < config.overlapStep) return false;  // a camera that turns on the spot looks around
  const bool isDue = way - wayAtLastLook_ >= config.overlapStep || turned_ - turnAtLastLook_ >= config.overlapStep;
  if (!isDue) return false;
  wayAtLastLook_ = way;
  turnAtLastLook_ = turned_;
  if (seenAtBegin_) return seenAtBegin_->overlap(placed) < config.leastOverlap;
  const auto* grid = dynamic_cast<const map::OccupancyGrid*>(submap_.findLayer(map::OccupancyGrid::kTypeId));
  if (grid != nullptr) seenAtBegin_.emplace(*grid);
  return false;
}

bool RunningSubMap::integrate(const map::PlacedReading& placed, const geometry::Pose3& T_travel_body,
                              base::StageTimes& times) {
  bool taken = false;
  for (auto& layer : submap_.layers) {
    const auto timing = times.measure(layer->typeId().data());
    taken |= layer->integrate(placed);
  }
  if (!taken) return false;
  auto& node = submap_.node;
  ++node.readings;
  node.end = placed.reading.time;
  trajectory_.push_back({node.session, node.end, node.id, T_travel_body, {}});
  return true;
}

void RunningSubMap::addTo(map::MapChange& change) const {
  const auto& node = submap_.node;
  change.nodes.push_back(node);
  if (edge_) change.edges.push_back(*edge_);
  change.trajectory.insert(change.trajectory.end(), trajectory_.begin(), trajectory_.end());
  for (const auto& layer : submap_.layers) change.layers.emplace_back(node.id, layer.get());
  const auto addEvent = [&](const char* kind, base::Time time, const std::string& payload) {
    change.events.push_back({time, node.session, kind, toString(node.id), payload});
  };
  addEvent("submap_begun", node.begin, "{}");
  addEvent("submap_finished", node.end, "{\"readings\": " + std::to_string(node.readings) + "}");
}

std::shared_ptr<const map::SubMap> RunningSubMap::clone() const {
  auto copy = std::make_shared<map::SubMap>();
  copy->node = submap_.node;
  copy->entities = submap_.entities;
  for (const auto& layer : submap_.layers) copy->layers.push_back(layer->clone());
  return copy;
}

void RunningSubMap::save(base::ByteWriter& out) const {
  const auto& node = submap_.node;
  out << node.id.value << node.floor.value_or(0);
  savePose(out, node.T_map_submap);
  savePose(out, node.T_travel_submap);
  saveTime(out, node.begin);
  out << edge_.has_value();
  if (!edge_) return;
  out << edge_->id.value << edge_->from.value << edge_->kind;
  savePose(out, edge_->T_from_to);
  for (int i = 0; i < 36; ++i) out << edge_->information.data()[i];
}

RunningSubMap RunningSubMap::load(base::ByteReader& in, base::SessionId session, const map::LayersConfig& config) {
  map::Node node;
  node.session = session;
  in >> node.id.value;
  node.floor = in.read<int>();
  node.T_map_submap = loadPose(in);
  node.T_travel_submap = loadPose(in);
  node.begin = node.end = loadTime(in);
  if (!in.read<bool>()) return {node, std::nullopt, config};
  map::Edge edge;
  edge.to = node.id;
  in >> edge.id.value >> edge.from.value >> edge.kind;
  edge.T_from_to = loadPose(in);
  for (int i = 0; i < 36; ++i) in >> edge.information.data()[i];
  return {node, edge, config};
}

}  // namespace prodomos::mapper
