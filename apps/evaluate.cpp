// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/evaluation/relations.hpp"
#include "prodomos/evaluation/trajectory.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/io/trajectory_file.hpp"
#include "prodomos/map/map_view.hpp"

#include "commands.hpp"
#include "evaluate_kinds.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <numbers>

namespace prodomos::apps {

namespace {

using evaluation::Statistics;
using nlohmann::json;

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

/// "0.0229 ± 0.0240 m": the mean and its deviation, as the papers' tables have it.
std::string meanAndStd(double mean, double std, const std::string& unit, int decimals) {
  return fixed(mean, decimals) + " ± " + fixed(std, decimals) + " " + unit;
}

std::vector<evaluation::TimedPose> bodyPosesOf(const map::MapView& view, const EvaluateOptions& options) {
  return evaluation::bodyPoses(
      view.trajectory(), options.poses == "travelled" ? evaluation::Poses::kTravelled : evaluation::Poses::kRefined);
}

/// Why nothing could be compared.
std::string timesOf(const std::vector<evaluation::TimedPose>& poses, const std::string& map) {
  if (poses.empty()) return map + " has no trajectory";
  return map + " tells of " + base::toString(poses.front().time) + " to " + base::toString(poses.back().time);
}

// --- relations ---

json listOf(const std::vector<evaluation::RelationError>& errors) {
  json list = json::array();
  for (const auto& error : errors) {
    list.push_back({{"first", base::toString(error.first)},
                    {"second", base::toString(error.second)},
                    {"translation_m", error.translation},
                    {"rotation_deg", error.rotation * kDegreesPerRadian}});
  }
  return list;
}

void print(const std::string& title, const std::vector<evaluation::RelationError>& errors) {
  std::cout << "  " << title << '\n';
  for (const auto& error : errors) {
    std::cout << "    " << base::toString(error.first) << " to " << base::toString(error.second) << "  "
              << fixed(error.translation, 3) << " m  " << fixed(error.rotation * kDegreesPerRadian, 2) << "°\n";
  }
}

void evaluateRelations(const EvaluateOptions& options) {
  const auto relations = evaluation::readRelations(options.truth);
  const auto poses = bodyPosesOf(map::MapView::open(options.maps.front()), options);
  const auto errors = evaluation::relationErrors(poses, relations);
  if (errors.empty()) {
    throw base::FileError(base::expectedFound(
        options.truth, "relations between times of the map's trajectory",
        "none of " + std::to_string(relations.size()) + "; " + timesOf(poses, options.maps.front())));
  }
  const auto score = evaluation::scoreOf(errors);
  if (options.json) {
    std::cout << json{{"poses", options.poses},
                      {"relations", relations.size()},
                      {"matched", errors.size()},
                      {"translation_m", toJson(score.translation)},
                      {"rotation_deg", toJson(score.rotation)},
                      {"worst_translation", listOf(score.worstShifted)},
                      {"worst_rotation", listOf(score.worstTurned)}}
                     .dump(2)
              << '\n';
    return;
  }
  std::cout << options.maps.front() << ", " << options.poses << " poses: " << errors.size() << " of "
            << relations.size() << " relations\n";
  const auto printScore = [](const char* title, const Statistics& s, const std::string& unit, int decimals) {
    std::cout << "  " << title << meanAndStd(s.mean, s.std, unit, decimals) << ", squared "
              << meanAndStd(s.squaredMean, s.squaredStd, unit + "²", decimals) << ", median "
              << fixed(s.median, decimals) << ", max " << fixed(s.max, decimals) << '\n';
  };
  printScore("translation  ", score.translation, "m", 4);
  printScore("rotation     ", score.rotation, "°", 3);
  print("worst in translation", score.worstShifted);
  print("worst in rotation", score.worstTurned);
}

void addRelations(CLI::App& kind, EvaluateOptions& options) {
  kind.footer(
      "After Kümmerle et al. 2009, \"On measuring the accuracy of SLAM algorithms\". FILE has lines\n"
      "`t1 t2 x y z roll pitch yaw`: where the robot was at t2, seen from where it was at t1.\n"
      "Examples:\n"
      "  prodomos evaluate relations intel.prodomos --relations intel.relations\n"
      "  prodomos evaluate relations intel.prodomos --relations intel.relations --json | jq .translation_m.mean");
  kind.add_option("--relations", options.truth, "true relations between poses")->required();
}

// --- trajectory ---

/// The poses of a TUM folder are those of its camera with the axes of an image; those of a map are the body's.
bool truthIsOfCamera(const map::MapView& view, const EvaluateOptions& options) {
  if (options.frame != "auto") return options.frame == "camera";
  return std::ranges::any_of(view.sessions(),
                             [](const auto& session) { return session.logKind == "TUM RGB-D folder"; });
}

std::vector<evaluation::TimedPose> readTruth(const std::string& path) {
  std::vector<evaluation::TimedPose> truth;
  for (const auto& pose : io::readTrajectory(path)) truth.push_back({pose.time, pose.T_world_body});
  return truth;
}

void evaluateTrajectory(const EvaluateOptions& options) {
  const auto truth = readTruth(options.truth);
  const auto view = map::MapView::open(options.maps.front());
  auto poses = bodyPosesOf(view, options);
  const bool ofCamera = truthIsOfCamera(view, options);
  // Alignment takes care of the frame that poses are given in, on the left; what is tracked, on the right, must be one.
  if (ofCamera) {
    for (auto& pose : poses) pose.pose = pose.pose * sensors::cameraAxesInBody();
  }
  const auto pairs = evaluation::associate(poses, truth);
  if (pairs.empty()) {
    throw base::FileError(
        base::expectedFound(options.truth, "poses at times of the map's trajectory",
                            "none of " + std::to_string(truth.size()) + "; " + timesOf(poses, options.maps.front())));
  }
  const auto absolute = evaluation::statisticsOf(evaluation::absoluteErrors(pairs));
  auto relative = evaluation::relativeErrors(poses, truth, base::fromSeconds(options.delta));
  for (double& angle : relative.rotation) angle *= kDegreesPerRadian;
  const auto shifts = evaluation::statisticsOf(std::move(relative.translation));
  const auto turns = evaluation::statisticsOf(std::move(relative.rotation));
  const char* frame = ofCamera ? "camera" : "body";
  if (options.json) {
    std::cout << json{{"poses", options.poses},
                      {"truth_frame", frame},
                      {"trajectory", poses.size()},
                      {"matched", pairs.size()},
                      {"ate_m", toJson(absolute)},
                      {"rpe_delta_s", options.delta},
                      {"rpe_pairs", shifts.count},
                      {"rpe_m", shifts.count == 0 ? json(nullptr) : toJson(shifts)},
                      {"rpe_deg", turns.count == 0 ? json(nullptr) : toJson(turns)}}
                     .dump(2)
              << '\n';
    return;
  }
  std::cout << options.maps.front() << ", " << options.poses << " poses: " << pairs.size() << " of " << poses.size()
            << " have a true pose of the " << frame << '\n';
  const auto printScore = [](const char* title, const Statistics& s, const std::string& unit, int decimals) {
    std::cout << "  " << title << "rmse " << fixed(s.rmse, decimals) << " " << unit << ", mean "
              << meanAndStd(s.mean, s.std, unit, decimals) << ", median " << fixed(s.median, decimals) << ", max "
              << fixed(s.max, decimals) << '\n';
  };
  printScore("absolute  ", absolute, "m", 4);
  if (shifts.count == 0) {
    std::cout << "  relative  none: no two poses with truth lie " << options.delta << " s apart\n";
    return;
  }
  std::cout << "  relative  over " << options.delta << " s, " << shifts.count << " pairs\n";
  printScore("          ", shifts, "m", 4);
  printScore("          ", turns, "°", 3);
}

void addTrajectory(CLI::App& kind, EvaluateOptions& options) {
  kind.footer(
      "ATE and RPE as evaluate_ate.py and evaluate_rpe.py --fixed_delta of the TUM RGB-D benchmark define them. FILE\n"
      "has lines `time x y z qx qy qz qw`.\n"
      "Examples:\n"
      "  prodomos evaluate trajectory room.prodomos --truth rgbd_dataset_freiburg1_room/groundtruth.txt\n"
      "  prodomos evaluate trajectory office.prodomos --truth robot.txt --truth-frame body --json | jq .ate_m.rmse");
  kind.add_option("--truth", options.truth, "true poses")->required();
  kind.add_option("--truth-frame", options.frame,
                  "what the true poses are of: body, camera (axes of an image), or auto, which is camera for maps of "
                  "TUM folders")
      ->check(CLI::IsMember({"auto", "body", "camera"}));
  kind.add_option("--delta", options.delta, "seconds over which the relative error is taken (1)")
      ->check(CLI::PositiveNumber);
}

constexpr Kind kRelations = {"relations", "the way against true relations between poses", addRelations,
                             evaluateRelations};
constexpr Kind kTrajectory = {"trajectory", "the way against true poses", addTrajectory, evaluateTrajectory};

constexpr std::array kKinds = {&kRelations, &kTrajectory, &kPrediction, &kHindsight, &kNoise,
                               &kLabels,    &kPlanes,     &kObjects,    &kHumans};

void addCommonOptions(CLI::App& kind, EvaluateOptions& options, Against against) {
  if (against == Against::kFile) {
    kind.add_option("MAP", options.maps, "the map file")->required()->expected(1);
    kind.add_option("--poses", options.poses, "refined (default) or travelled: as before all refinement")
        ->check(CLI::IsMember({"refined", "travelled"}));
    return;
  }
  kind.add_option("MAP", options.maps, "the map file; several are scored together")->required();
  if (against == Against::kTruthOfLog) {
    kind.add_option("--truth", options.truths, "LOG.truth.json of each map, in their order (default: beside its log)")
        ->allow_extra_args(false);
  }
  kind.add_option("--html", options.html, "write a page with the pictures");
}

}  // namespace

json toJson(const Statistics& s) {
  return {{"mean", s.mean},
          {"std", s.std},
          {"rmse", s.rmse},
          {"squared_mean", s.squaredMean},
          {"squared_std", s.squaredStd},
          {"median", s.median},
          {"min", s.min},
          {"max", s.max}};
}

std::vector<MapAndTruth> mapsAndTruths(const EvaluateOptions& options) {
  const auto& truths = options.truths;
  if (!truths.empty() && truths.size() != options.maps.size()) {
    throw base::UsageError(base::expectedFound(
        "--truth", std::to_string(options.maps.size()) + " files, as many as maps", std::to_string(truths.size())));
  }
  std::vector<MapAndTruth> pairs;
  for (std::size_t i = 0; i < options.maps.size(); ++i) {
    const auto& map = options.maps[i];
    if (!truths.empty()) {
      pairs.push_back({map, truths[i]});
      continue;
    }
    const auto view = map::MapView::open(map);
    if (view.sessions().empty()) {
      throw base::FileError(base::expectedFound(map, "a log that it was made of", "none; name its truth by --truth"));
    }
    pairs.push_back({map, evaluation::truthPath(view.sessions().front().log).string()});
  }
  return pairs;
}

void addEvaluate(CLI::App& program) {
  auto* command = program.add_subcommand("evaluate", "score a map against truth, or in hindsight");
  command->require_subcommand(1);
  command->footer(
      "prodomos evaluate KIND --help has options and examples of each kind.\n"
      "Examples:\n"
      "  prodomos evaluate relations intel.prodomos --relations intel.relations\n"
      "  prodomos evaluate trajectory room.prodomos --truth groundtruth.txt --json\n"
      "  prodomos evaluate prediction office.prodomos --truth office.truth.json\n"
      "  prodomos evaluate hindsight intel.prodomos");
  for (const Kind* kind : kKinds) {
    auto* subcommand = command->add_subcommand(kind->name, kind->text);
    auto options = std::make_shared<EvaluateOptions>();
    addCommonOptions(*subcommand, *options, kind->against);
    kind->addOptions(*subcommand, *options);
    subcommand->add_flag("--json", options->json, "as JSON (docs/evaluation.md)");
    subcommand->callback([options, evaluate = kind->evaluate] { evaluate(*options); });
  }
}

}  // namespace prodomos::apps
