// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

/// One file a command. Each adds itself to the program; its callback does the work and throws on failure:
/// base::UsageError ends the program with 2, anything else with 1.
namespace prodomos::apps {

void addReplay(CLI::App& program);
void addInfo(CLI::App& program);
void addQuery(CLI::App& program);
void addReport(CLI::App& program);
void addExport(CLI::App& program);
void addView(CLI::App& program);
void addEvaluate(CLI::App& program);
void addOptimize(CLI::App& program);
void addSimulate(CLI::App& program);
void addConfig(CLI::App& program);

}  // namespace prodomos::apps
