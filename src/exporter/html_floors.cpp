// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/html_floors.hpp"

#include "exporter/contents.hpp"
#include "exporter/palette.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::exporter {
namespace {

constexpr std::size_t kMostPlanPixels = 36'000'000;     // of all floors together
constexpr std::size_t kMostOverviewPixels = 1'500'000;  // of one floor: for looking at all of it
constexpr std::size_t kMostLayerBytes = 5'000'000;      // of all layers and floors together, as PNG

// A door found a little too narrow must not let places leak into one another.
constexpr double kDoorFrame = 0.1;  // metres a side

std::vector<PlaceSeed> placeSeeds(const map::MapView& view, std::optional<int> floor) {
  std::vector<PlaceSeed> seeds;
  for (const auto& node : observedNodes(view)) {
    if (!node.place || !onFloor(node.floor, floor)) continue;
    seeds.push_back({node.T_map_submap.translation().head<2>(), *node.place});
  }
  return seeds;
}

std::vector<DoorSegment> doorSegments(const map::MapView& view, std::optional<int> floor) {
  std::vector<DoorSegment> doors;
  for (const auto& entity : view.entities()) {
    const auto* door = std::get_if<map::Door>(&entity.attributes);
    if (door == nullptr || !onFloor(view.graph().getNode(entity.submap).floor, floor)) continue;
    const auto T_map_door = poseInMap(view, entity);
    const Eigen::Vector3d jamb(0.0, door->width / 2.0 + kDoorFrame, 0.0);
    doors.push_back({(T_map_door * -jamb).head<2>(), (T_map_door * jamb).head<2>()});
  }
  return doors;
}

double freeAreaOf(const map::OccupancyGrid& grid) {
  const auto box = grid.knownBox();
  std::size_t free = 0;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) free += grid.state({x, y}) == map::CellState::kFree ? 1 : 0;
  }
  return static_cast<double>(free) * grid.resolution() * grid.resolution();
}

Json heightOf(const map::MapView& view, std::optional<int> number) {
  for (const auto& floor : view.floors()) {
    if (floor.number == number) return rounded(floor.height);
  }
  return nullptr;
}

/// One type of layer on one floor.
struct LayerScene {
  std::string type;
  TopView raster;
  Json shapes = Json::array();
};

void addShape(LayerScene& scene, const Polyline& line, map::Rgba color, const std::string& label) {
  Json shape{{"points", pointsJson(line)}, {"color", hex(color)}};
  if (!label.empty()) shape["label"] = label;
  scene.shapes.push_back(std::move(shape));
}

void add(LayerScene& scene, const map::Drawing& drawing, const geometry::Pose3& T_map_submap) {
  scene.raster.add(drawing, T_map_submap);
  for (const auto& line : drawing.lines) {
    Polyline seen;
    for (const auto& point : line.points_in_submap) seen.push_back((T_map_submap * point).head<2>());
    addShape(scene, seen, line.color, line.label);
  }
  for (const auto& box : drawing.boxes) {
    const geometry::Pose3 T_map_box = T_map_submap * box.T_submap_box;
    Polyline base;
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}}) {
      base.push_back((T_map_box * box.size.cwiseProduct(Eigen::Vector3d(x, y, -0.5))).head<2>());
    }
    addShape(scene, base, box.color, box.label);
  }
}

/// All types but the grid, which is the plan itself.
std::vector<LayerScene> layerScenes(const map::MapView& view, std::optional<int> floor, double resolution) {
  std::vector<LayerScene> scenes;
  for (const auto id : view.graph().nodes()) {
    const auto& node = view.graph().getNode(id);
    if (!onFloor(node.floor, floor)) continue;
    for (const auto& type : view.layersOf(id)) {
      const auto layer = type == map::OccupancyGrid::kTypeId ? nullptr : view.findLayer(id, type);
      if (!layer) continue;
      auto scene = std::ranges::find(scenes, type, &LayerScene::type);
      if (scene == scenes.end()) scene = scenes.insert(scenes.end(), {type, TopView(resolution)});
      add(*scene, layer->draw(), node.T_map_submap);
    }
  }
  return scenes;
}

/// Pictures of all scenes, ever coarser until they are small enough together.
std::vector<std::optional<PlacedImage>> imagesOf(const std::vector<const TopView*>& views) {
  std::vector<std::optional<PlacedImage>> images;
  for (int coarser = 1; coarser <= 16; coarser *= 2) {
    images.clear();
    std::size_t bytes = 0;
    for (const auto* view : views) {
      images.push_back(view->empty() ? std::nullopt : std::optional(view->image(coarser)));
      if (images.back()) bytes += images.back()->png.size();
    }
    if (bytes <= kMostLayerBytes) break;
  }
  return images;
}

}  // namespace

Json rounded(double value, double unit) {
  if (!std::isfinite(value)) return nullptr;
  // Dividing by the whole number gives the double nearest to the decimal, which prints with no digits more.
  const double scale = std::round(1.0 / unit);
  const double result = std::round(value * scale) / scale;
  return result == 0.0 ? 0.0 : result;
}

Json pointsJson(const Polyline& points) {
  Json out = Json::array();
  for (const auto& point : points) out.push_back({rounded(point.x()), rounded(point.y())});
  return out;
}

Json imageJson(const PlacedImage& image) {
  return {{"png", base64(image.png)},
          {"pixel", rounded(image.pixel)},
          {"corner", {rounded(image.corner.x()), rounded(image.corner.y())}},
          {"size", {rounded(image.size.x()), rounded(image.size.y())}}};
}

HtmlFloors htmlFloors(const map::MapView& view) {
  const auto numbers = floorsOf(view);
  HtmlFloors floors{Json::array()};
  std::vector<std::vector<LayerScene>> scenes;
  for (const auto number : numbers) {
    const auto grid = map::fuseGrids(view, number);
    floors.freeArea += freeAreaOf(grid);
    // Browsers shrink walls to nothing; an overview whose pixels are wall where any of their cells is does not.
    const auto plans = planImages(grid, placeSeeds(view, number), doorSegments(view, number),
                                  {kMostPlanPixels / numbers.size(), kMostOverviewPixels});
    const bool overview = !plans.empty() && plans[1].pixel > plans[0].pixel;
    floors.json.push_back({{"number", optionalJson(number)},
                           {"height", heightOf(view, number)},
                           {"plan", plans.empty() ? Json(nullptr) : imageJson(plans[0])},
                           {"overview", overview ? imageJson(plans[1]) : Json(nullptr)},
                           {"layers", Json::array()}});
    scenes.push_back(layerScenes(view, number, grid.resolution()));
  }

  std::vector<const TopView*> rasters;
  for (const auto& ofFloor : scenes) {
    for (const auto& scene : ofFloor) rasters.push_back(&scene.raster);
  }
  const auto images = imagesOf(rasters);
  auto image = images.begin();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (auto& scene : scenes[i]) {
      floors.json[i]["layers"].push_back({{"type", scene.type},
                                          {"image", *image ? imageJson(**image) : Json(nullptr)},
                                          {"shapes", std::move(scene.shapes)}});
      ++image;
    }
  }
  return floors;
}

}  // namespace prodomos::exporter
