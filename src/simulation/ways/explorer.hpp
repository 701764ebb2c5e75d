// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/navigation.hpp"
#include "prodomos/simulation/tour.hpp"

#include "simulation/ways/driver.hpp"
#include "simulation/ways/floor_changes.hpp"
#include "simulation/ways/roadmap.hpp"

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace prodomos::simulation {

/// What a robot can know of a building's floors, by storey.
struct Floors {
  std::vector<FloorGrid> grids;
  std::vector<Roadmap> roadmaps;
  std::vector<FloorChange> changes;

  Floors(const Building& building, double clearance);
};

/// Where an exploration begins: a corridor from which much can be reached, other storeys in time, or what comes nearest
/// to it. Throws base::Error where nothing can be stood in.
DrivenPose startOf(const Building& building, const Floors& floors, const TourOptions& options);

/// Decides where a robot goes next, and has it driven there.
class Explorer {
 public:
  Explorer(const Building& building, const Floors& floors, const TourOptions& options, Driver& driver);

  /// Until the driver's time is over.
  void explore();
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  /// Of one storey: what has been seen of it, by node and by room.
  struct Knowledge {
    std::vector<bool> seen;
    std::set<int> entered;
  };

  const FloorGrid& grid() const { return floors_.grids[storey()]; }
  const Roadmap& roadmap() const { return floors_.roadmaps[storey()]; }
  Knowledge& knowledge() { return knowledge_[storey()]; }
  std::size_t storey() const { return static_cast<std::size_t>(driver_.now().storey); }

  std::vector<std::size_t> unseenCorridorSpots();
  std::vector<std::size_t> unenteredRoomSpots(bool everyRoom);
  std::optional<std::size_t> nearest(const std::vector<std::size_t>& nodes, const Roadmap::Routes& routes);

  bool exploreCorridors();
  bool exploreRooms(bool everyRoom);
  bool approach(std::size_t node, const Roadmap::Routes& routes, Driver::AtEnd atEnd);
  void enter(std::size_t node, const Roadmap::Routes& routes);
  void lookAround(std::size_t node);
  void markSeen();

  double stageEnd() const;
  bool isTimeToLeave(const FloorChange& change);
  const FloorChange* chooseChange();
  void changeFloor(const FloorChange& change);

  const Building& building_;
  const Floors& floors_;
  TourOptions options_;
  Driver& driver_;
  base::Random random_;
  std::vector<Knowledge> knowledge_;  ///< by storey
  std::vector<bool> entersFirst_;     ///< by room
  std::vector<double> whims_;         ///< by room: how much farther it seems to the robot, metres
  std::vector<bool> visited_;         ///< by storey
  int stages_ = 1;                    ///< storeys that there is time for
  int stage_ = 0;
  double stageBegin_ = 0.0;
  const FloorChange* nextChange_ = nullptr;
  std::size_t marked_ = 0;  ///< poses that markSeen() has looked at
  std::vector<std::string> remarks_;
};

}  // namespace prodomos::simulation
