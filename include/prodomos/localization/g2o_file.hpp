// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/localization/pose_graph.hpp"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace prodomos::localization {

/// A pose graph in the text format of g2o: `VERTEX_SE2`, `EDGE_SE2`, `VERTEX_SE3:QUAT`, `EDGE_SE3:QUAT` and `FIX`.
struct G2oFile {
  std::variant<PlanarPoseGraph, PoseGraph> graph;
  /// False where the file has edges alone: the vertices are then the edges' ends, ascending, all at the origin.
  bool hasPoses = true;
  /// All lines but those of vertices, as they were read: edges, FIX, parameters and comments.
  std::vector<std::string> otherLines;
};

/// In 3D g2o's information matrix is that of the quaternion's vector part: half an angle, where ours is of the whole.
/// It is converted, which is exact, so that chi² is the same. Lines of parameters (`PARAMS_...`), which these edges do
/// not use, and comments are kept. Throws base::FileError, naming file and line, for anything that is not understood:
/// to leave out an edge or a landmark would give another map.
G2oFile readG2o(const std::filesystem::path& path);

/// Poses in full precision, all else as in `otherLines`; the whole file or nothing. Throws base::FileError.
void writeG2o(const G2oFile& file, const std::filesystem::path& path);

/// With the lines that say the same as the graph, apart from which constraints are doubtful: g2o has no word for it.
G2oFile toG2o(const PoseGraph& graph);
G2oFile toG2o(const PlanarPoseGraph& graph);

}  // namespace prodomos::localization
