// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/io/rawlog_sink.hpp"
#include "prodomos/simulation/simulator.hpp"

#include "commands.hpp"
#include "overwriting.hpp"
#include "progress_bar.hpp"
#include "text.hpp"

#include <algorithm>
#include <iostream>
#include <map>

namespace prodomos::apps {

namespace {

namespace fs = std::filesystem;
using simulation::Labels;

struct SimulateOptions {
  std::string scene;
  std::string output;
  base::ConfigInput config;
  simulation::SimulationOptions simulation;
  int storeys = 0;
  io::RawlogFlavour flavour = io::RawlogFlavour::kObservations;
  std::vector<std::string> path;
  bool quiet = false;
};

/// "X,Y" or "X,Y,STOREY".
simulation::Stop stopOf(const std::string& text) {
  std::istringstream stream(text);
  simulation::Stop stop;
  char comma = 0;
  bool isRead = static_cast<bool>(stream >> stop.position.x() >> comma >> stop.position.y()) && comma == ',';
  if (isRead && stream.peek() == ',') isRead = static_cast<bool>(stream >> comma >> stop.storey);
  if (!isRead || stream.peek() != EOF) throw base::UsageError(base::expectedFound("--path", "X,Y or X,Y,STOREY", text));
  return stop;
}

void print(const evaluation::Truth& truth, const SimulateOptions& options) {
  const auto visible = [](const auto& things) {
    return std::ranges::count_if(things, [](const auto& thing) { return thing.sighting.visible; });
  };
  const auto leaves = std::ranges::count_if(truth.doors, [](const auto& door) { return door.leaves > 0; });
  const auto entered = std::ranges::count_if(truth.rooms, [](const auto& room) { return room.entered.has_value(); });
  std::cout << truth.building << ", seed " << truth.seed << '\n'
            << "  rooms   " << truth.rooms.size() << ", " << entered << " entered\n"
            << "  doors   " << leaves << " and " << truth.doors.size() - static_cast<std::size_t>(leaves)
            << " doorways, " << visible(truth.doors) << " seen well enough\n"
            << "  stairs  " << truth.stairs.size() << ", " << visible(truth.stairs) << " seen well enough\n"
            << "  people  " << truth.people.size() << '\n'
            << "  log     " << options.output << ", " << fileSize(fs::file_size(options.output)) << '\n'
            << "  truth   " << evaluation::truthPath(options.output).string() << '\n';
}

/// The log is made beside its place, so that a run that fails leaves no half log, and none lost that was there.
void simulateLog(SimulateOptions& options) {
  requireOtherFile("-o", options.output, options.scene, "the scene");
  for (const auto& text : options.path) options.simulation.path.push_back(stopOf(text));
  const auto config = base::readConfig<simulation::SimulationConfig>(options.config);
  auto building = simulation::openScene(options.scene, options.simulation.seed, options.storeys);
  if (!options.quiet) {
    for (const auto& remark : building.remarks) std::cerr << "prodomos: " << options.scene << ": " << remark << '\n';
  }
  const auto classes = options.simulation.labels == Labels::kNone ? sensors::ClassTable{} : simulation::classTable();
  const fs::path unfinished = options.output + ".part";
  evaluation::Truth truth;
  try {
    auto sink = io::createRawlog(unfinished, options.flavour, classes);
    ProgressBar bar("simulate", "frames", options.quiet);
    truth = simulation::simulate(std::move(building), options.simulation, config, *sink,
                                 [&](const base::Progress& progress) {
                                   bar.show(progress, static_cast<std::int64_t>(progress.done * config.camera.rate));
                                 });
    sink->close();
    evaluation::writeTruth(truth, evaluation::truthPath(options.output));
    fs::rename(unfinished, options.output);
  } catch (...) {
    std::error_code none;
    fs::remove(unfinished, none);
    throw;
  }
  if (!options.quiet) print(truth, options);
}

}  // namespace

void addSimulate(CLI::App& program) {
  auto* command = program.add_subcommand("simulate", "make a log of a robot in a building, and all that is true of it");
  command->footer(
      "SCENE is a floor plan (XML), a Gazebo world with its meshes, or a scene file (YAML, docs/scene-files.md).\n"
      "The truth is written beside the log: office.rawlog has office.truth.json (docs/truth.md).\n"
      "Examples:\n"
      "  prodomos simulate configs/sample_office.scene.yaml --seed 7 -o office.rawlog\n"
      "  prodomos simulate ED21.xml --seed 1 --storeys 2 --frames 1200 --labels degraded -o ed21.rawlog");
  auto options = std::make_shared<SimulateOptions>();
  auto& simulation = options->simulation;
  command->add_option("SCENE", options->scene, "the building")->required();
  command->add_option("-o,--output", options->output, "the log, an MRPT rawlog")->required();
  command->add_option("--seed", simulation.seed, "of furniture, door states, lighting, people and the robot's way")
      ->required();
  command->add_option("--frames", simulation.frames, "camera frames (600)")->check(CLI::Range(1, 1'000'000));
  command->add_option("--storeys", options->storeys, "storeys (0: as the scene has it)")->check(CLI::Range(0, 20));
  const std::map<std::string, Labels> labels{
      {"none", Labels::kNone}, {"true", Labels::kTrue}, {"degraded", Labels::kDegraded}};
  command->add_option("--labels", simulation.labels, "label images: none, true, degraded (none)")
      ->transform(CLI::CheckedTransformer(labels).description(""));
  const std::map<std::string, io::RawlogFlavour> flavours{{"observations", io::RawlogFlavour::kObservations},
                                                          {"frames", io::RawlogFlavour::kActionsAndSensoryFrames}};
  command
      ->add_option("--flavour", options->flavour, "of the rawlog: observations, or frames: actions and sensory frames")
      ->transform(CLI::CheckedTransformer(flavours).description(""));
  command->add_option("--path", options->path, "X,Y[,STOREY] ...: where the robot drives, instead of a way by seed");
  command->add_flag("--poses", simulation.recordsPoses, "log the true poses too, as a tracking system would");
  command->add_option("--config", options->config.file, "YAML configuration (prodomos config --of simulate)");
  command->add_option("--set", options->config.assignments, "section.key=value, over the configuration; repeatable")
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--threads", simulation.threads, "that render (0: all cores); the log is the same")
      ->check(CLI::Range(0, 256));
  command->add_flag("--quiet", options->quiet, "print errors only");
  command->callback([options] { simulateLog(*options); });
}

}  // namespace prodomos::apps
