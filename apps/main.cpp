// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "commands.hpp"

#include <csignal>
#include <iostream>

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

void printError(const std::string& lines) {
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) std::cerr << "prodomos: error: " << line << '\n';
}

int run(int argc, char** argv) {
  CLI::App program("maps what a robot has seen, and what must lie just beyond", "prodomos");
  program.set_version_flag("--version", "prodomos " PRODOMOS_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  program.footer("prodomos COMMAND --help has options and examples of each command.");
  for (const auto add :
       {prodomos::apps::addReplay, prodomos::apps::addInfo, prodomos::apps::addQuery, prodomos::apps::addReport,
        prodomos::apps::addExport, prodomos::apps::addView, prodomos::apps::addEvaluate, prodomos::apps::addOptimize,
        prodomos::apps::addSimulate, prodomos::apps::addConfig}) {
    add(program);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return program.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return program.exit(version);
  } catch (const CLI::ParseError& fault) {
    printError(std::string(fault.what()) + " (prodomos --help)");
    return kWrongUsage;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // A file size limit is a full disk like any other: an error of write(), not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const prodomos::base::UsageError& fault) {
    printError(fault.what());
    return kWrongUsage;
  } catch (const prodomos::base::Error& fault) {
    printError(fault.what());
  } catch (const std::bad_alloc&) {
    printError("out of memory");
  } catch (const std::exception& fault) {
    printError("unexpected: " + std::string(fault.what()));
  }
  return kFailed;
}
