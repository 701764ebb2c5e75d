// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mapper/graph_bytes.hpp"
#include "mapper/mapper_impl.hpp"

namespace prodomos::mapper {

namespace {

/// Of what a checkpoint holds. Raise it with every change there.
constexpr int kCheckpointVersion = 5;

/// Poses that are told, by wheels or else, are followed to the letter.
localization::LoopCloserConfig loopsOf(const MapperConfig& config, const Localizer& localizer) {
  auto loops = config.loops;
  loops.enabled = loops.enabled && localizer.isEstimated();
  return loops;
}

}  // namespace

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
    const auto known = passages();
    nameWays(known);
    nameLoops(known);
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

}  // namespace prodomos::mapper
