// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// Closed doors image by image: the way of paper 002 and ours in one table (docs/doors.md).
///
///     door_table [LOG.rawlog ...] [--corridor rgbd/icsl_corridor] [--every N] [--pictures FOLDER]
///
/// Of simulated logs, with true poses: the share of closed doors found in the images that show them whole (`images` of
/// the truth's sightings), false detections an image, errors of what was found, and how often doors are true that are
/// reported with so much evidence. Of the corridor, brought level by the floor of each image alone: images in which a
/// door that was marked by eye is found (IoU > 0.5), of those that show it whole. Reports of ajar and open doors are
/// counted apart, those of lifts' not at all.

#include "prodomos/evaluation/detections.hpp"
#include "prodomos/evaluation/timed_poses.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/perception/door_detector.hpp"

#include "support/corridor_doors.hpp"
#include "support/true_views.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace prodomos;
using perception::DoorSighting;

constexpr std::array kMethods{"paper", "segments"};

struct Options {
  std::vector<std::string> logs;
  std::string corridor;
  std::string pictures;
  int every = 1;
};

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// How often a door reported with so much evidence is one.
struct Bin {
  int right = 0;
  int wrong = 0;
};
constexpr std::array kBinEnds{1.0, 2.0, 4.0, 100.0};

struct Score {
  int images = 0;
  int whole = 0;
  int found = 0;
  int wrong = 0;
  int notClosed = 0;  ///< reports of doors that stand ajar or open
  double seconds = 0.0;
  std::vector<double> centre;
  std::vector<double> width;
  std::vector<double> normal;  ///< degrees
  int hinges = 0;
  int hingesRight = 0;
  std::array<Bin, kBinEnds.size()> bins{};
  std::map<std::string, std::array<int, 2>> marked;  ///< found, seen whole

  void add(const DoorSighting& sighting, bool right) {
    const auto bin = std::ranges::find_if(kBinEnds, [&](double end) { return sighting.evidence < end; });
    auto& counts = bins[static_cast<std::size_t>(bin - kBinEnds.begin())];
    ++(right ? counts.right : counts.wrong);
    wrong += right ? 0 : 1;
  }
};

/// Runs both methods over one view.
class Trial {
 public:
  explicit Trial(const Options& options) {
    if (!options.pictures.empty()) pictures_ = std::make_unique<perception::DebugImages>(options.pictures);
  }

  template <typename Judge>
  void run(const perception::RgbdView& view, int frame, const Judge& judge) {
    const auto surfaces = findSurfaces(view, perception::SurfacesConfig{});
    for (std::size_t method = 0; method < kMethods.size(); ++method) {
      perception::DoorDetectorConfig config;
      config.method = static_cast<int>(method);
      const bool draws = pictures_ && method == 1;
      if (draws) pictures_->beginFrame(frame);
      const double start = cpuSeconds();
      const auto doors = findDoors(view, surfaces, config, draws ? pictures_.get() : nullptr);
      Score& score = scores[method];
      score.seconds += cpuSeconds() - start;
      ++score.images;
      judge(doors, score);
    }
  }

  std::array<Score, kMethods.size()> scores;

 private:
  std::unique_ptr<perception::DebugImages> pictures_;
};

/// The door with leaves whose place and direction are nearest; none within a metre.
struct Nearest {
  const evaluation::TrueDoor* door = nullptr;
  double distance = 1.0;
};
Nearest nearestDoor(const DoorSighting& sighting, const evaluation::Truth& truth) {
  Nearest nearest;
  const geometry::Pose2 seen = geometry::toPose2(sighting.T_submap_door);
  for (const auto& door : truth.doors) {
    const double floor_z = truth.storeys[static_cast<std::size_t>(door.storey)].floor_z;
    if (door.leaves == 0 || std::abs(floor_z - sighting.T_submap_door.translation().z()) > 0.5) continue;
    const geometry::Pose2 pose = evaluation::leafPoseOf(door);
    const double distance = std::hypot(pose.x - seen.x, pose.y - seen.y);
    const double turned = std::abs(std::remainder(pose.theta - seen.theta, std::numbers::pi));
    if (turned < evaluation::MatchGates{}.angle && distance < nearest.distance) nearest = {&door, distance};
  }
  return nearest;
}

void addErrors(Score& score, const DoorSighting& sighting, const Nearest& nearest) {
  const geometry::Pose2 pose = evaluation::leafPoseOf(*nearest.door);
  const double yaw = geometry::yaw(sighting.T_submap_door);
  score.centre.push_back(nearest.distance);
  score.width.push_back(std::abs(sighting.door.width - nearest.door->width));
  score.normal.push_back(std::abs(std::remainder(pose.theta - yaw, std::numbers::pi)) * 180.0 / std::numbers::pi);
  if (nearest.door->leaves != 1 || sighting.hingeEvidence == 0.0) return;
  const bool sameWay = std::cos(pose.theta - yaw) > 0.0;
  const bool isLeft = (nearest.door->hingeSide == map::HingeSide::kLeft) == sameWay;
  ++score.hinges;
  score.hingesRight += (sighting.hingeEvidence > 0.0) == isLeft ? 1 : 0;
}

void judgeByTruth(const std::vector<DoorSighting>& doors, const evaluation::Truth& truth, base::Time time,
                  Score& score) {
  constexpr double kSame = 0.02;  // seconds
  std::vector<const evaluation::TrueDoor*> found;
  for (const auto& sighting : doors) {
    const Nearest nearest = nearestDoor(sighting, truth);
    const bool isClosed = nearest.door != nullptr && stateAt(*nearest.door, time) == map::DoorState::kClosed;
    if (nearest.door != nullptr && (!isClosed || isLiftDoor(truth, *nearest.door))) {
      score.notClosed += isClosed ? 0 : 1;
      continue;
    }
    const bool right = nearest.door != nullptr && nearest.distance < evaluation::MatchGates{}.doorDistance;
    score.add(sighting, right);
    if (!right) continue;
    found.push_back(nearest.door);
    addErrors(score, sighting, nearest);
  }
  for (const auto& door : truth.doors) {
    if (door.leaves == 0 || isLiftDoor(truth, door) || stateAt(door, time) != map::DoorState::kClosed) continue;
    const auto isNow = [&](base::Time image) { return std::abs(base::seconds(image - time)) < kSame; };
    if (std::ranges::none_of(door.sighting.images, isNow)) continue;
    ++score.whole;
    score.found += std::ranges::find(found, &door) != found.end() ? 1 : 0;
  }
}

void runLog(const std::string& log, const Options& options, Trial& trial) {
  const auto truth = evaluation::readTruth(evaluation::truthPath(log));
  test::forEachTrueView(log, truth, options.every, [&](const perception::RgbdView& view, int frame) {
    trial.run(view, frame, [&](const std::vector<DoorSighting>& doors, Score& score) {
      judgeByTruth(doors, truth, view.time, score);
    });
  });
}

void runCorridor(const Options& options, Trial& trial) {
  const auto marked = test::readMarkedDoors(std::filesystem::path(options.corridor) / "doors.json");
  const auto source = io::openSource(options.corridor);
  for (int frame = 0;;) {
    const auto item = source->next();
    if (std::holds_alternative<sensors::EndOfLog>(item)) break;
    const auto* reading = std::get_if<sensors::Reading>(&item);
    const auto* image = reading == nullptr ? nullptr : std::get_if<sensors::RgbdFrame>(&reading->data);
    if (image == nullptr || frame++ % options.every != 0) continue;
    const int number = frame - 1;
    const auto T_level_camera = test::levelByFloor(*image);
    if (!T_level_camera) continue;
    const perception::RgbdView view{
        .time = reading->time, .frame = *image, .T_submap_camera = *T_level_camera, .floor_z = 0.0};
    trial.run(view, number, [&](const std::vector<DoorSighting>& doors, Score& score) {
      for (const auto& door : marked) {
        if (door.counts && door.isWhole(number)) ++score.marked[door.id][1];
      }
      for (const auto& sighting : doors) {
        const auto name = test::nameOf(sighting, view, number, marked);
        if (!name) ++score.wrong;
        const auto door = std::ranges::find(marked, name.value_or(""), &test::MarkedDoor::id);
        if (door != marked.end() && door->counts && door->isWhole(number)) ++score.marked[door->id][0];
      }
    });
  }
}

void printLogs(const std::array<Score, kMethods.size()>& scores) {
  std::printf("%-9s %7s %13s %12s %10s %7s %7s %7s %11s %7s\n", "method", "images", "whole found", "false/image",
              "not closed", "centre", "width", "normal", "hinge", "ms");
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Score& score = scores[i];
    std::printf("%-9s %7d %6d / %4d %12.3f %10d %7.3f %7.3f %7.2f %5d / %3d %7.2f\n", kMethods[i], score.images,
                score.found, score.whole, static_cast<double>(score.wrong) / std::max(1, score.images), score.notClosed,
                median(score.centre), median(score.width), median(score.normal), score.hingesRight, score.hinges,
                1000.0 * score.seconds / std::max(1, score.images));
  }
  std::printf("\nsegments: evidence, of how many so reported there is a door\n");
  double begin = 0.0;
  for (std::size_t i = 0; i < kBinEnds.size(); ++i) {
    const Bin& bin = scores[1].bins[i];
    const int number = bin.right + bin.wrong;
    std::printf("%5.1f ... %5.1f %6d of %6d  %.3f\n", begin, kBinEnds[i], bin.right, number,
                number > 0 ? static_cast<double>(bin.right) / number : 0.0);
    begin = kBinEnds[i];
  }
}

void printCorridor(const std::array<Score, kMethods.size()>& scores) {
  std::printf("\n%-9s", "corridor");
  for (const auto& [name, counts] : scores[1].marked) std::printf(" %9s", name.c_str());
  std::printf(" %6s %7s\n", "false", "ms");
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Score& score = scores[i];
    std::printf("%-9s", kMethods[i]);
    for (const auto& [name, counts] : score.marked) std::printf("  %3d / %2d", counts[0], counts[1]);
    std::printf(" %6d %7.2f\n", score.wrong, 1000.0 * score.seconds / std::max(1, score.images));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"closed doors image by image"};
  app.add_option("logs", options.logs, "simulated logs, their truth beside them");
  app.add_option("--corridor", options.corridor, "folder rgbd/icsl_corridor");
  app.add_option("--every", options.every, "images")->check(CLI::Range(1, 1000));
  app.add_option("--pictures", options.pictures, "folder for pictures of verdicts");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!options.logs.empty()) {
      Trial trial(options);
      for (const auto& log : options.logs) runLog(log, options, trial);
      printLogs(trial.scores);
    }
    if (!options.corridor.empty()) {
      Trial trial(options);
      runCorridor(options, trial);
      printCorridor(trial.scores);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "door_table: %s\n", error.what());
    return 1;
  }
  return 0;
}
