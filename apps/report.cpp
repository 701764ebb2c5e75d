// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/prediction/predictor.hpp"

#include "commands.hpp"

#include <map>

namespace prodomos::apps {

namespace {

const std::map<std::string, map::Finding> kFindings = {{"refuted", map::Finding::kRefuted},
                                                       {"blocked", map::Finding::kBlocked}};

struct ReportOptions {
  std::string map;
  std::string prediction;
  map::Finding finding = map::Finding::kRefuted;
};

void report(const ReportOptions& options) {
  const auto id = base::parseId<base::PredictionId>(options.prediction);
  if (!id) {
    throw base::UsageError(base::expectedFound("prediction", "an id such as p3", "'" + options.prediction + "'"));
  }
  auto store = map::MapStore::openForWriting(options.map);
  const auto view = store.view();
  if (view.sessions().empty()) throw base::Error("the map holds no session");
  const auto& session = view.sessions().back();
  prediction::Predictor predictor({}, view);
  predictor.tell(*id, options.finding, session.id, session.end);
  map::MapChange change;
  predictor.addTo(change);
  store.commit(change);
  store.close();
}

}  // namespace

void addReport(CLI::App& program) {
  auto* command = program.add_subcommand("report", "tell a map what was found where a room was predicted");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("MAP", options->map, "the map file; no mapper may be writing it")->required();
  command->add_option("PREDICTION", options->prediction, "such as p3 (prodomos query MAP predicted-rooms --json)")
      ->required();
  command->add_option("FINDING", options->finding, "refuted: there is no room; blocked: the way there cannot be gone")
      ->required()
      ->transform(CLI::CheckedTransformer(kFindings));
  command->footer(
      "Examples:\n"
      "  prodomos report office.prodomos p3 refuted\n"
      "  prodomos report office.prodomos p4 blocked");
  command->callback([options] { report(*options); });
}

}  // namespace prodomos::apps
