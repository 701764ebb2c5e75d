// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/perception.hpp"

#include "prodomos/map/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prodomos::perception {

namespace {

/// Side files name the time of their image.
constexpr base::Duration kSameImage = std::chrono::milliseconds(20);
/// A frame that comes this much too early for its rate is taken all the same: clocks jitter.
constexpr double kEarly = 0.8;
constexpr double kScanRate = 5.0;  // of scans that leaves are looked for in, at most, 1/s

bool hasDepth(const sensors::RgbdFrame& frame) {
  return std::ranges::any_of(frame.depth.pixels(), [](float depth) { return depth > 0.0F && std::isfinite(depth); });
}

bool sameSize(const sensors::RgbdFrame& frame) {
  return frame.color.width() == frame.depth.width() && frame.color.height() == frame.depth.height();
}

}  // namespace

class Perception::Implementation {
 public:
  Implementation(const PerceptionConfig& config, base::SessionId session, sensors::ClassTable classes, Ids first,
                 DebugImages* debug)
      : config_(config),
        classes_(std::move(classes)),
        debug_(debug),
        next_(first.entity),
        memory_(config.memory, session, [this] { return newId(); }),
        detector_(config.people),
        tracker_(config.people, session, first.track.value, [this] { return newId(); }) {}

  void perceive(const Place& place, const EntityMemory::SubMapPoses& poses, base::StageTimes& times,
                std::map<std::string, std::int64_t>& notLookedAt);
  bool takeSideFile(const sensors::Reading& reading, const map::SubMap& submap);
  void lookAround(const Surroundings& around, const EntityMemory::SubMapPoses& poses);
  void finish(const map::SubMap& submap) { settleLast(submap); }
  void enter(const geometry::Pose3& T_submap_before);
  std::vector<map::Entity> entities() const;
  void addTo(map::MapChange& change);
  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  /// An image whose people a side file may still tell.
  struct Frame {
    base::Time time{};
    std::string sensor;
    sensors::RgbdFrame data;
    geometry::Pose3 T_submap_camera = geometry::Pose3::Identity();
    double floor_z = 0.0;
    bool isTold = false;
  };

  base::EntityId newId() { return std::exchange(next_, base::EntityId{next_.value + 1}); }
  static bool isDue(base::Time time, double rate, std::optional<base::Time>& last);
  bool hasNetworksOrLabels() const { return !config_.people.models.empty() || config_.people.fromLabels; }
  bool seesPeople() const { return hasNetworksOrLabels() || hasSideFile_; }

  void perceiveScan(const Place& place, const sensors::LaserScan& scan, const EntityMemory::SubMapPoses& poses,
                    base::StageTimes& times);
  void perceiveFrame(const Place& place, const sensors::RgbdFrame& frame, const EntityMemory::SubMapPoses& poses,
                     base::StageTimes& times, std::map<std::string, std::int64_t>& notLookedAt);
  void findDoorsAndStairs(const RgbdView& view, base::SubMapId submap, const EntityMemory::SubMapPoses& poses,
                          base::StageTimes& times);
  void findPeople(const RgbdView& view, const Place& place);
  void settleLast(const map::SubMap& submap);
  void waitForSideFile(const RgbdView& view, const Place& place);
  void follow(const map::SubMap& submap, base::Time time, const std::vector<PersonSighting>& sightings);

  PerceptionConfig config_;
  sensors::ClassTable classes_;
  DebugImages* debug_;
  int frames_ = 0;
  std::optional<base::Time> lastLook_;
  std::optional<base::Time> lastScan_;
  base::EntityId next_;
  EntityMemory memory_;
  PersonDetector detector_;
  PersonTracker tracker_;
  bool hasSideFile_ = false;
  std::optional<Frame> last_;  // of the running sub-map; none when it is finished
};

void Perception::Implementation::perceive(const Place& place, const EntityMemory::SubMapPoses& poses,
                                          base::StageTimes& times, std::map<std::string, std::int64_t>& notLookedAt) {
  if (!config_.enabled) return;
  const auto& data = place.placed.reading.data;
  if (const auto* frame = std::get_if<sensors::RgbdFrame>(&data))
    perceiveFrame(place, *frame, poses, times, notLookedAt);
  if (const auto* scan = std::get_if<sensors::LaserScan>(&data)) perceiveScan(place, *scan, poses, times);
}

void Perception::Implementation::perceiveScan(const Place& place, const sensors::LaserScan& scan,
                                              const EntityMemory::SubMapPoses& poses, base::StageTimes& times) {
  const auto time = place.placed.reading.time;
  const auto& T_submap_body = place.placed.T_submap_body;
  if (isDue(time, kScanRate, lastScan_)) {
    const auto timing = times.measure("open_doors");
    const auto doors = findOpenDoors(scan, T_submap_body, place.floor_z, time, config_.openDoors);
    memory_.add(place.submap.node.id, T_submap_body * scan.T_body_sensor, doors, poses);
    if (config_.openDoors.fromLaser) {
      memory_.look(place.submap.node.id, T_submap_body * scan.T_body_sensor, scan, time, poses);
    }
  }
  if (config_.people.enabled && config_.people.fromLaser && !seesPeople() && tracker_.wants(time)) {
    const auto timing = times.measure("people");
    follow(place.submap, time, findLegs(scan, T_submap_body, time));
  }
}

void Perception::Implementation::perceiveFrame(const Place& place, const sensors::RgbdFrame& frame,
                                               const EntityMemory::SubMapPoses& poses, base::StageTimes& times,
                                               std::map<std::string, std::int64_t>& notLookedAt) {
  if (debug_ != nullptr) debug_->beginFrame(frames_);
  ++frames_;
  if (!hasDepth(frame)) {
    ++notLookedAt["an image without depth"];
    return;
  }
  if (!frame.color.empty() && !sameSize(frame)) {
    ++notLookedAt["an image whose colour and depth differ in size"];
    return;
  }
  if (frame.color.empty()) {
    ++notLookedAt["closed doors and people: an image without colour"];
  } else if (config_.people.enabled && !seesPeople()) {
    ++notLookedAt["people: no networks to look at an image (--models)"];
  }
  const RgbdView view{.time = place.placed.reading.time,
                      .frame = frame,
                      .T_submap_camera = place.placed.T_submap_body * frame.T_body_camera,
                      .floor_z = place.floor_z,
                      .movers = place.placed.movers};
  if (isDue(view.time, config_.rate, lastLook_)) findDoorsAndStairs(view, place.submap.node.id, poses, times);
  if (!config_.people.enabled) return;
  const auto timing = times.measure("people");
  if (hasNetworksOrLabels() && !hasSideFile_ && tracker_.wants(view.time)) findPeople(view, place);
  waitForSideFile(view, place);
}

bool Perception::Implementation::isDue(base::Time time, double rate, std::optional<base::Time>& last) {
  if (last && base::seconds(time - *last) < kEarly / rate) return false;
  last = time;
  return true;
}

/// All sightings of one image, then a look at what was believed before.
void Perception::Implementation::findDoorsAndStairs(const RgbdView& view, base::SubMapId submap,
                                                    const EntityMemory::SubMapPoses& poses, base::StageTimes& times) {
  const auto timed = [&times](const char* stage, const auto& what) {
    const auto timing = times.measure(stage);
    return what();
  };
  const auto surfaces = timed("surfaces", [&] { return findSurfaces(view, config_.surfaces); });
  const auto stairs = timed("stairs", [&] { return findStaircases(view, surfaces, config_.stairs, debug_); });
  auto doors = timed("doors", [&] { return findDoors(view, surfaces, config_.doors, debug_); });
  const auto open = timed("open_doors", [&] { return findOpenDoors(view, surfaces, config_.openDoors, debug_); });
  doors.insert(doors.end(), open.begin(), open.end());
  const auto timing = times.measure("entities");
  memory_.add(submap, view.T_submap_camera, doors, poses);
  memory_.add(submap, view.T_submap_camera, stairs, poses);
  memory_.look(submap, view, surfaces, poses);
}

void Perception::Implementation::findPeople(const RgbdView& view, const Place& place) {
  const auto sightings =
      config_.people.fromLabels ? detector_.findInLabels(view, classes_) : detector_.find(view, debug_);
  follow(place.submap, view.time, sightings);
}

/// Who is not told of in an image is not in it.
void Perception::Implementation::settleLast(const map::SubMap& submap) {
  if (hasSideFile_ && last_ && !last_->isTold) follow(submap, last_->time, {});
  last_.reset();
}

void Perception::Implementation::waitForSideFile(const RgbdView& view, const Place& place) {
  settleLast(place.submap);
  last_ = {view.time, place.placed.reading.sensor, view.frame, view.T_submap_camera, view.floor_z};
}

bool Perception::Implementation::takeSideFile(const sensors::Reading& reading, const map::SubMap& submap) {
  const auto* joints = std::get_if<sensors::KeyPoints>(&reading.data);
  if (!config_.enabled || !config_.people.enabled || joints == nullptr) return false;
  hasSideFile_ = true;
  if (!last_ || last_->isTold || last_->sensor != reading.sensor ||
      std::chrono::abs(last_->time - reading.time) > kSameImage) {
    return false;
  }
  last_->isTold = true;
  const RgbdView view{last_->time, last_->data, last_->T_submap_camera, last_->floor_z};
  follow(submap, view.time, detector_.find(view, *joints, debug_));
  return true;
}

void Perception::Implementation::follow(const map::SubMap& submap, base::Time time,
                                        const std::vector<PersonSighting>& sightings) {
  tracker_.add(submap.node.id, time, sightings, submap.findLayer<map::OccupancyGrid>());
}

void Perception::Implementation::lookAround(const Surroundings& around, const EntityMemory::SubMapPoses& poses) {
  if (!config_.enabled || !config_.doorways.enabled) return;
  auto doorways = findDoorways(around.grid, Eigen::Vector2d::Zero(), config_.doorways);
  for (auto& doorway : doorways) {
    doorway.time = around.end;
    doorway.since = around.begin;
  }
  const auto showsNone = [&around](const geometry::Pose3& T_submap_doorway, double width) {
    return showsNoDoorway(around.grid, geometry::toPose2(T_submap_doorway), width);
  };
  memory_.addFromGrid(around.submap, doorways, showsNone, poses);
}

void Perception::Implementation::enter(const geometry::Pose3& T_submap_before) {
  tracker_.enter(T_submap_before);
}

std::vector<map::Entity> Perception::Implementation::entities() const {
  auto all = memory_.entities();
  const auto people = tracker_.entities();
  all.insert(all.end(), people.begin(), people.end());
  std::ranges::sort(all, {}, &map::Entity::id);
  return all;
}

void Perception::Implementation::addTo(map::MapChange& change) {
  memory_.addTo(change);
  tracker_.addTo(change);
}

void Perception::Implementation::save(base::ByteWriter& out) const {
  out << frames_;
  for (const auto& last : {lastLook_, lastScan_}) {
    out << last.has_value();
    if (last) out << base::toNanoseconds(*last);
  }
  out << next_.value << hasSideFile_;
  memory_.save(out);
  tracker_.save(out);
}

void Perception::Implementation::load(base::ByteReader& in) {
  in >> frames_;
  for (auto* last : {&lastLook_, &lastScan_}) {
    last->reset();
    if (in.read<bool>()) *last = base::fromNanoseconds(in.read<std::int64_t>());
  }
  in >> next_.value >> hasSideFile_;
  memory_.load(in);
  tracker_.load(in);
}

Perception::Perception(const PerceptionConfig& config, base::SessionId session, sensors::ClassTable classes, Ids first,
                       DebugImages* debug)
    : implementation_(std::make_unique<Implementation>(config, session, std::move(classes), first, debug)) {}
Perception::~Perception() = default;
void Perception::perceive(const Place& place, const EntityMemory::SubMapPoses& poses, base::StageTimes& times,
                          std::map<std::string, std::int64_t>& notLookedAt) {
  implementation_->perceive(place, poses, times, notLookedAt);
}
bool Perception::takeSideFile(const sensors::Reading& reading, const map::SubMap& submap) {
  return implementation_->takeSideFile(reading, submap);
}
void Perception::lookAround(const Surroundings& around, const EntityMemory::SubMapPoses& poses) {
  implementation_->lookAround(around, poses);
}
void Perception::finish(const map::SubMap& submap) {
  implementation_->finish(submap);
}
void Perception::enter(const geometry::Pose3& T_submap_before) {
  implementation_->enter(T_submap_before);
}
std::vector<map::Entity> Perception::entities() const {
  return implementation_->entities();
}
void Perception::addTo(map::MapChange& change) {
  implementation_->addTo(change);
}
void Perception::save(base::ByteWriter& out) const {
  implementation_->save(out);
}
void Perception::load(base::ByteReader& in) {
  implementation_->load(in);
}

}  // namespace prodomos::perception
