// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/scan_segments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prodomos::perception {

namespace {

constexpr double kSigma = 0.015;                                     // metres, of a range
constexpr double kLeastIncidence = 10.0 * std::numbers::pi / 180.0;  // of beams on what is still one surface
constexpr double kStraight = 0.05;                                   // metres that a straight thing deviates
constexpr double kMostRange = 8.0;                                   // metres
constexpr std::size_t kLeastBeams = 4;

/// Whether neighbouring beams may have met one surface.
bool areTogether(const ScanBeam& a, const ScanBeam& b) {
  if (!a.isHit() || !b.isHit() || a.range > kMostRange || b.range > kMostRange) return false;
  const double sineOfStep = std::abs(a.direction.x() * b.direction.y() - a.direction.y() * b.direction.x());
  const double incidence = kLeastIncidence - std::asin(std::min(0.5 * kLeastIncidence, sineOfStep));
  return (a.end() - b.end()).norm() < std::min(a.range, b.range) * sineOfStep / std::sin(incidence) + 3.0 * kSigma;
}

ScanSegment fitted(const std::vector<ScanBeam>& beams, std::size_t begin, std::size_t end) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = begin; i < end; ++i) mean += beams[i].end();
  mean /= static_cast<double>(end - begin);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector2d offset = beams[i].end() - mean;
    spread += offset * offset.transpose();
  }
  const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const auto onLine = [&](const Eigen::Vector2d& point) -> Eigen::Vector2d {
    return mean + along * along.dot(point - mean);
  };
  return {begin, end, onLine(beams[begin].end()), onLine(beams[end - 1].end())};
}

/// Iterative end point fit.
void split(const std::vector<ScanBeam>& beams, std::size_t begin, std::size_t end, std::vector<ScanSegment>& segments) {
  if (end - begin < kLeastBeams) return;
  const Eigen::Vector2d first = beams[begin].end();
  const Eigen::Vector2d along = (beams[end - 1].end() - first).normalized();
  std::size_t farthest = begin;
  double most = kStraight;
  for (std::size_t i = begin + 1; i + 1 < end; ++i) {
    const Eigen::Vector2d offset = beams[i].end() - first;
    const double distance = std::abs(along.x() * offset.y() - along.y() * offset.x());
    if (distance <= most) continue;
    most = distance;
    farthest = i;
  }
  if (farthest == begin) return segments.push_back(fitted(beams, begin, end));
  split(beams, begin, farthest + 1, segments);
  split(beams, farthest, end, segments);
}

}  // namespace

bool ScanBeam::isHit() const {
  return range > 0.0 && std::isfinite(range);
}

std::vector<ScanBeam> beamsOf(const sensors::LaserScan& scan) {
  std::vector<ScanBeam> beams;
  beams.reserve(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range{scan.ranges[i]};
    if (!(range > 0.0)) continue;
    const double angle = scan.firstAngle + static_cast<double>(i) * scan.angleStep;
    beams.push_back({Eigen::Vector2d(std::cos(angle), std::sin(angle)), range});
  }
  return beams;
}

std::vector<ScanSegment> segmentsOf(const std::vector<ScanBeam>& beams) {
  std::vector<ScanSegment> segments;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= beams.size(); ++i) {
    if (i < beams.size() && areTogether(beams[i - 1], beams[i])) continue;
    split(beams, begin, i, segments);
    begin = i;
  }
  return segments;
}

}  // namespace prodomos::perception
