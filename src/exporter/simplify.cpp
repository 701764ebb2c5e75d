// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/simplify.hpp"

#include <algorithm>

namespace prodomos::exporter {
namespace {

double distance(const Eigen::Vector2d& point, const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  const Eigen::Vector2d along = end - begin;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((point - begin).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - begin - t * along).norm();
}

}  // namespace

Polyline simplified(const Polyline& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size());
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    std::size_t furthest = begin;
    double greatest = tolerance;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const double here = distance(line[i], line[begin], line[end]);
      if (here > greatest) {
        greatest = here;
        furthest = i;
      }
    }
    if (furthest == begin) continue;
    kept[furthest] = true;
    open.emplace_back(begin, furthest);
    open.emplace_back(furthest, end);
  }
  Polyline out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) out.push_back(line[i]);
  }
  return out;
}

}  // namespace prodomos::exporter
