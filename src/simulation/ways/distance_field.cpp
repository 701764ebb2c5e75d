// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ways/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prodomos::simulation {

namespace {

constexpr float kFar = 1e12F;

/// The lower envelope of parabolas that stand on the samples of one line.
class Envelope {
 public:
  explicit Envelope(std::size_t length) : roots_(length), begins_(length + 1), sampled_(length) {}

  /// Replaces each value by the least of value(q) + (q - p)².
  void transform(std::vector<float>& values) {
    const int n = static_cast<int>(values.size());
    std::size_t top = 0;
    roots_[0] = 0;
    begins_[0] = -std::numeric_limits<double>::infinity();
    for (int q = 1; q < n; ++q) {
      double begin = meeting(values, roots_[top], q);
      while (begin <= begins_[top]) begin = meeting(values, roots_[--top], q);
      roots_[++top] = q;
      begins_[top] = begin;
    }
    const std::size_t count = top + 1;
    std::ranges::copy(values, sampled_.begin());
    for (int p = 0, k = 0; p < n; ++p) {
      while (static_cast<std::size_t>(k) + 1 < count && begins_[static_cast<std::size_t>(k) + 1] < p) ++k;
      const int root = roots_[static_cast<std::size_t>(k)];
      const auto offset = static_cast<float>(p - root);
      values[static_cast<std::size_t>(p)] = sampled_[static_cast<std::size_t>(root)] + offset * offset;
    }
  }

 private:
  /// From where on the parabola over q is below that over p, p < q.
  static double meeting(const std::vector<float>& values, int p, int q) {
    const auto raised = [&](int i) {
      return static_cast<double>(values[static_cast<std::size_t>(i)]) + static_cast<double>(i) * i;
    };
    return (raised(q) - raised(p)) / (2.0 * (q - p));
  }

  std::vector<int> roots_;
  std::vector<double> begins_;
  std::vector<float> sampled_;
};

}  // namespace

std::vector<float> distancesTo(int width, int height, const std::function<bool(std::size_t cell)>& isObstacle) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  std::vector<float> distances(columns * rows);
  for (std::size_t cell = 0; cell < distances.size(); ++cell) distances[cell] = isObstacle(cell) ? 0.0F : kFar;

  std::vector<float> line(rows);
  Envelope upright(rows);
  for (std::size_t x = 0; x < columns; ++x) {
    for (std::size_t y = 0; y < rows; ++y) line[y] = distances[y * columns + x];
    upright.transform(line);
    for (std::size_t y = 0; y < rows; ++y) distances[y * columns + x] = line[y];
  }
  line.resize(columns);
  Envelope level(columns);
  for (std::size_t y = 0; y < rows; ++y) {
    const auto row = distances.begin() + static_cast<std::ptrdiff_t>(y * columns);
    std::copy_n(row, columns, line.begin());
    level.transform(line);
    std::ranges::transform(line, row, [](float squared) { return std::sqrt(squared); });
  }
  return distances;
}

}  // namespace prodomos::simulation
