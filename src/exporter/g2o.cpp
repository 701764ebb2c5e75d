// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

#include <string>

namespace prodomos::exporter {
namespace {

constexpr int kDecimals = 9;

std::string poseColumns(const geometry::Pose3& pose) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q = quaternionOf(pose);
  std::string columns;
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) columns += ' ' + fixed(value, kDecimals);
  return columns;
}

/// Both are of deviations of the measured pose in its own axes; g2o's rotation is the quaternion's vector part, half of
/// our angle.
map::Matrix6 informationOfG2o(const map::Edge& edge) {
  const auto ourAngle = (Eigen::Matrix<double, 6, 1>() << 1.0, 1.0, 1.0, 2.0, 2.0, 2.0).finished();
  return ourAngle.asDiagonal() * edge.information * ourAngle.asDiagonal();
}

}  // namespace

void writeG2o(const map::MapView& view, const Path& path) {
  std::string text;
  for (const auto& node : observedNodes(view)) {
    text += "VERTEX_SE3:QUAT " + std::to_string(node.id.value) + poseColumns(node.T_map_submap) + '\n';
  }
  for (const auto& edge : observedEdges(view)) {
    text += "EDGE_SE3:QUAT " + std::to_string(edge.from.value) + ' ' + std::to_string(edge.to.value) +
            poseColumns(edge.T_from_to);
    const map::Matrix6 information = informationOfG2o(edge);
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) text += ' ' + fixed(information(row, column), kDecimals);
    }
    text += '\n';
  }
  writeFile(path, text);
}

}  // namespace prodomos::exporter
