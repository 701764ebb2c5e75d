// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/entity_memory.hpp"

#include "perception/archive.hpp"
#include "perception/door_memory.hpp"
#include "perception/staircase_memory.hpp"

#include <algorithm>
#include <utility>

namespace prodomos::perception {

void describe(base::ConfigVisitor& visitor, EntityMemoryConfig& config) {
  visitor.section("entity_memory", "lasting doors and staircases of what single readings show");
  visitor.key("certainty", config.certainty, "log-odds", {-10.0, 20.0}, "from which on a thing is in the map");
  visitor.key("doubt", config.doubt, "log-odds", {-10.0, 20.0}, "below which it is taken out again");
  visitor.key("prior", config.prior, "log-odds", {-10.0, 10.0}, "before anything was seen");
  visitor.key("correlation", config.correlation, "", {0.01, 1.0}, "of the errors of two readings from one place");
  visitor.key("look_spacing", config.lookSpacing, "m", {0.01, 5.0},
              "that the robot moves until a reading is a new look");
  visitor.key("position_floor", config.positionFloor, "m", {0.001, 1.0}, "no look places a thing better");
  visitor.key("heading_floor", config.headingFloor, "rad", {0.001, 1.0}, "no look tells a heading better");
  visitor.key("submap_position", config.submapPosition, "m", {0.0, 2.0}, "uncertainty of a sub-map against another");
  visitor.key("submap_heading", config.submapHeading, "rad", {0.0, 0.5}, "likewise");
  visitor.key("door_miss", config.doorMiss, "log-odds", {0.0, 10.0}, "lost where a door is not found though well seen");
  visitor.key("stairs_miss", config.stairsMiss, "log-odds", {0.0, 10.0}, "the same of stairs");
  visitor.key("doorway_miss", config.doorwayMiss, "log-odds", {0.0, 10.0},
              "lost where a grid shows that there is no doorway");
  visitor.key("opening_against_leaf", config.openingAgainstLeaf, "log-odds", {0.0, 5.0},
              "against a leaf, of an opening in which none is seen");
  visitor.key("state_trust", config.stateTrust, "", {0.34, 0.999}, "that one reading tells a door's state rightly");
  visitor.key("state_memory", config.stateMemory, "s", {0.1, 1e6}, "in which the state of an unseen door is forgotten");
  visitor.key("forgetting", config.forgetting, "s", {1.0, 1e6}, "after which what was never sure is forgotten");
  visitor.key("least_door_width", config.leastDoorWidth, "m", {0.1, 5.0}, "narrower ones are none");
  visitor.key("greatest_door_width", config.greatestDoorWidth, "m", {0.5, 10.0}, "wider ones are none");
  visitor.key("greatest_opening", config.greatestOpening, "m", {0.5, 10.0}, "the same of doorways without a leaf");
  visitor.endSection();
}

namespace {

bool mayBeWritten(const DoorLandmark& door) {
  return !door.isRivalled;
}
bool mayBeWritten(const StaircaseLandmark& /*stairs*/) {
  return true;
}

/// What a grid shows is not of a moment, and is asked for again in the end.
bool mayBeForgotten(const DoorLandmark& door) {
  return std::ranges::none_of(door.looks, [](const DoorLook& look) { return look.ofGrid && look.sightings > 0; });
}
bool mayBeForgotten(const StaircaseLandmark& /*stairs*/) {
  return true;
}

/// Whether its tidings of that kind may be told: a doorway has no state.
bool isTold(const DoorLandmark& door, const Tiding& tiding) {
  return tiding.state == map::DoorState::kUnknown || hasLeaf(door);
}
bool isTold(const StaircaseLandmark& /*stairs*/, const Tiding& /*tiding*/) {
  return true;
}

map::Event eventOf(base::EntityId id, base::SessionId session, const Tiding& tiding) {
  if (tiding.state == map::DoorState::kUnknown) return {tiding.time, session, "detected", toString(id), "{}"};
  return {tiding.time, session, "door_state", toString(id),
          "{\"state\": \"" + std::string(toString(tiding.state)) + "\"}"};
}

}  // namespace

class EntityMemory::Implementation {
 public:
  Implementation(const EntityMemoryConfig& config, base::SessionId session, NewId newId)
      : doors(config), stairs(config), config_(config), session_(session), newId_(std::move(newId)) {}

  /// After whatever may have changed what is believed.
  void settle(base::Time now) {
    now_ = std::max(now_, now);
    giveUp(doors.takeMerged(), "merged");
    giveUp(stairs.takeMerged(), "merged");
    settle(doors.landmarks());
    settle(stairs.landmarks());
  }

  std::vector<map::Entity> entities() const {
    std::vector<map::Entity> entities;
    const auto append = [&entities](const auto& landmarks) {
      for (const auto& landmark : landmarks) {
        if (landmark.id) entities.push_back(entityOf(landmark));
      }
    };
    append(doors.landmarks());
    append(stairs.landmarks());
    std::ranges::sort(entities, {}, &map::Entity::id);
    return entities;
  }

  void addTo(map::MapChange& change) {
    tell(doors.landmarks(), change);
    tell(stairs.landmarks(), change);
    std::ranges::move(removals_, std::back_inserter(change.events));
    std::ranges::move(removed_, std::back_inserter(change.removedEntities));
    removals_.clear();
    removed_.clear();
  }

  void save(base::ByteWriter& out) const {
    out << base::toNanoseconds(now_);
    Saving saving(out);
    saving(doors, stairs, removed_);
    saveRemovals(out);
  }

  void load(base::ByteReader& in) {
    now_ = base::fromNanoseconds(in.read<std::int64_t>());
    Loading loading(in);
    loading(doors, stairs, removed_);
    loadRemovals(in);
  }

  DoorMemory doors;
  StaircaseMemory stairs;

 private:
  /// Those who became sure enter the map, those who came into doubt leave it, and who never was sure is forgotten.
  template <typename AnyLandmark>
  void settle(std::vector<AnyLandmark>& landmarks) {
    for (auto& landmark : landmarks) {
      if (!landmark.id && landmark.logOdds >= config_.certainty && mayBeWritten(landmark)) landmark.id = newId_();
      if (landmark.id && (landmark.logOdds < config_.doubt || !mayBeWritten(landmark))) {
        if (landmark.isTold) giveUp({*landmark.id}, mayBeWritten(landmark) ? "refuted" : "outdone");
        landmark.id.reset();
        landmark.isTold = false;
        landmark.tidings.clear();
      }
    }
    std::erase_if(landmarks, [this](const AnyLandmark& landmark) {
      return !landmark.id && mayBeForgotten(landmark) &&
             base::seconds(now_ - landmark.lastDetected) > config_.forgetting;
    });
  }

  void giveUp(const std::vector<base::EntityId>& entities, const char* reason) {
    for (const auto id : entities) {
      removed_.push_back(id);
      removals_.push_back(
          {now_, session_, "entity_removed", toString(id), "{\"reason\": \"" + std::string(reason) + "\"}"});
    }
  }

  template <typename AnyLandmark>
  void tell(std::vector<AnyLandmark>& landmarks, map::MapChange& change) {
    for (auto& landmark : landmarks) {
      if (!landmark.id || !landmark.hasChanged) continue;
      change.entities.push_back(entityOf(landmark));
      for (const auto& tiding : landmark.tidings) {
        if (isTold(landmark, tiding)) change.events.push_back(eventOf(*landmark.id, session_, tiding));
      }
      std::erase_if(landmark.tidings, [&landmark](const Tiding& tiding) { return isTold(landmark, tiding); });
      landmark.hasChanged = false;
      landmark.isTold = true;
    }
  }

  void saveRemovals(base::ByteWriter& out) const {
    out << static_cast<std::uint64_t>(removals_.size());
    for (const auto& event : removals_) out << base::toNanoseconds(event.time) << event.subject << event.payload;
  }
  void loadRemovals(base::ByteReader& in) {
    removals_.clear();
    for (auto left = in.read<std::uint64_t>(); left > 0; --left) {
      map::Event event{base::fromNanoseconds(in.read<std::int64_t>()), session_, "entity_removed", {}, {}};
      in >> event.subject >> event.payload;
      removals_.push_back(std::move(event));
    }
  }

  EntityMemoryConfig config_;
  base::SessionId session_;
  NewId newId_;
  base::Time now_{};
  std::vector<base::EntityId> removed_;
  std::vector<map::Event> removals_;
};

EntityMemory::EntityMemory(const EntityMemoryConfig& config, base::SessionId session, NewId newId)
    : implementation_(std::make_unique<Implementation>(config, session, std::move(newId))) {}
EntityMemory::~EntityMemory() = default;
EntityMemory::EntityMemory(EntityMemory&&) noexcept = default;
EntityMemory& EntityMemory::operator=(EntityMemory&&) noexcept = default;

void EntityMemory::add(base::SubMapId submap, const geometry::Pose3& T_submap_sensor,
                       std::span<const DoorSighting> doors, const SubMapPoses& poses) {
  if (doors.empty() || !geometry::isFinite(T_submap_sensor)) return;
  implementation_->doors.add({submap, poses}, T_submap_sensor.translation(), doors);
  implementation_->settle(doors.back().time);
}

void EntityMemory::add(base::SubMapId submap, const geometry::Pose3& T_submap_sensor,
                       std::span<const StaircaseSighting> stairs, const SubMapPoses& poses) {
  if (stairs.empty() || !geometry::isFinite(T_submap_sensor)) return;
  implementation_->stairs.add({submap, poses}, T_submap_sensor.translation(), stairs);
  implementation_->settle(stairs.back().time);
}

void EntityMemory::addFromGrid(base::SubMapId submap, std::span<const DoorSighting> doorways,
                               const ShowsNoDoorway& showsNone, const SubMapPoses& poses) {
  implementation_->doors.addFromGrid({submap, poses}, doorways, showsNone);
  implementation_->settle(doorways.empty() ? base::Time{} : doorways.back().time);
}

void EntityMemory::look(base::SubMapId submap, const RgbdView& view, const Surfaces& surfaces,
                        const SubMapPoses& poses) {
  const Frames frames(submap, poses);
  implementation_->doors.look(frames, view, surfaces);
  implementation_->stairs.look(frames, view, surfaces);
  implementation_->settle(view.time);
}

void EntityMemory::look(base::SubMapId submap, const geometry::Pose3& T_submap_sensor, const sensors::LaserScan& scan,
                        base::Time time, const SubMapPoses& poses) {
  if (!geometry::isFinite(T_submap_sensor)) return;
  implementation_->doors.look({submap, poses}, T_submap_sensor, beamsOf(scan), time);
  implementation_->settle(time);
}

std::vector<map::Entity> EntityMemory::entities() const {
  return implementation_->entities();
}

void EntityMemory::addTo(map::MapChange& change) {
  implementation_->addTo(change);
}

void EntityMemory::save(base::ByteWriter& out) const {
  implementation_->save(out);
}

void EntityMemory::load(base::ByteReader& in) {
  implementation_->load(in);
}

}  // namespace prodomos::perception
