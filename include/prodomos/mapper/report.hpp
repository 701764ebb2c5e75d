// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace prodomos::mapper {

/// What became of the readings: used + skipped by reason = read.
struct Report {
  std::int64_t read = 0;
  std::int64_t used = 0;
  std::map<std::string, std::int64_t> usedByKind;
  std::map<std::string, std::int64_t> skippedByReason;
  std::vector<std::string> faults;  ///< the first few damages of the log, one line each
  std::int64_t faultCount = 0;
  int submaps = 0;
  double distance = 0.0;                            ///< metres
  std::int64_t lost = 0;                            ///< readings used whose own pose could not be estimated
  std::map<std::string, std::int64_t> notLookedAt;  ///< what detectors could not look at, by reason
  std::map<std::string, std::int64_t> refused;      ///< entities that nothing is predicted from, by reason

  static constexpr std::size_t kMostFaults = 5;
  void addFault(const std::string& fault);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);
};

}  // namespace prodomos::mapper
