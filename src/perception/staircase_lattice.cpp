// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_lattice.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace prodomos::perception {

namespace {

constexpr std::size_t kJudges = 120;  // points that judge a lattice in the search
constexpr int kPhases = 10;           // in which the search tries each size
constexpr double kNextDepth = 1.07;   // from one size to the next
constexpr int kRefits = 6;            // least squares, each with the points assigned anew
constexpr double kFrontSigma = 0.04;  // metres: voxels are as far apart
constexpr float kHopeless = 0.7F;     // misfit in the slope's own direction, of what is no flight in any other
constexpr double kTrust = 0.02;       // metres; a size that no point tells stays as the search has it

/// Points in single precision, an array for each coordinate.
struct Judges {
  std::vector<float> x, z, weight;
};

Judges judgesOf(std::span<const FlightPoint> points, double turn) {
  Judges judges;
  const double cosine = std::cos(turn);
  const double sine = std::sin(turn);
  const std::size_t stride = points.size() / kJudges + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const FlightPoint& p = points[i];
    judges.x.push_back(static_cast<float>(cosine * p.point.x() + sine * p.point.y()));
    judges.z.push_back(static_cast<float>(p.point.z()));
    judges.weight.push_back(static_cast<float>(1.0 / (0.02 + p.sigma)));
  }
  return judges;
}

/// Weighted mean distance of the points from the profile, at most half its amplitude each, over a quarter of the
/// amplitude, which is what points of a slope have.
float misfit(const Judges& judges, const StepLattice& lattice) {
  const auto depth = static_cast<float>(lattice.depth);
  const auto rise = static_cast<float>(lattice.rise);
  const auto amplitude = static_cast<float>(lattice.amplitude());
  const auto firstRiser = static_cast<float>(lattice.firstRiser);
  const auto firstTread = static_cast<float>(lattice.firstTread);
  float sum = 0.0F;
  float weights = 0.0F;
  for (std::size_t i = 0; i < judges.x.size(); ++i) {
    const float x = (judges.x[i] - firstRiser) / depth;
    const auto step = static_cast<float>(static_cast<int>(x + 1000.0F) - 1000);  // floor
    const float along = (x - step) * depth;
    const float above = judges.z[i] - firstTread - step * rise;
    // Above its tread a point is nearest to the tread or to the riser behind it, below to the riser before it.
    const float before = std::max(along, -above - rise);
    const float behind = std::max(depth - along, above - rise);
    const float riser = above > 0.0F ? behind : before;
    sum += judges.weight[i] * std::min(std::min(std::abs(above), riser), 0.5F * amplitude);
    weights += judges.weight[i];
  }
  return sum / (weights * 0.25F * amplitude);
}

/// The best of a grid of lattices near the slope z = slope * x.
FoundLattice search(std::span<const FlightPoint> points, double slope, bool mayTurn) {
  FoundLattice best;
  float least = std::numeric_limits<float>::infinity();
  for (const double turn : {0.0, -0.15, 0.15}) {
    if (turn != 0.0 && (!mayTurn || least > kHopeless)) break;
    const Judges judges = judgesOf(points, turn);
    for (const double steeper : {0.85, 1.0, 1.18}) {
      for (double depth = kLeastDepth; depth <= kMostDepth; depth *= kNextDepth) {
        const double rise = slope * steeper * depth;
        if (rise < kLeastRise || rise > kMostRise) continue;
        for (int phase = 0; phase < kPhases; ++phase) {
          const double firstRiser = depth * phase / kPhases;
          for (const double off : {-0.2, 0.0, 0.2}) {
            const StepLattice lattice{firstRiser, slope * firstRiser + (0.5 + off) * rise, depth, rise};
            const float found = misfit(judges, lattice);
            if (found >= least) continue;
            least = found;
            best = {lattice, turn, 1.0};
          }
        }
      }
    }
  }
  return best;
}

/// The front edges of treads, column by column across. Where risers are hidden, as in views from above, they alone tell
/// where steps begin.
class Fronts {
 public:
  Fronts() : fronts_(static_cast<std::size_t>(kSteps * kColumns)) {}

  void add(int step, const Eigen::Vector3d& point) {
    const int column = static_cast<int>(std::floor(point.y() / kColumn)) + kColumns / 2;
    const int row = step + kSteps / 2;
    if (column < 0 || column >= kColumns || row < 0 || row >= kSteps) return;
    const int index = row * kColumns + column;
    Front& front = fronts_[static_cast<std::size_t>(index)];
    front.x = std::min(front.x, point.x());
    ++front.points;
  }
  /// Calls use(step, x, y) for each.
  template <typename Use>
  void each(const Use& use) const {
    for (int i = 0; i < kSteps * kColumns; ++i) {
      const Front& front = fronts_[static_cast<std::size_t>(i)];
      if (front.points < kLeast) continue;
      const int column = i % kColumns - kColumns / 2;
      use(i / kColumns - kSteps / 2, front.x, (column + 0.5) * kColumn);
    }
  }

 private:
  static constexpr int kSteps = 60;
  static constexpr int kColumns = 30;
  static constexpr double kColumn = 0.2;  // metres
  static constexpr int kLeast = 3;        // points of one

  struct Front {
    double x = std::numeric_limits<double>::infinity();
    int points = 0;
  };
  std::vector<Front> fronts_;
};

/// Least squares of risers (x = firstRiser + k depth + skew y) and treads (z = firstTread + k rise), weakly held where
/// they are. Returns the skew: the tangent of the turn that is left.
double refine(StepLattice& lattice, std::span<const FlightPoint> points, bool mayTurn) {
  const double trust = 1.0 / (kTrust * kTrust);
  const double straight = mayTurn ? 10.0 : 1e9;  // 10: within some 20 degrees
  Eigen::Matrix3d riserSquares = Eigen::Vector3d(trust, trust, straight).asDiagonal();
  Eigen::Vector3d riserProducts(trust * lattice.firstRiser, trust * lattice.depth, 0.0);
  Eigen::Matrix2d treadSquares = trust * Eigen::Matrix2d::Identity();
  Eigen::Vector2d treadProducts = trust * Eigen::Vector2d(lattice.firstTread, lattice.rise);
  const auto addRiser = [&](int step, double x, double y, double weight) {
    const Eigen::Vector3d row(1.0, step, y);
    riserSquares.noalias() += weight * row * row.transpose();
    riserProducts += weight * x * row;
  };
  Fronts fronts;
  for (const FlightPoint& p : points) {
    const int level = static_cast<int>(std::lround((p.point.z() - lattice.firstTread) / lattice.rise));
    if (std::abs(p.point.z() - lattice.treadAt(level)) < 0.01 + p.sigma) fronts.add(level, p.point);
    const StepPlace place = lattice.placeOf(p.point.x(), p.point.z());
    if (place.distance > 0.02 + 2.0 * p.sigma) continue;
    const double sigma = 0.01 + p.sigma;
    const double weight = 1.0 / (sigma * sigma);
    if (place.part == StepPart::kRiser) {
      addRiser(place.step, p.point.x(), p.point.y(), weight);
    } else {
      const Eigen::Vector2d row(1.0, place.step);
      treadSquares.noalias() += weight * row * row.transpose();
      treadProducts += weight * p.point.z() * row;
    }
  }
  fronts.each([&](int step, double x, double y) { addRiser(step, x, y, 1.0 / (kFrontSigma * kFrontSigma)); });
  const Eigen::Vector3d riser = riserSquares.ldlt().solve(riserProducts);
  const Eigen::Vector2d tread = treadSquares.ldlt().solve(treadProducts);
  lattice = {riser.x(), tread.x(), riser.y(), tread.y()};
  return riser.z();
}

/// Of points that are measured well enough to tell steps from a slope.
double roughnessOf(std::span<const FlightPoint> points, const StepLattice& lattice) {
  const double amplitude = lattice.amplitude();
  const double across = lattice.depth / std::hypot(lattice.rise, lattice.depth);
  double fromSteps = 0.0;
  double fromSlope = 0.0;
  for (const FlightPoint& p : points) {
    const double middle =
        lattice.firstTread + lattice.slope() * (p.point.x() - lattice.firstRiser) - 0.5 * lattice.rise;
    const double weight = 1.0 / (0.01 + p.sigma);
    fromSlope += weight * std::min(std::abs(p.point.z() - middle) * across, 0.5 * amplitude);
    fromSteps += weight * std::min(lattice.placeOf(p.point.x(), p.point.z()).distance, 0.5 * amplitude);
  }
  return fromSlope > 0.0 ? fromSteps / fromSlope : 1.0;
}

}  // namespace

StepPlace StepLattice::placeOf(double x, double z) const {
  const int step = static_cast<int>(std::floor((x - firstRiser) / depth));
  const double along = x - riserAt(step);
  const double above = z - treadAt(step);
  const auto gap = [](double value, double least, double most) { return std::max({least - value, value - most, 0.0}); };
  const double before = std::hypot(along, gap(above, -rise, 0.0));
  const double behind = std::hypot(depth - along, gap(above, 0.0, rise));
  if (std::abs(above) <= std::min(before, behind)) return {StepPart::kTread, step, std::abs(above)};
  if (before <= behind) return {StepPart::kRiser, step, before};
  return {StepPart::kRiser, step + 1, behind};
}

std::optional<FoundLattice> findLattice(std::span<const FlightPoint> points, double slope, bool mayTurn) {
  FoundLattice found = search(points, slope, mayTurn);
  if (!(found.lattice.depth > 0.0)) return std::nullopt;
  std::vector<FlightPoint> turned(points.begin(), points.end());
  double turn = found.turn;
  found.turn = 0.0;
  for (int refit = 0; refit < kRefits; ++refit) {
    const double cosine = std::cos(turn);
    const double sine = std::sin(turn);
    for (FlightPoint& p : turned) {
      p.point.head<2>() =
          Eigen::Vector2d(cosine * p.point.x() + sine * p.point.y(), cosine * p.point.y() - sine * p.point.x());
    }
    found.turn += turn;
    // x = skew y along a riser: the uphill direction turns by its negative.
    turn = -std::atan(refine(found.lattice, turned, mayTurn));
    const StepLattice& lattice = found.lattice;
    if (!(lattice.rise > kLeastRise && lattice.rise < kMostRise && lattice.depth > kLeastDepth &&
          lattice.depth < kMostDepth && lattice.slope() < kSteepest)) {
      return std::nullopt;
    }
  }
  found.roughness = roughnessOf(turned, found.lattice);
  return found;
}

}  // namespace prodomos::perception
