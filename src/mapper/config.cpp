// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/config.hpp"

namespace prodomos::mapper {

void describe(base::ConfigVisitor& visitor, MapperConfig& config) {
  visitor.section("input", "what of a log is used");
  visitor.key("poses", config.input.poses,
              "auto | estimated | odometry | recorded | path of a file with `time x y z qx qy qz qw` a line");
  visitor.key("sensors", config.input.sensors, "labels of the sensors to use, with commas between; empty: all");
  visitor.key("start", config.input.start, "time stamp to begin at, decimal seconds; empty: the first");
  visitor.key("end", config.input.end, "time stamp to end at, decimal seconds; empty: the last");
  visitor.key("fps", config.input.fps, "1/s", {0.01, 1000.0}, "frame rate of RGB-D folders without time stamps");
  visitor.key("pose_gap", config.input.poseGap, "s", {0.0, 3600.0},
              "readings farther than this from any recorded pose are skipped");
  visitor.endSection();

  visitor.section("submap", "when a new sub-map begins");
  visitor.key("max_distance", config.submap.maxDistance, "m", {0.5, 1000.0}, "after this way travelled");
  visitor.key("least_overlap", config.submap.leastOverlap, "", {0.0, 1.0},
              "when less of a reading's end points lies in cells that were seen where the sub-map began");
  visitor.key("overlap_step", config.submap.overlapStep, "m or rad", {0.05, 100.0},
              "way or turn between two looks at the overlap");
  visitor.endSection();

  visitor.section("floor", "storeys");
  visitor.key("least_height", config.floor.leastHeight, "m", {0.5, 20.0}, "least height between two floors");
  visitor.endSection();

  visitor.section("odometry_noise",
                  "standard deviations of poses that are told, by wheels or else; they grow with the root of the way");
  visitor.key("translation_per_metre", config.odometryNoise.translationPerMetre, "m", {1e-6, 10.0}, "after a metre");
  visitor.key("rotation_per_metre", config.odometryNoise.rotationPerMetre, "rad", {1e-6, 10.0}, "after a metre");
  visitor.key("rotation_per_radian", config.odometryNoise.rotationPerRadian, "rad", {1e-6, 10.0},
              "after a radian turned");
  visitor.endSection();

  describe(visitor, config.laserOdometry);
  describe(visitor, config.rgbdOdometry);
  describe(visitor, config.loops);
  describe(visitor, config.layers);
  describe(visitor, config.perception);
  describe(visitor, config.prediction);
}

}  // namespace prodomos::mapper
