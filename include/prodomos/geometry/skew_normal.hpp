// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace prodomos::geometry {

/// Φ: of the standard normal distribution.
double normalCdf(double x);

/// Bivariate skew-normal density with covariance Iσ² (Azzalini and Dalla Valle 1996, 002 eq. (4)):
/// f(u) = 2 φ(u − t; σ²I) Φ(αᵀ(u − t) / σ). Its wider side lies where α points; α = 0 is the normal of 002 eq. (2).
class SkewNormal {
 public:
  /// `sigma` > 0, metres; `shape` is α, without unit.
  SkewNormal(const Eigen::Vector2d& centre, double sigma, const Eigen::Vector2d& shape = Eigen::Vector2d::Zero());

  double density(const Eigen::Vector2d& point) const;  ///< per m²
  /// f(u) / max f, 0 … 1: what 002's p_th is compared with.
  double relativeDensity(const Eigen::Vector2d& point) const;
  const Eigen::Vector2d& centre() const { return centre_; }
  Eigen::Vector2d mode() const;  ///< where the maximum is
  /// Metres from the centre: nowhere farther off is the relative density greater than `threshold` (above 0).
  double reach(double threshold) const;

 private:
  /// Without the constant factor.
  double kernel(const Eigen::Vector2d& scaled) const;

  Eigen::Vector2d centre_;
  double sigma_;
  Eigen::Vector2d shape_;
  Eigen::Vector2d scaledMode_;  ///< (mode − centre) / σ
  double greatest_;             ///< kernel at the mode
};

}  // namespace prodomos::geometry
