// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
// What the detectors of doors and stairs find in simulated logs where the robot knows its way truly: for tuning them
// apart from localization.
//
//     perceive_log LOG.rawlog ... [--frames N] [--level] [--set doors.enabled=false ...] [--claims] [--sightings]
//     [--look ID]
//
// Prints, by log and pooled: recall, precision and medians as `evaluate prediction` has them; of each detector its
// single sightings, those that lie at a true thing and those that do not, with their mean evidence and errors;
// milliseconds a frame. --level: as of a robot that does not know that it climbs. --claims lists every thing of truth
// or map and what became of it; --sightings every false sighting; --look every sighting of one true thing.
#include "prodomos/base/config.hpp"
#include "prodomos/base/stopwatch.hpp"
#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/detections.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/perception/config.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

namespace {

using namespace prodomos;

constexpr double kSubmapLength = 10.0;  // metres of way
constexpr double kScanPause = 0.16;     // seconds between scans that are looked at
constexpr double kStoreyChange = 1.0;   // metres of climbing, after which a new sub-map begins
constexpr base::SessionId kSession{1};
constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Options {
  std::vector<std::string> logs;
  std::vector<std::string> assignments;
  int frames = 1'000'000;
  bool level = false;
  bool claims = false;
  bool sightings = false;
  std::string look;
};

struct SightingCount {
  int right = 0;
  int wrong = 0;
  double evidenceRight = 0.0;  // sums
  double evidenceWrong = 0.0;
  std::vector<double> centre;  // of the right ones: errors
  std::vector<double> angle;
  std::vector<double> width;
  std::vector<double> normalized;  // squared errors by the sighting's own covariance, x y and yaw
  evaluation::FoundCount hinges;
  evaluation::FoundCount states;

  SightingCount& operator+=(const SightingCount& other) {
    right += other.right;
    wrong += other.wrong;
    evidenceRight += other.evidenceRight;
    evidenceWrong += other.evidenceWrong;
    const auto append = [](auto& values, const auto& others) {
      values.insert(values.end(), others.begin(), others.end());
    };
    append(centre, other.centre);
    append(angle, other.angle);
    append(width, other.width);
    append(normalized, other.normalized);
    hinges += other.hinges;
    states += other.states;
    return *this;
  }
};

struct LogScore {
  evaluation::DoorScore doors;
  evaluation::DoorScore doorways;
  evaluation::StairsScore stairs;
  std::map<std::string, SightingCount> sightings;  // by detector
  std::map<std::string, double> seconds;
  int frames = 0;

  LogScore& operator+=(const LogScore& other) {
    doors += other.doors;
    doorways += other.doorways;
    stairs += other.stairs;
    for (const auto& [name, count] : other.sightings) sightings[name] += count;
    for (const auto& [name, time] : other.seconds) seconds[name] += time;
    frames += other.frames;
    return *this;
  }
};

double median(std::vector<double> values) {
  return values.empty() ? std::nan("") : evaluation::statisticsOf(std::move(values)).median;
}

double lineTurn(double a, double b) {
  const double turn = std::abs(geometry::normalizeAngle(a - b));
  return std::min(turn, std::numbers::pi - turn);
}

/// Drives through one log.
class Drive {
 public:
  Drive(const std::string& log, const perception::PerceptionConfig& config, const Options& options)
      : log_(log),
        config_(config),
        options_(options),
        truth_(evaluation::readTruth(evaluation::truthPath(log))),
        memory_(config.memory, kSession, [this] { return base::EntityId{++lastEntity_}; }) {}

  LogScore run() {
    const auto source = io::openSource(log_);
    for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
      const auto* reading = std::get_if<sensors::Reading>(&item);
      if (reading == nullptr) continue;
      if (score_.frames >= options_.frames) break;
      auto T_world_body = evaluation::poseAt(truth_.trajectory, reading->time);
      if (!T_world_body) continue;
      if (!firstHeight_) firstHeight_ = T_world_body->translation().z();
      if (options_.level) T_world_body->translation().z() = *firstHeight_;
      take(*reading, *T_world_body);
    }
    endSubmap();
    judge();
    score_.seconds = {times_.seconds().begin(), times_.seconds().end()};
    return score_;
  }

 private:
  void take(const sensors::Reading& reading, const geometry::Pose3& T_world_body) {
    travel(reading.time, T_world_body);
    const auto T_submap_body = T_map_submap_.back().inverse() * T_world_body;
    if (const auto* scan = std::get_if<sensors::LaserScan>(&reading.data)) {
      grid_.insert(*scan, T_submap_body * scan->T_body_sensor);
      perceive(reading.time, *scan, T_submap_body);
    } else if (const auto* frame = std::get_if<sensors::RgbdFrame>(&reading.data)) {
      perceive(reading.time, *frame, T_submap_body);
      ++score_.frames;
    }
  }

  void travel(base::Time time, const geometry::Pose3& T_world_body) {
    const bool isFirst = T_map_submap_.empty();
    if (!isFirst) way_ += (T_world_body.translation() - last_).norm();
    last_ = T_world_body.translation();
    const bool isLeft = !isFirst && (way_ > kSubmapLength ||
                                     std::abs(last_.z() - T_map_submap_.back().translation().z()) > kStoreyChange);
    if (isFirst || isLeft) {
      if (isLeft) endSubmap();
      map::Node node{.id = {static_cast<std::int64_t>(T_map_submap_.size())}, .session = kSession};
      node.T_map_submap = node.T_travel_submap = geometry::levelled(T_world_body);
      node.begin = node.end = time;
      T_map_submap_.push_back(node.T_map_submap);
      change_.nodes.push_back(node);
      grid_ = map::OccupancyGrid();
      way_ = 0.0;
    }
    change_.trajectory.push_back({kSession, time, submap(), T_world_body, T_world_body});
    observer_ = (T_map_submap_.back().inverse() * T_world_body).translation().head<2>();
    now_ = time;
  }

  base::SubMapId submap() const { return {static_cast<std::int64_t>(T_map_submap_.size()) - 1}; }
  perception::EntityMemory::SubMapPoses poses() const {
    return [this](base::SubMapId id) { return T_map_submap_[static_cast<std::size_t>(id.value)]; };
  }

  template <typename Find>
  auto timed(const char* name, const Find& find) {
    const auto timing = times_.measure(name);
    return find();
  }

  void perceive(base::Time time, const sensors::LaserScan& scan, const geometry::Pose3& T_submap_body) {
    if (lastScan_ && base::seconds(time - *lastScan_) < kScanPause) return;
    lastScan_ = time;
    const auto doors = timed("scans", [&] {
      return findOpenDoors(scan, T_submap_body, T_submap_body.translation().z(), time, config_.openDoors);
    });
    count("scans", doors);
    const auto T_submap_sensor = T_submap_body * scan.T_body_sensor;
    memory_.add(submap(), T_submap_sensor, doors, poses());
    if (config_.openDoors.fromLaser) memory_.look(submap(), T_submap_sensor, scan, time, poses());
  }

  void perceive(base::Time time, const sensors::RgbdFrame& frame, const geometry::Pose3& T_submap_body) {
    const perception::RgbdView view{.time = time,
                                    .frame = frame,
                                    .T_submap_camera = T_submap_body * frame.T_body_camera,
                                    .floor_z = T_submap_body.translation().z()};
    const auto surfaces = timed("surfaces", [&] { return findSurfaces(view, config_.surfaces); });
    auto doors = timed("doors", [&] { return findDoors(view, surfaces, config_.doors); });
    const auto openings = timed("open doors", [&] { return findOpenDoors(view, surfaces, config_.openDoors); });
    const auto stairs = timed("stairs", [&] { return findStaircases(view, surfaces, config_.stairs); });
    count("doors", doors);
    count("open doors", openings);
    count("stairs", stairs);
    doors.insert(doors.end(), openings.begin(), openings.end());
    const auto timing = times_.measure("memory");
    memory_.add(submap(), view.T_submap_camera, doors, poses());
    memory_.add(submap(), view.T_submap_camera, stairs, poses());
    memory_.look(submap(), view, surfaces, poses());
  }

  void endSubmap() {
    auto doorways = timed("doorways", [&] { return findDoorways(grid_, observer_, config_.doorways); });
    for (auto& doorway : doorways) doorway.time = now_;
    count("doorways", doorways);
    const auto showsNone = [this](const geometry::Pose3& T_submap_doorway, double width) {
      return perception::showsNoDoorway(grid_, geometry::toPose2(T_submap_doorway), width);
    };
    memory_.addFromGrid(submap(), doorways, showsNone, poses());
  }

  int storey() const { return evaluation::storeyAt(truth_, T_map_submap_.back().translation().z()); }

  void count(const char* detector, const std::vector<perception::DoorSighting>& sightings) {
    auto& count = score_.sightings[detector];
    for (const auto& sighting : sightings) {
      const auto pose = geometry::toPose2(T_map_submap_.back() * sighting.T_submap_door);
      const evaluation::TrueDoor* nearest = nullptr;
      double least = 0.5;
      for (const auto& door : truth_.doors) {
        const auto actual = evaluation::leafPoseOf(door);
        const double distance = std::hypot(pose.x - actual.x, pose.y - actual.y);
        if (door.storey != storey() || distance > least || lineTurn(pose.theta, actual.theta) > 0.5) continue;
        nearest = &door;
        least = distance;
      }
      (nearest != nullptr ? count.evidenceRight : count.evidenceWrong) += sighting.evidence;
      ++(nearest != nullptr ? count.right : count.wrong);
      if (nearest != nullptr) judge(sighting, pose, *nearest, count);
      const bool isLookedAt = nearest != nullptr && nearest->id == options_.look;
      if (isLookedAt || (nearest == nullptr && options_.sightings)) print(detector, sighting, pose, nearest);
    }
  }

  static void judge(const perception::DoorSighting& sighting, const geometry::Pose2& pose,
                    const evaluation::TrueDoor& door, SightingCount& count) {
    const auto actual = evaluation::leafPoseOf(door);
    const auto off = geometry::inverse(pose) * actual;
    count.centre.push_back(std::hypot(off.x, off.y));
    count.angle.push_back(lineTurn(pose.theta, actual.theta));
    count.width.push_back(std::abs(sighting.door.width - door.width));
    const bool isBehind = std::abs(off.theta) > std::numbers::pi / 2.0;
    Eigen::Matrix2d covariance = sighting.covariance.topLeftCorner<2, 2>();
    const Eigen::Rotation2Dd R_door_submap(-geometry::yaw(sighting.T_submap_door));
    covariance = R_door_submap.toRotationMatrix() * covariance * R_door_submap.toRotationMatrix().transpose();
    const Eigen::Vector2d offset(off.x, off.y);
    const double turn = lineTurn(pose.theta, actual.theta);
    count.normalized.push_back(offset.dot(covariance.inverse() * offset) + turn * turn / sighting.covariance(3, 3));
    if (door.leaves == 1 && sighting.hingeEvidence != 0.0) {
      const bool isLeft = (sighting.hingeEvidence > 0.0) != isBehind;
      count.hinges += {1, isLeft == (door.hingeSide == map::HingeSide::kLeft) ? 1U : 0U};
    }
    if (door.leaves > 0 && sighting.door.state != map::DoorState::kUnknown) {
      count.states += {1, sighting.door.state == evaluation::stateAt(door, sighting.time) ? 1U : 0U};
    }
  }

  static void print(const char* detector, const perception::DoorSighting& sighting, const geometry::Pose2& pose,
                    const evaluation::TrueDoor* door) {
    std::printf(
        "  %s %s: %s at %.2f %.2f heading %.0f, width %.2f +- %.2f, range %.1f, evidence %.1f, %s%s, %s, hinge %.1f",
        base::toString(sighting.time).c_str(), detector, door == nullptr ? "false" : door->id.c_str(), pose.x, pose.y,
        pose.theta * kDegrees, sighting.door.width, sighting.widthSigma, sighting.range, sighting.evidence,
        sighting.door.hasLeaf ? "leaf" : "no leaf", sighting.whole ? "" : " cut",
        std::string(toString(sighting.door.state)).c_str(), sighting.hingeEvidence);
    if (door != nullptr) {
      const auto actual = evaluation::leafPoseOf(*door);
      std::printf(" | off %.2f m, %.1f deg, width %.2f", std::hypot(pose.x - actual.x, pose.y - actual.y),
                  lineTurn(pose.theta, actual.theta) * kDegrees, sighting.door.width - door->width);
    }
    std::printf("\n");
  }

  void count(const char* detector, const std::vector<perception::StaircaseSighting>& sightings) {
    auto& count = score_.sightings[detector];
    for (const auto& sighting : sightings) {
      const auto pose = geometry::toPose2(T_map_submap_.back() * sighting.T_submap_stairs);
      const evaluation::TrueStaircase* nearest = nullptr;
      for (const auto& stairs : truth_.stairs) {
        const auto inFlight =
            geometry::inverse(geometry::Pose2{stairs.foot.x(), stairs.foot.y(), stairs.direction}) * pose;
        const double run = stairs.stepCount * stairs.stepDepth;
        const bool isThere = (stairs.storeys[0] == storey() || stairs.storeys[1] == storey()) && inFlight.x > -0.5 &&
                             inFlight.x < run && std::abs(inFlight.y) < stairs.width / 2.0 &&
                             std::abs(geometry::normalizeAngle(inFlight.theta)) < 0.5;
        if (isThere) nearest = &stairs;
      }
      (nearest != nullptr ? count.evidenceRight : count.evidenceWrong) += sighting.evidence;
      ++(nearest != nullptr ? count.right : count.wrong);
      if (nearest != nullptr) {
        count.angle.push_back(std::abs(geometry::normalizeAngle(pose.theta - nearest->direction)));
        count.width.push_back(std::abs(sighting.width - nearest->width));
      }
      const bool isLookedAt = nearest != nullptr && nearest->id == options_.look;
      if (!isLookedAt && !(nearest == nullptr && options_.sightings)) continue;
      std::printf(
          "  %s %s: %s at %.2f %.2f heading %.0f, %zu steps from %.2f to %.2f, width %.2f%s%s%s%s, new floor %.2f +- "
          "%.2f, evidence %.1f\n",
          base::toString(sighting.time).c_str(), detector, nearest == nullptr ? "false" : nearest->id.c_str(), pose.x,
          pose.y, pose.theta * kDegrees, sighting.steps.size(), sighting.steps.front().z, sighting.steps.back().z,
          sighting.width, sighting.widthIsWhole ? " whole" : "", sighting.footIsSeen ? " foot" : "",
          sighting.headIsSeen ? " head" : "", sighting.descends ? " down" : "", sighting.newFloor_z,
          sighting.newFloorSigma, sighting.evidence);
    }
  }

  void judge() {
    memory_.addTo(change_);
    change_.removedEntities.clear();
    change_.entities = memory_.entities();
    map::Session session{.id = kSession, .log = log_, .logKind = "rawlog", .poses = "true"};
    change_.sessions = {session};
    auto store = map::MapStore::inMemory();
    store.commit(change_);
    const auto claims = evaluation::claimsOf(store.view(), truth_);
    const auto doorMatches = evaluation::matchDoors(claims.doors, truth_);
    const auto stairsMatches = evaluation::matchStairs(claims.stairs, truth_);
    score_.doors = evaluation::scoreDoors(claims, doorMatches, truth_, true);
    score_.doorways = evaluation::scoreDoors(claims, doorMatches, truth_, false);
    score_.stairs = evaluation::scoreStairs(claims, stairsMatches, truth_);
    if (options_.claims) {
      list("door", claims.doors, doorMatches, truth_.doors);
      list("stairs", claims.stairs, stairsMatches, truth_.stairs);
    }
  }

  static std::string text(const evaluation::ClaimedDoor& claim) {
    char line[160];
    std::snprintf(line, sizeof line, "%.2f %.2f heading %.0f, %.2f x %.2f, %s, hinge %s, %s", claim.T_world_door.x,
                  claim.T_world_door.y, claim.T_world_door.theta * kDegrees, claim.door.width, claim.door.height,
                  claim.door.hasLeaf ? "leaf" : "no leaf", std::string(toString(claim.door.hingeSide)).c_str(),
                  std::string(toString(claim.door.state)).c_str());
    return line;
  }
  static std::string text(const evaluation::ClaimedStaircase& claim) {
    char line[160];
    const Eigen::Vector2d foot = claim.foot.value_or(Eigen::Vector2d::Constant(std::nan("")));
    std::snprintf(line, sizeof line, "foot %.2f %.2f heading %.0f, height %.2f, width %.2f, %d steps of %.3f x %.3f",
                  foot.x(), foot.y(), claim.T_world_stairs.theta * kDegrees, claim.stairs.height,
                  claim.stairs.stepWidth, claim.stairs.stepCount, claim.stairs.stepHeight, claim.stairs.stepDepth);
    return line;
  }
  static std::string text(const evaluation::TrueDoor& door) {
    char line[160];
    const auto pose = evaluation::leafPoseOf(door);
    std::snprintf(line, sizeof line, "%.2f %.2f heading %.0f, %.2f x %.2f, %d leaves, hinge %s", pose.x, pose.y,
                  pose.theta * kDegrees, door.width, door.height, door.leaves,
                  std::string(toString(door.hingeSide)).c_str());
    return line;
  }
  static std::string text(const evaluation::TrueStaircase& stairs) {
    char line[160];
    std::snprintf(line, sizeof line, "foot %.2f %.2f heading %.0f, height %.2f, width %.2f, %d steps of %.3f x %.3f",
                  stairs.foot.x(), stairs.foot.y(), stairs.direction * kDegrees, stairs.head.z() - stairs.foot.z(),
                  stairs.width, stairs.stepCount, stairs.stepHeight, stairs.stepDepth);
    return line;
  }

  template <typename Claim, typename Thing>
  void list(const char* kind, const std::vector<Claim>& claims, const std::vector<evaluation::ClaimMatch>& matches,
            const std::vector<Thing>& things) {
    for (std::size_t i = 0; i < things.size(); ++i) {
      const auto match = std::ranges::find_if(
          matches, [i](const auto& m) { return m.verdict == evaluation::Verdict::kRight && m.truth == i; });
      const auto& sighting = things[i].sighting;
      if (match == matches.end() && !sighting.visible && !sighting.passed) continue;
      std::printf("  %s %s %s%s%s (share %.2f, %zu whole images): %s\n", match == matches.end() ? "MISSED" : "found",
                  kind, things[i].id.c_str(), sighting.visible ? " visible" : "", sighting.passed ? " passed" : "",
                  sighting.share, sighting.images.size(), text(things[i]).c_str());
      if (match == matches.end()) continue;
      const auto& claim = claims[static_cast<std::size_t>(match - matches.begin())];
      const auto entity = std::ranges::find(change_.entities, claim.id, &map::Entity::id);
      std::printf("        %s: %s, confidence %.3f, seen %d times\n", toString(claim.id).c_str(), text(claim).c_str(),
                  entity->confidence, entity->observations);
    }
    for (std::size_t i = 0; i < claims.size(); ++i) {
      if (matches[i].verdict == evaluation::Verdict::kRight) continue;
      const auto entity = std::ranges::find(change_.entities, claims[i].id, &map::Entity::id);
      std::printf("  %s %s %s: %s, confidence %.3f, seen %d times, last %s%s%s\n",
                  matches[i].verdict == evaluation::Verdict::kWrong ? "FALSE" : "neither", kind,
                  toString(claims[i].id).c_str(), text(claims[i]).c_str(), entity->confidence, entity->observations,
                  base::toString(entity->lastSeen).c_str(), matches[i].truth ? ", is " : "",
                  matches[i].truth ? things[*matches[i].truth].id.c_str() : "");
    }
  }

  std::string log_;
  perception::PerceptionConfig config_;
  Options options_;
  evaluation::Truth truth_;
  std::int64_t lastEntity_ = 0;
  perception::EntityMemory memory_;
  map::MapChange change_;
  std::vector<geometry::Pose3> T_map_submap_;
  std::optional<double> firstHeight_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double way_ = 0.0;
  map::OccupancyGrid grid_;
  Eigen::Vector2d observer_ = Eigen::Vector2d::Zero();
  base::Time now_{};
  std::optional<base::Time> lastScan_;
  base::StageTimes times_;
  LogScore score_;
};

std::string share(const evaluation::FoundCount& count) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f (%zu/%zu)", count.recall().value_or(std::nan("")), count.found, count.truth);
  return text;
}

void print(const char* name, const evaluation::DetectionCounts& counts) {
  std::printf("  %-9s visible %s passed %s precision %.2f (%zu right, %zu wrong) image %s\n", name,
              share(counts.visible).c_str(), share(counts.passed).c_str(), counts.precision().value_or(std::nan("")),
              counts.right, counts.wrong, counts.images ? share(*counts.images).c_str() : "-");
}

void print(const char* name, const evaluation::DoorScore& score) {
  print(name, score.counts);
  if (score.centre.empty()) return;
  std::printf("            centre %.3f m, normal %.2f deg, width %.3f m, height %.3f m, hinge %s, state %s\n",
              median(score.centre), median(score.normal) * kDegrees, median(score.width), median(score.height),
              share(score.hingeSides).c_str(), share(score.states).c_str());
}

void print(const std::string& name, const LogScore& score) {
  std::printf("%s, %d frames\n", name.c_str(), score.frames);
  print("doors", score.doors);
  print("doorways", score.doorways);
  print("stairs", score.stairs.counts);
  if (!score.stairs.direction.empty()) {
    std::printf("            foot %.3f m, direction %.2f deg, width %.3f m, height %.3f m\n", median(score.stairs.foot),
                median(score.stairs.direction) * kDegrees, median(score.stairs.width), median(score.stairs.height));
  }
  for (const auto& [detector, count] : score.sightings) {
    std::printf(
        "  sightings of %s: %d right, evidence %.2f; %d wrong, evidence %.2f; centre %.3f m, %.2f deg, width %.3f m, "
        "squared error by covariance %.1f, hinge %s, state %s\n",
        detector.c_str(), count.right, count.evidenceRight / std::max(1, count.right), count.wrong,
        count.evidenceWrong / std::max(1, count.wrong), median(count.centre), median(count.angle) * kDegrees,
        median(count.width), median(count.normalized), share(count.hinges).c_str(), share(count.states).c_str());
  }
  std::printf("  ms a frame:");
  for (const auto& [stage, seconds] : score.seconds)
    std::printf(" %s %.1f", stage.c_str(), 1e3 * seconds / std::max(1, score.frames));
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What detectors find in simulated logs with true poses");
  Options options;
  app.add_option("LOG", options.logs, "simulated logs, their truth beside them")->required()->check(CLI::ExistingFile);
  app.add_option("--frames", options.frames, "of each log, at most");
  app.add_option("--set", options.assignments, "section.key=value");
  app.add_flag("--level", options.level, "as if nobody measured heights: all poses are as high as the first");
  app.add_flag("--claims", options.claims, "list what was found, missed and false");
  app.add_flag("--sightings", options.sightings, "list false sightings");
  app.add_option("--look", options.look, "list the sightings of this true door or staircase");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto config =
        base::readConfig<perception::PerceptionConfig>({.file = {}, .text = {}, .assignments = options.assignments});
    LogScore all;
    for (const auto& log : options.logs) {
      const auto score = Drive(log, config, options).run();
      print(std::filesystem::path(log).stem().string(), score);
      std::fflush(stdout);
      all += score;
    }
    if (options.logs.size() > 1) print("all", all);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "perceive_log: %s\n", error.what());
    return 1;
  }
}
