// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// CPU time of simulated pictures, doors and people moving from one to the next (docs/sensor-models.md):
//
//     bench_rendering WORLD [--frames N] [--threads N] [--pictures FOLDER]
#include "prodomos/simulation/color_noise.hpp"
#include "prodomos/simulation/depth_noise.hpp"
#include "prodomos/simulation/furniture.hpp"
#include "prodomos/simulation/population.hpp"
#include "prodomos/simulation/renderer.hpp"
#include "prodomos/simulation/world_file.hpp"

#include "simulation/stage.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <string>

namespace {

using namespace prodomos;
using namespace prodomos::simulation;

/// Process time, all threads together, milliseconds.
double cpuTime() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Mean CPU time and wall time of what is done between start() and stop().
class Cost {
 public:
  void start() {
    cpu_ -= cpuTime();
    begin_ = std::chrono::steady_clock::now();
  }
  void stop() {
    cpu_ += cpuTime();
    wall_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
    ++count_;
  }
  void print(const std::string& name) const {
    std::cout << std::setw(8) << name << "  CPU " << std::fixed << std::setprecision(1) << std::setw(7) << cpu_ / count_
              << " ms, wall " << std::setw(7) << wall_ / count_ << " ms a frame\n";
  }

 private:
  double cpu_ = 0.0;
  double wall_ = 0.0;
  int count_ = 0;
  std::chrono::steady_clock::time_point begin_;
};

/// Somewhere in a room of at least 4 m², at a robot's eye height.
geometry::Pose3 somewhere(const Building& building, base::Random& random) {
  for (;;) {
    const auto& room =
        building.rooms[static_cast<std::size_t>(random.integer(0, static_cast<int>(building.rooms.size()) - 1))];
    Eigen::Vector2d low = room.outline.front();
    Eigen::Vector2d high = low;
    for (const auto& corner : room.outline) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const Eigen::Vector2d at(random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()));
    if (signedArea(room.outline) < 4.0 || !contains(room.outline, at)) continue;
    const double floor = building.storeys[static_cast<std::size_t>(room.storey)].floor_z;
    return geometry::fromYawPitchRoll({at.x(), at.y(), floor + 1.1}, random.uniform(0.0, 2.0 * std::numbers::pi), 0.1,
                                      0.0) *
           sensors::cameraAxesInBody();
  }
}

void writePicture(const sensors::Image<sensors::Rgb>& color, const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  out << "P6\n" << color.width() << ' ' << color.height() << "\n255\n";
  for (const auto& pixel : color.pixels())
    out << static_cast<char>(pixel.r) << static_cast<char>(pixel.g) << static_cast<char>(pixel.b);
}

std::size_t trianglesOf(const std::vector<Surface>& surfaces) {
  std::size_t count = 0;
  for (const auto& surface : surfaces) count += surface.triangles.size();
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("CPU time of simulated pictures");
  std::string world;
  std::string pictures;
  int frames = 40;
  int threads = 2;
  app.add_option("world", world, "a Gazebo world or its folder")->required();
  app.add_option("--frames", frames);
  app.add_option("--threads", threads);
  app.add_option("--pictures", pictures, "folder to write them to, as PPM");
  CLI11_PARSE(app, argc, argv);
  try {
    Building building = readWorld(world);
    furnish(building, 1);
    populate(building, 1, frames);
    Stage stage(building, 1);
    const Renderer renderer(stage.scene(), building.textures, building.lighting);
    std::cout << trianglesOf(stage.scene().fixed()) << " triangles that stand, " << trianglesOf(stage.scene().moving())
              << " that move\n";
    base::Random random(1, "bench");
    Cost stageCost, renderCost, depthCost, colorCost, all;
    for (int frame = 0; frame < frames; ++frame) {
      const auto T_world_camera = somewhere(building, random);
      all.start();
      stageCost.start();
      stage.setTime(frame, T_world_camera.translation(), threads);
      stageCost.stop();
      renderCost.start();
      const auto rendering = renderer.render(T_world_camera, threads);
      renderCost.stop();
      depthCost.start();
      noisyDepth(rendering, renderer.camera(), {}, random, threads);
      depthCost.stop();
      colorCost.start();
      const auto color = noisyColor(rendering.color, {}, random, threads);
      colorCost.stop();
      all.stop();
      if (!pictures.empty()) writePicture(color, std::filesystem::path(pictures) / (std::to_string(frame) + ".ppm"));
    }
    stageCost.print("stage");
    renderCost.print("render");
    depthCost.print("depth");
    colorCost.print("colour");
    all.print("all");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
