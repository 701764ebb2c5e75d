// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/progress.hpp"

#include <chrono>
#include <cstdint>

namespace prodomos::apps {

/// Shows how far a replay is, on stderr: a bar with rate and remaining time on a terminal, a line now and then in a
/// pipe.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const base::Progress& progress, std::int64_t readings);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool isTerminal_;
  bool hasDrawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace prodomos::apps
