// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/assignment.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::geometry {

namespace {

constexpr int kNone = -1;

/// Finite costs, so great for forbidden pairs that one of them costs more than all others together.
Eigen::MatrixXd withoutInfinity(const Eigen::MatrixXd& costs, double& forbidden) {
  double sum = 1.0;
  for (const double cost : costs.reshaped()) sum += std::isinf(cost) ? 0.0 : std::abs(cost);
  forbidden = 2.0 * sum;
  return costs.unaryExpr([f = forbidden](double cost) { return std::isinf(cost) ? f : cost; });
}

/// Row by row, each along the cheapest path of exchanges to a free column. Not more rows than columns.
class Augmentation {
 public:
  explicit Augmentation(const Eigen::MatrixXd& costs)
      : costs_(costs),
        rowPrice_(static_cast<std::size_t>(costs.rows()), 0.0),
        columnPrice_(static_cast<std::size_t>(costs.cols()), 0.0),
        rowOf_(static_cast<std::size_t>(costs.cols()), kNone) {
    for (int row = 0; row < costs.rows(); ++row) place(row);
  }

  const std::vector<int>& rowOfColumns() const { return rowOf_; }

 private:
  void place(int newRow) {
    const std::size_t columns = columnPrice_.size();
    std::vector<double> distance(columns, kForbidden);
    std::vector<int> before(columns, kNone);  // the column whose row leads here
    std::vector<bool> reached(columns, false);
    int row = newRow;
    int column = kNone;
    double length = 0.0;
    while (row != kNone) {
      const int from = column;
      for (std::size_t c = 0; c < columns; ++c) {
        if (reached[c]) continue;
        const double through =
            length + costs_(row, static_cast<int>(c)) - rowPrice_[static_cast<std::size_t>(row)] - columnPrice_[c];
        if (through < distance[c]) {
          distance[c] = through;
          before[c] = from;
        }
      }
      column = nearest(distance, reached);
      length = distance[static_cast<std::size_t>(column)];
      reached[static_cast<std::size_t>(column)] = true;
      row = rowOf_[static_cast<std::size_t>(column)];
    }
    // Prices rise so that all reduced costs stay positive and those of pairs zero.
    rowPrice_[static_cast<std::size_t>(newRow)] += length;
    for (std::size_t c = 0; c < columns; ++c) {
      if (!reached[c] || distance[c] >= length) continue;
      columnPrice_[c] -= length - distance[c];
      rowPrice_[static_cast<std::size_t>(rowOf_[c])] += length - distance[c];
    }
    for (int last = column; last != kNone; last = before[static_cast<std::size_t>(last)]) {
      const int previous = before[static_cast<std::size_t>(last)];
      rowOf_[static_cast<std::size_t>(last)] = previous == kNone ? newRow : rowOf_[static_cast<std::size_t>(previous)];
    }
  }

  static int nearest(const std::vector<double>& distance, const std::vector<bool>& reached) {
    int best = kNone;
    for (std::size_t c = 0; c < distance.size(); ++c) {
      if (!reached[c] && (best == kNone || distance[c] < distance[static_cast<std::size_t>(best)])) {
        best = static_cast<int>(c);
      }
    }
    return best;
  }

  const Eigen::MatrixXd& costs_;
  std::vector<double> rowPrice_;
  std::vector<double> columnPrice_;
  std::vector<int> rowOf_;  // by column
};

}  // namespace

std::vector<std::optional<int>> assign(const Eigen::MatrixXd& costs) {
  std::vector<std::optional<int>> columnOf(static_cast<std::size_t>(costs.rows()));
  if (costs.size() == 0) return columnOf;
  const bool turned = costs.rows() > costs.cols();
  double forbidden = 0.0;
  const Eigen::MatrixXd finite = withoutInfinity(turned ? Eigen::MatrixXd(costs.transpose()) : costs, forbidden);
  const Augmentation augmentation(finite);
  const auto& rowOf = augmentation.rowOfColumns();
  for (int column = 0; column < finite.cols(); ++column) {
    const int row = rowOf[static_cast<std::size_t>(column)];
    if (row == kNone || finite(row, column) >= forbidden) continue;
    columnOf[static_cast<std::size_t>(turned ? column : row)] = turned ? row : column;
  }
  return columnOf;
}

}  // namespace prodomos::geometry
