// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/config.hpp"

#include "prodomos/mapper/config.hpp"

#include "commands.hpp"

#include <iostream>

namespace prodomos::apps {

void addConfig(CLI::App& program) {
  auto* command = program.add_subcommand("config", "print the default configuration");
  command->footer(
      "Examples:\n"
      "  prodomos config > mine.yaml                 a file to change and give to replay --config\n"
      "  prodomos config --describe                  the same with unit, bounds and meaning of every key");
  auto describe = std::make_shared<bool>(false);
  command->add_flag("--describe", *describe, "with unit, bounds and meaning of every key");
  command->callback([describe] { std::cout << base::writeConfig(mapper::MapperConfig{}, *describe); });
}

}  // namespace prodomos::apps
