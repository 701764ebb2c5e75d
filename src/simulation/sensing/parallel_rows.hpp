// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace prodomos::simulation {

/// Calls work(row) for each row, on `threads` threads (0: as many as the machine has). Who writes to its own row alone
/// gets the same result for any number of them.
template <typename Work>
void forRows(int rows, int threads, const Work& work) {
  const int wanted = threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int count = std::clamp(wanted, 1, std::max(1, rows));
  std::atomic<int> next{0};
  std::vector<std::exception_ptr> faults(static_cast<std::size_t>(count));
  const auto run = [&](std::exception_ptr& fault) {
    try {
      for (int row = next++; row < rows; row = next++) work(row);
    } catch (...) {
      fault = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < count; ++i) others.emplace_back([&, i] { run(faults[static_cast<std::size_t>(i)]); });
    run(faults[0]);
  }
  for (const auto& fault : faults) {
    if (fault) std::rethrow_exception(fault);
  }
}

}  // namespace prodomos::simulation
