// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace prodomos::base {

/// How far a long piece of work has come.
struct Progress {
  double done = 0.0;   ///< in `unit`s
  double total = 0.0;  ///< 0 where it is not known
};

/// Told now and then; called from the thread that works. May be empty.
using ProgressListener = std::function<void(const Progress&)>;

}  // namespace prodomos::base
