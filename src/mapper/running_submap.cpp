// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/running_submap.hpp"

#include "mapper/graph_bytes.hpp"

namespace prodomos::mapper {

namespace {

// A robot that is parked leaves no sub-map; memory, and what a kill can cost, are bounded all the same.
constexpr int kMostReadings = 50'000;

}  // namespace

RunningSubMap::RunningSubMap(const map::Node& node, const std::optional<map::Edge>& edge,
                             const map::LayersConfig& config)
    : submap_(map::makeSubMap(node, config)), edge_(edge) {}

void RunningSubMap::move(const geometry::Pose3& T_before_after, const map::Matrix6& covariance) {
  submap_.node.distance += T_before_after.translation().norm();
  turned_ += geometry::rotationAngle(T_before_after);
  const auto adjoint = geometry::adjoint(T_before_after.inverse());
  covariance_ = adjoint * covariance_ * adjoint.transpose() + covariance;
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
  const auto* grid = submap_.findLayer<map::OccupancyGrid>();
  if (grid != nullptr) seenAtBegin_.emplace(*grid);
  return false;
}

std::vector<Eigen::Vector3d> RunningSubMap::wayInSubMap() const {
  std::vector<Eigen::Vector3d> way;
  for (const auto& point : trajectory_) way.push_back(T_submap_body(point.T_travel_body).translation());
  return way;
}

bool RunningSubMap::isTimeToLook(Look look, double step) {
  auto& last = wayAtLooks_[static_cast<std::size_t>(look)];
  if (submap_.node.distance - last < step) return false;
  last = submap_.node.distance;
  return true;
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
  change.trajectory.insert(change.trajectory.end(), trajectory_.begin(), trajectory_.end());
  for (const auto& layer : submap_.layers) change.layers.emplace_back(node.id, layer.get());
  const auto addEvent = [&](const char* kind, base::Time time, const std::string& payload) {
    change.events.push_back({time, node.session, kind, toString(node.id), payload});
  };
  addEvent("submap_begun", node.begin, "{}");
  addEvent("submap_finished", node.end, "{\"readings\": " + std::to_string(node.readings) + "}");
}

std::shared_ptr<map::SubMap> RunningSubMap::clone() const {
  auto copy = std::make_shared<map::SubMap>();
  copy->node = submap_.node;
  for (const auto& layer : submap_.layers) copy->layers.push_back(layer->clone());
  return copy;
}

void RunningSubMap::save(base::ByteWriter& out) const {
  saveNode(out, submap_.node);
  out << edge_.has_value();
  if (edge_) saveEdge(out, *edge_);
}

RunningSubMap RunningSubMap::load(base::ByteReader& in, const map::LayersConfig& config) {
  const auto node = loadNode(in);
  if (!in.read<bool>()) return {node, std::nullopt, config};
  return {node, loadEdge(in), config};
}

}  // namespace prodomos::mapper
