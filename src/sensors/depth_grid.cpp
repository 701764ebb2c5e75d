// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/sensors/depth_grid.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace prodomos::sensors {

namespace {

/// Depths of one block belong together within this share of its centre's.
constexpr float kSameSurface = 0.02F;
constexpr int kMostPixels = 20000;

}  // namespace

DepthGrid::DepthGrid(const Camera& camera, const Image<float>& depth, const Mask* movers, double maxDepth,
                     const DepthGrid* earlier) {
  resize(camera, earlier);
  const auto most = static_cast<float>(maxDepth);
  const auto usable = [most](float z) { return z > 0.0F && z < most; };  // false for NaN
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      Cell& cell = cells_[index(x, y)];
      const int left = x * kBlock;
      const int top = y * kBlock;
      float center = depth.row(top + kBlock / 2)[left + kBlock / 2];
      if (!usable(center)) center = depth.row(top + kBlock / 2 - 1)[left + kBlock / 2 - 1];
      if (!usable(center)) continue;
      if (movers != nullptr && movers->row(top + kBlock / 2)[left + kBlock / 2] != 0) continue;
      float sum = 0.0F;
      int count = 0;
      for (int v = top; v < top + kBlock; ++v) {
        const float* row = depth.row(v);
        for (int u = left; u < left + kBlock; ++u) {
          if (!(std::abs(row[u] - center) < kSameSurface * center)) continue;
          sum += row[u];
          ++count;
        }
      }
      cell.depth = sum / static_cast<float>(count);
      ++known_;
    }
  }
}

void DepthGrid::resize(const Camera& camera, const DepthGrid* earlier) {
  camera_ = camera;
  width_ = camera.width() / kBlock;
  height_ = camera.height() / kBlock;
  known_ = 0;
  cells_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), Cell{});
  if (earlier != nullptr && earlier->camera_ == camera) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      cells_[i].rayX = earlier->cells_[i].rayX;
      cells_[i].rayY = earlier->cells_[i].rayY;
    }
    return;
  }
  constexpr double kCenter = 0.5 * (kBlock - 1);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector2f ray = camera.ray({x * kBlock + kCenter, y * kBlock + kCenter}).cast<float>();
      Cell& cell = cells_[index(x, y)];
      cell.rayX = ray.x();
      cell.rayY = ray.y();
    }
  }
}

const DepthGrid::Cell* DepthGrid::cellAt(const Eigen::Vector3d& point) const {
  if (!(point.z() > 0.05)) return nullptr;
  const Eigen::Vector2d pixel = camera_.pixel(point.head<2>() / point.z());
  const double x = (pixel.x() + 0.5) / kBlock;
  const double y = (pixel.y() + 0.5) / kBlock;
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return nullptr;
  const Cell& cell = at(static_cast<int>(x), static_cast<int>(y));
  return cell.depth > 0.0F ? &cell : nullptr;
}

void DepthGrid::computeNormals() {
  constexpr int kReach = 2;        // cells to each side
  constexpr int kLeastCells = 12;  // of the 25
  for (int y = kReach; y < height_ - kReach; ++y) {
    for (int x = kReach; x < width_ - kReach; ++x) {
      Cell& center = cells_[index(x, y)];
      if (!(center.depth > 0.0F)) continue;
      Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
      Eigen::Vector3d products = Eigen::Vector3d::Zero();
      int count = 0;
      const float reach = center.depth * (0.03F + 0.02F * center.depth);
      for (int v = y - kReach; v <= y + kReach; ++v) {
        for (int u = x - kReach; u <= x + kReach; ++u) {
          const Cell& cell = at(u, v);
          if (!(cell.depth > 0.0F) || std::abs(cell.depth - center.depth) > reach) continue;
          const Eigen::Vector3d a(static_cast<double>(cell.rayX - center.rayX),
                                  static_cast<double>(cell.rayY - center.rayY), 1.0);
          squares.noalias() += a * a.transpose();
          products += a / static_cast<double>(cell.depth);
          ++count;
        }
      }
      if (count < kLeastCells) continue;
      // 1/z = a (x - x0) + b (y - y0) + c, that is a X + b Y + (c - a x0 - b y0) Z = 1 for the point (X, Y, Z).
      const Eigen::Vector3d abc = squares.ldlt().solve(products);
      Eigen::Vector3d normal(
          abc.x(), abc.y(),
          abc.z() - abc.x() * static_cast<double>(center.rayX) - abc.y() * static_cast<double>(center.rayY));
      const double length = normal.norm();
      if (!(length > 0.0) || !std::isfinite(length)) continue;
      normal /= -length;
      center.normalX = static_cast<float>(normal.x());
      center.normalY = static_cast<float>(normal.y());
      center.normalZ = static_cast<float>(normal.z());
    }
  }
}

void DepthGrid::save(base::ByteWriter& out) const {
  const auto& intrinsics = camera_.intrinsics();
  out << intrinsics.fx << intrinsics.fy << intrinsics.cx << intrinsics.cy;
  for (const double k : intrinsics.distortion) out << k;
  out << camera_.width() << camera_.height();
  std::vector<float> depths(cells_.size());
  std::ranges::transform(cells_, depths.begin(), &Cell::depth);
  out << depths;
}

void DepthGrid::load(base::ByteReader& in) {
  CameraIntrinsics intrinsics;
  in >> intrinsics.fx >> intrinsics.fy >> intrinsics.cx >> intrinsics.cy;
  for (double& k : intrinsics.distortion) in >> k;
  const int width = in.read<int>();
  const int height = in.read<int>();
  if (width < 0 || height < 0 || width > kMostPixels || height > kMostPixels) {
    throw base::Error(base::expectedFound("a saved depth image",
                                          "at most " + std::to_string(kMostPixels) + " pixels a side",
                                          std::to_string(width) + "x" + std::to_string(height)));
  }
  resize(Camera(intrinsics, width, height), nullptr);
  std::vector<float> depths;
  in >> depths;
  if (depths.size() != cells_.size()) {
    throw base::Error(base::expectedFound("a saved depth image", std::to_string(cells_.size()) + " cells",
                                          std::to_string(depths.size())));
  }
  for (std::size_t i = 0; i < depths.size(); ++i) {
    cells_[i].depth = depths[i];
    known_ += depths[i] > 0.0F ? 1 : 0;
  }
  computeNormals();
}

}  // namespace prodomos::sensors
