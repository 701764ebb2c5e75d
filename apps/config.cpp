// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/config.hpp"

#include "prodomos/mapper/config.hpp"
#include "prodomos/simulation/simulator.hpp"

#include "commands.hpp"

#include <iostream>

namespace prodomos::apps {

void addConfig(CLI::App& program) {
  auto* command = program.add_subcommand("config", "print the default configuration");
  command->footer(
      "Examples:\n"
      "  prodomos config > mine.yaml                 a file to change and give to replay --config\n"
      "  prodomos config --describe                  the same with unit, bounds and meaning of every key\n"
      "  prodomos config --of simulate --describe    of the simulator");
  auto describe = std::make_shared<bool>(false);
  command->add_flag("--describe", *describe, "with unit, bounds and meaning of every key");
  auto of = std::make_shared<std::string>("replay");
  command->add_option("--of", *of, "the command that is configured")
      ->check(CLI::IsMember({"replay", "simulate"}))
      ->capture_default_str();
  command->callback([describe, of] {
    std::cout << (*of == "replay" ? base::writeConfig(mapper::MapperConfig{}, *describe)
                                  : base::writeConfig(simulation::SimulationConfig{}, *describe));
  });
}

}  // namespace prodomos::apps
