// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/place_signature.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace prodomos::localization {

namespace {

constexpr std::size_t kDirections = 120;
// Farther things are seen by chance, through doors and past corners.
constexpr double kFarthest = 12.0;  // metres

using Profile = std::array<double, kDirections>;

/// Distances to the nearest surface; kFarthest where none was seen.
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
  for (std::size_t frequency = 0; frequency < PlaceSignature::kFrequencies; ++frequency) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(frequency * i) / kDirections;
      sum += profile[i] * std::polar(1.0, angle);
    }
    signature.magnitudes[frequency] = static_cast<float>(std::abs(sum) / kDirections);
  }
  return signature;
}

}  // namespace

std::vector<PlaceSignature> placeSignatures(const map::SurfaceLayer& surface) {
  std::vector<PlaceSignature> signatures;
  if (surface.points().empty()) return signatures;
  signatures.reserve(surface.viewpoints().size());
  for (const auto& viewpoint : surface.viewpoints()) {
    signatures.push_back(spectrumOf(profileFrom(viewpoint.position_in_submap(), surface)));
  }
  return signatures;
}

Likeness mostAlike(const std::vector<PlaceSignature>& from, const std::vector<PlaceSignature>& to) {
  Likeness best;
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t j = 0; j < to.size(); ++j) {
      double difference = 0.0;
      for (std::size_t k = 0; k < PlaceSignature::kFrequencies; ++k) {
        difference += static_cast<double>(std::abs(from[i].magnitudes[k] - to[j].magnitudes[k]));
      }
      if (difference < best.difference) best = {difference, i, j};
    }
  }
  return best;
}

geometry::Pose2 alignViewpoints(const map::SurfaceLayer& from, const map::SurfaceLayer& to, const Likeness& likeness) {
  const Eigen::Vector2d there = from.viewpoints()[likeness.from].position_in_submap();
  const Eigen::Vector2d here = to.viewpoints()[likeness.to].position_in_submap();
  const auto profileThere = profileFrom(there, from);
  const auto profileHere = profileFrom(here, to);
  std::size_t turn = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t shift = 0; shift < kDirections; ++shift) {
    double difference = 0.0;
    for (std::size_t i = 0; i < kDirections; ++i)
      difference += std::abs(profileThere[(i + shift) % kDirections] - profileHere[i]);
    if (difference < least) {
      least = difference;
      turn = shift;
    }
  }
  const double theta = geometry::normalizeAngle(2.0 * std::numbers::pi * static_cast<double>(turn) / kDirections);
  const Eigen::Vector2d translation = there - Eigen::Rotation2Dd(theta) * here;
  return {translation.x(), translation.y(), theta};
}

}  // namespace prodomos::localization
