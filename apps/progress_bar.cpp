// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "progress_bar.hpp"

#include "text.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <utility>

namespace prodomos::apps {

namespace {
constexpr std::chrono::milliseconds kRedraw{200};
constexpr std::chrono::seconds kLine{10};
constexpr int kWidth = 30;
}  // namespace

ProgressBar::ProgressBar(std::string command, std::string items, bool quiet)
    : command_(std::move(command)), items_(std::move(items)), quiet_(quiet), isTerminal_(isatty(STDERR_FILENO) != 0) {
  next_ = begin_ + (isTerminal_ ? Clock::duration(kRedraw) : Clock::duration(kLine));
}

ProgressBar::~ProgressBar() {
  if (hasDrawn_) std::cerr << "\r\033[K" << std::flush;
}

void ProgressBar::show(const base::Progress& progress, std::int64_t count) {
  const auto now = Clock::now();
  if (quiet_ || now < next_) return;
  next_ = now + (isTerminal_ ? Clock::duration(kRedraw) : Clock::duration(kLine));

  const double seconds = std::chrono::duration<double>(now - begin_).count();
  const double share = progress.total > 0.0 ? std::clamp(progress.done / progress.total, 0.0, 1.0) : 0.0;
  std::string line = fixed(100.0 * share, 0) + " %  " + grouped(count) + " " + items_ + "  " +
                     grouped(static_cast<std::int64_t>(static_cast<double>(count) / seconds)) + "/s";
  if (share > 0.01) line += "  " + clockTime(seconds / share * (1.0 - share)) + " left";
  if (!isTerminal_) {
    std::cerr << command_ << ": " << line << '\n';
    return;
  }
  const int filled = static_cast<int>(share * kWidth);
  std::string bar;
  for (int i = 0; i < kWidth; ++i) bar += i < filled ? "█" : "░";
  std::cerr << "\r\033[K" << bar << " " << line << std::flush;
  hasDrawn_ = true;
}

}  // namespace prodomos::apps
