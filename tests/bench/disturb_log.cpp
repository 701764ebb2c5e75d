// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// Writes a log again with worse wheel odometry, for tests of robustness. Each increment of the odometry is changed and
/// the way put together from them anew, so that faults add up as they do on a robot. Stamps stay as they are.
///
///     disturb_log intel.rawlog worse.rawlog --scale 1.2 --yaw-per-metre 2
///     disturb_log intel.rawlog blind.rawlog --no-odometry

#include "prodomos/base/error.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/io/rawlog_sink.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

namespace prodomos {
namespace {

using geometry::Pose2;

struct Disturbance {
  double scale = 1.0;        ///< of the way
  double turnScale = 1.0;    ///< of the turns
  double yawPerMetre = 0.0;  ///< degrees to the left, after a metre of the true way
  bool noOdometry = false;
};

/// The odometry of wheels that are worse.
class DisturbedOdometry {
 public:
  explicit DisturbedOdometry(const Disturbance& disturbance) : disturbance_(disturbance) {}

  Pose2 follow(const Pose2& T_odom_body) {
    if (!T_odom_last_) T_disturbed_last_ = T_odom_body;
    const Pose2 T_last_body = inverse(T_odom_last_.value_or(T_odom_body)) * T_odom_body;
    const double drift = disturbance_.yawPerMetre * std::numbers::pi / 180.0 * std::hypot(T_last_body.x, T_last_body.y);
    T_odom_last_ = T_odom_body;
    return T_disturbed_last_ = T_disturbed_last_ * Pose2{.x = disturbance_.scale * T_last_body.x,
                                                         .y = disturbance_.scale * T_last_body.y,
                                                         .theta = disturbance_.turnScale * T_last_body.theta + drift};
  }

 private:
  Disturbance disturbance_;
  std::optional<Pose2> T_odom_last_;
  Pose2 T_disturbed_last_;
};

void disturb(const std::string& in, const std::string& out, const Disturbance& disturbance) {
  const auto source = io::openSource(in);
  const auto sink = io::createRawlog(out, io::RawlogFlavour::kObservations, source->info().classes);
  DisturbedOdometry wheels(disturbance);
  for (;;) {
    auto item = source->next();
    if (const auto* end = std::get_if<sensors::EndOfLog>(&item)) {
      if (!end->fault.empty()) throw base::FileError(end->fault);
      break;
    }
    auto* reading = std::get_if<sensors::Reading>(&item);
    if (reading == nullptr) continue;
    if (auto* odometry = std::get_if<sensors::Odometry>(&reading->data)) {
      if (disturbance.noOdometry) continue;
      odometry->T_odom_body = geometry::toPose3(wheels.follow(geometry::toPose2(odometry->T_odom_body)));
    }
    sink->write(*reading);
  }
  sink->close();
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  CLI::App program("writes a log again with worse wheel odometry");
  std::string in;
  std::string out;
  prodomos::Disturbance disturbance;
  program.add_option("IN", in, "a log of any kind that prodomos reads")->required();
  program.add_option("OUT", out, "a rawlog")->required();
  program.add_option("--scale", disturbance.scale, "of the way between two readings")->capture_default_str();
  program.add_option("--turn-scale", disturbance.turnScale, "of the turns")->capture_default_str();
  program.add_option("--yaw-per-metre", disturbance.yawPerMetre, "degrees to the left")->capture_default_str();
  program.add_flag("--no-odometry", disturbance.noOdometry, "leave all of it out");
  CLI11_PARSE(program, argc, argv);
  try {
    prodomos::disturb(in, out, disturbance);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "disturb_log: %s\n", fault.what());
    return 1;
  }
  return 0;
}
