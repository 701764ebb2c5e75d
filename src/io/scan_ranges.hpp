// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <cmath>
#include <cstddef>
#include <string>

namespace prodomos::io {

/// Decides what a range of a log says, and counts the ones that are damaged: NaN or negative though said to be valid.
class RangeCheck {
 public:
  explicit RangeCheck(float maxRange) : maxRange_(maxRange) {}

  /// The range; kNoReturn where it is not less than the maximum, whether the log calls that valid or not (both are
  /// usual); kInvalid where the beam says nothing: damaged, declared invalid, or zero.
  float operator()(float range, bool valid = true) {
    const std::size_t beam = beams_++;
    if (range >= maxRange_) return sensors::LaserScan::kNoReturn;
    if (valid && range > 0.0F) return range;
    if (valid && range != 0.0F) {
      if (damaged_++ == 0) first_ = "beam " + std::to_string(beam) + " is " + (std::isnan(range) ? "NaN" : "negative");
    }
    return sensors::LaserScan::kInvalid;
  }

  /// "expected …, found …", or empty.
  std::string damage() const {
    if (damaged_ == 0) return "";
    return "expected ranges of zero or more, found " + std::to_string(damaged_) + " other of " +
           std::to_string(beams_) + " (" + first_ + ")";
  }

 private:
  float maxRange_;
  std::size_t beams_ = 0;
  std::size_t damaged_ = 0;
  std::string first_;
};

}  // namespace prodomos::io
