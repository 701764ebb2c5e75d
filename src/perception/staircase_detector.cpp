// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/staircase_detector.hpp"

#include "prodomos/base/random.hpp"

#include "perception/staircase_beside.hpp"
#include "perception/staircase_drawing.hpp"
#include "perception/staircase_lattice.hpp"
#include "perception/staircase_sighting.hpp"
#include "perception/staircase_steps.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace prodomos::perception {

namespace {

using geometry::Plane;
using geometry::Pose3;

constexpr int kTrials = 300;              // slopes drawn
constexpr std::size_t kJudges = 400;      // points that judge a slope
constexpr std::size_t kLeastPoints = 40;  // voxels, of a flight
constexpr int kMostSlopes = 4;            // looked into in a view
constexpr double kFlatness = 0.085;       // metres: half of what steps stand out of their slope, 002 §II-C
constexpr double kWallHeight = 0.33;      // metres; upright patches that are higher are no risers
constexpr double kTreadDepth = 0.55;      // metres; level patches that are broader both ways are no treads
constexpr double kFloorSkin = 0.03;       // metres
constexpr double kUpright = 1.05;         // radians of tilt: 60 degrees and more
constexpr double kLevel = 0.40;           // radians: 23 degrees; low, short treads are measured up to 19 off level
constexpr std::size_t kMostSteps = 10;    // more tell no more
constexpr double kBeside = 0.4;           // metres: what belongs to a flight that was found
constexpr double kBelow = 0.5;
constexpr double kRails = 1.4;
constexpr double kLeastSlope = 0.14;  // rise over run: 8 degrees
constexpr double kMostSlope = 1.2;    // 50 degrees

/// What of the view may belong to a flight.
struct Material {
  std::vector<StairCell> cells;   ///< all
  std::vector<StairCell> voxels;  ///< one a voxel
};

const sensors::DepthGrid::Cell& cellOf(const sensors::DepthGrid& grid, std::uint32_t index) {
  return grid.at(static_cast<int>(index) % grid.width(), static_cast<int>(index) / grid.width());
}

/// Walls, ceilings, floors, tables: whatever lies in patches that are no parts of steps nor of a slope.
bool isOfStairs(const PlanarPatch& patch, const Surfaces& surfaces, const Pose3& T_submap_camera) {
  const double tilt = patch.tilt();
  if (tilt < kUpright && patch.plane_in_submap.normal.z() < 0.0) return false;
  if (tilt > kLevel && tilt < kUpright) return true;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const std::uint32_t index : patch.cells) {
    const Eigen::Vector3d point = T_submap_camera * pointOf(cellOf(surfaces.depth, index));
    sum += point.head<2>();
    squares.noalias() += point.head<2>() * point.head<2>().transpose();
    least = std::min(least, point.z());
    most = std::max(most, point.z());
  }
  if (tilt >= kUpright) return most - least < kWallHeight;
  const auto count = static_cast<double>(patch.cells.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(squares / count - sum * sum.transpose() / (count * count));
  return std::sqrt(12.0 * std::max(axes.eigenvalues()[0], 0.0)) < kTreadDepth;
}

Material materialOf(const RgbdView& view, const Surfaces& surfaces) {
  const sensors::DepthGrid& grid = surfaces.depth;
  const std::size_t count = static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height());
  std::vector<bool> isOther(count, false);
  for (const PlanarPatch& patch : surfaces.patches) {
    if (isOfStairs(patch, surfaces, view.T_submap_camera)) continue;
    for (const std::uint32_t index : patch.cells) isOther[index] = true;
  }
  Material material;
  auto voxel = surfaces.voxels.begin();
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool isVoxel = voxel != surfaces.voxels.end() && *voxel == i;
    if (isVoxel) ++voxel;
    const sensors::DepthGrid::Cell& cell = cellOf(grid, i);
    if (isOther[i] || !(cell.depth > 0.0F)) continue;
    const StairCell stairCell{view.T_submap_camera * pointOf(cell),
                              sensors::depthSigma(static_cast<double>(cell.depth))};
    if (std::abs(stairCell.point_in_submap.z() - surfaces.floor_z) < kFloorSkin) continue;
    material.cells.push_back(stairCell);
    if (isVoxel) material.voxels.push_back(stairCell);
  }
  return material;
}

/// A plane with the slope of stairs, seen from above; z of its normal is positive.
bool isSlope(const Plane& plane, const Eigen::Vector3d& camera) {
  const double run = plane.normal.head<2>().norm();
  return run > kLeastSlope * plane.normal.z() && run < kMostSlope * plane.normal.z() &&
         plane.signedDistance(camera) > 0.0;
}

double slopeTolerance(const StairCell& cell) {
  return kFlatness + cell.sigma;
}

/// The slope that most voxels lie on, steps and all: RANSAC (002 §II-C).
std::optional<Plane> findSlope(const std::vector<StairCell>& voxels, const Eigen::Vector3d& camera,
                               base::Random& random) {
  if (voxels.size() < kLeastPoints) return std::nullopt;
  std::vector<std::array<float, 4>> judges;
  const std::size_t stride = voxels.size() / kJudges + 1;
  for (std::size_t i = 0; i < voxels.size(); i += stride) {
    const Eigen::Vector3f p = voxels[i].point_in_submap.cast<float>();
    judges.push_back({p.x(), p.y(), p.z(), static_cast<float>(slopeTolerance(voxels[i]))});
  }
  std::optional<Plane> best;
  std::size_t most = kLeastPoints / stride;
  const auto draw = [&] {
    return voxels[static_cast<std::size_t>(random.integer(0, static_cast<int>(voxels.size()) - 1))].point_in_submap;
  };
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d a = draw();
    const Eigen::Vector3d b = draw();
    const Eigen::Vector3d c = draw();
    Eigen::Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (!(length > 0.01)) continue;
    normal *= (normal.z() < 0.0 ? -1.0 : 1.0) / length;
    const Plane plane{normal, normal.dot(a)};
    if (!isSlope(plane, camera)) continue;
    const Eigen::Vector3f n = normal.cast<float>();
    const auto offset = static_cast<float>(plane.offset);
    std::size_t count = 0;
    for (const auto& p : judges) {
      count += std::abs(n.x() * p[0] + n.y() * p[1] + n.z() * p[2] - offset) < p[3] ? 1U : 0U;
    }
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

/// Voxels near the plane, and the plane fitted to them again.
std::vector<StairCell> slabOf(Plane& plane, const std::vector<StairCell>& voxels) {
  std::vector<StairCell> slab;
  for (int refit = 0; refit < 3; ++refit) {
    slab.clear();
    std::vector<Eigen::Vector3d> points;
    for (const StairCell& voxel : voxels) {
      if (std::abs(plane.signedDistance(voxel.point_in_submap)) > slopeTolerance(voxel)) continue;
      slab.push_back(voxel);
      points.push_back(voxel.point_in_submap);
    }
    const std::optional<Plane> fitted = geometry::fitPlane(points);
    if (!fitted) break;
    plane = fitted->normal.z() < 0.0 ? fitted->flipped() : *fitted;
  }
  return slab;
}

/// At the slab's centroid, x uphill: o = w·sgn(wᵀz) with w = (n × z) × n (002 §II-C), seen from above.
Pose3 flightFrame(const Plane& slope, const std::vector<StairCell>& slab) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const StairCell& cell : slab) centroid += cell.point_in_submap;
  centroid /= static_cast<double>(slab.size());
  centroid -= slope.signedDistance(centroid) * slope.normal;
  const Eigen::Vector3d n = slope.normal;
  const Eigen::Vector3d w = n.cross(Eigen::Vector3d::UnitZ()).cross(n);
  const Eigen::Vector3d o = w.z() < 0.0 ? Eigen::Vector3d(-w) : w;
  return geometry::fromYawPitchRoll(centroid, std::atan2(o.y(), o.x()), 0.0, 0.0);
}

std::vector<FlightPoint> inFrame(const Pose3& T_submap_flight, const std::vector<StairCell>& cells) {
  const Pose3 T_flight_submap = T_submap_flight.inverse();
  std::vector<FlightPoint> points;
  points.reserve(cells.size());
  for (const StairCell& cell : cells) points.push_back({T_flight_submap * cell.point_in_submap, cell.sigma});
  return points;
}

void removeSlab(const Plane& plane, std::vector<StairCell>& cells) {
  std::erase_if(cells, [&](const StairCell& cell) {
    return std::abs(plane.signedDistance(cell.point_in_submap)) < slopeTolerance(cell);
  });
}

/// Whatever stands on the flight or beside it, its rails among that, is no other flight.
void removeFlight(const StaircaseSighting& flight, Material& material) {
  const Pose3 T_stairs_submap = flight.T_submap_stairs.inverse();
  const auto isOfFlight = [&](const StairCell& cell) {
    const Eigen::Vector3d p = T_stairs_submap * cell.point_in_submap;
    const double above = p.z() - flight.slope * p.x();
    return std::abs(p.y()) < 0.5 * flight.width + kBeside && above > -kBelow && above < kRails &&
           p.x() > flight.steps.front().along - 1.0 && p.x() < flight.steps.back().along + 1.5;
  };
  std::erase_if(material.cells, isOfFlight);
  std::erase_if(material.voxels, isOfFlight);
}

/// The fewer the steps, the easier a sofa has it to look like them.
double mostRoughness(std::size_t steps) {
  return 0.25 + 0.035 * static_cast<double>(std::min(steps, kMostSteps));
}

/// Does the other, which leads the same way, lie in the flight's slope or where its rails are?
bool isOfFlight(const StaircaseSighting& flight, const StaircaseSighting& other) {
  constexpr double kTurn = 0.5;  // radians
  const Eigen::Vector3d between = flight.T_submap_stairs.inverse() * other.T_submap_stairs.translation();
  const double turn = geometry::yaw(other.T_submap_stairs) - geometry::yaw(flight.T_submap_stairs);
  const double above = between.z() - flight.slope * between.x();
  return std::abs(geometry::normalizeAngle(turn)) < kTurn && above > -kBelow && above < kRails &&
         std::abs(between.y()) < 0.5 * (flight.width + other.width);
}

std::optional<StaircaseSighting> flightOn(const Plane& slope, const std::vector<StairCell>& slab, const RgbdView& view,
                                          const Surfaces& surfaces, const Material& material) {
  const Pose3 T_submap_slope = flightFrame(slope, slab);
  const double rise = slope.normal.head<2>().norm() / slope.normal.z();
  const std::optional<FoundLattice> found = findLattice(inFrame(T_submap_slope, slab), rise);
  if (!found || found->roughness > mostRoughness(kMostSteps)) return std::nullopt;
  const Pose3 T_submap_flight = T_submap_slope * geometry::fromYawPitchRoll({0.0, 0.0, 0.0}, found->turn, 0.0, 0.0);
  const ProfileCheck check(view.T_submap_camera, surfaces.depth, found->lattice, T_submap_flight);
  const std::optional<FlightSteps> steps = findSteps(material.cells, found->lattice, T_submap_flight, check);
  if (!steps || found->roughness > mostRoughness(steps->steps.size())) return std::nullopt;
  return sightingOf(view, surfaces, *found, T_submap_flight, *steps, check);
}

}  // namespace

void describe(base::ConfigVisitor& visitor, StaircaseDetectorConfig& config) {
  visitor.section("stairs", "staircases in RGB-D images");
  visitor.key("enabled", config.enabled, "whether they are looked for");
  visitor.key("seed", config.seed, "of all chance");
  visitor.endSection();
}

std::vector<StaircaseSighting> findStaircases(const RgbdView& view, const Surfaces& surfaces,
                                              const StaircaseDetectorConfig& config, DebugImages* debug) {
  std::vector<StaircaseSighting> sightings;
  if (!config.enabled || surfaces.depth.known() == 0) return sightings;
  Material material = materialOf(view, surfaces);
  base::Random random(config.seed, "stairs");
  for (int i = 0; i < kMostSlopes; ++i) {
    std::optional<Plane> slope = findSlope(material.voxels, view.T_submap_camera.translation(), random);
    if (!slope) break;
    const std::vector<StairCell> slab = slabOf(*slope, material.voxels);
    const bool isLikely = slab.size() >= kLeastPoints && isSlope(*slope, view.T_submap_camera.translation());
    auto sighting = isLikely ? flightOn(*slope, slab, view, surfaces, material) : std::nullopt;
    if (sighting) {
      removeFlight(*sighting, material);
      sightings.push_back(std::move(*sighting));
    } else {
      removeSlab(*slope, material.voxels);
    }
  }
  for (StaircaseSighting& beside : findFlightsBeside(view, surfaces)) {
    const bool isKnown = std::ranges::any_of(sightings, [&](const auto& other) { return isOfFlight(other, beside); });
    if (!isKnown) sightings.push_back(std::move(beside));
  }
  if (debug != nullptr && debug->isWanted()) debug->add("stairs", drawStaircases(view, surfaces, sightings));
  return sightings;
}

}  // namespace prodomos::perception
