// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/point_layer.hpp"
#include "prodomos/map/submap.hpp"
#include "prodomos/map/surface_layer.hpp"

#include <algorithm>
#include <array>

namespace prodomos::map {

namespace {

struct LayerType {
  std::string_view typeId;
  std::unique_ptr<MapLayer> (*make)(const LayersConfig& config);
};

// One line a layer, in the order in which they are drawn.
constexpr std::array kLayerTypes = {
    LayerType{OccupancyGrid::kTypeId,
              [](const LayersConfig& config) -> std::unique_ptr<MapLayer> {
                return std::make_unique<OccupancyGrid>(config.grid);
              }},
    LayerType{PointLayer::kTypeId,
              [](const LayersConfig& config) -> std::unique_ptr<MapLayer> {
                return std::make_unique<PointLayer>(config.points);
              }},
    LayerType{SurfaceLayer::kTypeId,
              [](const LayersConfig& config) -> std::unique_ptr<MapLayer> {
                auto surface = config.surface;
                surface.heightBand = config.grid.heightBand;
                return std::make_unique<SurfaceLayer>(surface);
              }},
};

}  // namespace

std::unique_ptr<MapLayer> makeLayer(std::string_view typeId, const LayersConfig& config) {
  const auto* type = std::ranges::find(kLayerTypes, typeId, &LayerType::typeId);
  return type == kLayerTypes.end() ? nullptr : type->make(config);
}

std::vector<std::string_view> layerTypes() {
  std::vector<std::string_view> types;
  types.reserve(kLayerTypes.size());
  for (const auto& type : kLayerTypes) types.push_back(type.typeId);
  return types;
}

const MapLayer* SubMap::findLayer(std::string_view typeId) const {
  const auto found = std::ranges::find_if(layers, [&](const auto& layer) { return layer->typeId() == typeId; });
  return found == layers.end() ? nullptr : found->get();
}

SubMap makeSubMap(Node node, const LayersConfig& config) {
  SubMap submap;
  submap.node = std::move(node);
  for (const auto& type : kLayerTypes) submap.layers.push_back(type.make(config));
  return submap;
}

}  // namespace prodomos::map
