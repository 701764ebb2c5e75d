// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/furniture.hpp"

#include "simulation/scenes/scene_geometry.hpp"
#include "simulation/scenes/yaml_map.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::simulation {

/// In scene files.
inline constexpr std::string_view kOutsideName = "outside";

/// Reads one scene: first all rooms, then what stands between and in them.
class SceneReader {
 public:
  SceneReader(const std::filesystem::path& path, std::uint64_t seed) : faults_(path.string()), seed_(seed) {}

  Building read(const YAML::Node& root);

 private:
  void readStorey(YamlMap& map, int storey);
  void readRoom(const YAML::Node& node, int storey);
  Polygon readOutline(YamlMap& map);
  void checkRoomsAreApart(int storey);

  // Doors, stairs and lifts (scene_doors.cpp).
  void readDoor(const YAML::Node& node, int storey);
  std::array<int, 2> readDoorRooms(YamlMap& map, int storey);
  void placeDoor(YamlMap& map, Door& door);
  std::vector<WallStretch> wallsBetween(const std::array<int, 2>& rooms) const;
  void readLeaves(YamlMap& map, Door& door);
  void readSwings(YamlMap& map, Door& door);
  void readStairs(const YAML::Node& node, int storey);
  double riseOf(YamlMap& map, const Staircase& stairs, std::optional<double> stepHeight) const;
  int roomHolding(YamlMap& map, const Staircase& stairs, bool head);
  void readLift(const YAML::Node& node);
  void drawStates();

  // Furniture, people and light (scene_contents.cpp).
  void readThing(const YAML::Node& node, int storey);
  void placeThing(YamlMap& map, const ThingKind& kind, const Eigen::Vector2d& at, Thing& thing);
  void readPersonOf(const YAML::Node& node, int storey);
  void seatPeople();
  void readLighting(YamlMap& map);
  void markFurnished();

  std::string readId(YamlMap& map, std::string_view what);
  std::optional<int> roomNamed(const std::string& id) const;
  double rise(int storey) const { return building_.storeys[static_cast<std::size_t>(storey)].ceilingHeight + slab_; }
  bool isModelled(int storey) const { return storey >= 0 && storey < static_cast<int>(building_.storeys.size()); }
  const Room& room(int index) const { return building_.rooms[static_cast<std::size_t>(index)]; }

  Faults faults_;
  std::uint64_t seed_;
  Building building_;
  double wallThickness_ = 0.2;
  double slab_ = 0.3;
  std::vector<Polygon> centreLines_;          ///< by room
  std::vector<int> roomLines_;                ///< by room
  std::vector<std::optional<bool>> furnish_;  ///< by room, as given
  std::vector<bool> stateGiven_;              ///< by door
  std::set<std::size_t> passed_;              ///< doors that people go through
  std::set<std::string> ids_;
};

}  // namespace prodomos::simulation
