// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <vector>

namespace prodomos::perception {

template <int kSize>
struct Measured {
  Eigen::Matrix<double, kSize, 1> value;
  Eigen::Matrix<double, kSize, kSize> covariance;
};

/// The mean weighted by information, in which outliers fade: reweighted least squares with Cauchy's weights (Holland
/// and Welsch 1977). It begins where most of the values agree, not at the first. Values must not wrap around; there
/// must be one.
template <int kSize>
Measured<kSize> robustMean(const std::vector<Measured<kSize>>& all) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  constexpr int kIterations = 8;
  constexpr double kTuning = 2.0 * kSize;  // squared distances beyond are doubted
  std::vector<Matrix> informations;
  informations.reserve(all.size());
  for (const auto& one : all) informations.push_back(one.covariance.inverse());
  const auto squaredDistance = [&](std::size_t i, const auto& from) {
    const auto off = (all[i].value - from).eval();
    return off.dot(informations[i] * off);
  };

  Measured<kSize> mean = all.front();
  double least = -1.0;
  for (const auto& candidate : all) {
    double sum = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) sum += std::log1p(squaredDistance(i, candidate.value) / kTuning);
    if (least >= 0.0 && sum >= least) continue;
    least = sum;
    mean.value = candidate.value;
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix information = Matrix::Zero();
    Eigen::Matrix<double, kSize, 1> weighted = Eigen::Matrix<double, kSize, 1>::Zero();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double weight = 1.0 / (1.0 + squaredDistance(i, mean.value) / kTuning);
      information += weight * informations[i];
      weighted += weight * (informations[i] * (all[i].value - mean.value));
    }
    mean.covariance = information.inverse();
    mean.value += mean.covariance * weighted;
  }
  return mean;
}

}  // namespace prodomos::perception
