// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/witness.hpp"

#include "prodomos/simulation/furniture.hpp"
#include "prodomos/simulation/person.hpp"
#include "prodomos/simulation/shell.hpp"

#include "simulation/shell/openings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace prodomos::simulation {

namespace {

constexpr double kLeastRange = 0.6;  // metres: nearer or farther, a detector has no use of it
constexpr double kMostRange = 4.5;
const double kLeastCosine = std::cos(75.0 * std::numbers::pi / 180.0);
constexpr double kVisibleShare = 0.8;
constexpr int kVisibleSteps = 3;
constexpr double kPassedDistance = 3.0;
constexpr int kAcross = 8;  // spots of a leaf
constexpr int kUp = 16;
constexpr double kPlaneSpacing = 0.25;  // metres between spots of a plane

struct Spot {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

Eigen::Vector2d direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Eigen::Vector3d at(const Eigen::Vector2d& point, double z) {
  return {point.x(), point.y(), z};
}

std::vector<Spot> spotsOfRectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, double height) {
  std::vector<Spot> spots;
  const Eigen::Vector3d normal = along.cross(Eigen::Vector3d::UnitZ()).normalized();
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kUp; ++j) {
      spots.push_back({corner + along * ((i + 0.5) / kAcross) + at({0.0, 0.0}, height * (j + 0.5) / kUp), normal});
    }
  }
  return spots;
}

/// Spots of the leaves at that angle, always as many in the same order; of a doorway those of its opening.
std::vector<Spot> spotsOf(const Door& door, double leafOffset, double floor_z, double angle) {
  const auto T_world_door = geometry::toPose3(door.pose, floor_z);
  const auto hinges = hingesOf(door);
  if (hinges.empty()) {
    const Eigen::Vector3d along = T_world_door.linear() * at({0.0, door.width}, 0.0);
    return spotsOfRectangle(T_world_door.translation() - along / 2.0, along, door.height);
  }
  std::vector<Spot> spots;
  for (const auto& hinge : hinges) {
    const double closed = hinge.y_in_door > 0.0 ? -1.0 : 1.0;  // the way from the hinge to the other edge
    const Eigen::Vector2d along = Eigen::Rotation2Dd(hinge.turn * angle) * Eigen::Vector2d(0.0, closed);
    for (const auto& spot : spotsOfRectangle(T_world_door * at({leafOffset, hinge.y_in_door}, 0.0),
                                             T_world_door.linear() * at(along * leafWidthOf(door), 0.0), door.height)) {
      spots.push_back(spot);
    }
  }
  return spots;
}

/// Spots of a step's riser, of the tread above it and of its two ends: as many of each, normals to the side that is
/// seen.
std::array<std::vector<Spot>, Witness::kStepParts> spotsOfStep(const Staircase& stairs, int step) {
  const Eigen::Vector3d uphill = at(direction(stairs.direction), 0.0);
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(uphill);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d edge = stairs.foot + uphill * stairs.stepDepth * step + up * stairs.stepHeight * step;
  std::array<std::vector<Spot>, Witness::kStepParts> parts;
  for (int i = 0; i < kAcross; ++i) {
    const double share = (i + 0.5) / kAcross;
    for (const double other : {0.25, 0.75}) {
      const Eigen::Vector3d across = edge + left * stairs.width * (share - 0.5);
      parts[0].push_back({across + up * stairs.stepHeight * other, -uphill});
      parts[1].push_back({across + uphill * stairs.stepDepth * other + up * stairs.stepHeight, up});
      // The triangle below the tread and behind the riser: what tells steps from a slope to who stands beside them.
      const Eigen::Vector3d below =
          edge + uphill * stairs.stepDepth * share + up * stairs.stepHeight * (1.0 - other * (1.0 - share));
      parts[2].push_back({below + left * stairs.width / 2.0, left});
      parts[3].push_back({below - left * stairs.width / 2.0, -left});
    }
  }
  return parts;
}

template <typename Seen>
double shareOf(const Seen& seen) {
  return static_cast<double>(std::ranges::count(seen, true)) / static_cast<double>(seen.size());
}

void note(evaluation::Sighting& sighting, double share, bool isVisible, base::Time time) {
  sighting.share = share;
  if (isVisible && !sighting.visible) sighting.since = time;
  sighting.visible = isVisible;
}

/// The storey that one stands on whose feet are at that height.
int storeyAt(const Building& building, double z) {
  int storey = 0;
  for (std::size_t i = 1; i < building.storeys.size(); ++i) {
    if (z > building.storeys[i].floor_z - 0.5) storey = static_cast<int>(i);
  }
  return storey;
}

std::vector<evaluation::TrueDoorState> statesOf(const Door& door, base::Time begin) {
  // Between two swings the angle is linear: the state changes at the swings' times or where a threshold is crossed.
  std::vector<double> times{0.0};
  for (std::size_t i = 0; i < door.swings.size(); ++i) {
    times.push_back(door.swings[i].time);
    if (i == 0) continue;
    const auto& a = door.swings[i - 1];
    const auto& b = door.swings[i];
    for (const double degrees : {5.0, 60.0}) {
      const double share = (degrees * std::numbers::pi / 180.0 - a.angle) / (b.angle - a.angle);
      if (share > 0.0 && share < 1.0) times.push_back(a.time + share * (b.time - a.time));
    }
  }
  std::ranges::sort(times);
  std::vector<evaluation::TrueDoorState> states;
  for (const double time : times) {
    if (time < 0.0) continue;
    const double after = openingAngle(door, time + 1e-6);
    const auto state = door.leaves == 0 ? map::DoorState::kOpen : stateOf(after);
    if (states.empty() || states.back().state != state) {
      states.push_back({.time = begin + base::fromSeconds(time), .angle = after, .state = state});
    }
  }
  return states;
}

std::string roomId(const Building& building, int room) {
  return room == kOutside ? "" : building.rooms[static_cast<std::size_t>(room)].id;
}

std::string_view toString(RoomUse use) {
  switch (use) {
    case RoomUse::kRoom:
      return "room";
    case RoomUse::kCorridor:
      return "corridor";
    case RoomUse::kStairs:
      return "stairs";
    case RoomUse::kLift:
      return "lift";
  }
  return "";
}

evaluation::TruePlane wallOf(const Room& room, std::size_t edge, const Storey& storey) {
  // The outline runs counter-clockwise, with the room on its left: along the edge run back, x and up turn inwards.
  const auto& a = room.outline[(edge + 1) % room.outline.size()];
  const auto& b = room.outline[edge];
  const Eigen::Vector2d along = (b - a).normalized();
  evaluation::TruePlane plane{
      .id = room.id + ".wall" + std::to_string(edge), .classId = classId("wall"), .storey = room.storey};
  plane.T_world_plane.linear().col(0) = at(along, 0.0);
  plane.T_world_plane.linear().col(1) = Eigen::Vector3d::UnitZ();
  plane.T_world_plane.linear().col(2) = Eigen::Vector3d(along.y(), -along.x(), 0.0);
  plane.T_world_plane.translation() = at(a, storey.floor_z);
  plane.outline_in_plane = {
      {0.0, 0.0}, {(b - a).norm(), 0.0}, {(b - a).norm(), storey.ceilingHeight}, {0.0, storey.ceilingHeight}};
  return plane;
}

evaluation::TruePlane floorOrCeilingOf(const Room& room, const Storey& storey, bool isFloor) {
  evaluation::TruePlane plane{.id = room.id + (isFloor ? ".floor" : ".ceiling"),
                              .classId = classId(isFloor ? "floor" : "ceiling"),
                              .storey = room.storey};
  // A ceiling's axes: x stays, the normal points down.
  if (!isFloor) plane.T_world_plane.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  plane.T_world_plane.translation().z() = storey.floor_z + (isFloor ? 0.0 : storey.ceilingHeight);
  for (const auto& corner : room.outline)
    plane.outline_in_plane.emplace_back(corner.x(), isFloor ? corner.y() : -corner.y());
  return plane;
}

std::vector<evaluation::TruePlane> planesOf(const Building& building) {
  std::vector<evaluation::TruePlane> planes;
  for (const auto& room : building.rooms) {
    const auto& storey = building.storeys[static_cast<std::size_t>(room.storey)];
    planes.push_back(floorOrCeilingOf(room, storey, true));
    planes.push_back(floorOrCeilingOf(room, storey, false));
    for (std::size_t edge = 0; edge < room.outline.size(); ++edge) {
      if (!isSlit(room.outline, edge)) planes.push_back(wallOf(room, edge, storey));
    }
  }
  return planes;
}

evaluation::TrueDoor truthOf(const Building& building, std::size_t index, base::Time begin, std::uint64_t seed) {
  const auto& door = building.doors[index];
  return {.id = door.id,
          .instance = doorInstance(index),
          .storey = door.storey,
          .rooms = {roomId(building, door.rooms[0]), roomId(building, door.rooms[1])},
          .T_world_door = geometry::toPose3(door.pose, building.storeys[static_cast<std::size_t>(door.storey)].floor_z),
          .width = door.width,
          .height = door.height,
          .wallThickness = door.wallThickness,
          .leafOffset = leafOffset(building, index, seed),
          .leaves = door.leaves,
          .hingeSide = door.leaves == 1 ? door.hingeSide : map::HingeSide::kUnknown,
          .states = statesOf(door, begin)};
}

evaluation::TrueStaircase truthOf(const Building& building, std::size_t index) {
  const auto& stairs = building.stairs[index];
  return {.id = stairs.id,
          .instance = stairsInstance(building, index),
          .storeys = {stairs.lowerStorey, stairs.upperStorey},
          .rooms = {roomId(building, stairs.rooms[0]), roomId(building, stairs.rooms[1])},
          .foot = stairs.foot,
          .head = headOf(stairs),
          .direction = stairs.direction,
          .width = stairs.width,
          .stepDepth = stairs.stepDepth,
          .stepHeight = stairs.stepHeight,
          .stepCount = stairs.stepCount};
}

}  // namespace

evaluation::Truth truthOf(const Building& building, base::Time begin, std::uint64_t seed) {
  evaluation::Truth truth{.building = building.name, .seed = seed, .classes = classTable()};
  for (const auto& storey : building.storeys) truth.storeys.push_back({storey.floor_z, storey.ceilingHeight});
  for (const auto& room : building.rooms) {
    truth.rooms.push_back({.id = room.id,
                           .storey = room.storey,
                           .label = room.label,
                           .use = std::string(toString(room.use)),
                           .outline = room.outline});
  }
  for (std::size_t i = 0; i < building.doors.size(); ++i) truth.doors.push_back(truthOf(building, i, begin, seed));
  for (std::size_t i = 0; i < building.stairs.size(); ++i) truth.stairs.push_back(truthOf(building, i));
  for (std::size_t i = 0; i < building.things.size(); ++i) {
    const auto& thing = building.things[i];
    const auto* kind = findThingKind(thing.kind);
    truth.objects.push_back({.id = thing.id,
                             .instance = thingInstance(building, i),
                             .classId = kind == nullptr ? 0 : classId(kind->className),
                             .storey = thing.storey,
                             .mobility = thing.mobility,
                             .size = thing.size,
                             .poses = {{begin, thing.T_world_thing}}});
  }
  for (std::size_t i = 0; i < building.people.size(); ++i) {
    truth.people.push_back({.id = building.people[i].id, .instance = personInstance(building, i)});
  }
  for (const auto& lift : building.lifts) {
    evaluation::TrueLift trueLift{.id = lift.id, .outline = lift.outline};
    for (const int room : lift.rooms) trueLift.rooms.push_back(roomId(building, room));
    truth.lifts.push_back(std::move(trueLift));
  }
  truth.planes = planesOf(building);
  return truth;
}

/// Where in the image a spot would be, and how far.
struct Witness::View {
  const Rendering& rendering;
  const CameraModel& camera;
  Eigen::Vector3d eye;
  geometry::Pose3 T_camera_world;
  int storey;

  struct Pixel {
    int x, y;
    double depth;  ///< of the spot, along the camera's z
  };

  /// None where the spot is out of the image, too near or far, or seen too obliquely.
  std::optional<Pixel> pixelOf(const Spot& spot) const {
    const Eigen::Vector3d ray = spot.point - eye;
    const double distance = ray.norm();
    if (distance < kLeastRange || distance > kMostRange) return std::nullopt;
    if (std::abs(spot.normal.dot(ray)) < kLeastCosine * distance) return std::nullopt;
    const Eigen::Vector3d spot_in_camera = T_camera_world * spot.point;
    if (spot_in_camera.z() <= 0.0) return std::nullopt;
    const Eigen::Vector2d pixel = project(camera, spot_in_camera);
    const int x = static_cast<int>(std::lround(pixel.x()));
    const int y = static_cast<int>(std::lround(pixel.y()));
    if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) return std::nullopt;
    return Pixel{x, y, spot_in_camera.z()};
  }

  bool shows(const Spot& spot, std::uint16_t instance) const {
    const auto pixel = pixelOf(spot);
    return pixel && rendering.instances(pixel->x, pixel->y) == instance;
  }

  bool showsClass(const Spot& spot, int classId) const {
    const auto pixel = pixelOf(spot);
    return pixel && rendering.classes(pixel->x, pixel->y) == classId &&
           std::abs(rendering.depth(pixel->x, pixel->y) - pixel->depth) < 0.02 + 0.01 * pixel->depth;
  }

  /// The face itself, not the far side of the flight. By class, for steps of imported meshes are of no instance.
  bool showsStep(const Spot& spot) const {
    return spot.normal.dot(eye - spot.point) > 0.0 && showsClass(spot, simulation::classId("stairs"));
  }

  /// Nothing stands between the camera and the spot.
  bool looksThrough(const Spot& spot) const {
    const auto pixel = pixelOf(spot);
    if (!pixel) return false;
    const double depth = rendering.depth(pixel->x, pixel->y);
    return depth == 0.0 || depth > pixel->depth - 0.05;
  }
};

Witness::Witness(const Building& building, const CameraModel& camera, evaluation::Truth& truth)
    : building_(building),
      camera_(camera),
      truth_(truth),
      pixelArea_(camera.width, camera.height),
      instanceCount_(personInstance(building, building.people.size())) {
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      // What is seen through a pixel is smaller towards the corners, by the length of its ray.
      const double ray = directionThrough(camera, {x, y}).norm();
      pixelArea_(x, y) = static_cast<float>(1.0 / (camera.intrinsics.fx * camera.intrinsics.fy * ray));
    }
  }
  for (const auto& door : building.doors) {
    leafIsSeen_.emplace_back(std::max<std::size_t>(1, hingesOf(door).size()) * kAcross * kUp, false);
  }
  for (const auto& stairs : building.stairs) {
    stepIsSeen_.emplace_back();
    for (int step = 0; step < stairs.stepCount; ++step) {
      const std::vector<bool> nothing(std::size_t{2} * kAcross, false);
      stepIsSeen_.back().emplace_back().fill(nothing);
    }
  }
  for (const auto& plane : truth.planes) planes_.push_back(samplesOf(plane));
}

Witness::SampledPlane Witness::samplesOf(const evaluation::TruePlane& plane) {
  SampledPlane sampled;
  Eigen::AlignedBox2d box;
  for (const auto& corner : plane.outline_in_plane) box.extend(corner);
  for (double x = box.min().x() + kPlaneSpacing / 2.0; x < box.max().x(); x += kPlaneSpacing) {
    for (double y = box.min().y() + kPlaneSpacing / 2.0; y < box.max().y(); y += kPlaneSpacing) {
      if (contains(plane.outline_in_plane, {x, y}))
        sampled.points.push_back(plane.T_world_plane * Eigen::Vector3d(x, y, 0.0));
    }
  }
  for (const auto& point : sampled.points) sampled.box.extend(point);
  sampled.isSeen.resize(sampled.points.size(), false);
  return sampled;
}

void Witness::walk(base::Time time, const geometry::Pose3& T_world_body) {
  truth_.trajectory.push_back({time, T_world_body});
  const int storey = storeyAt(building_, T_world_body.translation().z());
  const Eigen::Vector2d position = T_world_body.translation().head<2>();
  const int room = roomAt(building_, storey, position);
  if (room == kOutside) return;
  auto& entered = truth_.rooms[static_cast<std::size_t>(room)].entered;
  if (!entered) entered = time;
  for (std::size_t i = 0; i < building_.doors.size(); ++i) {
    const auto& door = building_.doors[i];
    if (door.storey != storey || (door.rooms[0] != room && door.rooms[1] != room)) continue;
    if ((Eigen::Vector2d(door.pose.x, door.pose.y) - position).norm() < kPassedDistance) {
      truth_.doors[i].sighting.passed = true;
    }
  }
  for (std::size_t i = 0; i < building_.stairs.size(); ++i) {
    const auto& stairs = building_.stairs[i];
    const bool atFoot = stairs.rooms[0] == room && (stairs.foot.head<2>() - position).norm() < kPassedDistance;
    const bool atHead = stairs.rooms[1] == room && (headOf(stairs).head<2>() - position).norm() < kPassedDistance;
    if (atFoot || atHead) truth_.stairs[i].sighting.passed = true;
  }
}

void Witness::look(base::Time time, double seconds, const geometry::Pose3& T_world_camera, const Rendering& rendering) {
  const View view{.rendering = rendering,
                  .camera = camera_,
                  .eye = T_world_camera.translation(),
                  .T_camera_world = T_world_camera.inverse(),
                  .storey = storeyAt(building_, T_world_camera.translation().z() - 0.5)};
  for (std::size_t door = 0; door < building_.doors.size(); ++door) lookAtDoor(door, time, seconds, view);
  for (std::size_t flight = 0; flight < building_.stairs.size(); ++flight) lookAtFlight(flight, time, view);
  lookAtPlanes(view);
  countPixels(time, seconds, view);
}

void Witness::lookAtDoor(std::size_t index, base::Time time, double seconds, const View& view) {
  const auto& door = building_.doors[index];
  const Eigen::Vector2d toDoor = Eigen::Vector2d(door.pose.x, door.pose.y) - view.eye.head<2>();
  if (door.storey != view.storey || toDoor.norm() > kMostRange + door.width) return;
  const double floor_z = building_.storeys[static_cast<std::size_t>(door.storey)].floor_z;
  const auto spots = spotsOf(door, truth_.doors[index].leafOffset, floor_z, openingAngle(door, seconds));
  std::vector<bool> here(spots.size());
  for (std::size_t i = 0; i < spots.size(); ++i) {
    here[i] = door.leaves == 0 ? view.looksThrough(spots[i]) : view.shows(spots[i], doorInstance(index));
    if (here[i]) leafIsSeen_[index][i] = true;
  }
  auto& sighting = truth_.doors[index].sighting;
  const double share = shareOf(leafIsSeen_[index]);
  note(sighting, share, share >= kVisibleShare, time);
  if (shareOf(here) >= kVisibleShare) sighting.images.push_back(time);
}

void Witness::lookAtFlight(std::size_t index, base::Time time, const View& view) {
  const auto& stairs = building_.stairs[index];
  const Eigen::Vector3d middle = (stairs.foot + headOf(stairs)) / 2.0;
  if ((middle - view.eye).norm() > kMostRange + (headOf(stairs) - stairs.foot).norm() / 2.0 + stairs.width) return;
  int stepsSeen = 0;
  int stepsHere = 0;
  for (int step = 0; step < stairs.stepCount; ++step) {
    const auto parts = spotsOfStep(stairs, step);
    bool isSeen = false;
    bool isHere = false;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      auto& seen = stepIsSeen_[index][static_cast<std::size_t>(step)][part];
      std::vector<bool> here(seen.size());
      for (std::size_t i = 0; i < here.size(); ++i) {
        here[i] = view.showsStep(parts[part][i]);
        if (here[i]) seen[i] = true;
      }
      isSeen = isSeen || shareOf(seen) >= 0.5;
      isHere = isHere || shareOf(here) >= 0.5;
    }
    stepsSeen += isSeen ? 1 : 0;
    stepsHere += isHere ? 1 : 0;
  }
  auto& sighting = truth_.stairs[index].sighting;
  note(sighting, static_cast<double>(stepsSeen) / stairs.stepCount, stepsSeen >= kVisibleSteps, time);
  if (stepsHere >= kVisibleSteps) sighting.images.push_back(time);
}

void Witness::lookAtPlanes(const View& view) {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    auto& plane = planes_[i];
    if (plane.box.exteriorDistance(view.eye) > kMostRange) continue;
    const Eigen::Vector3d normal = truth_.planes[i].T_world_plane.linear().col(2);
    for (std::size_t j = 0; j < plane.points.size(); ++j) {
      if (plane.isSeen[j] || !view.showsClass({plane.points[j], normal}, truth_.planes[i].classId)) continue;
      plane.isSeen[j] = true;
      truth_.planes[i].seen += kPlaneSpacing * kPlaneSpacing;
    }
  }
}

void Witness::countPixels(base::Time time, double seconds, const View& view) {
  const auto& rendering = view.rendering;
  struct Seen {
    int pixels = 0;
    double area = 0.0;  // m²
  };
  std::vector<Seen> seen(instanceCount_);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const auto instance = rendering.instances(x, y);
      if (instance == 0) continue;
      const double depth = rendering.depth(x, y);
      ++seen[instance].pixels;
      seen[instance].area += depth * depth * pixelArea_(x, y) / std::max(0.1F, rendering.cosine(x, y));
    }
  }
  for (auto& object : truth_.objects) {
    object.seen = std::max(object.seen, seen[object.instance].area);
  }
  for (std::size_t i = 0; i < building_.people.size(); ++i) {
    const auto& person = building_.people[i];
    const auto state = stateOf(person, building_.storeys[static_cast<std::size_t>(person.storey)].floor_z, seconds);
    truth_.people[i].states.push_back({.time = time,
                                       .position = state.position,
                                       .heading = state.heading,
                                       .velocity = state.velocity,
                                       .joints = state.joints,
                                       .pixels = seen[truth_.people[i].instance].pixels});
  }
}

}  // namespace prodomos::simulation
