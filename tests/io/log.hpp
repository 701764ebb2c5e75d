// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/error.hpp"
#include "prodomos/sensors/source.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace prodomos::io {

/// A whole log in memory.
struct Log {
  std::vector<sensors::Reading> readings;
  std::vector<sensors::Skipped> skipped;
  sensors::EndOfLog end;

  std::size_t items() const { return readings.size() + skipped.size(); }

  template <typename Data>
  std::vector<sensors::Reading> of() const {
    std::vector<sensors::Reading> found;
    for (const auto& reading : readings) {
      if (std::holds_alternative<Data>(reading.data)) found.push_back(reading);
    }
    return found;
  }
};

inline Log readAll(sensors::SensorSource& source) {
  Log log;
  for (;;) {
    auto item = source.next();
    if (auto* reading = std::get_if<sensors::Reading>(&item)) {
      log.readings.push_back(std::move(*reading));
    } else if (auto* skipped = std::get_if<sensors::Skipped>(&item)) {
      log.skipped.push_back(std::move(*skipped));
    } else {
      log.end = std::get<sensors::EndOfLog>(item);
      return log;
    }
  }
}

/// The message of the error of type `Fault` that `act` throws; a failure where it throws none.
template <typename Fault = base::FileError>
std::string errorOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const Fault& fault) {
    return fault.what();
  }
  ADD_FAILURE() << "expected an error, found none";
  return "";
}

template <typename Data>
const Data& as(const sensors::Reading& reading) {
  return std::get<Data>(reading.data);
}

}  // namespace prodomos::io
