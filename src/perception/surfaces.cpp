// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/surfaces.hpp"

#include "prodomos/base/random.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <optional>

namespace prodomos::perception {

namespace {

using Cell = sensors::DepthGrid::Cell;
using geometry::Plane;

constexpr int kTrials = 40;           // hypotheses a plane
constexpr int kMostPlanes = 60;       // a view has less
constexpr int kRefits = 2;            // of the best hypothesis, each on the points that the last one gathered
constexpr std::size_t kJudges = 900;  // points that judge a hypothesis
constexpr double kRoughness = 0.01;   // metres that walls and floors deviate from planes by themselves
constexpr double kSigmas = 2.5;       // of depth noise that a point may lie off; beyond 4 m sheets are as far apart
constexpr float kLeastSlant = 0.1F;   // of cell areas: below, depth is too poor for a cell to stand for so much
constexpr double kFloorTilt = 0.14;   // 8 degrees
constexpr double kFloorReach = 0.25;  // metres that the floor may lie off the view's
constexpr double kFloorSigma = 0.10;  // metres; of two floors the nearer may be the smaller

/// Metres that a point may lie off its plane.
double toleranceAt(double depth) {
  return kRoughness + kSigmas * sensors::depthSigma(depth);
}

/// Least cosine between a cell's normal and its plane's: a normal is as good as the depths across its window are. That
/// of 0.3 + 2 atan(noise over window), at most 1.2 radians.
double leastCosineAt(double depth, double focalLength) {
  const double window = 4.0 * sensors::DepthGrid::kBlock * depth / focalLength;
  const double t = sensors::depthSigma(depth) / window;
  const double cosine = (0.955336 * (1.0 - t * t) - 0.295520 * 2.0 * t) / (1.0 + t * t);
  return std::max(cosine, 0.362358);
}

bool hasNormal(const Cell& cell) {
  return cell.normalX != 0.0F || cell.normalY != 0.0F || cell.normalZ != 0.0F;
}

/// m² that a cell shows of the surface with that slant: the cosine between its normal and the cell's ray, times the
/// ray's length.
float areaOf(const Cell& cell, float slant, const sensors::CameraIntrinsics& camera) {
  const auto block = static_cast<float>(sensors::DepthGrid::kBlock);
  const float side = block * cell.depth;
  return side * side / static_cast<float>(camera.fx * camera.fy) / std::max(slant, kLeastSlant);
}

float slantOf(const Cell& cell) {
  return std::abs(cell.normalX * cell.rayX + cell.normalY * cell.rayY + cell.normalZ);
}

/// Weighted points, of which a plane can be made.
class Moments {
 public:
  void add(const Eigen::Vector3d& point, double weight) {
    weight_ += weight;
    sum_ += weight * point;
    squares_.noalias() += (weight * point) * point.transpose();
  }
  /// Least squares; the normal turned to the origin, where the camera is. None for points on a line.
  std::optional<Plane> plane() const {
    if (!(weight_ > 0.0)) return std::nullopt;
    const Eigen::Vector3d mean = sum_ / weight_;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(squares_ / weight_ - mean * mean.transpose());
    if (!(solver.eigenvalues()[1] > 1e-6)) return std::nullopt;
    const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
    const Plane plane{normal, normal.dot(mean)};
    return plane.offset > 0.0 ? plane.flipped() : plane;
  }

 private:
  double weight_ = 0.0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

/// One cell for each voxel of the depth grid's points, those with a normal only; in the order of the cells.
std::vector<std::uint32_t> voxelFilter(const sensors::DepthGrid& grid, double voxel) {
  constexpr std::size_t kSlots = 1U << 16U;  // a power of two, more than twice the cells of a common image
  const auto cellCount = static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height());
  std::size_t slots = kSlots;
  while (slots < 2 * cellCount) slots *= 2;
  constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  std::vector<std::uint64_t> taken(slots, kEmpty);  // open addressing
  const auto scale = static_cast<float>(1.0 / voxel);
  const auto key = [scale](float metres) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(metres * scale)) + (1 << 20)) & 0x1fffffU;
  };
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < cellCount; ++i) {
    const Cell& cell = grid.at(static_cast<int>(i) % grid.width(), static_cast<int>(i) / grid.width());
    if (!(cell.depth > 0.0F) || !hasNormal(cell)) continue;
    const std::uint64_t voxelKey =
        key(cell.rayX * cell.depth) | key(cell.rayY * cell.depth) << 21U | key(cell.depth) << 42U;
    std::size_t slot = (voxelKey * 0x9e3779b97f4a7c15U >> 20U) & (slots - 1);
    while (taken[slot] != kEmpty && taken[slot] != voxelKey) slot = (slot + 1) & (slots - 1);
    if (taken[slot] == voxelKey) continue;
    taken[slot] = voxelKey;
    kept.push_back(static_cast<std::uint32_t>(i));
  }
  return kept;
}

/// Points in the camera with their normals, an array for each number: loops over them run four at a time.
struct Cloud {
  std::vector<float> x, y, z, normalX, normalY, normalZ, area, tolerance, leastCosine;

  std::size_t size() const { return x.size(); }
  Eigen::Vector3d point(std::size_t i) const { return Eigen::Vector3f(x[i], y[i], z[i]).cast<double>(); }
  void add(const Cell& cell, float cellArea, double focalLength) {
    const auto depth = static_cast<double>(cell.depth);
    x.push_back(cell.rayX * cell.depth);
    y.push_back(cell.rayY * cell.depth);
    z.push_back(cell.depth);
    normalX.push_back(cell.normalX);
    normalY.push_back(cell.normalY);
    normalZ.push_back(cell.normalZ);
    area.push_back(cellArea);
    tolerance.push_back(static_cast<float>(toleranceAt(depth)));
    leastCosine.push_back(static_cast<float>(leastCosineAt(depth, focalLength)));
  }
  /// Keeps the points that lie off the plane.
  void removeThoseOn(const Plane& plane);
};

/// A plane in single precision, for loops over clouds and cells.
struct FastPlane {
  explicit FastPlane(const Plane& plane)
      : x(static_cast<float>(plane.normal.x())),
        y(static_cast<float>(plane.normal.y())),
        z(static_cast<float>(plane.normal.z())),
        offset(static_cast<float>(plane.offset)) {}

  bool has(const Cloud& cloud, std::size_t i) const {
    const float distance = x * cloud.x[i] + y * cloud.y[i] + z * cloud.z[i] - offset;
    const float cosine = x * cloud.normalX[i] + y * cloud.normalY[i] + z * cloud.normalZ[i];
    return std::abs(distance) < cloud.tolerance[i] && cosine > cloud.leastCosine[i];
  }
  /// m² of every `stride`-th point on it.
  float areaOn(const Cloud& cloud, std::size_t stride) const {
    float sum = 0.0F;
    for (std::size_t i = 0; i < cloud.size(); i += stride) sum += has(cloud, i) ? cloud.area[i] : 0.0F;
    return sum;
  }

  float x, y, z, offset;
};

void Cloud::removeThoseOn(const Plane& plane) {
  const FastPlane fast(plane);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (fast.has(*this, i)) continue;
    for (auto* numbers : {&x, &y, &z, &normalX, &normalY, &normalZ, &area, &tolerance, &leastCosine}) {
      (*numbers)[kept] = (*numbers)[i];
    }
    ++kept;
  }
  for (auto* numbers : {&x, &y, &z, &normalX, &normalY, &normalZ, &area, &tolerance, &leastCosine}) {
    numbers->resize(kept);
  }
}

/// The plane that most of the cloud's area lies on: RANSAC with hypotheses of one point and its normal, then least
/// squares. None where there is less than `leastArea`.
std::optional<Plane> findPlane(const Cloud& cloud, double leastArea, base::Random& random) {
  if (cloud.size() == 0) return std::nullopt;
  const std::size_t stride = cloud.size() / kJudges + 1;
  std::optional<Plane> best;
  float bestArea = 0.5F * static_cast<float>(leastArea);  // before the fit
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(cloud.size()) - 1));
    const Eigen::Vector3d normal = Eigen::Vector3f(cloud.normalX[i], cloud.normalY[i], cloud.normalZ[i]).cast<double>();
    const Plane plane{normal, normal.dot(cloud.point(i))};
    const float area = FastPlane(plane).areaOn(cloud, stride) * static_cast<float>(stride);
    if (area <= bestArea) continue;
    bestArea = area;
    best = plane;
  }
  for (int refit = 0; best && refit < kRefits; ++refit) {
    const FastPlane fast(*best);
    Moments moments;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!fast.has(cloud, i)) continue;
      const auto tolerance = static_cast<double>(cloud.tolerance[i]);
      moments.add(cloud.point(i), 1.0 / (tolerance * tolerance));
    }
    best = moments.plane();
  }
  if (best && static_cast<double>(FastPlane(*best).areaOn(cloud, 1)) < leastArea) best.reset();
  return best;
}

/// Gathers cells to patches; each cell belongs to the first patch that takes it.
class PatchMaker {
 public:
  PatchMaker(const sensors::DepthGrid& grid, double leastArea, std::vector<PlanarPatch>& patches)
      : grid_(grid), leastArea_(leastArea), patches_(patches) {
    const auto count = static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height());
    states_.assign(count, State::kFree);
    tolerance_.resize(count);
    leastCosine_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(cell(i).depth > 0.0F)) continue;
      free_.push_back(static_cast<std::uint32_t>(i));
      const auto depth = static_cast<double>(cell(i).depth);
      tolerance_[i] = static_cast<float>(toleranceAt(depth));
      leastCosine_[i] = static_cast<float>(leastCosineAt(depth, grid.camera().focalLength()));
    }
  }

  /// Connected patches of the plane, in the camera.
  void addPatchesOf(const Plane& plane) {
    std::vector<std::uint32_t> on;
    const FastPlane fast(plane);
    for (const std::uint32_t i : free_) {
      if (!lies(i, fast)) continue;
      states_[i] = State::kOnPlane;
      on.push_back(i);
    }
    for (const std::uint32_t seed : on) {
      if (states_[seed] == State::kOnPlane) addPatch(connected(seed));
    }
    for (const std::uint32_t i : on) {
      if (states_[i] == State::kTooSmall) states_[i] = State::kFree;
    }
    std::erase_if(free_, [this](std::uint32_t i) { return states_[i] == State::kTaken; });
  }

 private:
  enum class State : std::uint8_t { kFree, kOnPlane, kTooSmall, kTaken };

  const Cell& cell(std::size_t i) const {
    return grid_.at(static_cast<int>(i) % grid_.width(), static_cast<int>(i) / grid_.width());
  }

  bool lies(std::size_t i, const FastPlane& plane) const {
    const Cell& c = cell(i);
    const float distance = c.depth * (plane.x * c.rayX + plane.y * c.rayY + plane.z) - plane.offset;
    if (!(std::abs(distance) < tolerance_[i])) return false;
    return !hasNormal(c) || plane.x * c.normalX + plane.y * c.normalY + plane.z * c.normalZ > leastCosine_[i];
  }

  /// Flood fill over gaps of one cell.
  std::vector<std::uint32_t> connected(std::uint32_t seed) {
    std::vector<std::uint32_t> found{seed};
    states_[seed] = State::kTooSmall;
    const int width = grid_.width();
    for (std::size_t next = 0; next < found.size(); ++next) {
      const int x = static_cast<int>(found[next]) % width;
      const int y = static_cast<int>(found[next]) / width;
      const auto visit = [&](int u, int v) {
        if (u < 0 || v < 0 || u >= width || v >= grid_.height()) return;
        const auto i = static_cast<std::uint32_t>(v * width + u);
        if (states_[i] != State::kOnPlane) return;
        states_[i] = State::kTooSmall;
        found.push_back(i);
      };
      for (const int step : {-2, -1, 1, 2}) {
        visit(x + step, y);
        visit(x, y + step);
      }
    }
    return found;
  }

  void addPatch(std::vector<std::uint32_t> cells) {
    Moments moments;
    for (const std::uint32_t i : cells) {
      const auto tolerance = static_cast<double>(tolerance_[i]);
      moments.add(pointOf(cell(i)), 1.0 / (tolerance * tolerance));
    }
    const std::optional<Plane> plane = moments.plane();
    if (!plane) return;
    PlanarPatch patch;
    patch.plane_in_submap = *plane;
    const Eigen::Vector3f normal = plane->normal.cast<float>();
    for (const std::uint32_t i : cells) {
      const Cell& c = cell(i);
      const float slant = std::abs(normal.x() * c.rayX + normal.y() * c.rayY + normal.z());
      const auto area = static_cast<double>(areaOf(c, slant, grid_.camera().intrinsics()));
      patch.area += area;
      patch.centroid_in_submap += area * pointOf(c);
    }
    if (patch.area < leastArea_) return;
    patch.centroid_in_submap /= patch.area;
    for (const std::uint32_t i : cells) states_[i] = State::kTaken;
    std::ranges::sort(cells);
    patch.cells = std::move(cells);
    patches_.push_back(std::move(patch));
  }

  const sensors::DepthGrid& grid_;
  double leastArea_;
  std::vector<PlanarPatch>& patches_;
  std::vector<State> states_;
  std::vector<std::uint32_t> free_;  ///< cells of known depth that no patch has taken
  std::vector<float> tolerance_;
  std::vector<float> leastCosine_;
};

/// The level patch, seen from above, that is as large and as near to where the floor is believed as any.
void findFloor(Surfaces& surfaces, double expected_z) {
  surfaces.floor_z = expected_z;
  double best = 0.0;
  for (const PlanarPatch& patch : surfaces.patches) {
    const double off = patch.centroid_in_submap.z() - expected_z;
    if (patch.tilt() > kFloorTilt || patch.plane_in_submap.normal.z() < 0.0 || std::abs(off) > kFloorReach) continue;
    const double score = patch.area * std::exp(-0.5 * off * off / (kFloorSigma * kFloorSigma));
    if (score <= best) continue;
    best = score;
    surfaces.floor_z = patch.centroid_in_submap.z();
    surfaces.floorIsSeen = true;
  }
}

}  // namespace

void describe(base::ConfigVisitor& visitor, SurfacesConfig& config) {
  visitor.section("surfaces", "planar patches of RGB-D images, for the detectors");
  visitor.key("voxel", config.voxel, "m", {0.01, 0.5}, "one point a voxel takes part in the search for planes");
  visitor.key("max_depth", config.maxDepth, "m", {0.5, 50.0}, "depths are used up to here");
  visitor.key("least_area", config.leastArea, "m2", {0.01, 10.0}, "smaller patches are none");
  visitor.key("seed", config.seed, "of all chance");
  visitor.endSection();
}

double PlanarPatch::tilt() const {
  return std::acos(std::min(1.0, std::abs(plane_in_submap.normal.z())));
}

Surfaces findSurfaces(const RgbdView& view, const SurfacesConfig& config) {
  Surfaces surfaces;
  surfaces.floor_z = view.floor_z;
  if (!hasPoints(view)) return surfaces;

  const sensors::Image<float>& depth = view.frame.depth;
  const bool moversFit =
      view.movers != nullptr && view.movers->width() == depth.width() && view.movers->height() == depth.height();
  const sensors::Camera camera(view.frame.camera, depth.width(), depth.height());
  surfaces.depth = sensors::DepthGrid(camera, depth, moversFit ? view.movers : nullptr, config.maxDepth, nullptr);
  surfaces.depth.computeNormals();

  surfaces.voxels = voxelFilter(surfaces.depth, config.voxel);
  Cloud cloud;
  for (const std::uint32_t i : surfaces.voxels) {
    const int width = surfaces.depth.width();
    const Cell& cell = surfaces.depth.at(static_cast<int>(i) % width, static_cast<int>(i) / width);
    const float side = static_cast<float>(config.voxel);
    const float area = std::max(areaOf(cell, slantOf(cell), camera.intrinsics()), side * side);
    cloud.add(cell, area, camera.focalLength());
  }

  base::Random random(config.seed, "surfaces");
  PatchMaker maker(surfaces.depth, config.leastArea, surfaces.patches);
  for (int plane = 0; plane < kMostPlanes; ++plane) {
    const std::optional<Plane> found = findPlane(cloud, config.leastArea, random);
    if (!found) break;
    maker.addPatchesOf(*found);
    cloud.removeThoseOn(*found);
  }

  for (PlanarPatch& patch : surfaces.patches) {
    patch.plane_in_submap = geometry::transformed(view.T_submap_camera, patch.plane_in_submap);
    patch.centroid_in_submap = view.T_submap_camera * patch.centroid_in_submap;
  }
  std::ranges::stable_sort(surfaces.patches, std::ranges::greater{}, &PlanarPatch::area);
  findFloor(surfaces, view.floor_z);
  return surfaces;
}

}  // namespace prodomos::perception
