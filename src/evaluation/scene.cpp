// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::evaluation {

namespace {

template <typename Claim>
std::optional<std::size_t> indexOf(const std::vector<Claim>& claims, base::EntityId id) {
  const auto found = std::ranges::find(claims, id, &Claim::id);
  if (found == claims.end()) return std::nullopt;
  return static_cast<std::size_t>(found - claims.begin());
}

/// The room that the claimed door's x-axis points into.
const std::string& farRoom(const ClaimedDoor& claim, const TrueDoor& door) {
  return door.rooms[std::cos(claim.T_world_door.theta - poseOf(door).theta) > 0.0 ? 1 : 0];
}

/// Does it lead to where the claim says, up or down?
bool endsAsClaimed(const ClaimedStaircase& claim, const TrueStaircase& stairs) {
  const double rise = stairs.head.z() - stairs.foot.z();
  const double expected = claim.storey == stairs.storeys[0] ? rise : -rise;
  return std::abs(claim.stairs.height - expected) <= kStoreyTolerance;
}

Behind behindOf(const ClaimedSpace& space, const Scene& scene) {
  const auto& truth = scene.truth;
  const auto& claims = scene.claims;
  Behind behind;
  if (const auto door = indexOf(claims.doors, space.cause)) {
    behind.door = scene.doorMatches[*door].truth;
    if (behind.door) behind.room = findRoom(truth, farRoom(claims.doors[*door], truth.doors[*behind.door]));
  } else if (const auto flight = indexOf(claims.stairs, space.cause)) {
    const auto& claim = claims.stairs[*flight];
    behind.flight = scene.stairsMatches[*flight].truth;
    if (behind.flight && !endsAsClaimed(claim, truth.stairs[*behind.flight])) behind.flight.reset();
    if (behind.flight) {
      const auto& stairs = truth.stairs[*behind.flight];
      behind.room = findRoom(truth, stairs.rooms[claim.storey == stairs.storeys[0] ? 1 : 0]);
    }
  }
  if (behind.room) {
    const auto& entered = truth.rooms[*behind.room].entered;
    const bool wasEntered = entered && *entered <= space.made;
    behind.isUnseen = !wasEntered && scene.unseenArea(*behind.room, space.made) >= kLeastUnseen;
  } else {
    behind.isUnseen = behind.flight.has_value();
  }
  return behind;
}

double areaOf(std::size_t cells) {
  return static_cast<double>(cells) * kCell * kCell;
}

}  // namespace

const ClaimedDoor* Scene::findDoor(base::EntityId cause) const {
  const auto index = indexOf(claims.doors, cause);
  return index ? &claims.doors[*index] : nullptr;
}

double Scene::unseenArea(std::size_t room, base::Time at) const {
  const int storey = truth.rooms[room].storey;
  const auto cells = cellsIn(truth.rooms[room].outline);
  const auto isUnknown = [&](geometry::CellIndex cell) { return !known.isKnown(storey, cell, at); };
  return areaOf(static_cast<std::size_t>(std::ranges::count_if(cells, isUnknown)));
}

double Scene::area(std::size_t room) const {
  return areaOf(cellsIn(truth.rooms[room].outline).size());
}

Scene makeScene(Truth truth, Claims claims, KnownSpace known) {
  Scene scene{.truth = std::move(truth), .claims = std::move(claims), .known = std::move(known)};
  scene.plans = groundPlansOf(scene.truth);
  scene.doorMatches = matchDoors(scene.claims.doors, scene.truth);
  scene.stairsMatches = matchStairs(scene.claims.stairs, scene.truth);
  for (const auto& space : scene.claims.spaces) scene.behind.push_back(behindOf(space, scene));
  return scene;
}

Scene makeScene(const map::MapView& view, Truth truth) {
  auto claims = claimsOf(view, truth);
  auto known = knownSpaceOf(view, truth);
  return makeScene(std::move(truth), std::move(claims), std::move(known));
}

}  // namespace prodomos::evaluation
