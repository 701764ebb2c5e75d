// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/hindsight.hpp"
#include "prodomos/map/map_view.hpp"

#include "evaluate_kinds.hpp"
#include "prediction_json.hpp"
#include "score_report.hpp"
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <iostream>

namespace prodomos::apps {

namespace {

using evaluation::HindsightScore;
using map::PredictionState;
using Json = nlohmann::ordered_json;

Json betsToJson(const HindsightScore& score) {
  return {{"made", score.made()},
          {"open", score.count(PredictionState::kOpen)},
          {"confirmed", score.count(PredictionState::kConfirmed)},
          {"merged", score.count(PredictionState::kMerged)},
          {"refuted", score.count(PredictionState::kRefuted)},
          {"settled_share", measure(score.settledShare())},
          {"precision", measure(score.precision())}};
}

Json toJson(const evaluation::RoomRecall& recall) {
  return {{"entered", recall.entered.truth},
          {"entered_predicted", measure(recall.entered.recall())},
          {"opening_detected_before", recall.inTime.truth},
          {"opening_detected_before_predicted", measure(recall.inTime.recall())},
          {"looked_into", recall.lookedInto.truth},
          {"looked_into_predicted", measure(recall.lookedInto.recall())}};
}

Json toJson(const evaluation::HindsightLevel& level) {
  Json out = Json::object();
  for (const auto mobility : {map::Mobility::kStatic, map::Mobility::kQuasiStatic, map::Mobility::kDynamic}) {
    out[std::string(toString(mobility))] = measure(level.byMobility[static_cast<std::size_t>(mobility)].precision());
  }
  const auto overall = level.overall();
  out["overall"] = measure(overall.precision());
  out["half_disc_equal_area"] = measure(level.halfDiscPrecision());
  out["seen_share"] = measure(overall.seenShare());
  out["cells"] = overall.all();
  return out;
}

Json toJson(const HindsightScore& score) {
  Json freeSpace = Json::object();
  for (std::size_t i = 0; i < score.levels.size(); ++i) {
    freeSpace[fixed(evaluation::kThresholds[i], 1)] = toJson(score.levels[i]);
  }
  Json rooms = shapesToJson(score.rooms);
  rooms["rooms_not_seen"] = score.roomsNotSeen;
  return {{"bets", betsToJson(score)},
          {"rooms", toJson(score.recall)},
          {"free_space", std::move(freeSpace)},
          {"room_iou", std::move(rooms)},
          {"calibration", calibrationToJson(score.bets)}};
}

/// The log that the map was made of.
std::string nameOf(const map::MapView& view) {
  return view.sessions().empty() ? "" : std::filesystem::path(view.sessions().front().log).stem().string();
}

void evaluateHindsight(const EvaluateOptions& options) {
  HindsightScore pooled;
  Json buildings = Json::array();
  std::vector<evaluation::ScorePicture> pictures;
  for (const auto& map : options.maps) {
    const auto view = map::MapView::open(map);
    const auto score = evaluation::scoreHindsight(view);
    pooled += score;
    Json building = {{"building", nameOf(view)}, {"map", map}};
    building.update(toJson(score));
    buildings.push_back(std::move(building));
    if (options.html.empty()) continue;
    for (auto& picture : evaluation::hindsightPictures(view)) {
      picture.title = nameOf(view) + ", " + picture.title;
      pictures.push_back(std::move(picture));
    }
  }
  Json report = toJson(pooled);
  report["buildings"] = std::move(buildings);
  const auto& maps = options.maps;
  const std::string title = "hindsight on " + (maps.size() == 1 ? maps[0] : std::to_string(maps.size()) + " maps");
  if (!options.html.empty()) writeReportPage(options.html, title, report, std::move(pictures), maps);
  if (options.json) {
    std::cout << report.dump(2) << '\n';
  } else {
    printReport(title, report);
  }
}

void addHindsight(CLI::App& kind, EvaluateOptions& /*options*/) {
  kind.footer(
      "What the ledger told of rooms and floor that nobody had seen, by what the rest of the log has shown, on any "
      "log\n"
      "(docs/evaluation.md).\n"
      "Examples:\n"
      "  prodomos evaluate hindsight intel.prodomos\n"
      "  prodomos evaluate hindsight *.prodomos --json | jq .bets.settled_share");
}

}  // namespace

constexpr Kind kHindsight = {"hindsight", "predicted rooms and free floor against the rest of the log", addHindsight,
                             evaluateHindsight, Against::kItself};

}  // namespace prodomos::apps
