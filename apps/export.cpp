// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/exporter/exporter.hpp"

#include "commands.hpp"
#include "overwriting.hpp"

#include <filesystem>
#include <iostream>

namespace prodomos::apps {

namespace {

struct ExportOptions {
  std::string map;
  std::string format;
  std::string output;
  bool social = false;
};

void exportMap(const ExportOptions& options) {
  const auto* exporter = exporter::findExporter(options.format);
  if (exporter == nullptr) {
    std::string known;
    for (const auto& each : exporter::exporters()) known += (known.empty() ? "" : ", ") + std::string(each.format);
    throw base::UsageError(base::expectedFound("FORMAT", "one of " + known, "'" + options.format + "'"));
  }
  if (options.social && exporter->writeSocial == nullptr) {
    throw base::UsageError("--social: people's space is no part of " + options.format + ", of nav2 it is");
  }
  const auto view = map::MapView::open(options.map);
  std::filesystem::path output = options.output;
  if (output.empty()) output = std::filesystem::path(options.map).replace_extension(exporter->extension);
  requireOtherFile("-o", output, options.map, "the map itself");
  exporter->write(view, output);
  if (options.social) exporter->writeSocial(view, output);
  std::cout << output.string() << '\n';
}

}  // namespace

void addExport(CLI::App& program) {
  auto* command = program.add_subcommand("export", "write a map in another format");
  std::string formats = "Formats:\n";
  for (const auto& exporter : exporter::exporters()) {
    formats += "  " + std::string(exporter.format) + std::string(14 - exporter.format.size(), ' ') +
               std::string(exporter.text) + "\n";
  }
  command->footer(formats +
                  "Examples:\n"
                  "  prodomos export office.prodomos html\n"
                  "  prodomos export office.prodomos nav2 -o maps/office.yaml");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("MAP", options->map, "the map file")->required();
  command->add_option("FORMAT", options->format, "what to write")->required();
  command->add_option("-o,--output", options->output, "where to; beside the map if not given");
  command->add_flag("--social", options->social, "nav2: people's space too, as a cost of its own");
  command->callback([options] { exportMap(*options); });
}

}  // namespace prodomos::apps
