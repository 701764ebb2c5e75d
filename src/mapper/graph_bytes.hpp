// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/topological_graph.hpp"

/// Running state is saved bit by bit, so that a resumed run goes on exactly as the one that was interrupted.
namespace prodomos::mapper {

template <int kRows, int kColumns>
void saveMatrix(base::ByteWriter& out, const Eigen::Matrix<double, kRows, kColumns>& matrix) {
  for (int i = 0; i < kRows * kColumns; ++i) out << matrix.data()[i];
}
template <int kRows, int kColumns>
void loadMatrix(base::ByteReader& in, Eigen::Matrix<double, kRows, kColumns>& matrix) {
  for (int i = 0; i < kRows * kColumns; ++i) in >> matrix.data()[i];
}

inline void savePose(base::ByteWriter& out, const geometry::Pose3& pose) {
  saveMatrix(out, pose.matrix());
}
inline geometry::Pose3 loadPose(base::ByteReader& in) {
  geometry::Pose3 pose;
  loadMatrix(in, pose.matrix());
  return pose;
}

inline void saveTime(base::ByteWriter& out, base::Time time) {
  out << base::toNanoseconds(time);
}
inline base::Time loadTime(base::ByteReader& in) {
  return base::fromNanoseconds(in.read<std::int64_t>());
}

/// All but the place, which is the map file's to say, and the covariance, which is computed again.
void saveNode(base::ByteWriter& out, const map::Node& node);
map::Node loadNode(base::ByteReader& in);

/// All but the entity that causes it.
void saveEdge(base::ByteWriter& out, const map::Edge& edge);
map::Edge loadEdge(base::ByteReader& in);

}  // namespace prodomos::mapper
