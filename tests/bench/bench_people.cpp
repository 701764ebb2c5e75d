// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// How well people are followed on simulated logs, along the true way of the robot: detector and tracker alone, scored
/// as `evaluate humans` does (docs/following-people.md).
///
///     bench_people MODELS LOG.rawlog … [--labels] [--laser] [--pictures FOLDER] [--every N]

#include "prodomos/base/stopwatch.hpp"
#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/humans.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/perception/people.hpp"

#include "support/true_views.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace prodomos;

struct Options {
  std::string models;
  std::vector<std::string> logs;
  bool labels = false;
  bool laser = false;
  std::string pictures;
  int every = 1;
};

double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Everything lies in one sub-map, which is the world.
struct Run {
  std::vector<evaluation::MappedPerson> people;
  int looks = 0;
  double seconds = 0.0;
};

std::vector<evaluation::MappedPerson> peopleOf(const map::MapChange& change) {
  std::vector<evaluation::MappedPerson> people;
  for (const auto& track : change.tracks) {
    evaluation::MappedPerson person{track.id.value, {}};
    for (const auto& state : track.states) {
      evaluation::MappedPersonState mapped{.time = state.time, .T_world_person = state.T_submap_thing};
      const auto attributes = nlohmann::json::parse(state.attributes);
      if (attributes.contains("joints")) {
        for (std::size_t i = 0; i < mapped.joints_in_world.size(); ++i) {
          const auto& joint = attributes["joints"][i];
          if (joint.is_array()) mapped.joints_in_world[i] = Eigen::Vector3d(joint[0], joint[1], joint[2]);
        }
      }
      person.states.push_back(mapped);
    }
    people.push_back(std::move(person));
  }
  return people;
}

Run follow(const std::string& log, const evaluation::Truth& truth, const Options& options) {
  perception::PeopleConfig config{.models = options.models, .fromLabels = options.labels};
  perception::PersonDetector detector(config);
  std::int64_t ids = 0;
  perception::PersonTracker tracker(config, base::SessionId{0}, 0, [&] { return base::EntityId{ids++}; });
  std::optional<perception::DebugImages> pictures;
  if (!options.pictures.empty()) pictures.emplace(options.pictures, options.every);
  const auto source = io::openSource(log);
  Run run;
  for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
    const auto* reading = std::get_if<sensors::Reading>(&item);
    if (reading == nullptr) continue;
    const auto* frame = std::get_if<sensors::RgbdFrame>(&reading->data);
    const auto* scan = std::get_if<sensors::LaserScan>(&reading->data);
    if ((options.laser ? scan != nullptr : frame != nullptr) == false || !tracker.wants(reading->time)) continue;
    const auto T_world_body = evaluation::poseAt(truth.trajectory, reading->time);
    if (!T_world_body) continue;
    const double begin = processorSeconds();
    std::vector<perception::PersonSighting> sightings;
    if (options.laser) {
      sightings = perception::findLegs(*scan, *T_world_body, reading->time);
    } else {
      if (pictures) pictures->beginFrame(run.looks);
      const perception::RgbdView view{.time = reading->time,
                                      .frame = *frame,
                                      .T_submap_camera = *T_world_body * frame->T_body_camera,
                                      .floor_z = test::floorBelow(truth, T_world_body->translation().z())};
      sightings = options.labels ? detector.findInLabels(view, truth.classes)
                                 : detector.find(view, pictures ? &*pictures : nullptr);
    }
    tracker.add(base::SubMapId{0}, reading->time, sightings, nullptr);
    run.seconds += processorSeconds() - begin;
    ++run.looks;
  }
  map::MapChange change;
  tracker.addTo(change);
  run.people = peopleOf(change);
  return run;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const std::string& name, const evaluation::HumanScore& score, const Run& run) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::printf("%-28.28s %4zu %4zu %4zu %4zu %3zu | %.3f %.3f | %5.1f %5.1f | %.3f | %5.1f\n", name.c_str(),
              score.frames, score.seen, score.matches, score.falsePositives, score.identitySwitches,
              quantile(score.positionErrors, 0.5), quantile(score.positionErrors, 0.9),
              kDegrees * quantile(score.headingErrors, 0.5), kDegrees * quantile(score.headingErrors, 0.9),
              quantile(score.jointErrors, 0.5), 1000.0 * run.seconds / std::max(1, run.looks));
  std::fflush(stdout);
}

void bench(const Options& options) {
  std::printf("%-28s  frm seen matc fals  sw | position m  | heading deg | joint | ms a look\n", "median, 90 %");
  evaluation::HumanScore all;
  Run looks;
  for (const auto& log : options.logs) {
    const auto truth = evaluation::readTruth(evaluation::truthPath(log));
    const Run run = follow(log, truth, options);
    const auto score = evaluation::scoreHumans(run.people, truth);
    print(std::filesystem::path(log).stem().string(), score, run);
    all += score;
    looks.looks += run.looks;
    looks.seconds += run.seconds;
  }
  print("all", all, looks);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How well are people of simulated logs followed?");
  Options options;
  app.add_option("MODELS", options.models, "folder of the models")->required()->check(CLI::ExistingDirectory);
  app.add_option("LOG", options.logs, "simulated logs with their truth")->required()->check(CLI::ExistingFile);
  app.add_flag("--labels", options.labels, "from label images");
  app.add_flag("--laser", options.laser, "from the laser alone");
  app.add_option("--pictures", options.pictures, "where to leave pictures with what was found");
  app.add_option("--every", options.every, "leave each N-th picture only")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    bench(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_people: %s\n", error.what());
    return 1;
  }
}
