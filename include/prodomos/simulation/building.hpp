// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/geometry/polygon.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/simulation/surface.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// A building one can know everything about. Frame `world`: metres, z up, the lowest floor at z = 0; angles in radians,
/// counter-clockwise seen from above; times in seconds from the log's first reading.
namespace prodomos::simulation {

using geometry::contains;
using geometry::Polygon;
using geometry::signedArea;

struct Storey {
  double floor_z = 0.0;
  double ceilingHeight = 2.8;  ///< above its floor
};

/// What a room is for, as far as it matters to robots and furniture.
enum class RoomUse { kRoom, kCorridor, kStairs, kLift };

struct Room {
  std::string id;
  int storey = 0;
  std::string label;  ///< as its source has it, upper case: "CLASSROOM"
  RoomUse use = RoomUse::kRoom;
  Polygon outline;         ///< the faces of its walls, simple, counter-clockwise; not closed
  bool furnished = false;  ///< its source says all that stands in it: furnish() adds nothing
};

inline constexpr int kOutside = -1;

/// How far a leaf stands open at one time; between two times it turns evenly, before the first and after the last it
/// rests.
struct Swing {
  double time = 0.0;
  double angle = 0.0;  ///< radians from closed; 0 … π/2 and a little more
};

/// An opening in a wall, with a leaf or none. Its x-axis is the normal of the closed leaf and points from rooms[0] into
/// rooms[1].
struct Door {
  std::string id;
  int storey = 0;
  std::array<int, 2> rooms{kOutside, kOutside};  ///< indices into Building::rooms
  geometry::Pose2 pose;                          ///< of the middle of the opening, in the middle of the wall
  double width = 0.9;                            ///< of the clear opening
  double height = 2.05;
  double wallThickness = 0.2;                        ///< between the faces of the two rooms
  int leaves = 1;                                    ///< 0: an open doorway or a passage; 2: a double door
  map::HingeSide hingeSide = map::HingeSide::kLeft;  ///< seen along the x-axis; of one leaf
  bool opensAlongNormal = true;                      ///< into rooms[1]
  std::vector<Swing> swings;                         ///< ascending in time; empty: always closed
};

/// A straight flight.
struct Staircase {
  std::string id;
  int lowerStorey = 0;  ///< -1: a storey below all others, of which nothing else is known; its foot is below z = 0
  int upperStorey = 1;  ///< storeys.size(): likewise above
  std::array<int, 2> rooms{kOutside, kOutside};    ///< that its foot and its head stand in
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< middle of the first riser's lower edge
  double direction = 0.0;                          ///< uphill
  double width = 1.2;
  double stepDepth = 0.29;
  double stepHeight = 0.17;
  int stepCount = 17;  ///< risers; its head is stepCount * stepHeight above the foot
};

/// A platform between two flights that go up to one storey.
struct Landing {
  int lowerStorey = 0;
  Polygon outline;
  double z = 0.0;  ///< of its top
};

/// Where a robot is carried from floor to floor.
struct Lift {
  std::string id;
  std::vector<int> rooms;  ///< its cabin or the spot before its doors, by storey: indices into Building::rooms
  Polygon outline;
};

/// Furniture, and whatever else stands or hangs about. Its parts are boxes (furniture.hpp) in an oriented box.
struct Thing {
  std::string id;
  std::string kind;  ///< "desk", "noticeboard", "ramp": what it looks like, and its class
  int storey = 0;
  geometry::Pose3 T_world_thing = geometry::Pose3::Identity();  ///< middle of the box; x-axis: its front
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  map::Mobility mobility = map::Mobility::kStatic;
};

/// A person's position on its way; it walks straight from one to the next, and stands where two are alike.
struct Waypoint {
  double time = 0.0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

struct Person {
  std::string id;
  int storey = 0;
  double height = 1.75;
  bool sits = false;          ///< at way[0], facing `heading`
  double heading = 0.0;       ///< of one who sits or has not walked yet
  std::vector<Waypoint> way;  ///< ascending in time; before the first it stands there, after the last likewise
  std::uint64_t look = 0;     ///< seed of its clothes and build
};

/// Light and colours of one seed.
struct Lighting {
  double brightness = 1.0;                         ///< of all lamps
  double ambient = 0.35;                           ///< share of light that comes from everywhere
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();  ///< of the light, by channel
  std::vector<Eigen::Vector3d> lamps;              ///< below the ceilings
};

/// Everything there is. Sources (floor_plan.hpp, scene_file.hpp, hospital.hpp) give rooms, openings and stairs;
/// furnish() adds what stands in them.
struct Building {
  std::string name;
  std::vector<Storey> storeys;
  std::vector<Room> rooms;
  std::vector<Door> doors;
  std::vector<Staircase> stairs;
  std::vector<Landing> landings;
  std::vector<Lift> lifts;
  std::vector<Thing> things;
  std::vector<Person> people;
  Lighting lighting;
  /// A source that brings meshes has its walls, floors and stairs here; of the others shell.hpp makes them.
  std::vector<Surface> imported;
  std::vector<sensors::Image<sensors::Rgb>> textures;  ///< that Material::texture names
  std::vector<std::string> remarks;                    ///< what of the source could not be had, and why
};

/// Numbers of things in instance images, by index: doors first, then stairs, things and people. 0 is none of them.
std::uint16_t doorInstance(std::size_t door);
std::uint16_t stairsInstance(const Building& building, std::size_t stairs);
std::uint16_t thingInstance(const Building& building, std::size_t thing);
std::uint16_t personInstance(const Building& building, std::size_t person);

/// Of all leaves of the door, radians.
double openingAngle(const Door& door, double time);
map::DoorState stateOf(double openingAngle);  ///< closed below 5°, ajar below 60°, else open

/// Whether one of its rooms is a lift's cabin: such a door is shut, and is no door to a detector of doors.
bool isLiftDoor(const Building& building, const Door& door);

Eigen::Vector3d headOf(const Staircase& stairs);

/// Index of the room of that storey that holds the point, or kOutside.
int roomAt(const Building& building, int storey, const Eigen::Vector2d& point);

/// By label: "CORRIDOR", "HALL", "LOBBY" and the like are corridors, "STAIRS", "ELEVATOR".
RoomUse useOfLabel(std::string_view label);

/// Does the edge from this corner run back beside another one, less than a millimetre off? So a room that goes round
/// others has what is inside joined with its outline: no wall stands there.
bool isSlit(const Polygon& polygon, std::size_t edge);
/// The first pair of edges that cross or touch apart from their shared corner, by their first corners.
std::optional<std::pair<std::size_t, std::size_t>> findSelfCrossing(const Polygon& polygon);

}  // namespace prodomos::simulation
