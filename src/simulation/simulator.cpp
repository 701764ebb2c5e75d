// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/simulator.hpp"

#include "prodomos/base/error.hpp"
#include "prodomos/simulation/color_noise.hpp"
#include "prodomos/simulation/furniture.hpp"
#include "prodomos/simulation/population.hpp"
#include "prodomos/simulation/renderer.hpp"
#include "prodomos/simulation/witness.hpp"

#include "simulation/stage.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>
#include <utility>

namespace prodomos::simulation {

namespace {

using sensors::Reading;

/// 2026-01-01 00:00 UTC: logs of real robots have dates.
constexpr base::Time kBegin{std::chrono::seconds(1'767'225'600)};

/// In the order in which readings of one time are logged.
enum class Event { kWheels, kPose, kLaser, kLidar, kCamera };

struct Moment {
  double seconds;
  Event event;
};

std::vector<Moment> timetable(double duration, const SimulationOptions& options, const SimulationConfig& config) {
  std::vector<Moment> moments;
  const auto add = [&](Event event, double rate) {
    const int count = static_cast<int>(std::ceil(duration * rate - 1e-9));
    for (int i = 0; i < count; ++i) moments.push_back({i / rate, event});
  };
  add(Event::kWheels, config.wheelRate);
  if (options.recordsPoses) add(Event::kPose, config.wheelRate);
  add(Event::kLaser, config.laser.rate);
  add(Event::kLidar, config.lidar.rate);
  add(Event::kCamera, config.camera.rate);
  std::ranges::stable_sort(moments, [](const Moment& a, const Moment& b) {
    return std::pair(a.seconds, a.event) < std::pair(b.seconds, b.event);
  });
  return moments;
}

geometry::Pose3 poseOf(const Mount& mount) {
  return geometry::fromYawPitchRoll({mount.forward, 0.0, mount.height}, 0.0, mount.pitch * std::numbers::pi / 180.0,
                                    0.0);
}

/// Hands readings to the sink in another thread, so that packing one frame's goes on while the next is rendered.
class Writer {
 public:
  explicit Writer(sensors::SensorSink& sink) : sink_(sink) {}

  void add(Reading reading) { waiting_.push_back(std::move(reading)); }

  void flush() {
    finish();
    writing_ = std::async(std::launch::async, [this, readings = std::exchange(waiting_, {})] {
      for (const auto& reading : readings) sink_.write(reading);
    });
  }

  void finish() {
    if (writing_.valid()) writing_.get();
  }

 private:
  sensors::SensorSink& sink_;
  std::vector<Reading> waiting_;
  std::future<void> writing_;
};

/// A robot in a building, from moment to moment.
class Simulation {
 public:
  Simulation(const Building& building, const Tour& tour, const SimulationOptions& options,
             const SimulationConfig& config, sensors::SensorSink& sink)
      : tour_(tour),
        options_(options),
        config_(config),
        stage_(building, options.seed),
        renderer_(stage_.scene(), building.textures, building.lighting, camera_),
        truth_(truthOf(building, kBegin, options.seed)),
        witness_(building, camera_, truth_),
        wheels_(config.wheels, options.seed),
        laserNoise_(options.seed, "laser"),
        lidarNoise_(options.seed, "lidar"),
        depthNoise_(options.seed, "depth"),
        colorNoise_(options.seed, "colour"),
        labelNoise_(options.seed, "labels"),
        lidar_(config.lidarModel),
        writer_(sink) {
    if (config.lidarRings == 1) lidar_.elevations = elevations64();
  }

  void live(const Moment& moment) {
    const auto time = kBegin + base::fromSeconds(moment.seconds);
    const auto T_world_body = poseAt(tour_, moment.seconds);
    switch (moment.event) {
      case Event::kWheels:
        writer_.add({time, "odometry", sensors::Odometry{geometry::toPose3(wheels_.moveTo(T_world_body))}});
        break;
      case Event::kPose:
        writer_.add({time, "truth", sensors::RecordedPose{T_world_body}});
        break;
      case Event::kLaser: {
        setTime(moment.seconds, T_world_body);
        const auto T_body_sensor = poseOf(config_.laser);
        writer_.add(
            {time, "laser",
             castLaser(stage_.scene(), T_world_body * T_body_sensor, T_body_sensor, config_.laserModel, laserNoise_)});
        witness_.walk(time, T_world_body);
        break;
      }
      case Event::kLidar: {
        setTime(moment.seconds, T_world_body);
        const auto T_body_sensor = poseOf(config_.lidar);
        writer_.add(
            {time, "lidar",
             castLidar(stage_.scene(), T_world_body * T_body_sensor, T_body_sensor, config_.lidarModel, lidarNoise_)});
        break;
      }
      case Event::kCamera:
        setTime(moment.seconds, T_world_body);
        look(time, moment.seconds, T_world_body);
        writer_.flush();
        break;
    }
  }

  evaluation::Truth finish() {
    writer_.flush();
    writer_.finish();
    return std::move(truth_);
  }

 private:
  void setTime(double seconds, const geometry::Pose3& T_world_body) {
    if (seconds == stageTime_) return;
    stageTime_ = seconds;
    stage_.setTime(seconds, T_world_body.translation() + Eigen::Vector3d::UnitZ(), options_.threads);
  }

  void look(base::Time time, double seconds, const geometry::Pose3& T_world_body) {
    const geometry::Pose3 T_body_camera = poseOf(config_.camera) * sensors::cameraAxesInBody();
    const geometry::Pose3 T_world_camera = T_world_body * T_body_camera;
    const auto rendering = renderer_.render(T_world_camera, options_.threads);
    witness_.walk(time, T_world_body);
    witness_.look(time, seconds, T_world_camera, rendering);
    sensors::RgbdFrame frame{
        .T_body_camera = T_body_camera,
        .camera = camera_.intrinsics,
        .depth = noisyDepth(rendering, camera_, config_.depthNoise, depthNoise_, options_.threads),
        .color = noisyColor(colorOf(rendering, seconds, T_world_camera), {}, colorNoise_, options_.threads)};
    if (options_.labels != Labels::kNone) {
      frame.labels = sensors::LabelImage{.classes = rendering.classes, .instances = rendering.instances};
      if (options_.labels == Labels::kDegraded) {
        frame.labels = degraded(*frame.labels, config_.degradation, labelNoise_);
      }
    }
    writer_.add({time, "camera", std::move(frame)});
  }

  sensors::Image<sensors::Rgb> colorOf(const Rendering& rendering, double seconds,
                                       const geometry::Pose3& T_world_camera) const {
    if (config_.shutter == 0.0) return rendering.color;
    const auto T_world_before =
        poseAt(tour_, seconds - config_.shutter) * poseOf(config_.camera) * sensors::cameraAxesInBody();
    return motionBlurred(rendering, camera_, T_world_camera.inverse() * T_world_before, options_.threads);
  }

  const Tour& tour_;
  const SimulationOptions& options_;
  const SimulationConfig& config_;
  CameraModel camera_;
  Stage stage_;
  double stageTime_ = -1.0;
  Renderer renderer_;
  evaluation::Truth truth_;
  Witness witness_;
  Wheels wheels_;
  base::Random laserNoise_;
  base::Random lidarNoise_;
  base::Random depthNoise_;
  base::Random colorNoise_;
  base::Random labelNoise_;
  LidarModel lidar_;
  Writer writer_;
};

std::string_view toString(Labels labels) {
  switch (labels) {
    case Labels::kNone:
      return "none";
    case Labels::kTrue:
      return "true";
    case Labels::kDegraded:
      return "degraded";
  }
  return "";
}

}  // namespace

evaluation::Truth simulate(Building building, const SimulationOptions& options, const SimulationConfig& config,
                           sensors::SensorSink& sink, const base::ProgressListener& onProgress) {
  const double duration = options.frames / config.camera.rate;
  furnish(building, options.seed);
  populate(building, options.seed, duration);
  const auto tour = planTour(building, {.seed = options.seed,
                                        .duration = duration,
                                        .speed = config.speed,
                                        .turnRate = config.turnRate,
                                        .path = options.path});
  Simulation simulation(building, tour, options, config, sink);
  for (const auto& moment : timetable(duration, options, config)) {
    simulation.live(moment);
    if (onProgress) onProgress({.done = moment.seconds, .total = duration});
  }
  auto truth = simulation.finish();
  truth.labels = toString(options.labels);
  return truth;
}

}  // namespace prodomos::simulation
