// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/progress.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace prodomos::apps {

/// Shows how far a long command is, on stderr: a bar with rate and remaining time on a terminal, a line now and then in
/// a pipe.
class ProgressBar {
 public:
  /// `items`: what is counted, "readings".
  ProgressBar(std::string command, std::string items, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const base::Progress& progress, std::int64_t count);

 private:
  using Clock = std::chrono::steady_clock;
  std::string command_;
  std::string items_;
  bool quiet_;
  bool isTerminal_;
  bool hasDrawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace prodomos::apps
