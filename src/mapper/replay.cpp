// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/replay.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <sstream>

namespace prodomos::mapper {

namespace {

std::optional<base::Time> parseStamp(const std::string& key, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto time = base::parseSeconds(text);
  if (!time) throw base::UsageError(base::expectedFound(key, "a time stamp in decimal seconds", "'" + text + "'"));
  return time;
}

/// Reads again what a checkpoint could only name by its place in the log.
void goBackTo(const ResumePoint& point, sensors::SensorSource& source, Mapper& mapper) {
  const std::int64_t first = point.waiting.empty() ? point.next : point.waiting.front();
  source.skip(static_cast<std::size_t>(first));
  std::vector<std::pair<std::int64_t, sensors::Reading>> waiting;
  for (std::int64_t item = first; item < point.next; ++item) {
    auto again = source.next();
    auto* reading = std::get_if<sensors::Reading>(&again);
    if (std::ranges::binary_search(point.waiting, item)) {
      if (reading == nullptr)
        throw base::FileError(source.info().path + ": is not the log that the map was begun with");
      waiting.emplace_back(item, std::move(*reading));
    }
  }
  if (!waiting.empty()) mapper.restore(std::move(waiting));
}

}  // namespace

std::unique_ptr<sensors::SensorSource> selectInput(std::unique_ptr<sensors::SensorSource> source,
                                                   const InputConfig& config) {
  sensors::SourceSelection selection;
  std::istringstream labels(config.sensors);
  for (std::string label; std::getline(labels, label, ',');) selection.sensors.push_back(label);
  selection.start = parseStamp("input.start", config.start);
  selection.end = parseStamp("input.end", config.end);
  return sensors::select(std::move(source), std::move(selection));
}

void replay(sensors::SensorSource& source, Mapper& mapper, const base::ProgressListener& listener) {
  goBackTo(mapper.resumePoint(), source, mapper);
  for (;;) {
    auto item = [&] {
      const auto timing = mapper.times().measure("read");
      return source.next();
    }();
    if (auto* reading = std::get_if<sensors::Reading>(&item)) {
      mapper.process(std::move(*reading));
    } else if (const auto* skipped = std::get_if<sensors::Skipped>(&item)) {
      mapper.skip(*skipped);
    } else {
      mapper.finish(std::get<sensors::EndOfLog>(item));
      return;
    }
    if (listener) listener(source.progress());
  }
}

}  // namespace prodomos::mapper
