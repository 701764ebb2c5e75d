// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/planes.hpp"

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/geometry/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace prodomos::evaluation {

namespace {

/// Above the floor: from where cameras of robots see tables from above and boards on walls from the front.
constexpr double kEyeHeight = 1.0;

/// Where a sub-map's robot looked from at that time; its origin where there is no way.
Eigen::Vector3d eyeInSubMap(const std::vector<TimedPose>& way_in_submap, base::Time time) {
  const auto* nearest = findNearest(way_in_submap, time, base::Duration::max());
  const Eigen::Vector3d feet =
      nearest == nullptr ? Eigen::Vector3d::Zero() : Eigen::Vector3d(nearest->pose.translation());
  return feet + kEyeHeight * Eigen::Vector3d::UnitZ();
}

/// Its normal and the x-axis of its plane turned over; outlines keep their places.
void turnOver(MappedPlane& plane) {
  plane.T_world_patch = plane.T_world_patch * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  for (auto& corner : plane.outline_in_patch) corner.y() = -corner.y();
}

Eigen::Vector3d middleOf(const MappedPlane& patch) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& corner : patch.outline_in_patch) sum += corner;
  sum /= static_cast<double>(patch.outline_in_patch.size());
  return patch.T_world_patch * Eigen::Vector3d(sum.x(), sum.y(), 0.0);
}

double angleBetween(const MappedPlane& patch, const TruePlane& plane) {
  const double cosine = patch.T_world_patch.linear().col(2).dot(plane.T_world_plane.linear().col(2));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double offsetBetween(const MappedPlane& patch, const TruePlane& plane) {
  return std::abs((plane.T_world_plane.inverse() * middleOf(patch)).z());
}

/// m² of the true plane that the patch lies on; 0 where it is of another plane.
double overlapOf(const MappedPlane& patch, const TruePlane& plane, const PlaneOptions& options) {
  if (patch.outline_in_patch.size() < 3) return 0.0;
  if (angleBetween(patch, plane) > options.widestAngle || offsetBetween(patch, plane) > options.farthest) return 0.0;
  const geometry::Pose3 T_plane_patch = plane.T_world_plane.inverse() * patch.T_world_patch;
  std::vector<Eigen::Vector2d> outline_in_plane;
  for (const auto& corner : patch.outline_in_patch) {
    outline_in_plane.emplace_back((T_plane_patch * Eigen::Vector3d(corner.x(), corner.y(), 0.0)).head<2>());
  }
  return geometry::sharedArea(outline_in_plane, plane.outline_in_plane);
}

/// All that SegComp's definitions look at.
struct Overlaps {
  Eigen::MatrixXd shared;         ///< m² by patch and true plane
  Eigen::VectorXd patchAreas;     ///< m²
  Eigen::VectorXd planeAreas;     ///< m² that were seen
  std::vector<bool> patchCounts;  ///< but for those on planes barely seen
  std::vector<bool> planeCounts;
};

/// A way in which some patches and some true planes are each other's.
struct Instance {
  enum class Kind { kCorrect, kOver, kUnder };
  Kind kind = Kind::kCorrect;
  double measure = 0.0;  ///< mean of the shares in each other
  std::vector<Eigen::Index> patches;
  std::vector<Eigen::Index> planes;
};

Overlaps overlapsOf(const std::vector<MappedPlane>& mapped, const Truth& truth, const PlaneOptions& options) {
  Overlaps overlaps;
  overlaps.shared.resize(std::ssize(mapped), std::ssize(truth.planes));
  overlaps.patchAreas.resize(std::ssize(mapped));
  overlaps.planeAreas.resize(std::ssize(truth.planes));
  Eigen::VectorXd onUncounted = Eigen::VectorXd::Zero(std::ssize(mapped));
  for (Eigen::Index m = 0; m < overlaps.shared.rows(); ++m) {
    overlaps.patchAreas[m] = geometry::areaOf(mapped[static_cast<std::size_t>(m)].outline_in_patch);
  }
  for (Eigen::Index t = 0; t < overlaps.shared.cols(); ++t) {
    const auto& plane = truth.planes[static_cast<std::size_t>(t)];
    overlaps.planeAreas[t] = std::min(plane.seen, geometry::areaOf(plane.outline_in_plane));
    overlaps.planeCounts.push_back(overlaps.planeAreas[t] >= options.leastSeen);
    for (Eigen::Index m = 0; m < overlaps.shared.rows(); ++m) {
      overlaps.shared(m, t) = overlapOf(mapped[static_cast<std::size_t>(m)], plane, options);
      if (!overlaps.planeCounts.back()) onUncounted[m] += overlaps.shared(m, t);
    }
  }
  for (Eigen::Index m = 0; m < overlaps.shared.rows(); ++m) {
    overlaps.patchCounts.push_back(onUncounted[m] < 0.5 * overlaps.patchAreas[m] || overlaps.patchAreas[m] == 0.0);
  }
  return overlaps;
}

/// Those of `from` that lie in `whole` by at least the threshold, with what they have in common. Counted ones only.
struct Parts {
  std::vector<Eigen::Index> indices;
  double shared = 0.0;
  double shares = 0.0;  ///< sum of their shares that lie in it
};
Parts partsOf(const Eigen::VectorXd& shared, const Eigen::VectorXd& areas, const std::vector<bool>& counts,
              double threshold) {
  Parts parts;
  for (Eigen::Index i = 0; i < shared.size(); ++i) {
    if (!counts[static_cast<std::size_t>(i)] || areas[i] <= 0.0 || shared[i] < threshold * areas[i]) continue;
    parts.indices.push_back(i);
    parts.shared += shared[i];
    parts.shares += shared[i] / areas[i];
  }
  return parts;
}

/// Hoover et al. 1996, definitions 1 to 3.
std::vector<Instance> instancesAt(double threshold, const Overlaps& o) {
  std::vector<Instance> instances;
  for (Eigen::Index t = 0; t < o.shared.cols(); ++t) {
    if (!o.planeCounts[static_cast<std::size_t>(t)]) continue;
    const auto parts = partsOf(o.shared.col(t), o.patchAreas, o.patchCounts, threshold);
    for (const auto m : parts.indices) {
      if (o.shared(m, t) < threshold * o.planeAreas[t]) continue;
      const double measure = 0.5 * (o.shared(m, t) / o.patchAreas[m] + std::min(1.0, o.shared(m, t) / o.planeAreas[t]));
      instances.push_back({Instance::Kind::kCorrect, measure, {m}, {t}});
    }
    if (parts.indices.size() < 2 || parts.shared < threshold * o.planeAreas[t]) continue;
    const double measure = 0.5 * (parts.shares / static_cast<double>(parts.indices.size()) +
                                  std::min(1.0, parts.shared / o.planeAreas[t]));
    instances.push_back({Instance::Kind::kOver, measure, parts.indices, {t}});
  }
  for (Eigen::Index m = 0; m < o.shared.rows(); ++m) {
    if (!o.patchCounts[static_cast<std::size_t>(m)] || o.patchAreas[m] <= 0.0) continue;
    const auto parts = partsOf(o.shared.row(m), o.planeAreas, o.planeCounts, threshold);
    if (parts.indices.size() < 2 || parts.shared < threshold * o.patchAreas[m]) continue;
    const double measure = 0.5 * (std::min(1.0, parts.shares / static_cast<double>(parts.indices.size())) +
                                  parts.shared / o.patchAreas[m]);
    instances.push_back({Instance::Kind::kUnder, measure, {m}, parts.indices});
  }
  std::ranges::stable_sort(instances, std::ranges::greater(), &Instance::measure);
  return instances;
}

/// Of instances that share a region, the one with the greatest measure holds.
std::vector<Instance> withoutConflicts(const std::vector<Instance>& instances, const Overlaps& o) {
  std::vector<bool> patchUsed(o.patchCounts.size(), false);
  std::vector<bool> planeUsed(o.planeCounts.size(), false);
  std::vector<Instance> kept;
  for (const auto& instance : instances) {
    const auto usedPatch = [&](Eigen::Index m) { return patchUsed[static_cast<std::size_t>(m)]; };
    const auto usedPlane = [&](Eigen::Index t) { return planeUsed[static_cast<std::size_t>(t)]; };
    if (std::ranges::any_of(instance.patches, usedPatch) || std::ranges::any_of(instance.planes, usedPlane)) continue;
    for (const auto m : instance.patches) patchUsed[static_cast<std::size_t>(m)] = true;
    for (const auto t : instance.planes) planeUsed[static_cast<std::size_t>(t)] = true;
    kept.push_back(instance);
  }
  return kept;
}

PlaneCounts countsOf(const std::vector<Instance>& instances, double threshold, const PlaneScore& score) {
  PlaneCounts counts{.threshold = threshold, .missed = score.truth, .noise = score.mapped};
  for (const auto& instance : instances) {
    counts.missed -= instance.planes.size();
    counts.noise -= instance.patches.size();
    switch (instance.kind) {
      case Instance::Kind::kCorrect:
        ++counts.correct;
        break;
      case Instance::Kind::kOver:
        ++counts.over;
        break;
      case Instance::Kind::kUnder:
        ++counts.under;
        break;
    }
  }
  return counts;
}

bool alike(double a, double b) {
  return std::abs(a - b) < 1e-9;
}

}  // namespace

std::vector<MappedPlane> planesOf(const map::MapView& view, const Truth& truth) {
  std::map<base::SubMapId, std::vector<TimedPose>> wayOf;
  for (const auto& point : view.trajectory()) {
    const auto& node = view.graph().getNode(point.submap);
    wayOf[point.submap].push_back({point.time, node.T_map_submap.inverse() * point.T_map_body});
  }
  const auto T_world_submap = truthFromSubMaps(view, truth);
  std::vector<MappedPlane> planes;
  for (const auto& entity : view.entities()) {
    const auto* patch = std::get_if<map::PlanePatch>(&entity.attributes);
    if (patch == nullptr || patch->outline_in_patch.size() < 3 || !T_world_submap.contains(entity.submap)) continue;
    MappedPlane plane{T_world_submap.at(entity.submap) * entity.T_submap_entity, patch->outline_in_patch};
    const Eigen::Vector3d eye = eyeInSubMap(wayOf[entity.submap], entity.firstSeen);
    if ((entity.T_submap_entity.inverse() * eye).z() < 0.0) turnOver(plane);
    planes.push_back(std::move(plane));
  }
  return planes;
}

PlaneScore scorePlanes(const std::vector<MappedPlane>& mapped, const Truth& truth, const PlaneOptions& options) {
  const auto overlaps = overlapsOf(mapped, truth, options);
  PlaneScore score;
  score.truth = static_cast<std::size_t>(std::ranges::count(overlaps.planeCounts, true));
  score.mapped = static_cast<std::size_t>(std::ranges::count(overlaps.patchCounts, true));
  for (const double threshold : options.thresholds) {
    const auto instances = withoutConflicts(instancesAt(threshold, overlaps), overlaps);
    score.curve.push_back(countsOf(instances, threshold, score));
    if (!alike(threshold, options.reported)) continue;
    for (const auto& instance : instances) {
      if (instance.kind != Instance::Kind::kCorrect) continue;
      const auto& patch = mapped[static_cast<std::size_t>(instance.patches[0])];
      const auto& plane = truth.planes[static_cast<std::size_t>(instance.planes[0])];
      score.angleErrors.push_back(angleBetween(patch, plane));
      score.offsetErrors.push_back(offsetBetween(patch, plane));
    }
  }
  return score;
}

const PlaneCounts* PlaneScore::at(double threshold) const {
  const auto found =
      std::ranges::find_if(curve, [&](const auto& counts) { return alike(counts.threshold, threshold); });
  return found == curve.end() ? nullptr : &*found;
}

PlaneScore& PlaneScore::operator+=(const PlaneScore& other) {
  truth += other.truth;
  mapped += other.mapped;
  if (curve.empty()) curve.resize(other.curve.size());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    curve[i].threshold = other.curve[i].threshold;
    curve[i].correct += other.curve[i].correct;
    curve[i].over += other.curve[i].over;
    curve[i].under += other.curve[i].under;
    curve[i].missed += other.curve[i].missed;
    curve[i].noise += other.curve[i].noise;
  }
  angleErrors.insert(angleErrors.end(), other.angleErrors.begin(), other.angleErrors.end());
  offsetErrors.insert(offsetErrors.end(), other.offsetErrors.begin(), other.offsetErrors.end());
  return *this;
}

}  // namespace prodomos::evaluation
