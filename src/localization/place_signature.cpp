// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/place_signature.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace prodomos::localization {

namespace {

constexpr std::size_t kDirections = 120;
// Farther things are seen by chance, through doors and past corners.
constexpr double kFarthest = 12.0;  // metres

using Profile = std::array<double, kDirections>;

/// Distances to the nearest surface; where none was seen, as far as the neighbouring directions tell.
Profile profileFrom(const Eigen::Vector2d& viewpoint, const map::SurfaceLayer& surface) {
  Profile profile;
  profile.fill(kFarthest);
  for (const auto& point : surface.points()) {
    const Eigen::Vector2d offset = point.position_in_submap() - viewpoint;
    const double turn = std::atan2(offset.y(), offset.x()) / (2.0 * std::numbers::pi) + 0.5;
    auto& distance = profile[static_cast<std::size_t>(turn * kDirections) % kDirections];
    distance = std::min(distance, offset.norm());
  }
  return profile;
}

PlaceSignature spectrumOf(const Profile& profile) {
  PlaceSignature signature;
  for (int frequency = 0; frequency < PlaceSignature::kFrequencies; ++frequency) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * frequency * static_cast<double>(i) / kDirections;
      sum += profile[i] * std::polar(1.0, angle);
    }
    signature.magnitudes[static_cast<std::size_t>(frequency)] = static_cast<float>(std::abs(sum) / kDirections);
  }
  return signature;
}

}  // namespace

std::vector<PlaceSignature> placeSignatures(const map::SurfaceLayer& surface) {
  std::vector<PlaceSignature> signatures;
  signatures.reserve(surface.viewpoints().size());
  for (const auto& viewpoint : surface.viewpoints()) {
    signatures.push_back(spectrumOf(profileFrom(Eigen::Vector2f(viewpoint.x, viewpoint.y).cast<double>(), surface)));
  }
  return signatures;
}

double dissimilarity(const std::vector<PlaceSignature>& a, const std::vector<PlaceSignature>& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& left : a) {
    for (const auto& right : b) {
      double sum = 0.0;
      for (std::size_t i = 0; i < left.magnitudes.size(); ++i) {
        sum += static_cast<double>(std::abs(left.magnitudes[i] - right.magnitudes[i]));
      }
      least = std::min(least, sum);
    }
  }
  return least;
}

}  // namespace prodomos::localization
