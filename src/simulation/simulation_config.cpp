// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/simulator.hpp"

#include <array>
#include <string_view>

namespace prodomos::simulation {

namespace {

constexpr base::Bounds kShare{0.0, 1.0};

/// Within the section of its sensor.
void describe(base::ConfigVisitor& visitor, Mount& mount, base::Bounds rates) {
  visitor.key("rate", mount.rate, "1/s", rates, "readings a second");
  visitor.key("height", mount.height, "m", {0.05, 3.0}, "above the floor");
  visitor.key("forward", mount.forward, "m", {-1.0, 1.0}, "ahead of the robot's middle");
  visitor.key("pitch", mount.pitch, "deg", {-90.0, 90.0}, "downwards");
}

void describe(base::ConfigVisitor& visitor, RangeNoise& noise) {
  visitor.key("sigma", noise.sigma, "m", {0.0, 1.0}, "standard deviation of a range");
  visitor.key("least_range", noise.leastRange, "m", {0.0, 10.0}, "what is nearer says nothing");
  visitor.key("max_range", noise.maxRange, "m", {0.5, 500.0}, "what is farther has no return");
  visitor.key("missing", noise.missing, "", kShare, "share of beams whose measurement fails, and is flagged so");
}

void describe(base::ConfigVisitor& visitor, DepthNoise& noise) {
  visitor.section("depth", "how the camera's depth errs");
  visitor.key("least_range", noise.leastRange, "m", {0.0, 5.0}, "nothing is measured nearer");
  visitor.key("most_range", noise.mostRange, "m", {0.5, 50.0}, "nor farther");
  visitor.key("disparity_sigma", noise.disparitySigma, "1/8 px", {0.0, 10.0}, "of one measurement");
  visitor.key("warp", noise.warp, "1/8 px", {0.0, 10.0}, "the device's own smooth distortion");
  visitor.key("device", noise.device, "seed of that distortion: one device has it in all pictures");
  visitor.endSection();
}

void describe(base::ConfigVisitor& visitor, WheelModel& wheels) {
  visitor.section("wheels", "wheel odometry");
  visitor.key("scale_sigma", wheels.scaleSigma, "", kShare, "of distances, one factor a log");
  visitor.key("turn_scale_sigma", wheels.turnScaleSigma, "", kShare, "of turns, one factor a log");
  visitor.key("drift_sigma", wheels.driftSigma, "rad/m", kShare, "heading gained on straight ways, one value a log");
  visitor.key("distance_noise", wheels.distanceNoise, "m", kShare, "after a metre; grows with the root of the way");
  visitor.key("heading_noise_per_meter", wheels.headingNoisePerMeter, "rad", kShare, "after a metre");
  visitor.key("heading_noise_per_radian", wheels.headingNoisePerRadian, "rad", kShare, "after a turn by a radian");
  visitor.endSection();
}

void describe(base::ConfigVisitor& visitor, LabelDegradation& labels) {
  visitor.section("labels", "how degraded labels err");
  visitor.key("boundary_noise", labels.boundaryNoise, "px", {0.0, 50.0}, "how far outlines are off");
  visitor.key("flips", labels.flips, "", kShare, "share of the image in patches of a wrong class");
  visitor.key("missed", labels.missed, "", kShare, "probability that a thing is missed in a frame");
  visitor.key("false_things", labels.falseThings, "1/frame", {0.0, 100.0}, "things that are not there");
  visitor.endSection();
}

}  // namespace

void describe(base::ConfigVisitor& visitor, SimulationConfig& config) {
  visitor.section("robot", "how it drives");
  visitor.key("speed", config.speed, "m/s", {0.05, 5.0}, "at most");
  visitor.key("turn_rate", config.turnRate, "rad/s", {0.05, 10.0}, "at most");
  visitor.key("wheel_rate", config.wheelRate, "1/s", {1.0, 1000.0}, "odometry and true poses a second");
  visitor.endSection();
  visitor.section("camera", "RGB-D camera");
  describe(visitor, config.camera, {0.1, 60.0});
  visitor.key("shutter", config.shutter, "s", {0.0, 1.0}, "how long it is open: motion blurs colour; 0: it does not");
  visitor.endSection();
  describe(visitor, config.depthNoise);
  visitor.section("laser", "2D laser");
  describe(visitor, config.laser, {0.0, 100.0});
  visitor.key("beams", config.laserModel.beams, "", {2.0, 10000.0}, "of a scan");
  describe(visitor, config.laserModel.noise);
  visitor.endSection();
  visitor.section("lidar", "3D lidar; not on board while its rate is 0");
  describe(visitor, config.lidar, {0.0, 30.0});
  static constexpr std::array<std::string_view, 2> kRings = {"16", "64"};
  visitor.choice("rings", config.lidarRings, kRings, "like a VLP-16, or an HDL-64");
  describe(visitor, config.lidarModel.noise);
  visitor.endSection();
  describe(visitor, config.wheels);
  describe(visitor, config.degradation);
}

}  // namespace prodomos::simulation
