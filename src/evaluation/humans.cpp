// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/humans.hpp"

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/relations.hpp"
#include "prodomos/geometry/assignment.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace prodomos::evaluation {

namespace {

constexpr std::string_view kHumanClass = "human";

/// A track says where its person was between two states no farther apart.
constexpr base::Duration kLongestGap = std::chrono::milliseconds(500);

/// `joints` of docs/map-file.md; none where the attributes hold something else.
std::array<std::optional<Eigen::Vector3d>, kJointCount> jointsOf(const std::string& attributes,
                                                                 const geometry::Pose3& T_world_submap) {
  std::array<std::optional<Eigen::Vector3d>, kJointCount> joints{};
  const auto object = nlohmann::json::parse(attributes, nullptr, false);
  if (!object.is_object() || !object.contains("joints") || object["joints"].size() != joints.size()) return joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& joint = object["joints"][i];
    const auto isNumber = [](const auto& value) { return value.is_number(); };
    if (!joint.is_array() || joint.size() != 3 || !std::ranges::all_of(joint, isNumber)) continue;
    joints[i] = T_world_submap * Eigen::Vector3d(joint[0], joint[1], joint[2]);
  }
  return joints;
}

/// Where the map believes a person at one time; none where its track says nothing of it.
std::optional<MappedPersonState> stateAt(const MappedPerson& person, base::Time time) {
  const auto after = std::ranges::lower_bound(person.states, time - kStampTolerance, {}, &MappedPersonState::time);
  if (after == person.states.end()) return std::nullopt;
  if (after->time - time <= kStampTolerance) return *after;
  if (after == person.states.begin()) return std::nullopt;
  const auto& before = *std::prev(after);
  const base::Duration gap = after->time - before.time;
  if (gap > kLongestGap) return std::nullopt;
  const double share = base::seconds(time - before.time) / base::seconds(gap);
  MappedPersonState state{.time = time,
                          .T_world_person = geometry::interpolate(before.T_world_person, after->T_world_person, share),
                          .hasHeading = before.hasHeading && after->hasHeading};
  for (std::size_t i = 0; i < state.joints_in_world.size(); ++i) {
    const auto& from = before.joints_in_world[i];
    const auto& to = after->joints_in_world[i];
    if (from && to) state.joints_in_world[i] = *from + share * (*to - *from);
  }
  return state;
}

/// A person of the truth in one frame.
struct TrueGuest {
  std::size_t person = 0;
  const TruePersonState* state = nullptr;
  bool counts = false;  ///< seen well enough and near enough
};

/// A person of the map in one frame.
struct MappedGuest {
  std::size_t person = 0;
  MappedPersonState state;
};

double distanceOf(const TrueGuest& guest, const MappedGuest& mapped) {
  return (guest.state->position - mapped.state.T_world_person.translation()).head<2>().norm();
}

/// Follows persons from frame to frame.
class Correspondence {
 public:
  Correspondence(const HumanOptions& options, HumanScore& score) : options_(options), score_(score) {}

  void addFrame(const std::vector<TrueGuest>& truth, const std::vector<MappedGuest>& mapped) {
    ++score_.frames;
    std::vector<bool> taken(mapped.size(), false);
    std::vector<TrueGuest> lost;
    for (const auto& guest : truth) {
      if (!guest.counts) continue;
      ++score_.seen;
      const auto kept = findKept(guest, mapped);
      if (!kept || taken[*kept]) {
        lost.push_back(guest);
        continue;
      }
      taken[*kept] = true;
      take(guest, mapped[*kept]);
    }
    pairUp(lost, mapped, taken, [&](const TrueGuest& guest, const MappedGuest& found) { take(guest, found); });
    // Whoever is there, but need not be found, is not false either.
    std::vector<TrueGuest> others;
    std::ranges::copy_if(truth, std::back_inserter(others), [](const auto& guest) { return !guest.counts; });
    pairUp(others, mapped, taken, [](const TrueGuest&, const MappedGuest&) {});
    score_.falsePositives += static_cast<std::size_t>(std::ranges::count(taken, false));
  }

 private:
  /// Among those in the map, the one it was paired with last, where it is still within reach.
  std::optional<std::size_t> findKept(const TrueGuest& guest, const std::vector<MappedGuest>& mapped) const {
    const auto last = partnerOf_.find(guest.person);
    if (last == partnerOf_.end()) return std::nullopt;
    const auto found = std::ranges::find(mapped, last->second, &MappedGuest::person);
    if (found == mapped.end() || distanceOf(guest, *found) > options_.reach) return std::nullopt;
    return static_cast<std::size_t>(found - mapped.begin());
  }

  /// The rest, for the least sum of distances.
  template <typename Act>
  void pairUp(const std::vector<TrueGuest>& guests, const std::vector<MappedGuest>& mapped, std::vector<bool>& taken,
              const Act& act) const {
    Eigen::MatrixXd costs(std::ssize(guests), std::ssize(mapped));
    for (std::size_t t = 0; t < guests.size(); ++t) {
      for (std::size_t m = 0; m < mapped.size(); ++m) {
        const double distance = distanceOf(guests[t], mapped[m]);
        costs(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(m)) =
            taken[m] || distance > options_.reach ? geometry::kForbidden : distance;
      }
    }
    const auto pairs = geometry::assign(costs);
    for (std::size_t t = 0; t < guests.size(); ++t) {
      if (!pairs[t]) continue;
      const auto m = static_cast<std::size_t>(*pairs[t]);
      taken[m] = true;
      act(guests[t], mapped[m]);
    }
  }

  void take(const TrueGuest& guest, const MappedGuest& found) {
    const auto [last, isNew] = partnerOf_.try_emplace(guest.person, found.person);
    if (!isNew && last->second != found.person) {
      ++score_.identitySwitches;
      last->second = found.person;
    }
    ++score_.matches;
    score_.positionErrors.push_back(distanceOf(guest, found));
    if (found.state.hasHeading) {
      const double turn = geometry::yaw(found.state.T_world_person) - guest.state->heading;
      score_.headingErrors.push_back(std::abs(geometry::normalizeAngle(turn)));
    }
    for (std::size_t i = 0; i < guest.state->joints.size(); ++i) {
      const auto& joint = found.state.joints_in_world[i];
      if (joint) score_.jointErrors.push_back((*joint - guest.state->joints[i]).norm());
    }
  }

  const HumanOptions& options_;
  HumanScore& score_;
  std::map<std::size_t, std::size_t> partnerOf_;  // of a true person, the one in the map it was paired with last
};

std::vector<TrueGuest> guestsAt(const Truth& truth, base::Time time, const HumanOptions& options) {
  std::vector<TrueGuest> guests;
  const auto T_world_body = poseAt(truth.trajectory, time);
  for (std::size_t i = 0; i < truth.people.size(); ++i) {
    const auto& states = truth.people[i].states;
    const auto state = std::ranges::lower_bound(states, time, {}, &TruePersonState::time);
    if (state == states.end() || state->time != time) continue;
    const bool near = T_world_body && (T_world_body->translation() - state->position).head<2>().norm() <= options.range;
    guests.push_back({i, &*state, near && state->pixels >= options.leastPixels});
  }
  return guests;
}

std::vector<MappedGuest> guestsAt(const std::vector<MappedPerson>& mapped, base::Time time) {
  std::vector<MappedGuest> guests;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    if (const auto state = stateAt(mapped[i], time)) guests.push_back({i, *state});
  }
  return guests;
}

/// The camera's, of which true persons have a state each. Where there never is any, those in which the map has one.
std::set<base::Time> framesOf(const std::vector<MappedPerson>& mapped, const Truth& truth) {
  std::set<base::Time> frames;
  for (const auto& person : truth.people) {
    for (const auto& state : person.states) frames.insert(state.time);
  }
  if (!frames.empty()) return frames;
  for (const auto& person : mapped) {
    for (const auto& state : person.states) frames.insert(state.time);
  }
  return frames;
}

MappedPerson personOf(const map::Track& track, const std::map<base::SubMapId, geometry::Pose3>& T_world_submap) {
  MappedPerson person{track.id.value, {}};
  for (const auto& state : track.states) {
    const auto frame = T_world_submap.find(state.submap);
    if (frame == T_world_submap.end()) continue;
    person.states.push_back({.time = state.time,
                             .T_world_person = frame->second * state.T_submap_thing,
                             .joints_in_world = jointsOf(state.attributes, frame->second)});
  }
  return person;
}

}  // namespace

std::vector<MappedPerson> peopleOf(const map::MapView& view, const Truth& truth) {
  const auto T_world_submap = truthFromSubMaps(view, truth);
  std::vector<MappedPerson> people;
  for (const auto& track : view.tracks()) {
    if (track.className == kHumanClass) people.push_back(personOf(track, T_world_submap));
  }
  if (!people.empty()) return people;
  for (const auto& entity : view.entities()) {
    if (!std::holds_alternative<map::Human>(entity.attributes) || !T_world_submap.contains(entity.submap)) continue;
    people.push_back(
        {entity.id.value,
         {{.time = entity.lastSeen, .T_world_person = T_world_submap.at(entity.submap) * entity.T_submap_entity}}});
  }
  return people;
}

HumanScore scoreHumans(const std::vector<MappedPerson>& mapped, const Truth& truth, const HumanOptions& options) {
  HumanScore score;
  Correspondence correspondence(options, score);
  for (const auto time : framesOf(mapped, truth)) {
    correspondence.addFrame(guestsAt(truth, time, options), guestsAt(mapped, time));
  }
  return score;
}

std::optional<double> HumanScore::mota() const {
  if (seen == 0) return std::nullopt;
  return 1.0 - static_cast<double>(falseNegatives() + falsePositives + identitySwitches) / static_cast<double>(seen);
}

std::optional<double> HumanScore::motp() const {
  if (positionErrors.empty()) return std::nullopt;
  return std::accumulate(positionErrors.begin(), positionErrors.end(), 0.0) /
         static_cast<double>(positionErrors.size());
}

HumanScore& HumanScore::operator+=(const HumanScore& other) {
  frames += other.frames;
  seen += other.seen;
  matches += other.matches;
  falsePositives += other.falsePositives;
  identitySwitches += other.identitySwitches;
  positionErrors.insert(positionErrors.end(), other.positionErrors.begin(), other.positionErrors.end());
  headingErrors.insert(headingErrors.end(), other.headingErrors.begin(), other.headingErrors.end());
  jointErrors.insert(jointErrors.end(), other.jointErrors.begin(), other.jointErrors.end());
  return *this;
}

}  // namespace prodomos::evaluation
