// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/sensors/source.hpp"

#include <algorithm>

namespace prodomos::sensors {

void SensorSource::skip(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) next();
}

namespace {

class SelectedSource final : public SensorSource {
 public:
  SelectedSource(std::unique_ptr<SensorSource> source, SourceSelection selection)
      : source_(std::move(source)), selection_(std::move(selection)) {}

  const SourceInfo& info() const override { return source_->info(); }
  void skip(std::size_t count) override { source_->skip(count); }
  base::Progress progress() const override { return source_->progress(); }

  SourceItem next() override {
    auto item = source_->next();
    if (const auto* reading = std::get_if<Reading>(&item)) {
      if (const auto* reason = reasonToSkip(*reading)) return Skipped{reason, reading->fault, reading->time};
    }
    return item;
  }

 private:
  const char* reasonToSkip(const Reading& reading) const {
    if (selection_.start && reading.time < *selection_.start) return "before start";
    if (selection_.end && reading.time > *selection_.end) return "after end";
    const bool isPose =
        std::holds_alternative<Odometry>(reading.data) || std::holds_alternative<RecordedPose>(reading.data);
    if (!isPose && !selection_.sensors.empty() && std::ranges::count(selection_.sensors, reading.sensor) == 0) {
      return "sensor not chosen";
    }
    return nullptr;
  }

  std::unique_ptr<SensorSource> source_;
  SourceSelection selection_;
};

}  // namespace

std::unique_ptr<SensorSource> select(std::unique_ptr<SensorSource> source, SourceSelection selection) {
  return std::make_unique<SelectedSource>(std::move(source), std::move(selection));
}

}  // namespace prodomos::sensors
