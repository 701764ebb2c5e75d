// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/mapper.hpp"

#include "prodomos/perception/perception.hpp"
#include "prodomos/prediction/predictor.hpp"

#include "mapper/crossings.hpp"
#include "mapper/floor_tracker.hpp"
#include "mapper/graph_bytes.hpp"
#include "mapper/graph_refiner.hpp"
#include "mapper/localizer.hpp"
#include "mapper/running_submap.hpp"
#include "mapper/surroundings.hpp"

#include <Eigen/LU>

#include <cmath>
#include <deque>
#include <map>

namespace prodomos::mapper {

namespace {

/// A camera or robot whose recorded height is beyond this stands in a world whose floor is not z = 0.
constexpr double kMostClearance = 2.5;

constexpr double kLookStep = 2.0;    // metres travelled between two looks around for doorways, and at what lies beyond
constexpr double kDoorStep = 0.25;   // metres travelled between two looks whether a door was passed
constexpr double kBeyondDoor = 0.4;  // metres from a door, where the next sub-map may begin
constexpr double kLeastWay = 1.5;    // metres; shorter sub-maps show too little to be found again

// A reading waits for a pose at or after its own stamp; not longer than this, so that a log without odometry flows too.
constexpr std::size_t kMostWaiting = 64;
constexpr base::Duration kLongestWait = std::chrono::seconds(2);

/// Of what a checkpoint holds. Raise it with every change there.
constexpr int kCheckpointVersion = 5;

/// Where there is something, and where nothing: what layers are made of. Other readings do not begin sub-maps.
bool tellsDistances(const sensors::ReadingData& data) {
  if (const auto* frame = std::get_if<sensors::RgbdFrame>(&data)) return !frame->depth.empty();
  return std::holds_alternative<sensors::LaserScan>(data) || std::holds_alternative<sensors::PointCloud>(data);
}

std::string nobodyTakes(const sensors::Reading& reading) {
  return "no layer takes a " + std::string(kindName(reading.data));
}

/// Poses that are told, by wheels or else, are followed to the letter.
localization::LoopCloserConfig loopsOf(const MapperConfig& config, const Localizer& localizer) {
  auto loops = config.loops;
  loops.enabled = loops.enabled && localizer.isEstimated();
  return loops;
}

}  // namespace

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
  std::vector<Eigen::Vector3d> way_in_map(base::SubMapId submap, std::vector<Eigen::Vector3d> way_in_submap) const;
  /// Does the robot stand beyond a door that it came through since the running sub-map began?
  bool hasPassedDoor();
  /// Doors may be found after they were passed: tells all ways once more what they lead through.
  void nameWays();
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

Mapper::Impl::Impl(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log,
                   perception::DebugImages* debug)
    : store_(store),
      config_(config),
      debug_(debug),
      localizer_(config, log),
      floors_(config.floor.leastHeight),
      refiner_(loopsOf(config, localizer_), store),
      surroundings_(store, refiner_) {
  const auto before = store.view();
  predictor_.emplace(config.prediction, before);
  const auto& sessions = before.sessions();
  if (sessions.empty()) {
    beginSession(log, base::SessionId{0}, before);
  } else if (sessions.back().state == map::SessionState::kRunning) {
    resume(before);
  } else {
    beginSession(log, base::SessionId{sessions.back().id.value + 1}, before);
  }
}

void Mapper::Impl::beginSession(const sensors::SourceInfo& log, base::SessionId id, const map::MapView& before) {
  session_.id = id;
  session_.log = log.path;
  session_.logKind = log.kind;
  session_.config = base::writeConfig(config_, false);
  session_.poses = localizer_.name();
  session_.version = PRODOMOS_VERSION;
  session_.classes = log.classes;
  beginPerception(before);
  map::MapChange change;
  change.floors = floors_.floors();
  commit(std::move(change));
}

void Mapper::Impl::resume(const map::MapView& before) {
  const auto& session = before.sessions().back();
  if (base::writeConfig(config_, false) != session.config) {
    throw base::UsageError("session " + toString(session.id) +
                           " of the map is not finished, and can only be gone on with under its own configuration");
  }
  session_ = session;
  beginPerception(before);
  if (const auto checkpoint = store_.findCheckpoint(session_.id)) load(*checkpoint);
}

void Mapper::Impl::beginPerception(const map::MapView& before) {
  perception::Perception::Ids first;
  for (const auto& entity : before.entities()) first.entity.value = std::max(first.entity.value, entity.id.value + 1);
  // Nor those of things that were given up.
  for (const auto& event : before.events()) {
    const auto id = base::parseId<base::EntityId>(event.subject);
    if (id) first.entity.value = std::max(first.entity.value, id->value + 1);
  }
  for (const auto& track : before.tracks()) first.track.value = std::max(first.track.value, track.id.value + 1);
  perception_ =
      std::make_unique<perception::Perception>(config_.perception, session_.id, session_.classes, first, debug_);
}

/// Before anything is taken.
void Mapper::Impl::requireOpen() {
  if (!isOpen_) throw base::Error("the session has ended: it was finished, or the map file could not be written");
  for (std::size_t i = 0; i < waitingWhenInterrupted_.size(); ++i) skip("lost when the session was interrupted");
  waitingWhenInterrupted_.clear();
}

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
  auto way = way_in_map(running_->node().id, running_->way_in_submap());
  way.push_back(node.T_map_submap.translation());
  nameWay(edge, way, passages());
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

/// The running sub-map is complete: where it shows what was seen before, all poses become better.
void Mapper::Impl::refine() {
  const auto timing = times.measure("refine");
  refiner_.close(running_->submap());
  running_->refine(refiner_.T_map_submap(running_->node().id));
}

std::vector<Eigen::Vector3d> Mapper::Impl::way_in_map(base::SubMapId submap,
                                                      std::vector<Eigen::Vector3d> way_in_submap) const {
  for (auto& body : way_in_submap) body.z() -= clearance_;
  way_in_submap.insert(way_in_submap.begin(), Eigen::Vector3d::Zero());
  for (auto& foot : way_in_submap) foot = refiner_.T_map_submap(submap) * foot;
  return way_in_submap;
}

bool Mapper::Impl::hasPassedDoor() {
  if (running_->node().distance < kLeastWay || !running_->isTimeToLook(RunningSubMap::Look::kForDoorsPassed, kDoorStep))
    return false;
  const auto way = way_in_map(running_->node().id, running_->way_in_submap());
  const auto crossed = doorCrossed(way, passages());
  return crossed && crossed->beyond >= kBeyondDoor;
}

void Mapper::Impl::nameWays() {
  std::map<base::SubMapId, std::vector<Eigen::Vector3d>> ways_in_submap;
  for (const auto& point : store_.view().trajectory()) {
    if (point.session != session_.id) continue;
    const geometry::Pose3 T_submap_travel = refiner_.node(point.submap).T_travel_submap.inverse();
    ways_in_submap[point.submap].push_back((T_submap_travel * point.T_travel_body).translation());
  }
  const auto known = passages();
  for (auto& edge : refiner_.waysOf(session_.id)) {
    auto way = way_in_map(edge.from, ways_in_submap[edge.from]);
    way.push_back(refiner_.T_map_submap(edge.to).translation());
    nameWay(edge, way, known);
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

void Mapper::Impl::commit(map::MapChange change) {
  const auto timing = times.measure("store");
  change.sessions.push_back(session_);
  isOpen_ = false;
  store_.commit(change);
  isOpen_ = session_.state == map::SessionState::kRunning;
}

void Mapper::Impl::tell(base::PredictionId id, map::Finding finding) {
  requireOpen();
  predictor_->tell(id, finding, session_.id, session_.end);
  map::MapChange change;
  predictor_->addTo(change);
  commit(std::move(change));
}

void Mapper::Impl::finish(const sensors::EndOfLog& end) {
  requireOpen();
  placeWaiting(true);
  if (!end.fault.empty()) report.addFault(end.fault);

  map::MapChange change;
  if (running_) {
    refine();
    refiner_.settle();
    running_->refine(refiner_.T_map_submap(running_->node().id));
    perception_->finish(running_->submap());
    // Once more everywhere: by now the neighbours are known on all sides, and all poses are the best.
    for (const auto submap : refiner_.nodesOf(session_.id)) lookAround(submap);
    nameWays();
    perception_->addTo(change);
    predict(std::nullopt, change.tracks);
  }
  const auto last = std::exchange(running_, std::nullopt);
  if (last) last->addTo(change);
  predictor_->addTo(change);
  refiner_.addTo(change, base::SubMapId{-1}, true);
  session_.state = map::SessionState::kComplete;
  change.events.push_back({session_.end, session_.id, "session_finished", toString(session_.id), "{}"});
  commit(std::move(change));
}

map::Checkpoint Mapper::Impl::checkpoint() const {
  base::ByteWriter out;
  out << kCheckpointVersion;
  report.save(out);
  localizer_.save(out);
  floors_.save(out);
  out << static_cast<std::uint64_t>(waiting_.size());
  for (const auto& waiting : waiting_) out << waiting.item;
  savePose(out, session_.T_map_travel);
  savePose(out, T_travel_lastBody_);
  saveTime(out, session_.begin);
  saveTime(out, session_.end);
  out << session_.distance << clearance_;
  refiner_.save(out);
  perception_->save(out);
  running_->save(out);
  return {session_.id, out.take()};
}

void Mapper::Impl::load(const map::Checkpoint& checkpoint) {
  base::ByteReader in(checkpoint.state);
  if (const int version = in.read<int>(); version != kCheckpointVersion) {
    throw base::FileError(base::expectedFound("the checkpoint of session " + toString(session_.id),
                                              "version " + std::to_string(kCheckpointVersion),
                                              "version " + std::to_string(version) + " of another prodomos"));
  }
  report.load(in);
  localizer_.load(in);
  floors_.load(in);
  waitingWhenInterrupted_.resize(in.read<std::uint64_t>());
  for (auto& item : waitingWhenInterrupted_) in >> item;
  session_.T_map_travel = loadPose(in);
  T_travel_lastBody_ = loadPose(in);
  session_.begin = loadTime(in);
  session_.end = loadTime(in);
  in >> session_.distance >> clearance_;
  refiner_.load(in);
  perception_->load(in);
  running_.emplace(RunningSubMap::load(in, config_.layers));
}

void Mapper::Impl::restore(std::vector<std::pair<std::int64_t, sensors::Reading>>&& waiting) {
  const auto interrupted = std::exchange(waitingWhenInterrupted_, {});
  requireOpen();
  for (auto& [item, reading] : waiting) waiting_.push_back({item, std::move(reading)});
  // The first was on its way up when the checkpoint was made: it has been located, and began the running sub-map.
  if (!interrupted.empty() && !waiting_.empty() && waiting_.front().item == interrupted.front()) {
    integrate(waiting_.front().reading);
    localizer_.forgetBefore(waiting_.front().reading.time);
    waiting_.pop_front();
  }
  placeWaiting(false);
}

map::MapView Mapper::Impl::view() const {
  if (!running_) return store_.view();
  auto running = running_->clone();
  running->entities = perception_->entities();
  return store_.view(std::move(running), running_->edge());
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
