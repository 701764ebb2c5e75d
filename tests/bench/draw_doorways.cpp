// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws a map's doorways on its fused grid (docs/doorways.md).
//
//     draw_doorways MAP -o PICTURE.png
#include "prodomos/map/fused_grid.hpp"
#include "prodomos/map/map_view.hpp"

#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <iostream>
#include <string>
#include <variant>
#include <vector>

namespace {

using namespace prodomos;

struct Doorway {
  geometry::Pose2 T_map_doorway;
  double width = 0.0;
};

std::vector<Doorway> doorwaysOf(const map::MapView& view) {
  std::vector<Doorway> doorways;
  for (const auto& entity : view.entities()) {
    const auto* door = std::get_if<map::Door>(&entity.attributes);
    if (door == nullptr || door->hasLeaf) continue;
    const auto& T_map_submap = view.graph().getNode(entity.submap).T_map_submap;
    doorways.push_back({geometry::toPose2(T_map_submap * entity.T_submap_entity), door->width});
  }
  return doorways;
}

cv::Mat draw(const map::OccupancyGrid& grid, const std::vector<Doorway>& doorways) {
  constexpr int kScale = 2;  // pixels a cell
  const auto box = grid.knownBox();
  cv::Mat picture(box.height() * kScale, box.width() * kScale, CV_8UC3, cv::Scalar(150, 150, 150));
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x; x <= box.last.x; ++x) {
      const auto state = grid.state({x, y});
      if (state == map::CellState::kUnknown) continue;
      const cv::Rect cell((x - box.first.x) * kScale, (box.last.y - y) * kScale, kScale, kScale);
      const int shade = state == map::CellState::kFree ? 250 : 40;
      cv::rectangle(picture, cell, cv::Scalar(shade, shade, shade), cv::FILLED);
    }
  }
  const auto pixel = [&](const Eigen::Vector2d& point) {
    return cv::Point(static_cast<int>((point.x() / grid.resolution() - box.first.x) * kScale),
                     static_cast<int>((box.last.y + 1 - point.y() / grid.resolution()) * kScale));
  };
  int number = 0;
  for (const auto& doorway : doorways) {
    const auto end = [&](double side) { return pixel(doorway.T_map_doorway * Eigen::Vector2d(0.0, side)); };
    cv::line(picture, end(-0.5 * doorway.width), end(0.5 * doorway.width), cv::Scalar(30, 60, 230), 4, cv::LINE_AA);
    cv::putText(picture, std::to_string(number++), end(0.0) + cv::Point(4, -4), cv::FONT_HERSHEY_SIMPLEX, 0.5,
                cv::Scalar(200, 60, 0), 1, cv::LINE_AA);
  }
  return picture;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"doorways on the map of a laser log"};
  std::string map;
  std::string output;
  app.add_option("MAP", map)->required();
  app.add_option("-o,--output", output)->required();
  CLI11_PARSE(app, argc, argv);
  const auto view = map::MapView::open(map);
  const auto doorways = doorwaysOf(view);
  cv::imwrite(output, draw(map::fuseGrids(view), doorways));
  std::cout << doorways.size() << " doorways\n";
}
