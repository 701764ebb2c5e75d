// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/carmen_source.hpp"

#include "prodomos/base/error.hpp"

#include "io/input_file.hpp"
#include "io/scan_ranges.hpp"
#include "io/text_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>

namespace prodomos::io {

namespace {

constexpr std::array<std::string_view, 12> kMessages = {"PARAM",     "SYNC",      "ODOM",        "FLASER",
                                                        "RLASER",    "TRUEPOS",   "ROBOTLASER1", "ROBOTLASER2",
                                                        "RAWLASER1", "RAWLASER2", "MARKER",      "NMEAGGA"};

using Fields = std::vector<std::string_view>;

struct MalformedLine {
  std::string expected;
};

double number(const Fields& fields, std::size_t index, const std::string& expected) {
  const auto value = index < fields.size() ? parseNumber<double>(fields[index]) : std::nullopt;
  if (!value || !std::isfinite(*value)) throw MalformedLine{expected};
  return *value;
}

geometry::Pose2 pose(const Fields& fields, std::size_t index, const std::string& expected) {
  return {number(fields, index, expected), number(fields, index + 1, expected), number(fields, index + 2, expected)};
}

/// Each message ends with `ipc_timestamp ipc_hostname logger_timestamp`; the first is when it was measured.
base::Time stamp(const Fields& fields, std::size_t index) {
  const auto time = index < fields.size() ? base::parseSeconds(fields[index]) : std::nullopt;
  if (!time) throw MalformedLine{"a time stamp as field " + std::to_string(index + 1)};
  return *time;
}

std::size_t readingCount(const Fields& fields, std::size_t index) {
  const auto count = index < fields.size() ? parseNumber<std::size_t>(fields[index]) : std::nullopt;
  if (!count || *count > fields.size()) throw MalformedLine{"the number of readings that follow"};
  return *count;
}

/// What the log says of a laser before its first scan.
struct Laser {
  std::string offsetKey;  ///< metres ahead of the body's origin
  std::string fovKey;     ///< degrees
  std::string maxKey;     ///< metres
  double heading = 0.0;   ///< of the laser in the body, radians
};

const Laser kFrontLaser = {"robot_frontlaser_offset", "laser_front_laser_fov", "robot_front_laser_max", 0.0};
const Laser kRearLaser = {"robot_rearlaser_offset", "laser_rear_laser_fov", "robot_rear_laser_max", std::numbers::pi};

class CarmenSource final : public sensors::SensorSource {
 public:
  explicit CarmenSource(const std::filesystem::path& path) : file_(path) {
    info_.path = path.string();
    info_.kind = "CARMEN log";
  }

  const sensors::SourceInfo& info() const override { return info_; }
  base::Progress progress() const override { return file_.progress(); }

  sensors::SourceItem next() override {
    while (items_.empty()) {
      if (!file_.readLine(line_)) return endOfLog();
      ++lineNumber_;
      readMessage();
    }
    auto item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

 private:
  sensors::EndOfLog endOfLog() const {
    if (file_.damage().empty()) return {};
    return {
        base::expectedFound(place(file_.path(), lineNumber_), "another line or the end of the log", file_.damage())};
  }

  void readMessage() {
    if (isComment(line_)) return;
    const auto fields = splitFields(line_);
    try {
      readMessage(fields);
    } catch (const MalformedLine& fault) {
      const auto message = "malformed " + std::string(fields[0]);
      const auto found = line_.size() > kShown ? "`" + line_.substr(0, kShown) + "…`" : "`" + line_ + "`";
      items_.push_back(
          sensors::Skipped{message, base::expectedFound(place(file_.path(), lineNumber_), fault.expected, found)});
    }
  }

  void readMessage(const Fields& fields) {
    const auto name = fields[0];
    if (name == "PARAM") {
      if (fields.size() > 2) parameters_[std::string(fields[1])] = parseNumber<double>(fields[2]).value_or(kNoNumber);
    } else if (name == "SYNC") {
      // marks of the logger's user: no reading
    } else if (name == "ODOM") {
      const auto odometry = pose(fields, 1, "`ODOM x y theta tv rv accel time host time`");
      addOdometry(odometry, stamp(fields, 7), "ODOM");
    } else if (name == "FLASER") {
      readLaser(fields, kFrontLaser);
    } else if (name == "RLASER") {
      readLaser(fields, kRearLaser);
    } else if (name == "ROBOTLASER1") {
      readRobotLaser(fields, kFrontLaser);
    } else if (name == "ROBOTLASER2") {
      readRobotLaser(fields, kRearLaser);
    } else if (std::ranges::count(kMessages, name) > 0) {
      items_.push_back(sensors::Skipped{"unsupported " + std::string(name), ""});
    } else {
      throw MalformedLine{"a CARMEN message such as FLASER or ODOM"};
    }
  }

  /// FLASER count ranges... x y theta odom_x odom_y odom_theta time host time. The pose before the odometry is one that
  /// CARMEN corrected, in most logs the odometry again: it is not handed on.
  void readLaser(const Fields& fields, const Laser& laser) {
    const std::size_t count = readingCount(fields, 1);
    const std::size_t after = 2 + count;
    const auto odometry = pose(fields, after + 3, "`x y theta odom_x odom_y odom_theta` after the ranges");
    const auto time = stamp(fields, after + 6);
    const std::string label(fields[0]);
    sensors::LaserScan scan;
    scan.T_body_sensor = geometry::toPose3({parameter(laser.offsetKey, 0.0), 0.0, laser.heading});
    scan.maxRange = parameter(laser.maxKey, kDefaultMaxRange);
    setFan(scan, count, laser);
    addScan(std::move(scan), fields, 2, count, time, label, odometry);
  }

  /// ROBOTLASER1 type start_angle field_of_view resolution max_range accuracy remission_mode count ranges...
  /// remissions remission... laser_x laser_y laser_theta x y theta tv rv forward side turn time host time
  void readRobotLaser(const Fields& fields, const Laser& laser) {
    const std::string expected = "`start_angle field_of_view angular_resolution maximum_range` after the laser's type";
    sensors::LaserScan scan;
    scan.firstAngle = number(fields, 2, expected);
    scan.angleStep = number(fields, 4, expected);
    scan.maxRange = number(fields, 5, expected);
    const std::size_t count = readingCount(fields, 8);
    const std::size_t remissions = readingCount(fields, 9 + count);
    const std::size_t after = 10 + count + remissions;
    const auto T_odom_laser = pose(fields, after, "`laser_x laser_y laser_theta` after the remissions");
    const auto T_odom_body = pose(fields, after + 3, "`x y theta` after the laser's pose");
    scan.T_body_sensor = geometry::toPose3(inverse(T_odom_body) * T_odom_laser);
    const auto time = stamp(fields, after + 11);
    const auto label = laser.heading == 0.0 ? "FLASER" : "RLASER";
    addScan(std::move(scan), fields, 9, count, time, label, T_odom_body);
  }

  /// The old messages do not say where their beams point. Like the importers of MRPT and with them the public rawlogs
  /// of such logs: from the right to the left end of 180 degrees. (Lasers of 0.5 degrees that drop their 361st beam end
  /// at 89.5 degrees instead; no log tells the two apart.)
  void setFan(sensors::LaserScan& scan, std::size_t count, const Laser& laser) const {
    const double fov = parameter(laser.fovKey, 180.0) * kRadiansPerDegree;
    scan.firstAngle = -fov / 2.0;
    scan.angleStep = count > 1 ? fov / static_cast<double>(count - 1) : 0.0;
  }

  void addScan(sensors::LaserScan scan, const Fields& fields, std::size_t first, std::size_t count, base::Time time,
               const std::string& label, const geometry::Pose2& odometry) {
    RangeCheck check(static_cast<float>(scan.maxRange));
    scan.ranges.reserve(count);
    for (std::size_t i = first; i < first + count; ++i) {
      const auto range = parseNumber<float>(fields[i]);
      if (!range) throw MalformedLine{"a range in metres as field " + std::to_string(i + 1)};
      scan.ranges.push_back(check(*range));
    }
    addOdometry(odometry, time, label);
    auto damage = check.damage();
    if (!damage.empty()) damage = place(file_.path(), lineNumber_) + ": " + damage;
    items_.push_back(sensors::Reading{time, label, std::move(scan), damage});
  }

  void addOdometry(const geometry::Pose2& odometry, base::Time time, const std::string& label) {
    items_.push_back(sensors::Reading{time, label, sensors::Odometry{geometry::toPose3(odometry)}});
  }

  double parameter(const std::string& key, double otherwise) const {
    const auto found = parameters_.find(key);
    return found == parameters_.end() || !std::isfinite(found->second) ? otherwise : found->second;
  }

  static constexpr std::size_t kShown = 60;
  static constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kDefaultMaxRange = 80.0;  // metres, SICK LMS
  static constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

  sensors::SourceInfo info_;
  InputFile file_;
  std::string line_;
  std::size_t lineNumber_ = 0;
  std::map<std::string, double> parameters_;
  std::deque<sensors::SourceItem> items_;
};

}  // namespace

bool isCarmenLog(std::string_view begin) {
  while (!begin.empty()) {
    const auto end = begin.find('\n');
    const auto line = begin.substr(0, end);
    if (line.starts_with("# CARMEN Logfile")) return true;
    const auto fields = splitFields(line);
    if (!isComment(line)) return std::ranges::count(kMessages, fields[0]) > 0;
    begin = end == std::string_view::npos ? std::string_view{} : begin.substr(end + 1);
  }
  return false;
}

std::unique_ptr<sensors::SensorSource> openCarmenLog(const std::filesystem::path& path) {
  return std::make_unique<CarmenSource>(path);
}

}  // namespace prodomos::io
