// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/mapper_impl.hpp"

#include <Eigen/LU>

#include <cmath>

namespace prodomos::mapper {

namespace {

/// A camera or robot whose recorded height is beyond this stands in a world whose floor is not z = 0.
constexpr double kMostClearance = 2.5;

constexpr double kLookStep = 2.0;  // metres travelled between two looks around for doorways, and at what lies beyond

// A reading waits for a pose at or after its own stamp; not longer than this, so that a log without odometry flows too.
constexpr std::size_t kMostWaiting = 64;
constexpr base::Duration kLongestWait = std::chrono::seconds(2);

/// Where there is something, and where nothing: what layers are made of. Other readings do not begin sub-maps.
bool tellsDistances(const sensors::ReadingData& data) {
  if (const auto* frame = std::get_if<sensors::RgbdFrame>(&data)) return !frame->depth.empty();
  return std::holds_alternative<sensors::LaserScan>(data) || std::holds_alternative<sensors::PointCloud>(data);
}

std::string nobodyTakes(const sensors::Reading& reading) {
  return "no layer takes a " + std::string(kindName(reading.data));
}

}  // namespace

void Mapper::Impl::process(sensors::Reading reading) {
  requireOpen();
  const std::int64_t item = report.read++;
  if (!reading.fault.empty()) report.addFault(reading.fault);
  if (!Localizer::isPose(reading)) {
    localizer_.expect(reading);
    waiting_.push_back({item, std::move(reading)});
  } else if (const auto uselessness = localizer_.take(reading); uselessness.empty()) {
    use(reading);
  } else {
    skip(uselessness);
  }
  placeWaiting(false);
}

void Mapper::Impl::skip(const sensors::Skipped& skipped) {
  requireOpen();
  ++report.read;
  skip(skipped.reason);
  if (!skipped.fault.empty()) report.addFault(skipped.fault);
}

void Mapper::Impl::use(const sensors::Reading& reading) {
  ++report.used;
  ++report.usedByKind[std::string(kindName(reading.data))];
}

/// Places the readings whose poses are known, in their order; with `all`, also those that no later pose will come for.
void Mapper::Impl::placeWaiting(bool all) {
  while (!waiting_.empty()) {
    const auto& first = waiting_.front().reading;
    const bool waitedLong = waiting_.size() > kMostWaiting || waiting_.back().reading.time - first.time > kLongestWait;
    if (!all && !waitedLong && localizer_.awaits(first.time)) return;
    place(first);
    localizer_.forgetBefore(first.time);
    waiting_.pop_front();
  }
}

/// One reading's way up: where was the robot, in which sub-map is that, and what do its layers take?
void Mapper::Impl::place(const sensors::Reading& reading) {
  if (!tellsDistances(reading.data)) return takeSideFile(reading);
  const auto located = [&] {
    const auto timing = times.measure("localize");
    return localizer_.locate(reading, nullptr);
  }();
  report.lost = localizer_.lost();
  if (!located) return skip("no recorded pose near");
  travelTo(*located, reading);
  integrate(reading);
}

/// What another program saw in an image that has just been integrated.
void Mapper::Impl::takeSideFile(const sensors::Reading& reading) {
  if (!running_ || !perception_->takeSideFile(reading, running_->submap())) return skip(nobodyTakes(reading));
  use(reading);
}

/// What the robot sees where it is now.
void Mapper::Impl::integrate(const sensors::Reading& reading) {
  const map::PlacedReading placed{.reading = reading,
                                  .T_submap_body = running_->T_submap_body(T_travel_lastBody_),
                                  .velocity = localizer_.velocity()};
  if (!running_->integrate(placed, T_travel_lastBody_, times)) return skip(nobodyTakes(reading));
  perception_->perceive({placed, running_->submap(), floorBelow()}, submapPoses(), times, report.notLookedAt);
  use(reading);
  session_.end = reading.time;
}

/// Goes on within the running sub-map, or into a new one (002 §II-A).
void Mapper::Impl::travelTo(const Localizer::Located& located, const sensors::Reading& reading) {
  const auto& T_travel_body = located.T_travel_body;
  if (!running_) return beginTravel(T_travel_body, reading.time);
  const geometry::Pose3 T_last_body = T_travel_lastBody_.inverse() * T_travel_body;
  T_travel_lastBody_ = T_travel_body;
  report.distance = session_.distance += T_last_body.translation().norm();
  running_->move(T_last_body, located.covariance);
  if (running_->isTimeToLook(RunningSubMap::Look::kAround, kLookStep)) glance();

  if (located.T_upright_travel) {
    standUpright(*located.T_upright_travel);
    passOn(map::EdgeKind::kTravelled, T_travel_body, reading.time);
  } else if (const auto way = floors_.update(heightAt(T_travel_body), session_.distance)) {
    passOn(*way, T_travel_body, reading.time);
  } else if (hasPassedDoor()) {
    passOn(map::EdgeKind::kDoor, T_travel_body, reading.time);
  } else if (running_->isLeftBy({.reading = reading, .T_submap_body = running_->T_submap_body(T_travel_body)},
                                config_.submap)) {
    passOn(map::EdgeKind::kTravelled, T_travel_body, reading.time);
  }
}

/// The map frame: below the robot where it was first placed, x its heading, z up. A further session begins beside the
/// map, until it is found in it.
void Mapper::Impl::beginTravel(const geometry::Pose3& T_travel_body, base::Time time) {
  // Poses in a world are those of the camera or robot itself, over a floor that is z = 0.
  const double height = T_travel_body.translation().z();
  const bool isOverFloor = localizer_.knowsHeight() && height >= 0.0 && height <= kMostClearance;
  clearance_ = isOverFloor ? height : 0.0;
  const geometry::Pose3 T_travel_first = geometry::toPose3(geometry::toPose2(T_travel_body), height - clearance_);
  session_.T_map_travel =
      (localizer_.isEstimated() ? refiner_.T_map_beside() : geometry::Pose3::Identity()) * T_travel_first.inverse();
  session_.begin = time;
  T_travel_lastBody_ = T_travel_body;
  running_.emplace(nodeBelow(T_travel_body, time), std::nullopt, config_.layers);
  refiner_.add(running_->node(), std::nullopt);
  ++report.submaps;
}

/// What was mapped so far moves as a whole; within, its sub-maps stay as they are.
void Mapper::Impl::standUpright(const geometry::Pose3& T_upright_travel) {
  refiner_.move(session_.id, T_upright_travel * session_.T_map_travel.inverse());
  session_.T_map_travel = T_upright_travel;
  running_->refine(refiner_.T_map_submap(running_->node().id));
}

/// Finishes the running sub-map, and begins the next one below the robot.
void Mapper::Impl::passOn(map::EdgeKind kind, const geometry::Pose3& T_travel_body, base::Time time) {
  refine();
  perception_->finish(running_->submap());
  lookAround(running_->node().id);
  const auto node = nodeBelow(T_travel_body, time);
  auto edge = edgeBetween(*running_, node, kind);
  auto way = wayInMap(running_->node().id, running_->wayInSubMap());
  way.push_back(node.T_map_submap.translation());
  const auto known = passages();
  nameWay(edge, way, known);
  nameLoops(known);
  map::MapChange change;
  perception_->addTo(change);
  predict(running_->node().id, change.tracks);
  const auto finished = std::exchange(running_, RunningSubMap(node, edge, config_.layers));
  perception_->enter(node.T_travel_submap.inverse() * finished->node().T_travel_submap);
  refiner_.add(node, edge);
  ++report.submaps;
  change.floors = floors_.floors();
  finished->addTo(change);
  predictor_->addTo(change);
  refiner_.addTo(change, node.id, false);
  change.checkpoint = checkpoint();
  commit(std::move(change));
}

double Mapper::Impl::floorHeightAt(const geometry::Pose3& T_travel_body) const {
  const double height = heightAt(T_travel_body);
  const double floorHeight = floors_.current().height;
  return std::abs(height - floorHeight) < FloorTracker::kLevelTolerance ? floorHeight : height;
}

double Mapper::Impl::floorBelow() const {
  const geometry::Pose3 T_map_submap = session_.T_map_travel * running_->node().T_travel_submap;
  return floorHeightAt(T_travel_lastBody_) - T_map_submap.translation().z();
}

map::Node Mapper::Impl::nodeBelow(const geometry::Pose3& T_travel_body, base::Time time) {
  map::Node node;
  node.id = refiner_.newNodeId();
  node.session = session_.id;
  node.floor = floors_.current().number;
  const geometry::Pose3 T_map_unrefined =
      geometry::toPose3(geometry::toPose2(session_.T_map_travel * T_travel_body), floorHeightAt(T_travel_body));
  node.T_travel_submap = session_.T_map_travel.inverse() * T_map_unrefined;
  node.T_map_submap = T_map_unrefined;
  if (running_) {
    const auto& last = running_->node();
    node.T_map_submap = last.T_map_submap * last.T_travel_submap.inverse() * node.T_travel_submap;
  }
  node.begin = node.end = time;
  return node;
}

/// As surely as the way within the sub-map is known.
map::Edge Mapper::Impl::edgeBetween(const RunningSubMap& from, const map::Node& to, map::EdgeKind kind) {
  constexpr double kLeastSigma = 1e-3;  // metres, radians; nothing is known better
  map::Edge edge;
  edge.id = refiner_.newEdgeId();
  edge.from = from.node().id;
  edge.to = to.id;
  edge.kind = kind;
  edge.T_from_to = from.node().T_travel_submap.inverse() * to.T_travel_submap;
  edge.information = (from.covariance() + kLeastSigma * kLeastSigma * map::Matrix6::Identity()).inverse();
  return edge;
}

Mapper::Mapper(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log,
               perception::DebugImages* debug)
    : impl_(std::make_unique<Impl>(store, config, log, debug)) {}
Mapper::~Mapper() = default;
void Mapper::process(sensors::Reading reading) {
  impl_->process(std::move(reading));
}
void Mapper::skip(const sensors::Skipped& skipped) {
  impl_->skip(skipped);
}
void Mapper::finish(const sensors::EndOfLog& end) {
  impl_->finish(end);
}
void Mapper::tell(base::PredictionId id, map::Finding finding) {
  impl_->tell(id, finding);
}
ResumePoint Mapper::resumePoint() const {
  return impl_->resumePoint();
}
void Mapper::restore(std::vector<std::pair<std::int64_t, sensors::Reading>> waiting) {
  impl_->restore(std::move(waiting));
}
map::MapView Mapper::view() const {
  return impl_->view();
}
const Report& Mapper::report() const {
  return impl_->report;
}
bool Mapper::meetsEarlierSessions() const {
  return impl_->meetsEarlierSessions();
}
base::StageTimes& Mapper::times() {
  return impl_->times;
}

}  // namespace prodomos::mapper
