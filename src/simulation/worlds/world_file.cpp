// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/world_file.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/shell/door_swings.hpp"
#include "simulation/worlds/door_frames.hpp"
#include "simulation/worlds/gazebo_world.hpp"
#include "simulation/worlds/lift_portals.hpp"
#include "simulation/worlds/room_outlines.hpp"
#include "simulation/worlds/stairwells.hpp"
#include "simulation/worlds/stand_ins.hpp"
#include "simulation/worlds/storey_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr double kSliceHeight = 1.2;  ///< rooms are what walls at this height enclose
constexpr double kDoubleDoor = 1.2;   ///< frames as wide as this have two leaves

std::vector<std::filesystem::path> worldsIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> worlds;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".world" && isGazeboWorld(entry.path())) {
      worlds.push_back(entry.path());
    }
  }
  std::ranges::sort(worlds);
  return worlds;
}

/// How often the world includes its most frequent floor: that is cheap to tell.
std::size_t countStoreys(const std::filesystem::path& path) {
  const auto world = readGazeboWorld(path);
  return static_cast<std::size_t>(
      std::ranges::count_if(world.models, [](const WorldModel& model) { return model.model.ends_with("_floor"); }));
}

std::filesystem::path worldFile(const std::filesystem::path& path, int storeys) {
  if (!std::filesystem::is_directory(path)) return path;
  auto worlds = worldsIn(path);
  if (worlds.empty())
    throw base::FileError(base::expectedFound(path.string(), "a Gazebo world (*.world) in the folder", "none"));
  std::ranges::stable_sort(worlds, {}, countStoreys);
  const auto fits = [&](const auto& world) { return static_cast<int>(countStoreys(world)) >= storeys; };
  const auto world = std::ranges::find_if(worlds, fits);
  return world == worlds.end() ? worlds.back() : *world;
}

class WorldReader {
 public:
  WorldReader(std::filesystem::path path, const WorldOptions& options)
      : path_(std::move(path)), options_(options), world_(readGazeboWorld(path_)) {}

  Building read() {
    building_.name = path_.stem().string();
    building_.remarks = world_.remarks;
    auto meshes = readStoreyMeshes(world_, path_, building_);
    if (options_.storeys > static_cast<int>(meshes.storeys.size())) {
      throw base::UsageError(base::expectedFound(
          "storeys", "at most " + std::to_string(meshes.storeys.size()) + ", as " + path_.string() + " has",
          std::to_string(options_.storeys)));
    }
    if (options_.storeys > 0) meshes.storeys.resize(static_cast<std::size_t>(options_.storeys));
    storeys_ = std::move(meshes.storeys);
    storeyModels_ = std::move(meshes.models);
    lowestFloor_ = meshes.lowestFloor;
    for (const auto& mesh : storeys_) building_.storeys.push_back(mesh.storey);

    lowerPlatforms();
    building_.stairs = joinByStairs(storeys_, building_.remarks);
    for (int storey = 0; storey < static_cast<int>(storeys_.size()); ++storey) readStorey(storey);
    placeStairs();
    placeModels();
    nameRooms();
    setDoors();
    for (auto& mesh : storeys_) {
      std::ranges::move(mesh.surfaces, std::back_inserter(building_.imported));
    }
    return std::move(building_);
  }

 private:
  StoreyMesh& meshOf(int storey) { return storeys_[static_cast<std::size_t>(storey)]; }

  static std::string idOf(char kind, int storey, std::size_t number) {
    return std::string(1, kind) + std::to_string(storey) + "." + std::to_string(number);
  }

  template <typename Items>
  static std::size_t countOn(const Items& items, int storey) {
    return static_cast<std::size_t>(
        std::ranges::count_if(items, [&](const auto& item) { return item.storey == storey; }));
  }

  /// A robot on wheels is to reach what a low platform bears: its steps go, its top becomes floor.
  void lowerPlatforms() {
    constexpr float kHighest = 0.3F;
    constexpr float kLowest = 0.03F;
    for (std::size_t k = 0; k < storeys_.size(); ++k) {
      const auto level = static_cast<float>(storeys_[k].floor());
      bool found = false;
      for (auto& surface : storeys_[k].surfaces) {
        if (surface.classId != classId("floor")) continue;
        for (auto& vertex : surface.vertices) {
          const float height = vertex.z() - level;
          if (height < kLowest || height > kHighest) continue;
          vertex.z() = level;
          found = true;
        }
        // Risers have become lines.
        std::erase_if(surface.triangles, [&](const auto& t) {
          const auto& v = surface.vertices;
          return (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm() < 1e-6F;
        });
      }
      if (found) building_.remarks.push_back("a platform on storey " + std::to_string(k) + " is lowered to the floor");
    }
  }

  /// Rooms and doors of one storey.
  void readStorey(int storey) {
    const auto& mesh = meshOf(storey);
    const auto walls = sliceOf(mesh, "wall", kSliceHeight);
    const auto openings = framedOpenings(mesh);
    const auto portals = liftPortals(storey);
    std::vector<Polygon> closures;
    closures.reserve(openings.size() + portals.size());
    for (const auto& opening : openings) closures.push_back(opening.footprint);
    for (const auto& portal : portals) closures.push_back(portal.footprint);
    for (const auto& surface : mesh.surfaces) {
      if (surface.classId != classId("window")) continue;
      for (const auto& pane : connectedPieces(surface)) closures.push_back(cornersOf(planOf(boundsOf(pane))));
    }
    for (auto& outline : roomOutlines(walls, closures)) addRoom(storey, std::move(outline), RoomUse::kRoom, "ROOM");
    for (const auto& portal : portals) addRoom(storey, cabinOf(portal.portal), RoomUse::kLift, "LIFT");
    for (const auto& opening : openings) addDoor(storey, opening);
    for (const auto& portal : portals) addLift(storey, portal.portal);
  }

  std::vector<FramedOpening> framedOpenings(const StoreyMesh& mesh) {
    std::vector<FramedOpening> openings;
    for (const auto& surface : mesh.surfaces) {
      if (surface.classId != classId("door_frame")) continue;
      for (const auto& piece : connectedPieces(surface)) {
        if (const auto opening = openingOf(piece)) openings.push_back(*opening);
      }
    }
    return openings;
  }

  struct PlacedPortal {
    LiftPortal portal;
    Polygon footprint;
  };

  std::vector<PlacedPortal> liftPortals(int storey) {
    std::vector<PlacedPortal> portals;
    for (const auto& model : world_.models) {
      if (!isLiftDoor(model.model) || storeyOf(model) != storey) continue;
      const auto portal = portalAt(meshOf(storey), geometry::toPose2(model.T_world_model));
      if (!portal) {
        building_.remarks.push_back(model.name + ": no opening in a wall is there for a lift's door");
        continue;
      }
      const double x = portal->wallThickness / 2.0;
      const double y = portal->width / 2.0;
      Polygon footprint;
      for (const auto& corner : cornersOf({Eigen::Vector2d(-x, -y), Eigen::Vector2d(x, y)})) {
        const auto p = portal->pose * geometry::Pose2{corner.x(), corner.y(), 0.0};
        footprint.emplace_back(p.x, p.y);
      }
      portals.push_back({*portal, std::move(footprint)});
    }
    return portals;
  }

  static bool isLiftDoor(const std::string& model) {
    return model.find("elevator") != std::string::npos && model.ends_with("_door");
  }

  void addRoom(int storey, Polygon outline, RoomUse use, const std::string& label) {
    building_.rooms.push_back({.id = idOf('r', storey, countOn(building_.rooms, storey)),
                               .storey = storey,
                               .label = label,
                               .use = use,
                               .outline = std::move(outline)});
  }

  int roomBeside(const Door& door, double offset) const {
    const auto beside = door.pose * geometry::Pose2{offset, 0.0, 0.0};
    return roomAt(building_, door.storey, {beside.x, beside.y});
  }

  /// Between the faces of the rooms' walls, the pose in their middle.
  void fitIntoWall(Door& door) const {
    constexpr double kStep = 0.005;
    constexpr double kReach = 0.5;
    std::array<double, 2> faces{-kReach, kReach};
    for (const std::size_t side : {0U, 1U}) {
      const double sign = side == 0 ? -1.0 : 1.0;
      for (double reach = 0.0; reach < kReach; reach += kStep) {
        if (roomBeside(door, sign * reach) == kOutside) continue;
        faces[side] = sign * reach;
        break;
      }
    }
    if (door.rooms[0] == kOutside) faces[0] = -faces[1];
    if (door.rooms[1] == kOutside) faces[1] = -faces[0];
    door.wallThickness = faces[1] - faces[0];
    door.pose = door.pose * geometry::Pose2{(faces[0] + faces[1]) / 2.0, 0.0, 0.0};
  }

  void addDoor(int storey, const FramedOpening& opening) {
    constexpr double kBeside = 0.3;
    Door door{.id = idOf('d', storey, countOn(building_.doors, storey)),
              .storey = storey,
              .pose = opening.pose,
              .width = opening.width,
              .height = opening.height,
              .leaves = opening.width >= kDoubleDoor ? 2 : 1};
    door.rooms = {roomBeside(door, -kBeside), roomBeside(door, kBeside)};
    if (door.rooms[0] == door.rooms[1]) {
      building_.remarks.push_back("a door frame on storey " + std::to_string(storey) + " divides nothing: no door");
      return;
    }
    fitIntoWall(door);
    building_.doors.push_back(std::move(door));
  }

  void addLift(int storey, const LiftPortal& portal) {
    addCabin(meshOf(storey), portal);
    const Polygon cabin = cabinOf(portal);
    const Eigen::Vector2d middle = (cabin[0] + cabin[2]) / 2.0;
    const int room = roomAt(building_, storey, middle);
    building_.doors.push_back({.id = idOf('d', storey, countOn(building_.doors, storey)),
                               .storey = storey,
                               .rooms = {roomAt(building_, storey, beside(portal.pose, -0.3)), room},
                               .pose = portal.pose,
                               .width = portal.width,
                               .height = portal.height,
                               .wallThickness = portal.wallThickness,
                               .leaves = 2});
    const auto isBelow = [&](const Lift& lift) { return contains(lift.outline, middle); };
    auto lift = std::ranges::find_if(building_.lifts, isBelow);
    if (lift == building_.lifts.end()) {
      building_.lifts.push_back({.id = "l" + std::to_string(building_.lifts.size()), .outline = cabin});
      lift = std::prev(building_.lifts.end());
      lift->rooms.resize(storeys_.size(), kOutside);
    }
    lift->rooms[static_cast<std::size_t>(storey)] = room;
  }

  static Eigen::Vector2d beside(const geometry::Pose2& pose, double offset) {
    const auto moved = pose * geometry::Pose2{offset, 0.0, 0.0};
    return {moved.x, moved.y};
  }

  void placeStairs() {
    constexpr double kBefore = 0.3;
    std::vector<std::size_t> counts(storeys_.size());
    for (auto& stairs : building_.stairs) {
      const Eigen::Vector2d uphill(std::cos(stairs.direction), std::sin(stairs.direction));
      const Eigen::Vector2d foot = stairs.foot.head<2>() - kBefore * uphill;
      const Eigen::Vector2d head = headOf(stairs).head<2>() + (stairs.stepDepth + kBefore) * uphill;
      stairs.rooms = {roomAt(building_, stairs.lowerStorey, foot), roomAt(building_, stairs.upperStorey, head)};
      const int storey = std::max(stairs.lowerStorey, 0);
      stairs.id = idOf('s', storey, counts[static_cast<std::size_t>(storey)]++);
      for (const int room : stairs.rooms) {
        if (room == kOutside) continue;
        building_.rooms[static_cast<std::size_t>(room)].label = "STAIRS";
        building_.rooms[static_cast<std::size_t>(room)].use = RoomUse::kStairs;
      }
    }
  }

  /// By height: storeys.size() where it is above all that are wanted; none of a height that cannot be.
  std::optional<int> storeyOf(const WorldModel& model) const {
    constexpr double kBelow = 0.5;
    constexpr double kTallestBuilding = 500.0;
    const double z = model.T_world_model.translation().z() - lowestFloor_;
    if (z < -kBelow || z > kTallestBuilding) return std::nullopt;
    const auto& highest = building_.storeys.back();
    if (z > highest.floor_z + highest.ceilingHeight) return static_cast<int>(storeys_.size());
    const auto isAbove = [&](const Storey& storey) { return storey.floor_z - kBelow > z; };
    return static_cast<int>(std::ranges::find_if(building_.storeys, isAbove) - building_.storeys.begin()) - 1;
  }

  /// Furniture and people.
  void placeModels() {
    std::vector<std::vector<Segment>> walls;
    for (const auto& mesh : storeys_) walls.push_back(sliceOf(mesh, "wall", kSliceHeight));
    std::set<std::string> unknown;
    int last = 0;
    bool furnishes = false;
    for (std::size_t i = 0; i < world_.models.size(); ++i) {
      const auto& model = world_.models[i];
      if (isPassedOver(model.model) || std::ranges::binary_search(storeyModels_, i)) continue;
      const StandIn* standIn = findStandIn(model.model);
      if (standIn == nullptr) {
        unknown.insert(model.model);
        continue;
      }
      // A height that cannot be is that of the models listed before.
      const auto storey = storeyOf(model);
      last = storey.value_or(last);
      if (last == static_cast<int>(storeys_.size())) continue;  // not wanted
      auto T_world_model = model.T_world_model;
      T_world_model.translation().z() -= lowestFloor_;
      if (!storey) {
        T_world_model.translation().z() = meshOf(last).floor();
        building_.remarks.push_back(model.name + " lies at z = " + heightText(model) + ": put on the floor of storey " +
                                    std::to_string(last));
      }
      addStandIn(*standIn, last, T_world_model, walls[static_cast<std::size_t>(last)], building_);
      furnishes = true;
    }
    for (const auto& model : unknown)
      building_.remarks.push_back(model + " has neither a mesh nor a stand-in: left out");
    // A world says little of what hangs and stands about in corridors: boards, posters, cupboards, ramps.
    for (auto& room : building_.rooms) room.furnished = furnishes && room.use != RoomUse::kCorridor;
  }

  static std::string heightText(const WorldModel& model) {
    return std::to_string(std::lround(model.T_world_model.translation().z())) + " m";
  }

  /// Light and ground, and parts of lifts that their cabins show.
  static bool isPassedOver(const std::string& model) {
    return model == "sun" || model == "ground_plane" || model.find("elevator") != std::string::npos;
  }

  /// Corridors have many doors, halls are wide; what stands in a room names it.
  void nameRooms() {
    constexpr int kManyDoors = 4;
    constexpr double kLargeHall = 100.0;
    for (int i = 0; i < static_cast<int>(building_.rooms.size()); ++i) {
      auto& room = building_.rooms[static_cast<std::size_t>(i)];
      if (room.use != RoomUse::kRoom) continue;
      if (doorsOf(i) < kManyDoors) {
        room.label = labelByThings(building_, i);
        continue;
      }
      room.label = signedArea(room.outline) > kLargeHall && isWide(room.outline) ? "HALL" : "CORRIDOR";
      room.use = RoomUse::kCorridor;
    }
  }

  int doorsOf(int room) const {
    return static_cast<int>(std::ranges::count_if(
        building_.doors, [&](const Door& door) { return door.rooms[0] == room || door.rooms[1] == room; }));
  }

  /// Its area is more than that of a strip 3 m wide along half its outline.
  static bool isWide(const Polygon& outline) {
    double length = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) length += (outline[(i + 1) % outline.size()] - outline[i]).norm();
    return signedArea(outline) > 3.0 * length / 2.0;
  }

  /// The x-axis points from the room with more doors into the other one; leaves and states as in other buildings.
  void setDoors() {
    for (auto& door : building_.doors) {
      const bool endsOutside = door.rooms[1] == kOutside;
      if (door.rooms[0] != kOutside && (endsOutside || doorsOf(door.rooms[0]) >= doorsOf(door.rooms[1]))) continue;
      std::swap(door.rooms[0], door.rooms[1]);
      door.pose.theta = geometry::normalizeAngle(door.pose.theta + std::numbers::pi);
    }
    hangLeaves(options_.seed, building_);
    setDoorStates(options_.seed, building_);
  }

  std::filesystem::path path_;
  WorldOptions options_;
  GazeboWorld world_;
  Building building_;
  std::vector<StoreyMesh> storeys_;
  std::vector<std::size_t> storeyModels_;
  double lowestFloor_ = 0.0;
};

}  // namespace

bool isWorld(const std::filesystem::path& world) {
  return std::filesystem::is_directory(world) ? !worldsIn(world).empty() : isGazeboWorld(world);
}

Building readWorld(const std::filesystem::path& world, const WorldOptions& options) {
  if (options.storeys < 0) {
    throw base::UsageError(base::expectedFound("storeys", "0 (all) or more", std::to_string(options.storeys)));
  }
  return WorldReader(worldFile(world, options.storeys), options).read();
}

}  // namespace prodomos::simulation
