// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/replay.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/perception/debug_images.hpp"

#include "commands.hpp"
#include "overwriting.hpp"
#include "progress_bar.hpp"
#include "replay_report.hpp"
#include "text.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <optional>

namespace prodomos::apps {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNoModels = "none";

struct ReplayOptions {
  std::string log;
  std::string output;
  std::string into;
  base::ConfigInput config;
  bool resume = false;
  std::string poses;
  std::string sensors;
  std::string start;
  std::string end;
  std::string fps;
  std::vector<double> camera;
  double depthScale = 0.0;
  std::string labels;
  std::string detections;
  std::string keyPoints;
  std::string models;
  std::string debugImages;
  int debugEvery = 10;
  std::string report;
  bool quiet = false;
};

/// The flags that are short for a key of the configuration.
void applyShorthands(ReplayOptions& options) {
  const auto set = [&](const char* key, const std::string& value) {
    if (!value.empty()) options.config.assignments.push_back(std::string(key) + "=" + value);
  };
  set("input.poses", options.poses);
  set("input.sensors", options.sensors);
  set("input.start", options.start);
  set("input.end", options.end);
  set("input.fps", options.fps);
  if (options.models != kNoModels) set("people.models", options.models);
}

/// Where the data sets are put, their networks are.
void findModels(const ReplayOptions& options, mapper::MapperConfig& config) {
  auto& models = config.perception.people.models;
  const char* datasets = std::getenv("PRODOMOS_DATASETS");
  if (!models.empty() || !options.models.empty() || !options.keyPoints.empty() || datasets == nullptr) return;
  const fs::path folder = fs::path(datasets) / "models";
  std::error_code unknown;
  if (fs::is_directory(folder, unknown)) models = folder.string();
}

io::SourceOptions sourceOptions(const ReplayOptions& options, const mapper::MapperConfig& config) {
  io::SourceOptions source;
  source.framesPerSecond = config.input.fps;
  if (!options.camera.empty()) {
    sensors::CameraIntrinsics camera{options.camera[0], options.camera[1], options.camera[2], options.camera[3], {}};
    std::copy(options.camera.begin() + 4, options.camera.end(), camera.distortion.begin());
    source.camera = camera;
  }
  if (options.depthScale > 0.0) source.depthScale = options.depthScale;
  if (!options.labels.empty()) source.labels = options.labels;
  if (!options.detections.empty()) source.detections = options.detections;
  if (!options.keyPoints.empty()) source.keyPoints = options.keyPoints;
  return source;
}

constexpr std::array kMapParts = {"", "-wal", "-shm"};

/// Nothing is lost: a map that is in the way stays beside the new one.
void keepAside(const fs::path& map) {
  map::MapView::open(map);  // throws where it is another kind of file, which we do not touch
  const fs::path aside = map.string() + "~";
  for (const char* part : kMapParts) {
    std::error_code none;
    fs::remove(aside.string() + part, none);  // an older one's journal is not this one's
    fs::rename(map.string() + part, aside.string() + part, none);
  }
  std::cerr << "prodomos: " << map.string() << " was there already and is now " << aside.string() << '\n';
}

/// A map that a further log is to grow.
map::MapStore openToGrow(const fs::path& map) {
  const auto view = map::MapView::open(map);
  if (!view.sessions().empty() && view.sessions().back().state != map::SessionState::kComplete) {
    throw base::UsageError(base::expectedFound("--into", "a map whose last replay was finished",
                                               map.string() + ", which was interrupted: --resume it first"));
  }
  return map::MapStore::openForWriting(map);
}

map::MapStore openStore(const ReplayOptions& options) {
  const fs::path output = options.output;
  if (!options.into.empty() && !options.resume) return openToGrow(output);
  std::error_code unknown;
  const bool exists = fs::exists(output, unknown);
  if (exists && options.resume) return map::MapStore::openForWriting(output);
  if (exists && fs::is_regular_file(output) && fs::file_size(output) == 0) {
    fs::remove(output);
  } else if (exists) {
    keepAside(output);
  }
  return map::MapStore::create(output);
}

/// A session goes on as it was begun: with its own configuration and its own log.
mapper::MapperConfig configToResume(const ReplayOptions& options, const map::Session& session) {
  auto stored = base::readConfig<mapper::MapperConfig>({{}, session.config, {}});
  const bool givesConfig = !options.config.file.empty() || !options.config.assignments.empty();
  if (givesConfig) {
    const auto given = base::readConfig<mapper::MapperConfig>(options.config);
    if (base::writeConfig(given, false) != session.config) {
      throw base::UsageError(
          "--resume goes on with the configuration that the map was begun with; leave out --config, "
          "--set and the like, or map anew");
    }
  }
  if (fs::path(session.log).filename() != fs::path(options.log).filename()) {
    throw base::UsageError(
        base::expectedFound("--resume", "the log that the map was begun with, " + session.log, options.log));
  }
  return stored;
}

std::string nounOf(const map::EntityAttributes& attributes) {
  if (const auto* door = std::get_if<map::Door>(&attributes)) return door->hasLeaf ? "door" : "doorway";
  if (std::holds_alternative<map::Human>(attributes)) return "person";
  return std::string(className(attributes));
}

ReplayResult resultOf(mapper::Mapper& mapper, const map::MapView& view) {
  const auto& graph = view.graph();
  const auto edges = graph.edges();
  ReplayResult result{.report = mapper.report(),
                      .seconds = mapper.times().seconds(),
                      .poses = view.sessions().back().poses,
                      .places = graph.places().size(),
                      .floors = view.floors().size()};
  result.loops = static_cast<std::size_t>(std::ranges::count_if(edges, [&](base::EdgeId id) {
    const auto kind = graph.getEdge(id).kind;
    return kind == map::EdgeKind::kLoop || kind == map::EdgeKind::kOverlap;
  }));
  for (const auto& entity : view.entities()) ++result.entities[nounOf(entity.attributes)];
  if (view.sessions().size() > 1) result.meetsEarlier = mapper.meetsEarlierSessions();
  return result;
}

void replayLog(ReplayOptions& options) {
  applyShorthands(options);
  if (options.output.empty() == options.into.empty()) {
    throw base::UsageError("replay takes either -o MAP, a new map, or --into MAP, one that is to grow");
  }
  if (options.output.empty()) options.output = options.into;
  const auto begin = std::chrono::steady_clock::now();

  // All that can be wrong is found before anything is written.
  if (!options.report.empty()) {
    requireOtherFile("--report", options.report, options.log, "the log");
    requireOtherFile("--report", options.report, options.output, "the map");
  }
  auto config = base::readConfig<mapper::MapperConfig>(options.config);
  findModels(options, config);
  const bool resumes = options.resume && fs::exists(options.output);
  if (resumes) {
    const auto view = map::MapView::open(options.output);
    if (!view.sessions().empty()) {
      if (view.sessions().back().state == map::SessionState::kComplete) {
        std::cout << options.output << " is complete: nothing to resume\n";
        return;
      }
      config = configToResume(options, view.sessions().back());
    }
  }
  auto source = mapper::selectInput(io::openSource(options.log, sourceOptions(options, config)), config.input);
  const auto log = source->info();
  for (const auto& remark : log.remarks) std::cerr << "prodomos: " << log.path << ": " << remark << '\n';

  ReplayResult result;
  {
    auto store = openStore(options);
    std::optional<perception::DebugImages> debug;
    if (!options.debugImages.empty()) debug.emplace(options.debugImages, options.debugEvery);
    mapper::Mapper mapper(store, config, log, debug ? &*debug : nullptr);
    {
      ProgressBar bar("replay", "readings", options.quiet);
      mapper::replay(*source, mapper,
                     [&](const base::Progress& progress) { bar.show(progress, mapper.report().read); });
    }
    result = resultOf(mapper, store.view());
    store.close();
  }
  result.seconds["total"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!options.report.empty()) writeReport(result, options.report);
  if (!options.quiet) printReport(result, log, options.output);

  if (result.report.faultCount > 0) {
    std::string faults;
    for (const auto& fault : result.report.faults) faults += fault + "\n";
    const auto more = result.report.faultCount - static_cast<std::int64_t>(result.report.faults.size());
    if (more > 0) faults += log.path + ": and " + grouped(more) + " more such faults\n";
    throw base::FileError(faults);
  }
  if (result.report.submaps == 0) {
    throw base::FileError(base::expectedFound(log.path, "laser scans, depth images or point clouds to map", "none"));
  }
}

}  // namespace

void addReplay(CLI::App& program) {
  auto* command = program.add_subcommand("replay", "map a log");
  command->footer(
      "LOG is an MRPT rawlog, a TUM or plain RGB-D folder, or a CARMEN log; it is recognised by its content.\n"
      "Examples:\n"
      "  prodomos replay office.rawlog -o office.prodomos\n"
      "  prodomos replay next_day.rawlog --into office.prodomos\n"
      "  prodomos replay rgbd_dataset_freiburg1_room -o room.prodomos --camera 517.3,516.5,318.6,255.3 --set "
      "grid.resolution=0.02");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("LOG", options->log, "the log")->required();
  command->add_option("-o,--output", options->output, "the map file");
  command->add_option("--into", options->into,
                      "a map that the log is to grow; it finds itself where both show the same");
  command->add_option("--config", options->config.file, "YAML configuration (prodomos config prints the defaults)");
  command->add_option("--set", options->config.assignments, "section.key=value, over the configuration; repeatable")
      ->allow_extra_args(false)
      ->take_all();
  command->add_flag("--resume", options->resume, "go on with a map whose replay was interrupted");
  command->add_option(
      "--poses", options->poses,
      "estimated, odometry, recorded, or a file of `time x y z qx qy qz qw` lines (auto: recorded where the log has "
      "them, else estimated)");
  command->add_option("--sensor", options->sensors, "labels of the sensors to use, with commas between");
  command->add_option("--start", options->start, "time stamp to begin at, seconds");
  command->add_option("--end", options->end, "time stamp to end at, seconds");
  command->add_option("--fps", options->fps, "frame rate of RGB-D folders without time stamps (30)");
  command->add_option("--camera", options->camera, "fx,fy,cx,cy[,k1,k2,p1,p2,k3] of RGB-D folders, pixels")
      ->delimiter(',')
      ->expected(4, 9);
  command->add_option("--depth-scale", options->depthScale, "units a metre in depth images (TUM: 5000)")
      ->check(CLI::PositiveNumber);
  command->add_option("--labels", options->labels, "folder of label images and classes.yaml");
  command->add_option("--detections", options->detections, "side file of detected boxes");
  command->add_option("--key-points", options->keyPoints, "side file of persons' joints");
  command->add_option("--models", options->models,
                      "folder of the networks that find people, or none (default: models of $PRODOMOS_DATASETS)");
  command->add_option("--debug-images", options->debugImages,
                      "folder for pictures of how doors, stairs and people were found");
  command->add_option("--debug-every", options->debugEvery, "a picture of one frame in so many (10)")
      ->check(CLI::PositiveNumber);
  command->add_option("--report", options->report, "write the closing report as JSON");
  command->add_flag("--quiet", options->quiet, "print errors only");
  command->callback([options] { replayLog(*options); });
}

}  // namespace prodomos::apps
