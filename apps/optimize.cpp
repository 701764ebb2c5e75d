// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/g2o_file.hpp"

#include "commands.hpp"
#include "overwriting.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <iostream>

namespace prodomos::apps {

namespace {

using localization::Graph;
using localization::OptimizationReport;

struct OptimizeOptions {
  std::string input;
  std::string output;
  std::string start = "tree";
  bool mayBeWrong = false;
  bool json = false;
};

struct Summary {
  OptimizationReport report;
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::size_t rejected = 0;
  int parts = 0;
};

template <typename Pose>
Summary refine(Graph<Pose>& graph, const OptimizeOptions& options, bool hasPoses) {
  for (auto& edge : graph.constraints) edge.isDoubtful = options.mayBeWrong && std::abs(edge.to - edge.from) != 1;
  if (options.start == "tree" || !hasPoses) placeBySpanningTree(graph);
  Summary summary{.report = optimize(graph), .vertices = graph.vertices.size(), .edges = graph.constraints.size()};
  summary.rejected = static_cast<std::size_t>(std::ranges::count(summary.report.weights, 0.0));
  summary.parts = componentCount(graph);
  return summary;
}

void print(const Summary& summary) {
  const auto& report = summary.report;
  std::cout << "  vertices    " << grouped(static_cast<std::int64_t>(summary.vertices));
  if (summary.parts > 1) std::cout << ", in " << summary.parts << " unconnected parts: each has a vertex that stays";
  std::cout << "\n  edges       " << grouped(static_cast<std::int64_t>(summary.edges));
  if (summary.rejected > 0) std::cout << ", " << summary.rejected << " left out as wrong";
  std::cout << "\n  chi2        " << fixed(report.chi2Before, 6) << " before, " << fixed(report.chi2After, 6)
            << " after\n"
            << "  iterations  " << report.iterations << (report.converged ? "" : ", not converged") << "\n"
            << "  seconds     " << fixed(report.seconds, 4) << '\n';
}

nlohmann::json toJson(const Summary& summary) {
  const auto& report = summary.report;
  return {{"vertices", summary.vertices},
          {"edges", summary.edges},
          {"rejected", summary.rejected},
          {"parts", summary.parts},
          {"chi2", {{"before", report.chi2Before}, {"after", report.chi2After}}},
          {"iterations", report.iterations},
          {"converged", report.converged},
          {"seconds", report.seconds}};
}

void run(const OptimizeOptions& options) {
  requireOtherFile("-o", options.output, options.input, "the graph itself");
  auto file = localization::readG2o(options.input);
  const auto summary = std::visit([&](auto& graph) { return refine(graph, options, file.hasPoses); }, file.graph);
  localization::writeG2o(file, options.output);
  if (options.json) {
    std::cout << toJson(summary).dump(2) << '\n';
  } else {
    print(summary);
  }
}

}  // namespace

void addOptimize(CLI::App& program) {
  auto* command = program.add_subcommand("optimize", "refine the poses of a g2o file");
  command->footer(
      "Examples:\n"
      "  prodomos optimize sphere2500.g2o -o refined.g2o\n"
      "  prodomos optimize loops.g2o -o refined.g2o --robust --json | jq .chi2.after");
  auto options = std::make_shared<OptimizeOptions>();
  command->add_option("GRAPH", options->input, "a pose graph (docs/optimize.md)")->required();
  command->add_option("-o,--output", options->output, "the same graph with refined poses")->required();
  command->add_option("--start", options->start, "from a spanning tree of the measurements, or from the file's poses")
      ->check(CLI::IsMember({"tree", "file"}))
      ->capture_default_str();
  command->add_flag("--robust", options->mayBeWrong,
                    "leave out edges that contradict the rest; those from n to n + 1 are trusted");
  command->add_flag("--json", options->json, "as JSON (docs/optimize.md)");
  command->callback([options] { run(*options); });
}

}  // namespace prodomos::apps
