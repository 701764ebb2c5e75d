// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/labels.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/geometry/overlap.hpp"

#include "evaluation/true_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string_view>

namespace prodomos::evaluation {

namespace {

using CellOf3D = std::array<int, 3>;

CellOf3D cellAt(const Eigen::Vector3d& position, double size) {
  const Eigen::Vector3d cell = (position / size).array().floor();
  return {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())};
}

double distanceTo(const TruePlane& plane, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = plane.T_world_plane.inverse() * point;
  const auto& outline = plane.outline_in_plane;
  bool inside = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& a = outline[i];
    const auto& b = outline[(i + 1) % outline.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
    const Eigen::Vector2d edge = b - a;
    const double along = edge.isZero() ? 0.0 : std::clamp((p.head<2>() - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p.head<2>() - a - along * edge).norm());
  }
  return inside ? std::abs(p.z()) : std::hypot(nearest, p.z());
}

/// 0 inside: what fills a box, its truth does not say.
double distanceTo(const geometry::OrientedBox& box, const Eigen::Vector3d& point) {
  const Eigen::Vector3d outside = (box.T_frame_box.inverse() * point).cwiseAbs() - 0.5 * box.size;
  return outside.cwiseMax(0.0).norm();
}

std::optional<int> findClass(const sensors::ClassTable& classes, std::string_view name) {
  const auto entry = std::ranges::find(classes, name, [](const auto& row) { return std::string_view(row.second); });
  return entry == classes.end() ? std::nullopt : std::optional(entry->first);
}

/// All surfaces that have a class, found by buckets.
class TrueSurfaces {
 public:
  TrueSurfaces(const Truth& truth, double reach) : reach_(reach) {
    for (const auto& plane : truth.planes) add(plane);
    for (const auto& object : truth.objects) {
      if (!object.poses.empty()) add({object.poses.back().T_world_object, object.size}, object.classId);
    }
    if (const auto door = findClass(truth.classes, "door")) {
      for (const auto& d : truth.doors) {
        for (const auto& leaf : leavesAt(d, d.states.empty() ? 0.0 : d.states.back().angle)) add(leaf, *door);
      }
    }
    if (const auto stairs = findClass(truth.classes, "stairs")) {
      for (const auto& flight : truth.stairs) {
        for (const auto& step : stepsOf(flight)) add(step, *stairs);
      }
    }
  }

  /// Of the voxel around a point: the class that is said, where a surface of that class passes through its
  /// circumsphere, else that of the nearest surface; none where all are beyond reach.
  std::optional<int> classAt(const Eigen::Vector3d& point, double radius, int said) const {
    const auto bucket = buckets_.find(cellAt(point, kBucket));
    if (bucket == buckets_.end()) return std::nullopt;
    std::optional<int> nearest;
    double nearestDistance = reach_;
    for (const auto index : bucket->second) {
      const auto& surface = surfaces_[index];
      const double distance =
          surface.plane != nullptr ? distanceTo(*surface.plane, point) : distanceTo(surface.box, point);
      if (surface.classId == said && distance <= radius) return said;
      if (distance > nearestDistance || (nearest && distance == nearestDistance)) continue;
      nearest = surface.classId;
      nearestDistance = distance;
    }
    return nearest;
  }

 private:
  static constexpr double kBucket = 0.5;  // metres

  struct Surface {
    int classId = kUnlabeled;
    const TruePlane* plane = nullptr;  // of the truth; else the box
    geometry::OrientedBox box;
  };

  void add(const TruePlane& plane) {
    Eigen::AlignedBox3d bounds;
    for (const auto& corner : plane.outline_in_plane) {
      bounds.extend(plane.T_world_plane * Eigen::Vector3d(corner.x(), corner.y(), 0.0));
    }
    add({.classId = plane.classId, .plane = &plane}, bounds);
  }

  void add(const geometry::OrientedBox& box, int classId) {
    const Eigen::Vector3d half = 0.5 * box.T_frame_box.linear().cwiseAbs() * box.size;
    const Eigen::Vector3d middle = box.T_frame_box.translation();
    add({.classId = classId, .box = box}, {middle - half, middle + half});
  }

  void add(const Surface& surface, const Eigen::AlignedBox3d& bounds) {
    if (bounds.isEmpty()) return;
    const auto first = cellAt(bounds.min() - Eigen::Vector3d::Constant(reach_), kBucket);
    const auto last = cellAt(bounds.max() + Eigen::Vector3d::Constant(reach_), kBucket);
    for (int x = first[0]; x <= last[0]; ++x) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int z = first[2]; z <= last[2]; ++z) buckets_[{x, y, z}].push_back(surfaces_.size());
      }
    }
    surfaces_.push_back(surface);
  }

  double reach_;
  std::vector<Surface> surfaces_;
  std::map<CellOf3D, std::vector<std::size_t>> buckets_;
};

std::string nameIn(const sensors::ClassTable& classes, int id) {
  const auto entry = classes.find(id);
  return entry == classes.end() ? "none" : "\"" + entry->second + "\"";
}

/// Ids mean the same in both. What 0 is called, or whether it is listed, does not matter.
void checkClasses(const sensors::ClassTable& expected, const sensors::ClassTable& found) {
  std::set<int> ids;
  for (const auto& table : {expected, found}) {
    for (const auto& [id, name] : table) ids.insert(id);
  }
  ids.erase(kUnlabeled);
  for (const int id : ids) {
    if (nameIn(expected, id) == nameIn(found, id)) continue;
    throw base::Error(base::expectedFound("class " + std::to_string(id) + " of the map",
                                          nameIn(expected, id) + " as in the truth", nameIn(found, id)));
  }
}

/// trueClassOf: of a voxel, none where there is no truth near.
template <typename TrueClassOf>
LabelScore countLabels(const LabelledVoxels& mapped, const TrueClassOf& trueClassOf) {
  LabelScore score;
  score.classes = mapped.classes;
  for (const auto& voxel : mapped.voxels) {
    if (voxel.classId == kUnlabeled) {
      ++score.unlabeled;
      continue;
    }
    const std::optional<int> actual = trueClassOf(voxel);
    if (!actual) {
      ++score.stray;
    } else {
      ++score.confusion[{*actual, voxel.classId}];
    }
  }
  return score;
}

}  // namespace

std::optional<LabelledVoxels> labelledVoxelsOf(const map::MapView& /*view*/, const Truth& /*truth*/) {
  return std::nullopt;
}

LabelScore scoreLabels(const LabelledVoxels& mapped, const Truth& truth, const LabelOptions& options) {
  checkClasses(truth.classes, mapped.classes);
  const double radius = 0.5 * std::numbers::sqrt3 * mapped.size;
  const TrueSurfaces surfaces(truth, std::max(options.reach, radius));
  return countLabels(mapped, [&](const LabelledVoxel& voxel) {
    return surfaces.classAt(voxel.position_in_world, radius, voxel.classId);
  });
}

LabelScore scoreLabels(const LabelledVoxels& mapped, std::span<const LabelledPoint> reference) {
  std::map<CellOf3D, std::map<int, std::size_t>> votes;
  for (const auto& point : reference) {
    if (point.classId != kUnlabeled) ++votes[cellAt(point.position_in_world, mapped.size)][point.classId];
  }
  return countLabels(mapped, [&](const LabelledVoxel& voxel) -> std::optional<int> {
    const auto found = votes.find(cellAt(voxel.position_in_world, mapped.size));
    if (found == votes.end()) return std::nullopt;
    return std::ranges::max_element(found->second, {}, [](const auto& vote) { return vote.second; })->first;
  });
}

std::size_t LabelScore::compared() const {
  std::size_t sum = 0;
  for (const auto& [pair, count] : confusion) sum += count;
  return sum;
}

std::optional<double> LabelScore::accuracy() const {
  std::size_t right = 0;
  for (const auto& [pair, count] : confusion) {
    if (pair.first == pair.second) right += count;
  }
  return shareOf(right, compared());
}

std::optional<double> LabelScore::iou(int classId) const {
  std::size_t both = 0;
  std::size_t either = 0;
  for (const auto& [pair, count] : confusion) {
    if (pair.first == classId && pair.second == classId) both += count;
    if (pair.first == classId || pair.second == classId) either += count;
  }
  return shareOf(both, either);
}

std::optional<double> LabelScore::meanIou() const {
  std::set<int> trueClasses;
  for (const auto& [pair, count] : confusion) trueClasses.insert(pair.first);
  if (trueClasses.empty()) return std::nullopt;
  double sum = 0.0;
  for (const int id : trueClasses) sum += iou(id).value_or(0.0);
  return sum / static_cast<double>(trueClasses.size());
}

LabelScore& LabelScore::operator+=(const LabelScore& other) {
  if (classes.empty()) classes = other.classes;
  if (!other.classes.empty()) checkClasses(classes, other.classes);
  for (const auto& [pair, count] : other.confusion) confusion[pair] += count;
  unlabeled += other.unlabeled;
  stray += other.stray;
  return *this;
}

}  // namespace prodomos::evaluation
