// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/exporter/exporter.hpp"

#include "exporter/formats.hpp"

#include <algorithm>
#include <array>

namespace prodomos::exporter {
namespace {

constexpr std::array kExporters = {
    Exporter{"html", ".html", "one offline page: plan, graph, layers and floors to pan, zoom and click", writeHtml},
    Exporter{"svg", ".svg", "the plan as a drawing: grid, graph, trajectory, entities, predictions", writeSvg},
    Exporter{"png", ".png", "the same drawing as a picture", writePng},
    Exporter{"graphml", ".graphml", "the graph with all attributes, for networkx, Gephi, yEd", writeGraphml},
    Exporter{"dot", ".dot", "the graph for Graphviz, nodes pinned where they lie", writeDot},
    Exporter{"json", ".json", "all but the layers, as documented in docs/json.md", writeJson},
    Exporter{"geojson", ".geojson", "nodes, edges, trajectory and entities in local metres, for QGIS", writeGeojson},
    Exporter{"nav2", ".yaml", "PGM + YAML per floor: free, occupied, unknown, for map_server and explorers", writeNav2,
             writeNav2Social},
    Exporter{"g2o", ".g2o", "the pose graph, refined poses, for g2o, Ceres, GTSAM, SE-Sync", writeG2o},
    Exporter{"ply", ".ply", "all points in the map frame, for CloudCompare and MeshLab", writePly},
    Exporter{"3dscene", ".3Dscene", "the scene for MRPT's SceneViewer3D", writeScene3d},
    Exporter{"simplemap", ".simplemap", "poses and scans for MRPT's map tools", writeSimplemap},
    Exporter{"topomap", ".tmap2.yaml", "the topological map of LCAS/topological_navigation", writeTopomap},
};

}  // namespace

std::span<const Exporter> exporters() {
  return kExporters;
}

const Exporter* findExporter(std::string_view format) {
  const auto* const found = std::ranges::find(kExporters, format, &Exporter::format);
  return found == kExporters.end() ? nullptr : found;
}

}  // namespace prodomos::exporter
