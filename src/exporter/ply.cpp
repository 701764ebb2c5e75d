// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/bytes.hpp"

#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/write_file.hpp"

#include <string>

namespace prodomos::exporter {
namespace {

std::size_t appendPoints(const map::MapView& view, const map::Node& node, base::ByteWriter& out) {
  const Eigen::Isometry3f T_map_submap = node.T_map_submap.cast<float>();
  std::size_t count = 0;
  for (const auto& type : view.layersOf(node.id)) {
    const auto layer = view.findLayer(node.id, type);
    if (!layer) continue;
    const auto drawing = layer->draw();
    for (const auto& point : drawing.points) {
      const Eigen::Vector3f position = T_map_submap * point.position_in_submap;
      out << position.x() << position.y() << position.z() << point.color.r << point.color.g << point.color.b
          << static_cast<std::int32_t>(node.id.value);
    }
    count += drawing.points.size();
  }
  return count;
}

}  // namespace

void writePly(const map::MapView& view, const Path& path) {
  base::ByteWriter body;
  std::size_t count = 0;
  for (const auto& node : observedNodes(view)) count += appendPoints(view, node, body);
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\n"
      "comment points of all sub-maps in the map frame, metres\n"
      "element vertex " +
      std::to_string(count) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property int submap\nend_header\n";
  bytes.append(reinterpret_cast<const char*>(body.bytes().data()), body.bytes().size());
  writeFile(path, bytes);
}

}  // namespace prodomos::exporter
