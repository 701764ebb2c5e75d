// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/geometry/skew_normal.hpp"

#include <cmath>
#include <numbers>

namespace prodomos::geometry {

namespace {

double normalPdf(double x) {
  return std::exp(-x * x / 2.0) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

/// Where exp(−s²/2) Φ(a s) is greatest, a ≥ 0. Its logarithm is concave, so its slope has one zero; at 0 it rises, and
/// at 1 it falls for all a.
double modeAlong(double a) {
  double rising = 0.0;
  double falling = 1.0;
  for (int i = 0; i < 48; ++i) {
    const double s = (rising + falling) / 2.0;
    (a * normalPdf(a * s) > s * normalCdf(a * s) ? rising : falling) = s;
  }
  return (rising + falling) / 2.0;
}

}  // namespace

double normalCdf(double x) {
  return std::erfc(-x / std::numbers::sqrt2) / 2.0;
}

SkewNormal::SkewNormal(const Eigen::Vector2d& centre, double sigma, const Eigen::Vector2d& shape)
    : centre_(centre), sigma_(sigma), shape_(shape), scaledMode_(Eigen::Vector2d::Zero()) {
  const double skewness = shape.norm();
  if (skewness > 0.0) scaledMode_ = shape / skewness * modeAlong(skewness);
  greatest_ = kernel(scaledMode_);
}

double SkewNormal::kernel(const Eigen::Vector2d& scaled) const {
  return std::exp(-scaled.squaredNorm() / 2.0) * normalCdf(shape_.dot(scaled));
}

double SkewNormal::density(const Eigen::Vector2d& point) const {
  return kernel((point - centre_) / sigma_) * std::numbers::inv_pi / (sigma_ * sigma_);
}

double SkewNormal::relativeDensity(const Eigen::Vector2d& point) const {
  return kernel((point - centre_) / sigma_) / greatest_;
}

Eigen::Vector2d SkewNormal::mode() const {
  return centre_ + sigma_ * scaledMode_;
}

double SkewNormal::reach(double threshold) const {
  // Φ ≤ 1, so the kernel is nowhere greater than exp(−r²/2).
  const double exponent = -2.0 * std::log(threshold * greatest_);
  return exponent > 0.0 ? sigma_ * std::sqrt(exponent) : 0.0;
}

}  // namespace prodomos::geometry
