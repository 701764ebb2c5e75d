// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/rgbd_features.hpp"

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace prodomos::localization::rgbd {

namespace {

constexpr int kFurthest = 64;         ///< differing bits of 256 up to which two descriptors are taken as alike
constexpr double kScaleFactor = 1.2;  ///< from one octave to the next

/// OpenCV takes images as it may write to them, and does not.
template <typename Pixel>
cv::Mat wrapped(const sensors::Image<Pixel>& image, int type) {
  return {image.height(), image.width(), type, const_cast<Pixel*>(image.data())};
}

/// 0 where it is not known or the surroundings are at several depths: the corner may be of either.
float depthAround(const sensors::Image<float>& depth, double u, double v, double maxDepth) {
  constexpr float kSpread = 0.04F;  // of the depth
  const int x = static_cast<int>(std::lround(u));
  const int y = static_cast<int>(std::lround(v));
  if (depth.empty() || x < 1 || y < 1 || x + 1 >= depth.width() || y + 1 >= depth.height()) return 0.0F;
  float least = std::numeric_limits<float>::max();
  float most = 0.0F;
  float sum = 0.0F;
  int count = 0;
  for (int row = y - 1; row <= y + 1; ++row) {
    for (int column = x - 1; column <= x + 1; ++column) {
      const float z = depth.row(row)[column];
      if (!(z > 0.0F) || !(z < static_cast<float>(maxDepth))) continue;
      least = std::min(least, z);
      most = std::max(most, z);
      sum += z;
      ++count;
    }
  }
  if (count < 4 || most - least > kSpread * least) return 0.0F;
  return sum / static_cast<float>(count);
}

/// The strongest of each tile of the image in turn, until `count` are chosen: their indices in ascending order.
std::vector<std::size_t> spread(const std::vector<cv::KeyPoint>& corners, const cv::Size& size, std::size_t count) {
  std::vector<std::size_t> chosen(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) chosen[i] = i;
  if (corners.size() <= count) return chosen;
  constexpr int kTile = 40;  // pixels
  const int columns = size.width / kTile + 1;
  const auto tileOf = [&](std::size_t i) {
    return static_cast<int>(corners[i].pt.y) / kTile * columns + static_cast<int>(corners[i].pt.x) / kTile;
  };
  std::ranges::stable_sort(chosen, [&](auto a, auto b) { return corners[a].response > corners[b].response; });
  std::vector<int> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(size.height / kTile + 1), 0);
  std::vector<int> rank(corners.size());
  for (const auto i : chosen) rank[i] = taken[static_cast<std::size_t>(tileOf(i))]++;
  std::ranges::stable_sort(chosen, [&](auto a, auto b) { return rank[a] < rank[b]; });
  chosen.resize(count);
  std::ranges::sort(chosen);
  return chosen;
}

int difference(const KeyPoint& a, const KeyPoint& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.descriptor.size(); ++i) bits += std::popcount(a.descriptor[i] ^ b.descriptor[i]);
  return bits;
}

cv::Mat descriptorsOf(std::span<const KeyPoint> points) {
  cv::Mat rows(static_cast<int>(points.size()), 32, CV_8U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(rows.ptr(static_cast<int>(i)), points[i].descriptor.data(), 32);
  }
  return rows;
}

/// Key points by tiles of the image, for looking around a place.
class Tiles {
 public:
  Tiles(std::span<const KeyPoint> points, const Camera& camera)
      : columns_(camera.width() / kTile + 1), rows_(camera.height() / kTile + 1) {
    tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    pixels_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      pixels_.push_back(camera.pixel(rayOf(points[i])));
      tiles_[index(clamped(pixels_[i].x(), columns_), clamped(pixels_[i].y(), rows_))].push_back(i);
    }
  }

  template <typename Use>
  void around(const Eigen::Vector2d& pixel, double radius, Use&& use) const {
    for (int y = clamped(pixel.y() - radius, rows_); y <= clamped(pixel.y() + radius, rows_); ++y) {
      for (int x = clamped(pixel.x() - radius, columns_); x <= clamped(pixel.x() + radius, columns_); ++x) {
        for (const auto i : tiles_[index(x, y)]) {
          if ((pixels_[i] - pixel).squaredNorm() < radius * radius) use(i);
        }
      }
    }
  }

 private:
  static constexpr int kTile = 20;  ///< pixels
  static int clamped(double pixel, int count) {
    return static_cast<int>(std::clamp(pixel / kTile, 0.0, static_cast<double>(count - 1)));
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  }

  int columns_;
  int rows_;
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<std::vector<std::uint32_t>> tiles_;
};

}  // namespace

std::vector<KeyPoint> findKeyPoints(const Camera& camera, const sensors::RgbdFrame& frame, const sensors::Mask* movers,
                                    int count, double maxDepth) {
  if (frame.color.empty() || count == 0) return {};
  cv::Mat gray;
  cv::cvtColor(wrapped(frame.color, CV_8UC3), gray, cv::COLOR_RGB2GRAY);
  cv::Mat still;
  if (movers != nullptr) still = wrapped(*movers, CV_8U) == 0;
  constexpr int kOctaves = 6;
  constexpr int kEdge = 19;
  constexpr int kFastThreshold = 8;
  const auto orb = cv::ORB::create(count * 3 / 2, static_cast<float>(kScaleFactor), kOctaves, kEdge, 0, 2,
                                   cv::ORB::HARRIS_SCORE, 31, kFastThreshold);
  std::vector<cv::KeyPoint> corners;
  cv::Mat descriptors;
  orb->detectAndCompute(gray, still, corners, descriptors);

  std::vector<KeyPoint> points;
  for (const auto i : spread(corners, gray.size(), static_cast<std::size_t>(count))) {
    const cv::KeyPoint& corner = corners[i];
    const Eigen::Vector2d pixel(static_cast<double>(corner.pt.x), static_cast<double>(corner.pt.y));
    const Eigen::Vector2f ray = camera.ray(pixel).cast<float>();
    KeyPoint& point = points.emplace_back();
    point.rayX = ray.x();
    point.rayY = ray.y();
    point.depth = depthAround(frame.depth, pixel.x(), pixel.y(), maxDepth);
    point.sigma = static_cast<float>(std::pow(kScaleFactor, corner.octave));
    std::memcpy(point.descriptor.data(), descriptors.ptr(static_cast<int>(i)), 32);
  }
  return points;
}

std::vector<Match> matchAnywhere(std::span<const KeyPoint> reference, std::span<const KeyPoint> current) {
  if (reference.size() < 2 || current.size() < 2) return {};
  constexpr float kClearly = 0.85F;
  std::vector<std::vector<cv::DMatch>> best;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(descriptorsOf(reference), descriptorsOf(current), best, 2);
  std::vector<int> claimedBy(current.size(), -1);  // the reference that looks most alike
  const auto claims = [&](const std::vector<cv::DMatch>& two) {
    return two.size() == 2 && two[0].distance <= kFurthest && two[0].distance < kClearly * two[1].distance;
  };
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (!claims(best[i])) continue;
    int& claimed = claimedBy[static_cast<std::size_t>(best[i][0].trainIdx)];
    if (claimed < 0 || best[i][0].distance < best[static_cast<std::size_t>(claimed)][0].distance) {
      claimed = static_cast<int>(i);
    }
  }
  std::vector<Match> matches;
  for (std::uint32_t i = 0; i < current.size(); ++i) {
    if (claimedBy[i] >= 0) matches.push_back({static_cast<std::uint32_t>(claimedBy[i]), i});
  }
  return matches;
}

std::vector<Match> matchNear(std::span<const KeyPoint> reference, std::span<const KeyPoint> current,
                             const geometry::Pose3& T_current_reference, const Camera& camera, double radius) {
  struct Claim {
    int bits = kFurthest + 1;
    std::uint32_t reference = 0;
  };
  std::vector<Claim> claims(current.size());
  const Tiles tiles(current, camera);
  for (std::uint32_t i = 0; i < reference.size(); ++i) {
    if (!(reference[i].depth > 0.0F)) continue;
    const Eigen::Vector3d point = T_current_reference * pointOf(reference[i]);
    if (point.z() < 0.1) continue;
    const Eigen::Vector2d pixel = camera.pixel(point.head<2>() / point.z());
    if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < camera.width() && pixel.y() < camera.height())) continue;
    int bits = kFurthest + 1;
    int second = bits;
    std::uint32_t nearest = 0;
    tiles.around(pixel, radius, [&](std::uint32_t j) {
      const int now = difference(reference[i], current[j]);
      if (now < bits) {
        second = bits;
        bits = now;
        nearest = j;
      } else if (now < second) {
        second = now;
      }
    });
    if (bits > kFurthest || bits * 10 > second * 9 || bits >= claims[nearest].bits) continue;
    claims[nearest] = {bits, i};
  }
  std::vector<Match> matches;
  for (std::uint32_t j = 0; j < claims.size(); ++j) {
    if (claims[j].bits <= kFurthest) matches.push_back({claims[j].reference, j});
  }
  return matches;
}

}  // namespace prodomos::localization::rgbd
