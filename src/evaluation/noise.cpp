// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/noise.hpp"

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/geometry/grid_index.hpp"
#include "prodomos/map/point_layer.hpp"

#include "evaluation/true_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace prodomos::evaluation {

namespace {

/// Of a person, with its arms and strides.
constexpr double kBodyRadius = 0.5;  // metres
constexpr double kBodyHeight = 2.0;  // metres

/// Poses of one thing that are no farther apart take the same space.
constexpr double kSamePlace = 0.05;   // metres
constexpr double kSameHeading = 0.1;  // radians

/// A rectangle or a disc on the floor, with what is there from one height to another.
struct Shape {
  geometry::Pose2 pose_in_world;
  Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< of the rectangle
  double radius = 0.0;                             ///< of the disc; 0: a rectangle
  double lowest = 0.0;                             ///< above the floor, metres
  double highest = std::numeric_limits<double>::infinity();
  Matter matter = Matter::kStructure;

  double reach() const { return radius > 0.0 ? radius : half.norm(); }
  bool covers(const Eigen::Vector2d& spot, double tolerance) const {
    const Eigen::Vector2d away = spot - Eigen::Vector2d(pose_in_world.x, pose_in_world.y);
    if (radius > 0.0) return away.norm() <= radius + tolerance;
    const Eigen::Vector2d spot_in_shape = Eigen::Rotation2Dd(-pose_in_world.theta) * away;
    return (spot_in_shape.cwiseAbs().array() <= half.array() + tolerance).all();
  }
};

double distanceToEdge(const Eigen::Vector2d& spot, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d edge = to - from;
  const double length2 = edge.squaredNorm();
  const double along = length2 == 0.0 ? 0.0 : std::clamp((spot - from).dot(edge) / length2, 0.0, 1.0);
  return (spot - from - along * edge).norm();
}

/// Deeper in the polygon than so many metres.
bool isInside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& spot, double depth) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    if (distanceToEdge(spot, a, b) <= depth) return false;
    if ((a.y() > spot.y()) != (b.y() > spot.y()) &&
        spot.x() < a.x() + (spot.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

/// The box as seen from above, its heights those above the floor.
Shape shapeOf(const TrueObject& object, const geometry::Pose3& T_world_object, double floorHeight, Matter matter) {
  const auto T_world_level = geometry::levelled(T_world_object);
  const Eigen::Matrix3d tilt = T_world_level.linear().transpose() * T_world_object.linear();
  const Eigen::Vector3d half = 0.5 * tilt.cwiseAbs() * object.size;
  const double middle = T_world_object.translation().z() - floorHeight;
  return {.pose_in_world = geometry::toPose2(T_world_object),
          .half = half.head<2>(),
          .lowest = middle - half.z(),
          .highest = middle + half.z(),
          .matter = matter};
}

bool isSamePlace(const geometry::Pose3& a, const geometry::Pose3& b) {
  return (a.translation() - b.translation()).norm() < kSamePlace &&
         geometry::rotationAngle(a.inverse() * b) < kSameHeading;
}

/// Where it stood, the last place as structure.
std::vector<Shape> shapesOf(const TrueObject& object, double floorHeight) {
  std::vector<Shape> shapes;
  if (object.poses.empty()) return shapes;
  const auto& last = object.poses.back().T_world_object;
  shapes.push_back(shapeOf(object, last, floorHeight, Matter::kStructure));
  const geometry::Pose3* before = &last;
  for (const auto& pose : object.poses) {
    if (isSamePlace(pose.T_world_object, *before) || isSamePlace(pose.T_world_object, last)) continue;
    shapes.push_back(shapeOf(object, pose.T_world_object, floorHeight, Matter::kMovedThing));
    before = &pose.T_world_object;
  }
  return shapes;
}

/// Where it was, and where it was when the robot saw it last.
std::vector<Shape> shapesOf(const TruePerson& person, int storey, const Truth& truth) {
  std::vector<Shape> shapes;
  const auto add = [&](const TruePersonState& state, Matter matter) {
    if (storeyAt(truth, state.position.z()) != storey) return;
    shapes.push_back({.pose_in_world = {state.position.x(), state.position.y(), 0.0},
                      .radius = kBodyRadius,
                      .highest = kBodyHeight,
                      .matter = matter});
  };
  if (person.states.empty()) return shapes;
  const auto lastSeen = std::find_if(person.states.rbegin(), person.states.rend(),
                                     [](const TruePersonState& state) { return state.pixels > 0; });
  add(lastSeen == person.states.rend() ? person.states.back() : *lastSeen, Matter::kLastPerson);
  const TruePersonState* before = nullptr;
  for (const auto& state : person.states) {
    if (before != nullptr && (state.position - before->position).norm() < kSamePlace) continue;
    add(state, Matter::kPerson);
    before = &state;
  }
  return shapes;
}

bool hasTurned(const TrueDoor& door) {
  return door.leaves > 0 && door.states.size() > 1;
}

/// Leaves where they ended, and where they turned through.
std::vector<Shape> shapesOf(const TrueDoor& door) {
  std::vector<Shape> shapes;
  for (const auto& leaf : leavesAt(door, door.states.empty() ? 0.0 : door.states.back().angle)) {
    shapes.push_back({.pose_in_world = geometry::toPose2(leaf.T_frame_box),
                      .half = 0.5 * leaf.size.head<2>(),
                      .highest = door.height});
  }
  if (!hasTurned(door)) return shapes;
  for (const auto& hinge : hingesOf(door)) {
    shapes.push_back({.pose_in_world = geometry::toPose2(door.T_world_door) * hinge.T_door_hinge,
                      .radius = hinge.width,
                      .highest = door.height,
                      .matter = Matter::kDoorLeaf});
  }
  return shapes;
}

Shape shapeOf(const TrueStaircase& stairs) {
  const Eigen::Vector2d along = (stairs.head - stairs.foot).head<2>();
  const Eigen::Vector2d middle = stairs.foot.head<2>() + 0.5 * along;
  return {.pose_in_world = {middle.x(), middle.y(), stairs.direction},
          .half = {0.5 * along.norm(), 0.5 * stairs.width}};
}

}  // namespace

/// One storey's rooms and shapes, found by buckets.
class TrueSpace::Storey {
 public:
  Storey(const Truth& truth, int storey, double tolerance)
      : tolerance_(tolerance), ceilingHeight_(truth.storeys[static_cast<std::size_t>(storey)].ceilingHeight) {
    const double floorHeight = truth.storeys[static_cast<std::size_t>(storey)].floor_z;
    for (const auto& room : truth.rooms) {
      if (room.storey == storey) add(room.outline);
    }
    const auto addAll = [&](const std::vector<Shape>& shapes) {
      std::ranges::for_each(shapes, [&](auto& s) { add(s); });
    };
    for (const auto& object : truth.objects) {
      if (object.storey == storey) addAll(shapesOf(object, floorHeight));
    }
    for (const auto& door : truth.doors) {
      if (door.storey == storey) addAll(shapesOf(door));
    }
    for (const auto& stairs : truth.stairs) {
      if (std::ranges::find(stairs.storeys, storey) != stairs.storeys.end()) add(shapeOf(stairs));
    }
    for (const auto& person : truth.people) addAll(shapesOf(person, storey, truth));
  }

  Matter at(const Eigen::Vector2d& spot, double lowest, double highest) const {
    if (lowest <= tolerance_ || highest >= ceilingHeight_ - tolerance_) return Matter::kStructure;
    const auto bucket = buckets_.find(bucketOf(spot));
    if (bucket == buckets_.end()) return Matter::kStructure;
    const auto holds = [&](std::size_t room) { return isInside(rooms_[room], spot, tolerance_); };
    if (std::ranges::none_of(bucket->second.rooms, holds)) return Matter::kStructure;
    Matter matter = Matter::kFree;
    for (const auto index : bucket->second.shapes) {
      const auto& shape = shapes_[index];
      if (shape.matter >= matter || highest < shape.lowest - tolerance_ || lowest > shape.highest + tolerance_)
        continue;
      if (shape.covers(spot, tolerance_)) matter = shape.matter;
    }
    return matter;
  }

 private:
  static constexpr double kBucket = 1.0;  // metres

  struct Bucket {
    std::vector<std::size_t> rooms;
    std::vector<std::size_t> shapes;
  };

  static geometry::CellIndex bucketOf(const Eigen::Vector2d& spot) {
    return geometry::cellAt(spot.x(), spot.y(), kBucket);
  }

  void add(const std::vector<Eigen::Vector2d>& room) {
    if (room.empty()) return;
    Eigen::Vector2d least = room.front();
    Eigen::Vector2d most = room.front();
    for (const auto& corner : room) {
      least = least.cwiseMin(corner);
      most = most.cwiseMax(corner);
    }
    forBuckets(least, most, [&](Bucket& bucket) { bucket.rooms.push_back(rooms_.size()); });
    rooms_.push_back(room);
  }

  void add(const Shape& shape) {
    const Eigen::Vector2d middle(shape.pose_in_world.x, shape.pose_in_world.y);
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(shape.reach() + 2.0 * tolerance_);
    forBuckets(middle - reach, middle + reach, [&](Bucket& bucket) { bucket.shapes.push_back(shapes_.size()); });
    shapes_.push_back(shape);
  }

  template <typename Act>
  void forBuckets(const Eigen::Vector2d& least, const Eigen::Vector2d& most, const Act& act) {
    const auto first = bucketOf(least);
    const auto last = bucketOf(most);
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) act(buckets_[{x, y}]);
    }
  }

  double tolerance_;
  double ceilingHeight_;
  std::vector<std::vector<Eigen::Vector2d>> rooms_;
  std::vector<Shape> shapes_;
  std::map<geometry::CellIndex, Bucket> buckets_;
};

TrueSpace::TrueSpace(const Truth& truth, double tolerance) {
  for (int storey = 0; storey < std::ssize(truth.storeys); ++storey) storeys_.emplace_back(truth, storey, tolerance);
}

TrueSpace::~TrueSpace() = default;

Matter TrueSpace::at(int storey, const Eigen::Vector2d& spot_in_world, double lowest, double highest) const {
  if (storey < 0 || storey >= std::ssize(storeys_)) return Matter::kStructure;
  return storeys_[static_cast<std::size_t>(storey)].at(spot_in_world, lowest, highest);
}

namespace {

std::vector<base::SubMapId> subMapsOf(const std::map<base::SubMapId, geometry::Pose3>& T_world_submap,
                                      const Truth& truth, int storey) {
  std::vector<base::SubMapId> found;
  for (const auto& [id, pose] : T_world_submap) {
    if (storeyAt(truth, pose.translation().z()) == storey) found.push_back(id);
  }
  return found;
}

void countCells(const map::OccupancyGrid& grid, const TrueSpace& space, int storey, NoiseScore& score) {
  const auto& band = grid.config().heightBand;
  const auto box = grid.box();
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const auto state = grid.state({x, y});
      if (state == map::CellState::kUnknown) continue;
      const Eigen::Vector2d spot(geometry::cellCentre(x, grid.resolution()),
                                 geometry::cellCentre(y, grid.resolution()));
      const auto matter = space.at(storey, spot, band.least, band.most);
      if (matter > Matter::kLastPerson) ++score.freeFloor;
      if (state == map::CellState::kOccupied) score.cells->add(matter);
    }
  }
}

/// Is there such a cell within so many metres?
bool isNear(const map::OccupancyGrid& grid, const Eigen::Vector2d& spot, double distance, map::CellState state) {
  const auto middle = grid.cellAt(spot);
  const int reach = static_cast<int>(std::ceil(distance / grid.resolution()));
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (std::hypot(x, y) * grid.resolution() <= distance && grid.state({middle.x + x, middle.y + y}) == state) {
        return true;
      }
    }
  }
  return false;
}

bool isInDoor(const Truth& truth, int storey, const Eigen::Vector2d& spot) {
  constexpr double kFrame = 0.15;  // metres, on either side
  return std::ranges::any_of(truth.doors, [&](const TrueDoor& door) {
    if (door.storey != storey) return false;
    const Eigen::Vector3d spot_in_door =
        door.T_world_door.inverse() * Eigen::Vector3d(spot.x(), spot.y(), door.T_world_door.translation().z());
    return std::abs(spot_in_door.x()) <= 0.5 * door.wallThickness + kFrame &&
           std::abs(spot_in_door.y()) <= 0.5 * door.width + kFrame;
  });
}

/// Walls with free floor before them: are they there?
void countWalls(const map::OccupancyGrid& grid, const Truth& truth, int storey, double tolerance, NoiseScore& score) {
  constexpr double kBefore = 0.3;  // metres into the room
  for (const auto& room : truth.rooms) {
    if (room.storey != storey) continue;
    for (std::size_t i = 0; i < room.outline.size(); ++i) {
      const Eigen::Vector2d edge = room.outline[(i + 1) % room.outline.size()] - room.outline[i];
      const double length = edge.norm();
      const Eigen::Vector2d into(-edge.y() / length, edge.x() / length);  // outlines go counter-clockwise
      for (double along = 0.5 * grid.resolution(); along < length; along += grid.resolution()) {
        const Eigen::Vector2d spot = room.outline[i] + along / length * edge;
        if (grid.state(grid.cellAt(spot + kBefore * into)) != map::CellState::kFree) continue;
        if (!isInside(room.outline, spot + kBefore * into, tolerance) || isInDoor(truth, storey, spot)) continue;
        ++score.walls;
        if (isNear(grid, spot, tolerance + grid.resolution(), map::CellState::kOccupied)) ++score.wallsKept;
      }
    }
  }
}

/// Each voxel once, however many sub-maps have it.
void countPoints(const map::MapView& view, const std::map<base::SubMapId, geometry::Pose3>& T_world_submap,
                 const Truth& truth, const TrueSpace& space, int storey, NoiseScore& score) {
  const double floorHeight = truth.storeys[static_cast<std::size_t>(storey)].floor_z;
  std::set<std::array<int, 3>> seen;
  for (const auto id : subMapsOf(T_world_submap, truth, storey)) {
    const auto layer = view.findLayer<map::PointLayer>(id);
    if (layer == nullptr) continue;
    if (!score.points) score.points.emplace();
    for (const auto& point : layer->points()) {
      const Eigen::Vector3d position = T_world_submap.at(id) * point.position_in_submap.cast<double>();
      const Eigen::Vector3d voxel = (position / layer->voxel()).array().floor();
      if (!seen.insert({static_cast<int>(voxel.x()), static_cast<int>(voxel.y()), static_cast<int>(voxel.z())})
               .second) {
        continue;
      }
      const double height = position.z() - floorHeight;
      score.points->add(space.at(storey, position.head<2>(), height, height));
    }
  }
}

}  // namespace

std::optional<map::OccupancyGrid> gridInWorld(const map::MapView& view, const Truth& truth, int storey) {
  std::optional<map::OccupancyGrid> merged;
  const auto T_world_submap = truthFromSubMaps(view, truth);
  for (const auto id : subMapsOf(T_world_submap, truth, storey)) {
    const auto grid = view.findLayer<map::OccupancyGrid>(id);
    if (grid == nullptr) continue;
    if (!merged) merged.emplace(grid->config());
    merged->merge(*grid, T_world_submap.at(id));
  }
  return merged;
}

NoiseScore scoreNoise(const map::MapView& view, const Truth& truth, const NoiseOptions& options) {
  NoiseScore score;
  score.hasPersons = !truth.people.empty();
  score.hasMovedThings = std::ranges::any_of(truth.objects, [](const auto& o) { return o.poses.size() > 1; });
  score.hasTurnedLeaves = std::ranges::any_of(truth.doors, hasTurned);
  const TrueSpace space(truth, options.tolerance);
  const auto T_world_submap = truthFromSubMaps(view, truth);
  for (int storey = 0; storey < std::ssize(truth.storeys); ++storey) {
    if (const auto grid = gridInWorld(view, truth, storey)) {
      if (!score.cells) score.cells.emplace();
      countCells(*grid, space, storey, score);
      countWalls(*grid, truth, storey, options.tolerance, score);
    }
    countPoints(view, T_world_submap, truth, space, storey, score);
  }
  return score;
}

void NoiseCounts::add(Matter matter) {
  ++occupied;
  switch (matter) {
    case Matter::kStructure:
      break;
    case Matter::kLastPerson:
      ++lastPersons;
      break;
    case Matter::kPerson:
      ++persons;
      break;
    case Matter::kMovedThing:
      ++movedThings;
      break;
    case Matter::kDoorLeaf:
      ++doorLeaves;
      break;
    case Matter::kFree:
      ++others;
      break;
  }
}

NoiseCounts& NoiseCounts::operator+=(const NoiseCounts& other) {
  occupied += other.occupied;
  lastPersons += other.lastPersons;
  persons += other.persons;
  movedThings += other.movedThings;
  doorLeaves += other.doorLeaves;
  others += other.others;
  return *this;
}

std::optional<double> NoiseScore::noiseShare() const {
  return cells ? shareOf(cells->noise(), freeFloor) : std::nullopt;
}

NoiseScore& NoiseScore::operator+=(const NoiseScore& other) {
  hasPersons |= other.hasPersons;
  hasMovedThings |= other.hasMovedThings;
  hasTurnedLeaves |= other.hasTurnedLeaves;
  const auto add = [](std::optional<NoiseCounts>& sum, const std::optional<NoiseCounts>& part) {
    if (part) (sum ? *sum : sum.emplace()) += *part;
  };
  add(cells, other.cells);
  add(points, other.points);
  freeFloor += other.freeFloor;
  walls += other.walls;
  wallsKept += other.wallsKept;
  return *this;
}

}  // namespace prodomos::evaluation
