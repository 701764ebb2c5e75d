// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// Learns the weights of src/perception/door_verdict.cpp from simulated logs with true poses (docs/doors.md).
///
///     fit_doors TRAIN.rawlog ... [--test LOG.rawlog ...] [--every N] [--rows FILE]
///
/// Of every pair of lines the detector looks at, the truth tells whether it is a closed door. Logistic regression over
/// the pairs' cues gives the evidence; over pairs near a door, of which some are its very edges, the fit; over the
/// corners at both jambs of doors with one leaf, what a handle tells of the hinge. Prints the table to be put into
/// door_verdict.cpp, and how well weights learned from TRAIN do on the logs of --test. --rows writes the pairs.

#include "prodomos/evaluation/detections.hpp"
#include "prodomos/evaluation/timed_poses.hpp"
#include "prodomos/perception/door_detector.hpp"

#include "perception/door_candidates.hpp"
#include "perception/door_verdict.hpp"
#include "support/true_views.hpp"

#include <CLI/CLI.hpp>
#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace prodomos;
using perception::DoorCandidate;

constexpr int kCues = static_cast<int>(perception::Cue::kCount);
constexpr std::size_t kMostWalls = 4;  // a view, as the detector has it

struct Options {
  std::vector<std::string> train;
  std::vector<std::string> test;
  std::string rows;
  int every = 2;
};

/// What the truth says of a pair of lines.
enum class Label : std::uint8_t { kNoDoor, kOpenDoor, kDoor, kUnclear };

struct Row {
  Label label = Label::kNoDoor;
  bool isNearDoor = false;   ///< of a closed door's rivals: lines at its leaf, its frame, or beside them
  bool isPrecise = false;    ///< the leaf's own edges
  double hinge = 0.0;        ///< of a closed door with one leaf: 1 on the observer's left, -1 right
  double handleRatio = 0.0;  ///< logarithm, right to left
  perception::Cues cues{};
  std::string place;  ///< log, image, door: to find it again
};

/// The door with leaves that is nearest to a pair's leaf.
struct Nearest {
  const evaluation::TrueDoor* door = nullptr;
  double distance = 1.0;
  bool isAligned = false;
  bool isFacing = false;  ///< the observer looks along its x-axis
};

Nearest nearestDoor(const geometry::Pose2& leaf, double floor_z, const evaluation::Truth& truth) {
  Nearest nearest;
  for (const auto& door : truth.doors) {
    const double its_z = truth.storeys[static_cast<std::size_t>(door.storey)].floor_z;
    if (door.leaves == 0 || std::abs(its_z - floor_z) > 0.5) continue;
    const geometry::Pose2 pose = evaluation::leafPoseOf(door);
    const double distance = std::hypot(pose.x - leaf.x, pose.y - leaf.y);
    if (distance >= nearest.distance) continue;
    const double turned = std::abs(std::remainder(pose.theta - leaf.theta, std::numbers::pi));
    nearest = {&door, distance, turned<evaluation::MatchGates{}.angle, std::cos(pose.theta - leaf.theta)> 0.0};
  }
  return nearest;
}

double angleAt(const evaluation::TrueDoor& door, base::Time time) {
  double angle = 0.0;
  for (const auto& state : door.states) {
    if (state.time <= time || &state == door.states.data()) angle = state.angle;
  }
  return std::abs(angle);
}

Label labelOf(const Nearest& nearest, double widthError, const evaluation::Truth& truth, base::Time time) {
  constexpr double kPlace = 0.12;   // metres, of a pair that stands for the door
  constexpr double kTouches = 0.5;  // up to here neither it nor something else
  constexpr double kHardlyAjar = 15.0 * std::numbers::pi / 180.0;
  if (nearest.door == nullptr) return Label::kNoDoor;
  if (isLiftDoor(truth, *nearest.door)) return Label::kUnclear;
  if (stateAt(*nearest.door, time) != map::DoorState::kClosed) {
    return angleAt(*nearest.door, time) < kHardlyAjar ? Label::kUnclear : Label::kOpenDoor;
  }
  if (nearest.isAligned && nearest.distance < kPlace && widthError < kPlace) return Label::kDoor;
  return nearest.distance < kTouches ? Label::kUnclear : Label::kNoDoor;
}

Row rowOf(const DoorCandidate& candidate, const perception::RectifiedWall& wall, const perception::RgbdView& view,
          const evaluation::Truth& truth) {
  Row row;
  row.cues = candidate.cues;
  if (candidate.handle.left > 0.0 && candidate.handle.right > 0.0) {
    row.handleRatio = std::log(candidate.handle.right / candidate.handle.left);
  }
  const auto& T_submap_wall = wall.wall().T_submap_wall;
  const double x = 0.5 * (candidate.left_x + candidate.right_x);
  const Eigen::Vector3d middle = T_submap_wall * Eigen::Vector3d(x, candidate.leaf_y, 0.0);
  const Eigen::Vector3d away = T_submap_wall.linear().col(1);
  const Nearest nearest = nearestDoor({middle.x(), middle.y(), std::atan2(away.y(), away.x())}, view.floor_z, truth);
  if (nearest.door == nullptr) return row;
  const double widthError = std::abs(candidate.width() - nearest.door->width);
  row.label = labelOf(nearest, widthError, truth, view.time);
  row.place = nearest.door->id;
  const bool isClosed = stateAt(*nearest.door, view.time) == map::DoorState::kClosed;
  row.isNearDoor = isClosed && nearest.isAligned && nearest.distance < 0.3 && widthError < 0.3;
  row.isPrecise = row.isNearDoor && nearest.distance < 0.05 && widthError < 0.035;
  if (row.label == Label::kDoor && nearest.door->leaves == 1 && candidate.leaves == 1) {
    const bool isLeft = (nearest.door->hingeSide == map::HingeSide::kLeft) == nearest.isFacing;
    row.hinge = isLeft ? 1.0 : -1.0;
  }
  return row;
}

void addRows(const perception::RgbdView& view, const evaluation::Truth& truth, std::vector<Row>& rows) {
  const perception::DoorDetectorConfig config;
  const auto surfaces = findSurfaces(view, perception::SurfacesConfig{});
  auto walls = findWalls(view, surfaces);
  if (walls.size() > kMostWalls) walls.resize(kMostWalls);
  for (const auto& found : walls) {
    const perception::RectifiedWall wall(view, surfaces, found, config.reach);
    if (wall.empty()) continue;
    const perception::WallEdges edges(wall, config.edgeContrast);
    for (const auto& candidate : pairLines(wall, edges, edges.uprightLines(config.tilt))) {
      rows.push_back(rowOf(candidate, wall, view, truth));
    }
  }
}

std::vector<Row> readRows(const std::vector<std::string>& logs, int every) {
  std::vector<Row> rows;
  for (const auto& log : logs) {
    const auto truth = evaluation::readTruth(evaluation::truthPath(log));
    test::forEachTrueView(log, truth, every, [&](const perception::RgbdView& view, int frame) {
      const std::size_t before = rows.size();
      addRows(view, truth, rows);
      const std::string name = std::filesystem::path(log).stem().string() + " " + std::to_string(frame) + " ";
      for (std::size_t i = before; i < rows.size(); ++i) rows[i].place = name + rows[i].place;
    });
  }
  return rows;
}

/// One weight a column, and the bias last.
using Weights = Eigen::VectorXd;

/// Ridge-regularized logistic regression by Newton's method; columns of different spread are penalized alike.
Weights fitLogistic(const Eigen::MatrixXd& columns, const Eigen::VectorXd& isTrue, bool hasBias = true) {
  constexpr double kRidge = 3.0;
  constexpr double kFree = 1e-6;
  constexpr int kSteps = 60;
  const Eigen::Index count = columns.cols();
  const Eigen::RowVectorXd mean = columns.colwise().mean();
  const Eigen::RowVectorXd spread = ((columns.rowwise() - mean).colwise().norm().array() /
                                     std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, columns.rows())))) +
                                    1e-6;
  Eigen::MatrixXd inputs(columns.rows(), count + 1);
  inputs << (columns.array().rowwise() / spread.array()).matrix(),
      Eigen::VectorXd::Constant(columns.rows(), hasBias ? 1.0 : 0.0);
  Eigen::VectorXd ridge = Eigen::VectorXd::Constant(count + 1, kRidge);
  ridge[count] = kFree;
  Weights weights = Weights::Zero(count + 1);
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::ArrayXd likely = 1.0 / (1.0 + (-(inputs * weights).array()).exp());
    const Eigen::VectorXd gradient =
        inputs.transpose() * (likely.matrix() - isTrue) + ridge.cwiseProduct(weights).eval();
    const Eigen::VectorXd curvature = likely * (1.0 - likely);
    Eigen::MatrixXd hessian = inputs.transpose() * curvature.asDiagonal() * inputs;
    hessian.diagonal() += ridge;
    const Weights change = hessian.ldlt().solve(gradient);
    weights -= change;
    if (change.cwiseAbs().maxCoeff() < 1e-8) break;
  }
  weights.head(count).array() /= spread.transpose().array();
  return weights;
}

/// Of rows, those that `isUsed`, with what they are.
template <typename Used, typename True>
Weights fitCues(const std::vector<Row>& rows, const Used& isUsed, const True& isTrue) {
  const auto count = std::ranges::count_if(rows, isUsed);
  Eigen::MatrixXd columns(count, kCues);
  Eigen::VectorXd outcome(count);
  Eigen::Index at = 0;
  for (const Row& row : rows) {
    if (!isUsed(row)) continue;
    for (int i = 0; i < kCues; ++i) columns(at, i) = row.cues[static_cast<std::size_t>(i)];
    outcome[at++] = isTrue(row) ? 1.0 : 0.0;
  }
  return fitLogistic(columns, outcome);
}

Weights fitHandle(const std::vector<Row>& rows) {
  std::vector<double> ratios;
  std::vector<double> sides;
  for (const Row& row : rows) {
    if (row.hinge == 0.0 || row.handleRatio == 0.0) continue;
    ratios.push_back(row.handleRatio);
    sides.push_back(row.hinge > 0.0 ? 1.0 : 0.0);
  }
  const auto count = static_cast<Eigen::Index>(ratios.size());
  return fitLogistic(Eigen::Map<Eigen::VectorXd>(ratios.data(), count),
                     Eigen::Map<Eigen::VectorXd>(sides.data(), count), false);
}

double evidenceOf(const Row& row, const Weights& weights) {
  return Eigen::Map<const Eigen::VectorXd>(row.cues.data(), kCues).dot(weights.head(kCues)) + weights[kCues];
}

void printTable(const Weights& evidence, const Weights& fit, const Weights& handle) {
  std::printf("constexpr double kBias = %.2f;\n", evidence[kCues]);
  for (int i = 0; i < kCues; ++i) {
    std::printf("    {\"%s\", %.2f, %.2f},\n", std::string(perception::nameOf(static_cast<perception::Cue>(i))).c_str(),
                evidence[i], fit[i]);
  }
  std::printf("constexpr double kHandle = %.2f;\n\n", handle[0]);
}

/// How often pairs of each kind have positive evidence, and whether evidence means what it says.
void printSuccess(const char* name, const std::vector<Row>& rows, const Weights& weights) {
  const auto share = [&](Label label) {
    std::size_t count = 0;
    std::size_t positive = 0;
    for (const Row& row : rows) {
      if (row.label != label) continue;
      ++count;
      positive += evidenceOf(row, weights) > 0.0 ? 1 : 0;
    }
    std::printf(" %zu of %zu", positive, count);
  };
  std::printf("%s: pairs with positive evidence: doors", name);
  share(Label::kDoor);
  std::printf(", open doors");
  share(Label::kOpenDoor);
  std::printf(", others");
  share(Label::kNoDoor);
  std::printf("\n  evidence  doors of   expected\n");
  constexpr std::array kEnds{-4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0, 100.0};
  for (std::size_t i = 0; i + 1 < kEnds.size(); ++i) {
    int doors = 0;
    int all = 0;
    double expected = 0.0;
    for (const Row& row : rows) {
      const double evidence = evidenceOf(row, weights);
      if (row.label == Label::kUnclear || evidence < kEnds[i] || evidence >= kEnds[i + 1]) continue;
      ++all;
      doors += row.label == Label::kDoor ? 1 : 0;
      expected += 1.0 / (1.0 + std::exp(-evidence));
    }
    std::printf("  %4.0f ... %d of %d, %.1f\n", kEnds[i], doors, all, expected);
  }
}

void writeRows(const std::string& file, const std::vector<Row>& rows, const Weights& weights) {
  std::ofstream out(file);
  for (const Row& row : rows) {
    out << static_cast<int>(row.label) << ' ' << row.isNearDoor << ' ' << row.isPrecise << ' ' << row.hinge << ' '
        << row.handleRatio << ' ' << evidenceOf(row, weights);
    for (const double cue : row.cues) out << ' ' << cue;
    out << ' ' << row.place << '\n';
  }
}

void run(const Options& options) {
  auto rows = readRows(options.train, options.every);
  const auto isClear = [](const Row& row) { return row.label != Label::kUnclear; };
  const Weights evidence = fitCues(rows, isClear, [](const Row& row) { return row.label == Label::kDoor; });
  const auto isNear = [](const Row& row) { return row.isNearDoor; };
  const Weights fit = fitCues(rows, isNear, [](const Row& row) { return row.isPrecise; });
  printTable(evidence, fit, fitHandle(rows));
  printSuccess("train", rows, evidence);
  const auto others = readRows(options.test, options.every);
  if (!others.empty()) printSuccess("test", others, evidence);
  rows.insert(rows.end(), others.begin(), others.end());
  if (!options.rows.empty()) writeRows(options.rows, rows, evidence);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"learns what speaks for a closed door"};
  app.add_option("train", options.train, "simulated logs, their truth beside them")->required();
  app.add_option("--test", options.test, "logs that are not learned from");
  app.add_option("--every", options.every, "images")->check(CLI::Range(1, 1000));
  app.add_option("--rows", options.rows, "file for the pairs");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fit_doors: %s\n", error.what());
    return 1;
  }
  return 0;
}
