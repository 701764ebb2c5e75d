// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

/// Classes of voxels against the true surfaces (004, 000 §III-B). docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

inline constexpr int kUnlabeled = 0;

struct LabelledVoxel {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();  ///< of its middle
  int classId = kUnlabeled;
  double probability = 1.0;  ///< of that class
};

/// Occupied voxels with their likeliest classes.
struct LabelledVoxels {
  sensors::ClassTable classes;
  double size = 0.05;  ///< edge, metres
  std::vector<LabelledVoxel> voxels;
};

/// Of all sub-maps. None where the map has no layer that holds classes; no layer of this version does.
std::optional<LabelledVoxels> labelledVoxelsOf(const map::MapView& view, const Truth& truth);

struct LabelOptions {
  double reach = 0.15;  ///< metres from a true surface; what lies farther from all has no true class
};

struct LabelScore {
  sensors::ClassTable classes;
  std::map<std::pair<int, int>, std::size_t> confusion;  ///< voxels by (true, mapped) class, both labelled
  std::size_t unlabeled = 0;                             ///< occupied voxels without a class
  std::size_t stray = 0;                                 ///< voxels near no true surface

  std::size_t compared() const;
  std::optional<double> accuracy() const;
  /// None where neither truth nor map has the class.
  std::optional<double> iou(int classId) const;
  /// Over the classes of the truth's voxels.
  std::optional<double> meanIou() const;
  /// For scores over several maps. Throws base::Error where the class tables differ.
  LabelScore& operator+=(const LabelScore& other);
};

/// Throws base::Error naming the first class at which the tables of voxels and truth differ.
LabelScore scoreLabels(const LabelledVoxels& mapped, const Truth& truth, const LabelOptions& options = {});

/// Against labelled points instead, as of another sensor or a reference scan: each voxel has the class that most of
/// the points within it have. Points are in the world.
struct LabelledPoint {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  int classId = kUnlabeled;
};
LabelScore scoreLabels(const LabelledVoxels& mapped, std::span<const LabelledPoint> reference);

}  // namespace prodomos::evaluation
