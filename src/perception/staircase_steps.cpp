// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/staircase_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>

namespace prodomos::perception {

namespace {

using geometry::Pose3;

constexpr std::size_t kLeastSteps = 3;
constexpr std::size_t kLeastCells = 10;  // of a step
constexpr double kLeastWidth = 0.35;     // metres of a step that must be seen
constexpr double kProfile = 0.02;        // metres off the profile, but for depth noise
constexpr double kEdge = 0.02;           // metres: cells so near an edge show both sides of it
constexpr double kInFront = 0.35;        // metres; what hides a step stands that much nearer
constexpr double kBin = 0.05;            // metres: a column across
constexpr int kBins = 60;                // columns to either side
constexpr int kGapBins = 5;              // that a post or a rail may hide
constexpr int kMostStep = 40;            // from the frame's origin, either way
constexpr double kOddRiser = 0.35;       // of a rise
constexpr int kLeastAsked = 8;           // spots that tell how a flight ends

/// A cell's place on the profile.
struct PlacedCell {
  StepPlace place;
  Eigen::Vector3d point;
  double sigma;
};

std::vector<PlacedCell> placed(std::span<const StairCell> cells, const StepLattice& lattice,
                               const Pose3& T_submap_flight) {
  const Pose3 T_flight_submap = T_submap_flight.inverse();
  std::vector<PlacedCell> onSteps;
  for (const StairCell& cell : cells) {
    const Eigen::Vector3d point = T_flight_submap * cell.point_in_submap;
    const StepPlace place = lattice.placeOf(point.x(), point.z());
    if (place.distance > kProfile + 2.0 * cell.sigma || std::abs(place.step) > kMostStep) continue;
    onSteps.push_back({place, point, cell.sigma});
  }
  return onSteps;
}

/// The steps that were seen, upwards.
std::vector<SeenStep> stepsOf(const std::vector<PlacedCell>& cells) {
  std::vector<SeenStep> all(2 * kMostStep + 1);
  std::vector<std::vector<double>> across(all.size());
  for (const PlacedCell& c : cells) {
    const int index = c.place.step + kMostStep;
    const auto i = static_cast<std::size_t>(index);
    all[i].index = c.place.step;
    all[i].sigma += c.sigma;
    ++(c.place.part == StepPart::kRiser ? all[i].riserCells : all[i].treadCells);
    across[i].push_back(c.point.y());
  }
  std::vector<SeenStep> seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (across[i].size() < kLeastCells) continue;
    std::ranges::sort(across[i]);
    const std::size_t tail = across[i].size() / 100;
    all[i].least = across[i][tail];
    all[i].most = across[i][across[i].size() - 1 - tail];
    all[i].sigma /= static_cast<double>(across[i].size());
    if (all[i].most - all[i].least >= kLeastWidth) seen.push_back(all[i]);
  }
  return seen;
}

struct Across {
  double least = 0.0;
  double most = 0.0;
};

/// Of the columns between, all together.
template <typename Look>
ProfileCheck::Count countAcross(const Across& across, const Look& look) {
  ProfileCheck::Count count;
  for (double y = across.least + 0.5 * kBin; y < across.most; y += kBin) count += look(y);
  return count;
}

ProfileCheck::Count countOf(const ProfileCheck& check, int step, const Across& across) {
  return countAcross(across, [&](double y) {
    auto count = check.riser(step, y);
    return count += check.tread(step, y);
  });
}

/// The widest row of columns that cells lie in and in which the steps from `lowest` to `highest` are there rather than
/// anything else.
Across widestRow(const std::vector<PlacedCell>& cells, const ProfileCheck& check, int lowest, int highest) {
  constexpr int kNever = -10 * kBins;
  std::array<bool, 2 * kBins> hasCells{};
  for (const PlacedCell& c : cells) {
    const double column = std::floor(c.point.y() / kBin) + kBins;
    if (column >= 0.0 && column < 2.0 * kBins) hasCells[static_cast<std::size_t>(column)] = true;
  }
  Across best;
  int first = 0;
  int last = kNever;
  for (int bin = -kBins; bin < kBins; ++bin) {
    const int column = bin + kBins;
    if (!hasCells[static_cast<std::size_t>(column)]) continue;
    ProfileCheck::Count count;
    for (int step = lowest; step <= highest; ++step) {
      count += countOf(check, step, {bin * kBin, (bin + 1) * kBin});
    }
    if (count.other > count.there) last = kNever;
    if (count.other > count.there || count.there == 0) continue;
    if (bin - last > kGapBins) first = bin;
    last = bin;
    if ((last + 1 - first) * kBin > best.most - best.least) best = {first * kBin, (last + 1) * kBin};
  }
  return best;
}

/// The longest run of steps one above the other; one in between may be hidden, but not be missing.
std::vector<SeenStep> longestRun(const std::vector<SeenStep>& steps, const ProfileCheck& check, const Across& across) {
  std::size_t bestFirst = 0;
  std::size_t bestCount = 0;
  std::size_t first = 0;
  const auto goesOn = [&](int from, int to) {
    if (to - from == 1) return true;
    const auto between = countOf(check, from + 1, across);
    return to - from == 2 && between.there >= between.other;
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0 && !goesOn(steps[i - 1].index, steps[i].index)) first = i;
    if (i + 1 - first <= bestCount) continue;
    bestCount = i + 1 - first;
    bestFirst = first;
  }
  const auto begin = steps.begin() + static_cast<std::ptrdiff_t>(bestFirst);
  return {begin, begin + static_cast<std::ptrdiff_t>(bestCount)};
}

/// Before the first riser there is a floor, or a tread, or something hides it. First risers are often of a size of
/// their own.
bool hasFooting(const ProfileCheck& check, const StepLattice& lattice, int lowest, const Across& across) {
  const auto count =
      countAcross(across, [&](double y) { return check.tread(lowest - 1, y, kOddRiser * lattice.rise); });
  return count.asked() < kLeastAsked || count.share() >= 0.5;
}

}  // namespace

ProfileCheck::ProfileCheck(const Pose3& T_submap_camera, const sensors::DepthGrid& grid, const StepLattice& lattice,
                           const Pose3& T_submap_flight)
    : grid_(grid),
      lattice_(lattice),
      T_camera_flight_(T_submap_camera.inverse() * T_submap_flight),
      T_flight_camera_(T_camera_flight_.inverse()) {}

ProfileCheck::Count& ProfileCheck::Count::operator+=(const Count& count) {
  there += count.there;
  other += count.other;
  return *this;
}

ProfileCheck::Count ProfileCheck::riser(int step, double y) const {
  Count count;
  if (T_flight_camera_.translation().x() > lattice_.riserAt(step)) return count;
  for (const double share : {0.3, 0.7}) {
    const Eigen::Vector3d spot(lattice_.riserAt(step), y, lattice_.treadAt(step) - share * lattice_.rise);
    if (!isBehind(step - 1, spot)) count += at(spot, Eigen::Vector3d::UnitX(), 0.0);
  }
  return count;
}

ProfileCheck::Count ProfileCheck::tread(int step, double y, double tolerance) const {
  Count count;
  if (T_flight_camera_.translation().z() < lattice_.treadAt(step)) return count;
  for (const double share : {0.3, 0.7}) {
    const Eigen::Vector3d spot(lattice_.riserAt(step) + share * lattice_.depth, y, lattice_.treadAt(step));
    if (!isBehind(step + 1, spot)) count += at(spot, Eigen::Vector3d::UnitZ(), tolerance);
  }
  return count;
}

bool ProfileCheck::isBehind(int step, const Eigen::Vector3d& spot) const {
  const Eigen::Vector3d eye = T_flight_camera_.translation();
  const double share = (lattice_.riserAt(step) - spot.x()) / (eye.x() - spot.x());  // of the way to the eye
  return share > 0.0 && share < 1.0 &&
         spot.z() + share * (eye.z() - spot.z()) < lattice_.treadAt(step) + kProfile + kEdge;
}

ProfileCheck::Count ProfileCheck::at(const Eigen::Vector3d& spot, const Eigen::Vector3d& normal,
                                     double tolerance) const {
  const Eigen::Vector3d expected = T_camera_flight_ * spot;
  const auto* cell = grid_.cellAt(expected);
  if (cell == nullptr) return {};
  const auto depth = static_cast<double>(cell->depth);
  if (depth < expected.z() - kInFront) return {};
  const double sigma = sensors::depthSigma(depth);
  const Eigen::Vector3d off = T_flight_camera_ * pointOf(*cell) - spot;
  const bool isThere = std::abs(normal.dot(off)) < kProfile + tolerance + 1.5 * sigma &&
                       std::abs(off.x()) < 0.5 * lattice_.depth + 1.5 * sigma;
  return isThere ? Count{1, 0} : Count{0, 1};
}

std::optional<double> ProfileCheck::depthBehind(const Eigen::Vector3d& point_in_flight) const {
  const Eigen::Vector3d expected = T_camera_flight_ * point_in_flight;
  const auto* cell = grid_.cellAt(expected);
  if (cell == nullptr) return std::nullopt;
  return static_cast<double>(cell->depth) - expected.z();
}

std::optional<FlightSteps> findSteps(std::span<const StairCell> cells, const StepLattice& lattice,
                                     const Pose3& T_submap_flight, const ProfileCheck& check) {
  std::vector<PlacedCell> onSteps = placed(cells, lattice, T_submap_flight);
  std::vector<SeenStep> steps = longestRun(stepsOf(onSteps), check, {});
  if (steps.size() < kLeastSteps) return std::nullopt;
  const Across across = widestRow(onSteps, check, steps.front().index, steps.back().index);
  std::erase_if(onSteps, [&](const PlacedCell& c) { return c.point.y() < across.least || c.point.y() > across.most; });
  steps = stepsOf(onSteps);
  std::erase_if(steps, [&](const SeenStep& step) {
    const auto count = countOf(check, step.index, across);
    return count.there * kBin < kLeastWidth || count.other > count.there;
  });
  steps = longestRun(steps, check, across);
  if (steps.size() < kLeastSteps || !hasFooting(check, lattice, steps.front().index, across)) return std::nullopt;

  FlightSteps found;
  for (const SeenStep& step : steps) found.count += countOf(check, step.index, across);
  for (const PlacedCell& c : onSteps) {
    if (c.place.step < steps.front().index || c.place.step > steps.back().index) continue;
    found.points_in_flight.push_back(c.point);
  }
  found.steps = std::move(steps);
  return found;
}

}  // namespace prodomos::perception
