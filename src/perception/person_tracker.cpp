// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/person_tracker.hpp"

#include "prodomos/geometry/assignment.hpp"

#include "perception/archive.hpp"
#include "perception/person_track.hpp"

#include <algorithm>
#include <utility>

namespace prodomos::perception {

namespace {

constexpr double kGate = 16.0;           ///< squared standard deviations
constexpr double kNearGate = 0.35;       ///< metres; nearer ones may be the same whatever the filter says
constexpr double kFarGate = 1.5;         ///< metres; farther ones are not
constexpr double kLikenessWeight = 6.0;  ///< of clothes, against squared standard deviations
constexpr base::Duration kTentativeFor = std::chrono::milliseconds(1000);
constexpr base::Duration kFollowedFor = std::chrono::milliseconds(2500);

// Who was lost and is met again.
constexpr base::Duration kRememberedFor = std::chrono::seconds(120);
constexpr std::size_t kMostRemembered = 64;
constexpr double kRunningSpeed = 1.7;  ///< m/s
constexpr double kSamePlace = 0.7;     ///< metres
constexpr double kLikeClothes = 0.75;
constexpr double kSimilarClothes = 0.5;  ///< enough in the same place

}  // namespace

class PersonTracker::Implementation {
 public:
  Implementation(const PeopleConfig& config, base::SessionId session, std::int64_t firstTrack,
                 std::function<base::EntityId()> nextEntity)
      : config_(config), session_(session), nextTrack_(firstTrack), nextEntity_(std::move(nextEntity)) {}

  bool wants(base::Time time) const {
    // A frame that comes a little early, for all jitter, is the one that is due.
    return !lastTime_ || base::seconds(time - *lastTime_) > 0.9 / config_.rate;
  }
  void add(base::SubMapId submap, base::Time time, const std::vector<PersonSighting>& sightings,
           const map::OccupancyGrid* grid);
  void enter(const geometry::Pose3& T_submap_before);
  std::vector<map::Entity> entities() const;
  void addTo(map::MapChange& change);

  static void fields(auto& archive, auto& self) {
    archive(self.nextTrack_, self.lastTime_, self.tracks_, self.remembered_, self.forgotten_);
  }

 private:
  std::vector<bool> follow(base::SubMapId submap, base::Time time, const std::vector<PersonSighting>& sightings);
  void confirm(PersonTrack& track);
  std::vector<PersonTrack>::iterator findRemembered(const PersonTrack& track);
  void retire(base::Time time);

  PeopleConfig config_;
  base::SessionId session_;
  std::int64_t nextTrack_;
  std::function<base::EntityId()> nextEntity_;
  std::optional<base::Time> lastTime_;
  std::vector<PersonTrack> tracks_;      // in the order in which they began
  std::vector<PersonTrack> remembered_;  // in the order in which they were lost
  std::vector<PersonTrack> forgotten_;   // not to be met again, but not written yet
};

void PersonTracker::Implementation::add(base::SubMapId submap, base::Time time,
                                        const std::vector<PersonSighting>& sightings, const map::OccupancyGrid* grid) {
  lastTime_ = time;
  for (auto& track : tracks_) track.predict(time);
  const auto used = follow(submap, time, sightings);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!used[i] && sightings[i].score >= config_.leastScore) tracks_.emplace_back(submap, sightings[i]);
  }
  for (auto& track : tracks_) {
    if (track.lastSeen() != time) continue;
    if (!track.isConfirmed() && track.isConvincing()) confirm(track);
    if (grid != nullptr && track.isConfirmed()) track.lookAround(*grid);
  }
  retire(time);
}

/// Updates those who are seen; says which sightings are theirs.
std::vector<bool> PersonTracker::Implementation::follow(base::SubMapId submap, base::Time time,
                                                        const std::vector<PersonSighting>& sightings) {
  Eigen::MatrixXd costs(std::ssize(tracks_), std::ssize(sightings));
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    for (std::size_t s = 0; s < sightings.size(); ++s) {
      const double metres = tracks_[t].metresFrom(sightings[s]);
      const double distance = tracks_[t].distance(sightings[s]);
      const bool isNear = metres < kFarGate && (distance < kGate || metres < kNearGate);
      const double unlike = 1.0 - tracks_[t].likeness(sightings[s].appearance).value_or(1.0);
      costs(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(s)) =
          isNear ? std::min(distance, kGate) + kLikenessWeight * unlike : geometry::kForbidden;
    }
  }
  std::vector<bool> used(sightings.size(), false);
  const auto sightingOf = geometry::assign(costs);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (!sightingOf[t]) {
      tracks_[t].miss(time);
      continue;
    }
    const auto s = static_cast<std::size_t>(*sightingOf[t]);
    used[s] = true;
    tracks_[t].update(submap, sightings[s]);
  }
  return used;
}

/// Someone new, or someone met again.
void PersonTracker::Implementation::confirm(PersonTrack& track) {
  const auto known = findRemembered(track);
  if (known == remembered_.end()) {
    track.track = {nextTrack_++};
    track.entityId = nextEntity_();
    return;
  }
  track.takeOver(std::move(*known));
  remembered_.erase(known);
}

/// The one in the likest clothes of those who can have come here meanwhile.
std::vector<PersonTrack>::iterator PersonTracker::Implementation::findRemembered(const PersonTrack& track) {
  auto best = remembered_.end();
  double bestLikeness = 0.0;
  for (auto known = remembered_.begin(); known != remembered_.end(); ++known) {
    const double away = (known->position() - track.position()).norm();
    const double meanwhile = base::seconds(track.lastSeen() - known->lastSeen());
    const double likeness = known->likeness(track.appearance()).value_or(kSimilarClothes);
    const double least = away < kSamePlace ? kSimilarClothes : kLikeClothes;
    if (away > kSamePlace + kRunningSpeed * meanwhile || likeness < least || likeness <= bestLikeness) continue;
    best = known;
    bestLikeness = likeness;
  }
  return best;
}

void PersonTracker::Implementation::retire(base::Time time) {
  for (auto& track : tracks_) {
    if (track.isConfirmed() && time - track.lastSeen() > kFollowedFor) remembered_.push_back(std::move(track));
  }
  std::erase_if(tracks_, [&](const PersonTrack& track) {
    return time - track.lastSeen() > (track.isConfirmed() ? kFollowedFor : kTentativeFor);
  });
  const auto isOld = [&](const PersonTrack& track) { return time - track.lastSeen() > kRememberedFor; };
  while (!remembered_.empty() && (remembered_.size() > kMostRemembered || isOld(remembered_.front()))) {
    if (remembered_.front().hasChanged) forgotten_.push_back(std::move(remembered_.front()));
    remembered_.erase(remembered_.begin());
  }
}

void PersonTracker::Implementation::enter(const geometry::Pose3& T_submap_before) {
  for (auto* tracks : {&tracks_, &remembered_}) {
    for (auto& track : *tracks) track.enter(T_submap_before);
  }
}

std::vector<map::Entity> PersonTracker::Implementation::entities() const {
  std::vector<map::Entity> entities;
  for (const auto* tracks : {&tracks_, &remembered_, &forgotten_}) {
    for (const auto& track : *tracks) {
      if (track.isConfirmed()) entities.push_back(track.entity());
    }
  }
  std::ranges::sort(entities, {}, &map::Entity::id);
  return entities;
}

void PersonTracker::Implementation::addTo(map::MapChange& change) {
  for (auto* tracks : {&tracks_, &remembered_, &forgotten_}) {
    for (auto& track : *tracks) {
      if (!track.isConfirmed() || !std::exchange(track.hasChanged, false)) continue;
      change.entities.push_back(track.entity());
      change.tracks.push_back({.id = track.track,
                               .session = session_,
                               .className = "human",
                               .states = track.takeStates(),
                               .entity = track.entityId});
    }
  }
  forgotten_.clear();
}

PersonTracker::PersonTracker(const PeopleConfig& config, base::SessionId session, std::int64_t firstTrack,
                             std::function<base::EntityId()> nextEntity)
    : implementation_(std::make_unique<Implementation>(config, session, firstTrack, std::move(nextEntity))) {}
PersonTracker::~PersonTracker() = default;
PersonTracker::PersonTracker(PersonTracker&&) noexcept = default;
PersonTracker& PersonTracker::operator=(PersonTracker&&) noexcept = default;

bool PersonTracker::wants(base::Time time) const {
  return implementation_->wants(time);
}

void PersonTracker::add(base::SubMapId submap, base::Time time, const std::vector<PersonSighting>& sightings,
                        const map::OccupancyGrid* grid) {
  implementation_->add(submap, time, sightings, grid);
}

void PersonTracker::enter(const geometry::Pose3& T_submap_before) {
  implementation_->enter(T_submap_before);
}

std::vector<map::Entity> PersonTracker::entities() const {
  return implementation_->entities();
}

void PersonTracker::addTo(map::MapChange& change) {
  implementation_->addTo(change);
}

void PersonTracker::save(base::ByteWriter& out) const {
  Saving archive(out);
  Implementation::fields(archive, *implementation_);
}

void PersonTracker::load(base::ByteReader& in) {
  Loading archive(in);
  Implementation::fields(archive, *implementation_);
}

}  // namespace prodomos::perception
