// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/predicted_nodes.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace prodomos::evaluation {

namespace {

/// More of a room's floor than this unknown in the end, and nobody in it: it is unseen.
constexpr double kUnseenShare = 0.5;

bool leadsElsewhere(const ClaimedSpace& space) {
  return space.mobility != map::Mobility::kDynamic;
}

/// What lies behind, by its room's id; what is not modelled, by the flight that leads there. Empty: nothing, or nothing
/// that the truth tells of.
std::string nameOf(const Behind& behind, const Truth& truth) {
  if (behind.room) return truth.rooms[*behind.room].id;
  return behind.flight ? "beyond " + truth.stairs[*behind.flight].id : "";
}

/// Two spaces that can be reached from each other.
struct Passage {
  std::array<std::string, 2> spaces;
  bool isVisible = false;
};

std::vector<Passage> passagesOf(const Truth& truth) {
  std::vector<Passage> passages;
  for (const auto& door : truth.doors) {
    const bool leadsOutside = door.rooms[0].empty() || door.rooms[1].empty();
    if (!leadsOutside && !isLiftDoor(truth, door)) passages.push_back({door.rooms, door.sighting.visible});
  }
  for (const auto& flight : truth.stairs) {
    Passage passage{flight.rooms, flight.sighting.visible};
    for (auto& space : passage.spaces) {
      if (space.empty()) space = "beyond " + flight.id;
    }
    passages.push_back(passage);
  }
  return passages;
}

struct RoomsByKnowledge {
  std::set<std::string> seen;
  std::set<std::string> tooSmall;  ///< unseen, but nobody would miss them
};

RoomsByKnowledge roomsByKnowledge(const Scene& scene) {
  RoomsByKnowledge rooms;
  for (std::size_t i = 0; i < scene.truth.rooms.size(); ++i) {
    const auto& room = scene.truth.rooms[i];
    const double unseen = scene.unseenArea(i, base::Time::max());
    if (room.entered || unseen <= kUnseenShare * scene.area(i)) {
      rooms.seen.insert(room.id);
    } else if (unseen < kLeastUnseen) {
      rooms.tooSmall.insert(room.id);
    }
  }
  return rooms;
}

/// When bets on one space stand at the same time, only the first made is right.
class Standing {
 public:
  bool isFirst(const std::string& space, const ClaimedSpace& claim) {
    for (const auto& [node, settled] : bets_[space]) {
      if (node != claim.node && (!settled || *settled > claim.made)) return false;
    }
    bets_[space].emplace_back(claim.node, claim.settled);
    return true;
  }

 private:
  std::map<std::string, std::vector<std::pair<base::SubMapId, std::optional<base::Time>>>> bets_;
};

}  // namespace

NodeScore& NodeScore::operator+=(const NodeScore& other) {
  right += other.right;
  wrong += other.wrong;
  behindVisible += other.behindVisible;
  adjacent += other.adjacent;
  return *this;
}

NodeScore scoreNodes(const Scene& scene) {
  const auto& spaces = scene.claims.spaces;
  std::vector<std::size_t> inOrder(spaces.size());
  for (std::size_t i = 0; i < inOrder.size(); ++i) inOrder[i] = i;
  std::ranges::sort(inOrder, {}, [&](std::size_t i) { return std::pair(spaces[i].made, spaces[i].id); });

  Standing standing;
  std::map<base::SubMapId, bool> isRight;  // of predicted nodes
  std::set<std::string> predicted;
  for (const auto i : inOrder) {
    const auto& behind = scene.behind[i];
    if (!leadsElsewhere(spaces[i]) || (behind.exists() && !behind.isJudged())) continue;
    const auto space = nameOf(behind, scene.truth);
    const bool right = behind.isUnseen && standing.isFirst(space, spaces[i]);
    isRight[spaces[i].node] = isRight[spaces[i].node] || right;
    if (behind.exists() && spaces[i].state != map::PredictionState::kRefuted) predicted.insert(space);
  }

  NodeScore score;
  for (const auto& [node, right] : isRight) ++(right ? score.right : score.wrong);
  const auto rooms = roomsByKnowledge(scene);
  std::map<std::string, bool> unseen;  // next to a seen space: is it behind something visible?
  for (const auto& passage : passagesOf(scene.truth)) {
    for (const std::size_t side : {0U, 1U}) {
      const auto& space = passage.spaces[side];
      const bool isUnseen = !rooms.seen.contains(space) && !rooms.tooSmall.contains(space);
      if (isUnseen && rooms.seen.contains(passage.spaces[1 - side])) unseen[space] |= passage.isVisible;
    }
  }
  for (const auto& [space, isVisible] : unseen) {
    const FoundCount one{1, predicted.contains(space) ? 1U : 0U};
    score.adjacent += one;
    if (isVisible) score.behindVisible += one;
  }
  return score;
}

std::vector<Bet> betsOf(const Scene& scene) {
  std::vector<Bet> bets;
  for (std::size_t i = 0; i < scene.claims.spaces.size(); ++i) {
    const auto& space = scene.claims.spaces[i];
    const auto& behind = scene.behind[i];
    if (leadsElsewhere(space) && behind.isJudged()) bets.push_back({space.probability, behind.isUnseen});
  }
  return bets;
}

}  // namespace prodomos::evaluation
