// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// Plane residuals of depth pictures per metre of range, real and simulated (docs/sensor-models.md).
//
//     plane_residuals LOG [--every N] [--camera FX FY CX CY] [--write WINDOWS]     measure a log with a depth camera
//     plane_residuals --simulate WINDOWS                                           the same windows, seen by the
//     simulated camera
#include "support/plane_residuals.hpp"

#include "prodomos/io/open_source.hpp"

#include <CLI/CLI.hpp>

#include <iostream>

namespace {

using namespace prodomos;

test::PlaneWindowFile measure(const std::string& log, int every, const std::vector<double>& camera) {
  io::SourceOptions options;
  if (!camera.empty()) options.camera = sensors::CameraIntrinsics{camera[0], camera[1], camera[2], camera[3], {}};
  const auto source = io::openSource(log, options);
  test::PlaneWindowFile file;
  int frame = 0;
  for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
    const auto* reading = std::get_if<sensors::Reading>(&item);
    const auto* rgbd = reading == nullptr ? nullptr : std::get_if<sensors::RgbdFrame>(&reading->data);
    if (rgbd == nullptr || rgbd->depth.empty()) continue;
    if (frame++ % every != 0) continue;
    file.camera = rgbd->camera;
    for (const auto& window : test::measureWindows(rgbd->depth, rgbd->camera, frame - 1)) {
      if (test::binOf(window)) file.windows.push_back(window);
    }
  }
  return file;
}

void print(const std::map<test::Bin, test::BinFigure>& real, const std::map<test::Bin, test::BinFigure>& simulated) {
  std::cout << "range m  view     windows  residual mm" << (simulated.empty() ? "\n" : "  simulated mm  ratio\n");
  for (const auto& [bin, figure] : real) {
    std::cout << "  " << bin.range << "-" << bin.range + 1 << "    " << (bin.isFrontal ? "frontal" : "oblique") << "  "
              << std::setw(7) << figure.windows << "  " << std::fixed << std::setprecision(2) << std::setw(11)
              << 1e3 * figure.residual;
    if (const auto other = simulated.find(bin); other != simulated.end()) {
      std::cout << "  " << std::setw(12) << 1e3 * other->second.residual << "  " << std::setw(5)
                << other->second.residual / figure.residual;
    }
    std::cout << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Plane residuals of depth pictures, real and simulated");
  std::string log;
  std::string simulate;
  std::string write;
  int every = 1;
  std::vector<double> camera;
  app.add_option("log", log, "a log with a depth camera");
  app.add_option("--every", every, "take each N-th picture");
  app.add_option("--camera", camera, "its fx, fy, cx and cy, where the log does not say")->expected(4);
  app.add_option("--write", write, "write the windows found to this file");
  app.add_option("--simulate", simulate, "windows written before: compare with the simulated camera");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto file = simulate.empty() ? measure(log, every, camera) : test::readWindows(simulate);
    if (!write.empty()) test::writeWindows(file, write);
    std::map<test::Bin, test::BinFigure> simulated;
    if (!simulate.empty()) {
      const simulation::CameraModel model{.intrinsics = file.camera};
      simulated = test::figuresOf(test::simulatedWindows(file.windows, model, {}));
    }
    print(test::figuresOf(file.windows), simulated);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
