// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/mapper.hpp"

#include "prodomos/io/trajectory_file.hpp"
#include "prodomos/map/occupancy_grid.hpp"

#include "mapper/floor_tracker.hpp"
#include "mapper/pose_bytes.hpp"
#include "mapper/pose_track.hpp"

#include <cmath>
#include <deque>

namespace prodomos::mapper {

namespace {

enum class PoseOrigin { kOdometry, kRecorded, kFile };

PoseOrigin poseOrigin(const InputConfig& config, const sensors::SourceInfo& log) {
  if (config.poses == "odometry") return PoseOrigin::kOdometry;
  if (config.poses == "recorded") return PoseOrigin::kRecorded;
  if (config.poses == "auto") return log.hasRecordedPoses ? PoseOrigin::kRecorded : PoseOrigin::kOdometry;
  return PoseOrigin::kFile;
}

/// A camera or robot whose recorded height is beyond this stands in a world whose floor is not z = 0.
constexpr double kMostClearance = 2.5;

// A reading waits for a pose at or after its own stamp; not longer than this, so that a log without odometry flows too.
constexpr std::size_t kMostWaiting = 64;
constexpr base::Duration kLongestWait = std::chrono::seconds(2);

}  // namespace

class Mapper::Impl {
 public:
  Impl(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log);

  void process(sensors::Reading reading);
  void skip(const sensors::Skipped& skipped);
  void finish(const sensors::EndOfLog& end);
  ResumePoint resumePoint() const;
  void restore(std::vector<std::pair<std::int64_t, sensors::Reading>> waiting);
  map::MapView view() const;

  Report report;
  base::StageTimes times;

 private:
  struct Waiting {
    std::int64_t item;
    sensors::Reading reading;
  };

  bool takePose(const sensors::Reading& reading);
  void placeWaiting(bool all);
  void place(const sensors::Reading& reading);
  std::optional<geometry::Pose3> poseAt(base::Time time) const;
  void travelTo(const geometry::Pose3& T_travel_body, const sensors::Reading& reading);
  void beginTravel(const geometry::Pose3& T_travel_body);
  double heightAt(const geometry::Pose3& T_travel_body) const;
  bool needsNewSubMap(const map::PlacedReading& placed);
  void beginSubMap(const geometry::Pose3& T_travel_body, base::Time time, const map::SubMap* before = nullptr);
  map::Edge travelledEdge(const map::Node& from, const map::Node& to);
  map::MapChange finishedChange(const map::SubMap& submap);
  void commit(map::MapChange& change);
  geometry::Pose3 inSubMap(const geometry::Pose3& T_travel_body) const {
    return running_->node.T_travel_submap.inverse() * T_travel_body;
  }
  void use(const sensors::Reading& reading);
  void skip(const std::string& reason) { ++report.skippedByReason[reason]; }
  map::Checkpoint checkpoint() const;
  void resume(const map::Checkpoint& checkpoint);

  map::MapStore& store_;
  MapperConfig config_;
  PoseOrigin poseOrigin_;

  // All that follows is running state: what a checkpoint holds.
  map::Session session_;
  PoseTrack track_;
  FloorTracker floors_;
  std::deque<Waiting> waiting_;
  std::vector<std::int64_t> waitingWhenInterrupted_;
  std::shared_ptr<map::SubMap> running_;          // null until the first reading is placed
  std::vector<map::TrajectoryPoint> trajectory_;  // of the running sub-map
  std::optional<map::Edge> edgeToRunning_;
  std::int64_t nextSubMap_ = 0;
  std::int64_t nextEdge_ = 0;
  double clearance_ = 0.0;  // height of the body above the floor
  geometry::Pose3 T_travel_lastBody_ = geometry::Pose3::Identity();
  double turned_ = 0.0;  // radians within the running sub-map
  double wayAtLastLook_ = 0.0;
  double turnAtLastLook_ = 0.0;
};

Mapper::Impl::Impl(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log)
    : store_(store), config_(config), poseOrigin_(poseOrigin(config.input, log)), floors_(config.floor.leastHeight) {
  if (poseOrigin_ == PoseOrigin::kFile) {
    for (const auto& pose : io::readTrajectory(config.input.poses)) track_.add(pose.time, pose.T_world_body);
  }
  const auto view = store.view();
  if (!view.sessions().empty() && view.sessions().back().state == map::SessionState::kRunning) {
    session_ = view.sessions().back();
    if (const auto checkpoint = store.findCheckpoint(session_.id)) resume(*checkpoint);
    return;
  }
  session_.id = base::SessionId{view.sessions().empty() ? 0 : view.sessions().back().id.value + 1};
  session_.log = log.path;
  session_.logKind = log.kind;
  session_.config = base::writeConfig(config, false);
  session_.poses = poseOrigin_ == PoseOrigin::kOdometry   ? "odometry"
                   : poseOrigin_ == PoseOrigin::kRecorded ? "recorded"
                                                          : config.input.poses;
  session_.version = PRODOMOS_VERSION;
  session_.classes = log.classes;
  map::MapChange begun;
  begun.sessions.push_back(session_);
  begun.floors = floors_.floors();
  store_.commit(begun);
}

void Mapper::Impl::process(sensors::Reading reading) {
  const std::int64_t item = report.read++;
  if (!reading.fault.empty()) report.addFault(reading.fault);
  if (std::holds_alternative<sensors::Odometry>(reading.data) ||
      std::holds_alternative<sensors::RecordedPose>(reading.data)) {
    if (takePose(reading)) {
      use(reading);
    } else {
      skip(std::string(kindName(reading.data)) + " not asked for");
    }
  } else {
    waiting_.push_back({item, std::move(reading)});
  }
  placeWaiting(false);
}

void Mapper::Impl::skip(const sensors::Skipped& skipped) {
  ++report.read;
  skip(skipped.reason);
  if (!skipped.fault.empty()) report.addFault(skipped.fault);
}

/// True where the reading says where the robot is, and this run follows such readings.
bool Mapper::Impl::takePose(const sensors::Reading& reading) {
  if (const auto* odometry = std::get_if<sensors::Odometry>(&reading.data);
      odometry && poseOrigin_ == PoseOrigin::kOdometry) {
    track_.add(reading.time, odometry->T_odom_body);
    return true;
  }
  if (const auto* recorded = std::get_if<sensors::RecordedPose>(&reading.data);
      recorded && poseOrigin_ == PoseOrigin::kRecorded) {
    track_.add(reading.time, recorded->T_world_body);
    return true;
  }
  return false;
}

/// Places the readings whose poses are known, in their order; with `all`, also those that no later pose will come for.
void Mapper::Impl::placeWaiting(bool all) {
  while (!waiting_.empty()) {
    const auto& first = waiting_.front().reading;
    const bool waitedLong = waiting_.size() > kMostWaiting || waiting_.back().reading.time - first.time > kLongestWait;
    if (!all && !waitedLong && !track_.reaches(first.time)) return;
    place(first);
    if (poseOrigin_ != PoseOrigin::kFile) track_.forgetBefore(first.time);
    waiting_.pop_front();
  }
}

/// One reading's way up: where was the robot, is this still the same sub-map, what do the layers take from it.
void Mapper::Impl::place(const sensors::Reading& reading) {
  const auto T_travel_body = poseAt(reading.time);
  if (!T_travel_body) return skip("no recorded pose near");
  if (!geometry::isFinite(*T_travel_body)) return skip("pose is not finite");

  travelTo(*T_travel_body, reading);
  bool taken = false;
  const map::PlacedReading placed{reading, inSubMap(*T_travel_body)};
  for (auto& layer : running_->layers) {
    const auto timing = times.measure(layer->typeId().data());
    taken |= layer->integrate(placed);
  }
  if (!taken) return skip("no layer takes a " + std::string(kindName(reading.data)));

  use(reading);
  ++running_->node.readings;
  running_->node.end = session_.end = reading.time;
  trajectory_.push_back({session_.id, reading.time, running_->node.id, *T_travel_body, {}});
}

std::optional<geometry::Pose3> Mapper::Impl::poseAt(base::Time time) const {
  if (poseOrigin_ != PoseOrigin::kOdometry) {
    const auto gap = track_.distanceTo(time);
    if (!gap || base::seconds(*gap) > config_.input.poseGap) return std::nullopt;
  }
  return track_.at(time);
}

/// Goes on within the running sub-map, or into a new one.
void Mapper::Impl::travelTo(const geometry::Pose3& T_travel_body, const sensors::Reading& reading) {
  if (!running_) {
    beginTravel(T_travel_body);
    session_.begin = reading.time;
    T_travel_lastBody_ = T_travel_body;
    return beginSubMap(T_travel_body, reading.time);
  }
  const geometry::Pose3 step = T_travel_lastBody_.inverse() * T_travel_body;
  T_travel_lastBody_ = T_travel_body;
  report.distance = session_.distance += step.translation().norm();
  running_->node.distance += step.translation().norm();
  turned_ += geometry::rotationAngle(step);

  const bool changedFloor = floors_.update(heightAt(T_travel_body), session_.distance);
  if (!changedFloor && !needsNewSubMap({reading, inSubMap(T_travel_body)})) return;
  const auto finished = std::move(running_);
  auto change = finishedChange(*finished);
  beginSubMap(T_travel_body, reading.time, finished.get());
  change.checkpoint = checkpoint();
  commit(change);
}

/// The map frame: below the robot where it was first placed, x its heading, z up.
void Mapper::Impl::beginTravel(const geometry::Pose3& T_travel_body) {
  // Recorded poses of a camera carried by hand are those of the camera, over a floor that is z = 0.
  const double height = T_travel_body.translation().z();
  const bool isOverFloor = poseOrigin_ != PoseOrigin::kOdometry && height >= 0.0 && height <= kMostClearance;
  clearance_ = isOverFloor ? height : 0.0;
  session_.T_map_travel = geometry::toPose3(geometry::toPose2(T_travel_body), height - clearance_).inverse();
}

/// Of the ground below the robot, above the first floor.
double Mapper::Impl::heightAt(const geometry::Pose3& T_travel_body) const {
  return (session_.T_map_travel * T_travel_body).translation().z() - clearance_;
}

bool Mapper::Impl::needsNewSubMap(const map::PlacedReading& placed) {
  const double way = running_->node.distance;
  if (way >= config_.submap.maxDistance) return true;
  const double step = config_.submap.overlapStep;
  if (way - wayAtLastLook_ < step && turned_ - turnAtLastLook_ < step) return false;
  wayAtLastLook_ = way;
  turnAtLastLook_ = turned_;
  for (auto& layer : running_->layers) {
    if (auto* grid = dynamic_cast<map::OccupancyGrid*>(layer.get())) {
      return grid->overlap(placed) < config_.submap.leastOverlap;
    }
  }
  return false;
}

void Mapper::Impl::beginSubMap(const geometry::Pose3& T_travel_body, base::Time time, const map::SubMap* before) {
  const double height = heightAt(T_travel_body);
  const auto& floor = floors_.current();
  const bool isLevel = std::abs(height - floor.height) < FloorTracker::kLevelTolerance;
  map::Node node;
  node.id = base::SubMapId{nextSubMap_++};
  node.session = session_.id;
  node.floor = floor.number;
  node.T_map_submap =
      geometry::toPose3(geometry::toPose2(session_.T_map_travel * T_travel_body), isLevel ? floor.height : height);
  node.T_travel_submap = session_.T_map_travel.inverse() * node.T_map_submap;
  node.begin = node.end = time;
  edgeToRunning_ = before == nullptr ? std::nullopt : std::optional(travelledEdge(before->node, node));
  running_ = std::make_shared<map::SubMap>(map::makeSubMap(node, config_.layers));
  turned_ = wayAtLastLook_ = turnAtLastLook_ = 0.0;
  ++report.submaps;
}

map::Edge Mapper::Impl::travelledEdge(const map::Node& from, const map::Node& to) {
  const auto& noise = config_.odometryNoise;
  constexpr double kLeastSigma = 1e-3;  // metres, radians; nothing is known better
  const double translation = kLeastSigma + noise.translationPerMetre * from.distance;
  const double rotation = kLeastSigma + noise.rotationPerMetre * from.distance + noise.rotationPerRadian * turned_;
  map::Edge edge;
  edge.id = base::EdgeId{nextEdge_++};
  edge.from = from.id;
  edge.to = to.id;
  edge.T_from_to = from.T_travel_submap.inverse() * to.T_travel_submap;
  edge.information.diagonal() << Eigen::Vector3d::Constant(1.0 / (translation * translation)),
      Eigen::Vector3d::Constant(1.0 / (rotation * rotation));
  return edge;
}

/// The rows of a sub-map that is finished.
map::MapChange Mapper::Impl::finishedChange(const map::SubMap& submap) {
  const auto& node = submap.node;
  const auto event = [&](const char* kind, base::Time time, const std::string& payload) {
    return map::Event{time, session_.id, kind, toString(node.id), payload};
  };
  map::MapChange change;
  change.floors = floors_.floors();
  change.nodes.push_back(node);
  if (edgeToRunning_) change.edges.push_back(*edgeToRunning_);
  change.trajectory = std::move(trajectory_);
  trajectory_.clear();
  for (const auto& layer : submap.layers) change.layers.emplace_back(node.id, layer.get());
  change.events.push_back(event("submap_begun", node.begin, "{}"));
  change.events.push_back(event("submap_finished", node.end, "{\"readings\": " + std::to_string(node.readings) + "}"));
  return change;
}

void Mapper::Impl::commit(map::MapChange& change) {
  const auto timing = times.measure("store");
  change.sessions.push_back(session_);
  store_.commit(change);
}

void Mapper::Impl::finish(const sensors::EndOfLog& end) {
  placeWaiting(true);
  map::MapChange change;
  const auto last = std::move(running_);
  if (last) change = finishedChange(*last);
  session_.state = map::SessionState::kComplete;
  change.events.push_back({session_.end, session_.id, "session_finished", toString(session_.id), "{}"});
  commit(change);
  if (!end.fault.empty()) report.addFault(end.fault);
}

void Mapper::Impl::use(const sensors::Reading& reading) {
  ++report.used;
  ++report.usedByKind[std::string(kindName(reading.data))];
}

ResumePoint Mapper::Impl::resumePoint() const {
  return {report.read, waitingWhenInterrupted_};
}

map::Checkpoint Mapper::Impl::checkpoint() const {
  base::ByteWriter out;
  report.save(out);
  if (poseOrigin_ != PoseOrigin::kFile) track_.save(out);
  floors_.save(out);
  out << static_cast<std::uint64_t>(waiting_.size());
  for (const auto& waiting : waiting_) out << waiting.item;
  savePose(out, session_.T_map_travel);
  savePose(out, T_travel_lastBody_);
  saveTime(out, session_.begin);
  saveTime(out, session_.end);
  out << session_.distance << clearance_ << nextSubMap_ << nextEdge_;

  const auto& node = running_->node;
  out << node.id.value << node.floor.value_or(0);
  savePose(out, node.T_map_submap);
  savePose(out, node.T_travel_submap);
  saveTime(out, node.begin);
  const auto& edge = *edgeToRunning_;  // a checkpoint is taken when one sub-map follows another
  out << edge.id.value << edge.from.value;
  savePose(out, edge.T_from_to);
  for (int i = 0; i < 6; ++i) out << edge.information(i, i);
  return {session_.id, out.take()};
}

void Mapper::Impl::resume(const map::Checkpoint& checkpoint) {
  base::ByteReader in(checkpoint.state);
  report.load(in);
  if (poseOrigin_ != PoseOrigin::kFile) track_.load(in);
  floors_.load(in);
  waitingWhenInterrupted_.resize(in.read<std::uint64_t>());
  for (auto& item : waitingWhenInterrupted_) in >> item;
  session_.T_map_travel = loadPose(in);
  T_travel_lastBody_ = loadPose(in);
  session_.begin = loadTime(in);
  session_.end = loadTime(in);
  in >> session_.distance >> clearance_ >> nextSubMap_ >> nextEdge_;

  map::Node node;
  node.session = session_.id;
  in >> node.id.value;
  node.floor = in.read<int>();
  node.T_map_submap = loadPose(in);
  node.T_travel_submap = loadPose(in);
  node.begin = node.end = loadTime(in);
  running_ = std::make_shared<map::SubMap>(map::makeSubMap(node, config_.layers));
  edgeToRunning_.emplace();
  edgeToRunning_->to = node.id;
  in >> edgeToRunning_->id.value >> edgeToRunning_->from.value;
  edgeToRunning_->T_from_to = loadPose(in);
  for (int i = 0; i < 6; ++i) in >> edgeToRunning_->information(i, i);
}

void Mapper::Impl::restore(std::vector<std::pair<std::int64_t, sensors::Reading>> waiting) {
  for (auto& [item, reading] : waiting) waiting_.push_back({item, std::move(reading)});
  placeWaiting(false);
}

map::MapView Mapper::Impl::view() const {
  if (!running_) return store_.view();
  auto copy = std::make_shared<map::SubMap>();
  copy->node = running_->node;
  copy->entities = running_->entities;
  for (const auto& layer : running_->layers) copy->layers.push_back(layer->clone());
  return store_.view(std::move(copy), edgeToRunning_);
}

Mapper::Mapper(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log)
    : impl_(std::make_unique<Impl>(store, config, log)) {}
Mapper::~Mapper() = default;
void Mapper::process(sensors::Reading reading) {
  impl_->process(std::move(reading));
}
void Mapper::skip(const sensors::Skipped& skipped) {
  impl_->skip(skipped);
}
void Mapper::finish(const sensors::EndOfLog& end) { impl_->finish(end); }
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
base::StageTimes& Mapper::times() { return impl_->times; }

}  // namespace prodomos::mapper
