// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/replay.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/io/open_source.hpp"

#include "commands.hpp"
#include "overwriting.hpp"
#include "progress_bar.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <array>
#include <fstream>
#include <iostream>

namespace prodomos::apps {

namespace {

namespace fs = std::filesystem;

struct ReplayOptions {
  std::string log;
  std::string output;
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

map::MapStore openStore(const ReplayOptions& options) {
  const fs::path output = options.output;
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

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

struct Result {
  mapper::Report report;
  std::map<std::string, double, std::less<>> seconds;
  std::size_t places = 0;
  std::size_t floors = 0;
};

void writeReport(const Result& result, const std::string& path) {
  const auto& report = result.report;
  const nlohmann::json out = {{"readings",
                               {{"read", report.read},
                                {"used", report.used},
                                {"used_by_kind", report.usedByKind},
                                {"skipped", report.skippedByReason}}},
                              {"faults", {{"count", report.faultCount}, {"first", report.faults}}},
                              {"submaps", report.submaps},
                              {"places", result.places},
                              {"distance_m", report.distance},
                              {"seconds", result.seconds},
                              {"peak_memory_mb", peakMemoryMb()}};
  std::ofstream file(path);
  file << out.dump(2) << '\n';
  if (!file.flush()) throw base::FileError(path + ": the report cannot be written");
}

void printReport(const Result& result, const ReplayOptions& options, const sensors::SourceInfo& log) {
  const auto& report = result.report;
  std::cout << log.path << " (" << log.kind << ")\n";
  std::cout << "  readings  " << grouped(report.read) << " read, " << grouped(report.used) << " used\n";
  for (const auto& [kind, count] : report.usedByKind)
    std::cout << "            " << grouped(count) << "  " << kind << '\n';
  for (const auto& [reason, count] : report.skippedByReason) {
    std::cout << "  skipped   " << grouped(count) << "  " << reason << '\n';
  }
  std::cout << "  map       " << report.submaps << (report.submaps == 1 ? " sub-map" : " sub-maps") << ", "
            << result.places << (result.places == 1 ? " place" : " places") << ", " << result.floors
            << (result.floors == 1 ? " floor" : " floors") << ", " << fixed(report.distance, 1) << " m travelled\n";
  std::cout << "  time      " << fixed(result.seconds.at("total"), 2) << " s (";
  const char* comma = "";
  for (const auto& [stage, seconds] : result.seconds) {
    if (stage == "total") continue;
    std::cout << comma << stage << " " << fixed(seconds, 2);
    comma = ", ";
  }
  std::cout << "), " << fixed(peakMemoryMb(), 0) << " MB of memory\n";
  std::cout << "  written   " << options.output << ", " << fileSize(fs::file_size(options.output)) << '\n';
}

void replayLog(ReplayOptions& options) {
  applyShorthands(options);
  const auto begin = std::chrono::steady_clock::now();

  // All that can be wrong is found before anything is written.
  if (!options.report.empty()) {
    requireOtherFile("--report", options.report, options.log, "the log");
    requireOtherFile("--report", options.report, options.output, "the map");
  }
  auto config = base::readConfig<mapper::MapperConfig>(options.config);
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

  Result result;
  {
    auto store = openStore(options);
    mapper::Mapper mapper(store, config, log);
    {
      ProgressBar bar(options.quiet);
      mapper::replay(*source, mapper,
                     [&](const base::Progress& progress) { bar.show(progress, mapper.report().read); });
    }
    const auto view = store.view();
    result = {mapper.report(), mapper.times().seconds(), view.graph().places().size(), view.floors().size()};
    store.close();
  }
  result.seconds["total"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!options.report.empty()) writeReport(result, options.report);
  if (!options.quiet) printReport(result, options, log);

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
      "  prodomos replay rgbd_dataset_freiburg1_room -o room.prodomos --camera 517.3,516.5,318.6,255.3 --set "
      "grid.resolution=0.02");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("LOG", options->log, "the log")->required();
  command->add_option("-o,--output", options->output, "the map file")->required();
  command->add_option("--config", options->config.file, "YAML configuration (prodomos config prints the defaults)");
  command->add_option("--set", options->config.assignments, "section.key=value, over the configuration; repeatable")
      ->allow_extra_args(false)
      ->take_all();
  command->add_flag("--resume", options->resume, "go on with a map whose replay was interrupted");
  command->add_option("--poses", options->poses, "odometry, recorded, or a file of `time x y z qx qy qz qw` lines");
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
  command->add_option("--report", options->report, "write the closing report as JSON");
  command->add_flag("--quiet", options->quiet, "print errors only");
  command->callback([options] { replayLog(*options); });
}

}  // namespace prodomos::apps
