// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace prodomos::base {

/// Wall seconds by stage, summed: `const auto timing = times.measure("grid");` until the end of the scope.
class StageTimes {
 public:
  class Scope {
   public:
    Scope(StageTimes& times, const char* stage) : times_(times), stage_(stage) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope() { times_.seconds_[stage_] += std::chrono::duration<double>(Clock::now() - begin_).count(); }

   private:
    StageTimes& times_;
    const char* stage_;
    std::chrono::steady_clock::time_point begin_ = Clock::now();
  };

  [[nodiscard]] Scope measure(const char* stage) { return {*this, stage}; }
  const std::map<std::string, double, std::less<>>& seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::map<std::string, double, std::less<>> seconds_;
};

}  // namespace prodomos::base
