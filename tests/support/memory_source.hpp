// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::test {

/// What a MemorySource throws where it is told to break: a process that is killed, as far as one process can tell.
struct Kill {};

/// A log that stands in memory.
class MemorySource final : public sensors::SensorSource {
 public:
  explicit MemorySource(std::vector<sensors::SourceItem> items, std::string fault = {}) : items_(std::move(items)) {
    info_.path = "memory.log";
    info_.kind = "readings in memory";
    end_.fault = std::move(fault);
  }
  explicit MemorySource(const std::vector<sensors::Reading>& readings)
      : MemorySource(std::vector<sensors::SourceItem>(readings.begin(), readings.end())) {}

  /// Throws Kill instead of handing out this item.
  MemorySource& breakAt(std::size_t item) {
    breakAt_ = item;
    return *this;
  }
  sensors::SourceInfo& info() { return info_; }

  const sensors::SourceInfo& info() const override { return info_; }
  base::Progress progress() const override { return {static_cast<double>(next_), static_cast<double>(items_.size())}; }
  sensors::SourceItem next() override {
    if (next_ == breakAt_) throw Kill();
    if (next_ == items_.size()) return end_;
    return items_[next_++];
  }

 private:
  std::vector<sensors::SourceItem> items_;
  sensors::EndOfLog end_;
  sensors::SourceInfo info_;
  std::size_t next_ = 0;
  std::size_t breakAt_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace prodomos::test
