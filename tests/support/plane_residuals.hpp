// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/error.hpp"
#include "prodomos/base/random.hpp"
#include "prodomos/geometry/plane.hpp"
#include "prodomos/sensors/reading.hpp"
#include "prodomos/simulation/depth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// How far depth strays from flat surfaces: one protocol for real and for simulated pictures.
///
/// A picture is divided into windows of 80 x 80 pixels. Of a window with depth at 95 % of its pixels, the plane is
/// found that most points lie on (RANSAC, then least squares) within 1 cm + 0.6 % of z² (four sigma of such a camera);
/// if it holds 97 % of them the window shows one flat surface. Its residual is the robust rms, 1.4826 times the median
/// of the points' distances from the plane. A figure of a bin is the median of its windows' residuals.
namespace prodomos::test {

constexpr int kWindow = 80;

struct PlaneWindow {
  int frame = 0;
  int x = 0;  ///< of its upper left pixel
  int y = 0;
  geometry::Plane plane_in_camera;
  double range = 0.0;     ///< median of z, metres
  double cosine = 0.0;    ///< of the incidence in its middle
  double residual = 0.0;  ///< metres
};

inline std::vector<Eigen::Vector3d> windowPoints(const sensors::Image<float>& depth,
                                                 const sensors::CameraIntrinsics& camera, int x0, int y0) {
  std::vector<Eigen::Vector3d> points;
  for (int y = y0; y < y0 + kWindow; ++y) {
    for (int x = x0; x < x0 + kWindow; ++x) {
      const double z = depth(x, y);
      if (z > 0.0) points.emplace_back((x - camera.cx) / camera.fx * z, (y - camera.cy) / camera.fy * z, z);
    }
  }
  return points;
}

inline double medianOf(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

inline std::optional<PlaneWindow> measureWindow(const sensors::Image<float>& depth,
                                                const sensors::CameraIntrinsics& camera, int x, int y) {
  const auto points = windowPoints(depth, camera, x, y);
  if (static_cast<int>(points.size()) < 0.95 * kWindow * kWindow) return std::nullopt;
  base::Random random(1, "plane windows");
  const auto tolerance = [](const Eigen::Vector3d& point) { return 0.01 + 0.006 * point.z() * point.z(); };
  const auto found =
      geometry::findPlane(points, {.trials = 50, .tolerance = tolerance, .facing = -Eigen::Vector3d::UnitZ()}, random);
  if (!found || static_cast<double>(found->inliers.size()) < 0.97 * static_cast<double>(points.size())) {
    return std::nullopt;
  }
  std::vector<double> depths;
  std::vector<double> distances;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& point : points) {
    depths.push_back(point.z());
    distances.push_back(std::abs(found->plane.signedDistance(point)));
    middle += point / static_cast<double>(points.size());
  }
  return PlaneWindow{.x = x,
                     .y = y,
                     .plane_in_camera = found->plane,
                     .range = medianOf(depths),
                     .cosine = std::abs(found->plane.normal.dot(middle.normalized())),
                     .residual = 1.4826 * medianOf(distances)};
}

inline std::vector<PlaneWindow> measureWindows(const sensors::Image<float>& depth,
                                               const sensors::CameraIntrinsics& camera, int frame) {
  std::vector<PlaneWindow> windows;
  for (int y = 0; y + kWindow <= depth.height(); y += kWindow) {
    for (int x = 0; x + kWindow <= depth.width(); x += kWindow) {
      if (auto window = measureWindow(depth, camera, x, y)) {
        window->frame = frame;
        windows.push_back(*window);
      }
    }
  }
  return windows;
}

/// Range in whole metres, and whether seen from the front (cosine of 0.8 and more) or from aside (0.3 to 0.8).
struct Bin {
  int range = 0;
  bool isFrontal = false;
  auto operator<=>(const Bin&) const = default;
};

/// None: seen flatter than any bin, or too near the end of the range for windows to be whole.
inline std::optional<Bin> binOf(const PlaneWindow& window) {
  if (window.cosine < 0.3 || window.range < 0.6 || window.range > 4.8) return std::nullopt;
  return Bin{static_cast<int>(window.range), window.cosine >= 0.8};
}

/// The picture that an exact camera would have taken of these windows' planes alone.
inline simulation::Rendering flatRendering(const std::vector<PlaneWindow>& windows,
                                           const simulation::CameraModel& camera) {
  simulation::Rendering flat{.depth = sensors::Image<float>(camera.width, camera.height),
                             .cosine = sensors::Image<float>(camera.width, camera.height),
                             .infrared = sensors::Image<float>(camera.width, camera.height)};
  const auto& in = camera.intrinsics;
  for (const auto& window : windows) {
    for (int y = window.y; y < window.y + kWindow; ++y) {
      for (int x = window.x; x < window.x + kWindow; ++x) {
        const Eigen::Vector3d ray((x - in.cx) / in.fx, (y - in.cy) / in.fy, 1.0);
        const double z = window.plane_in_camera.offset / window.plane_in_camera.normal.dot(ray);
        if (z <= 0.0) continue;
        flat.depth(x, y) = static_cast<float>(z);
        flat.cosine(x, y) = static_cast<float>(std::abs(window.plane_in_camera.normal.dot(ray.normalized())));
        flat.infrared(x, y) = 0.8F * flat.cosine(x, y);
      }
    }
  }
  return flat;
}

/// The same windows, seen by a simulated camera. Those that are no longer flat are left out.
inline std::vector<PlaneWindow> simulatedWindows(const std::vector<PlaneWindow>& real,
                                                 const simulation::CameraModel& camera,
                                                 const simulation::DepthNoise& noise) {
  std::map<int, std::vector<PlaneWindow>> frames;
  for (const auto& window : real) frames[window.frame].push_back(window);
  std::vector<PlaneWindow> simulated;
  base::Random random(1, "simulated windows");
  for (const auto& [frame, windows] : frames) {
    const auto depth = simulation::noisyDepth(flatRendering(windows, camera), camera, noise, random);
    for (const auto& window : windows) {
      auto measured = measureWindow(depth, camera.intrinsics, window.x, window.y);
      if (!measured) continue;
      measured->frame = frame;
      simulated.push_back(*measured);
    }
  }
  return simulated;
}

struct BinFigure {
  std::size_t windows = 0;
  double residual = 0.0;  ///< median, metres
};

inline std::map<Bin, BinFigure> figuresOf(const std::vector<PlaneWindow>& windows) {
  std::map<Bin, std::vector<double>> residuals;
  for (const auto& window : windows) {
    if (const auto bin = binOf(window)) residuals[*bin].push_back(window.residual);
  }
  std::map<Bin, BinFigure> figures;
  for (const auto& [bin, values] : residuals) figures[bin] = {values.size(), medianOf(values)};
  return figures;
}

/// One line a window: frame, x, y, normal, offset, range, cosine, residual; before them fx, fy, cx, cy.
struct PlaneWindowFile {
  sensors::CameraIntrinsics camera;
  std::vector<PlaneWindow> windows;
};

inline void writeWindows(const PlaneWindowFile& file, const std::filesystem::path& path) {
  std::ofstream out(path);
  out << std::setprecision(7) << file.camera.fx << ' ' << file.camera.fy << ' ' << file.camera.cx << ' '
      << file.camera.cy << '\n'
      << std::setprecision(5);
  for (const auto& w : file.windows) {
    const auto& plane = w.plane_in_camera;
    out << w.frame << ' ' << w.x << ' ' << w.y << ' ' << plane.normal.x() << ' ' << plane.normal.y() << ' '
        << plane.normal.z() << ' ' << plane.offset << ' ' << w.range << ' ' << w.cosine << ' ' << w.residual << '\n';
  }
}

inline PlaneWindowFile readWindows(const std::filesystem::path& path) {
  std::ifstream in(path);
  PlaneWindowFile file;
  if (!(in >> file.camera.fx >> file.camera.fy >> file.camera.cx >> file.camera.cy)) {
    throw base::FileError(base::expectedFound(path.string(), "fx fy cx cy", "none"));
  }
  for (PlaneWindow w; in >> w.frame >> w.x >> w.y >> w.plane_in_camera.normal.x() >> w.plane_in_camera.normal.y() >>
                      w.plane_in_camera.normal.z() >> w.plane_in_camera.offset >> w.range >> w.cosine >> w.residual;) {
    w.plane_in_camera.normal.normalize();
    file.windows.push_back(w);
  }
  return file;
}

}  // namespace prodomos::test
