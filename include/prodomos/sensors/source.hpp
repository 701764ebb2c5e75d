// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/progress.hpp"
#include "prodomos/sensors/reading.hpp"

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace prodomos::sensors {

/// A reading that was there but is not handed on.
struct Skipped {
  std::string
      reason;  ///< short, groups the report: "unsupported CObservationGPS", "sensor not chosen", "unreadable image"
  std::string fault;  ///< where the log is damaged: one line with file, place, expected, found; else empty
  base::Time time{};
};

/// After the last reading.
struct EndOfLog {
  std::string fault;  ///< where the log is cut or damaged: one line with file and place; else empty
};

using SourceItem = std::variant<Reading, Skipped, EndOfLog>;

/// What is known of a log before its first reading.
struct SourceInfo {
  std::string path;
  std::string kind;                  ///< "MRPT rawlog", "TUM RGB-D folder", "RGB-D folder", "CARMEN log"
  bool hasRecordedPoses = false;     ///< poses worth following come with the log
  std::vector<std::string> remarks;  ///< what a user should know: assumed intrinsics, assumed frame rate
  ClassTable classes;
};

/// A stream of readings in the order of the log. Memory does not grow with its length. The same log gives the same
/// items each time, so that an item's running number is a place in the log.
class SensorSource {
 public:
  virtual ~SensorSource() = default;

  virtual const SourceInfo& info() const = 0;
  /// The next item; EndOfLog again and again once the end is reached. Damage within the log is told in the items.
  virtual SourceItem next() = 0;
  /// Passes over items without decoding them where that is possible. Default: calls next().
  virtual void skip(std::size_t count);
  /// Of the log, in any unit.
  virtual base::Progress progress() const = 0;
};

/// What of a log is wanted.
struct SourceSelection {
  std::vector<std::string> sensors;  ///< labels; empty: all. Odometry and recorded poses are always wanted
  std::optional<base::Time> start;   ///< inclusive
  std::optional<base::Time> end;     ///< inclusive
};

/// Turns readings that are not wanted into Skipped ("sensor not chosen", "before start", "after end").
std::unique_ptr<SensorSource> select(std::unique_ptr<SensorSource> source, SourceSelection selection);

/// Where readings are written to.
class SensorSink {
 public:
  virtual ~SensorSink() = default;

  virtual void write(const Reading& reading) = 0;
  /// Completes the file; throws FileError where that fails. A sink that goes without close() leaves a cut file.
  virtual void close() = 0;
};

}  // namespace prodomos::sensors
