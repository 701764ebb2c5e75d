// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/stopwatch.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/mapper/config.hpp"
#include "prodomos/mapper/report.hpp"
#include "prodomos/sensors/source.hpp"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace prodomos::perception {
class DebugImages;
}

namespace prodomos::mapper {

/// Where an interrupted session goes on in its log; items count from 0.
struct ResumePoint {
  std::int64_t next = 0;              ///< the first item that was not taken yet
  std::vector<std::int64_t> waiting;  ///< items before it that were taken but not yet placed, ascending
};

/// Carries readings up through the tiers: where was the robot, what does it see, into which sub-map does it go. Fed by
/// replay() from a log or live by a program: the same readings give the same map.
///
///     auto store = map::MapStore::create("office.prodomos");
///     Mapper mapper(store, config, {.path = "live", .kind = "my robot"});
///     while (…) mapper.process(reading);
///     mapper.finish();
class Mapper {
 public:
  /// Begins a session in the store, or goes on with the one that is still running there (see resumePoint()). The store
  /// must outlive the mapper. Throws base::FileError where the trajectory file of the configuration cannot be read, or
  /// the running session is another version's; base::UsageError where it has another configuration.
  /// `debug`: takes pictures of how detectors came to their verdicts; may be null, else must outlive the mapper.
  Mapper(map::MapStore& store, const MapperConfig& config, const sensors::SourceInfo& log,
         perception::DebugImages* debug = nullptr);
  ~Mapper();
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  /// Readings come in the order of their log. Throws base::FileError where the map file cannot be written. After that,
  /// and after finish(), nothing more is taken: base::Error.
  void process(sensors::Reading reading);
  /// An item that is no reading: counted.
  void skip(const sensors::Skipped& skipped);
  /// Places what still waits, finishes the running sub-map and the session. A log that ended early is reported.
  void finish(const sensors::EndOfLog& end = {});

  /// What a planner found where it went for a predicted room; in the map with the next sub-map that ends. Throws
  /// base::Error where there is no open one of that id.
  void tell(base::PredictionId id, map::Finding finding);

  ResumePoint resumePoint() const;
  /// Hands in the waiting items of the resume point again, before anything else. What is not handed in is lost, and
  /// counted when the session finishes.
  void restore(std::vector<std::pair<std::int64_t, sensors::Reading>> waiting);

  /// What the map is now, the running sub-map included; for `query` and exporters in the mapper's own thread. Others
  /// open the file with map::MapView::open().
  map::MapView view() const;
  const Report& report() const;
  /// Has the session been found in what the map held before it? Poses are in one frame then.
  bool meetsEarlierSessions() const;
  /// Wall seconds by stage; what feeds the mapper may add its own.
  base::StageTimes& times();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prodomos::mapper
