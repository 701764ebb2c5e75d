// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/evaluation/prediction.hpp"
#include "prodomos/map/map_view.hpp"

#include "evaluate_kinds.hpp"
#include "prediction_json.hpp"
#include "prediction_table.hpp"
#include "score_report.hpp"

#include <nlohmann/json.hpp>

#include <iostream>
#include <numbers>

namespace prodomos::apps {

namespace {

using evaluation::PredictionScore;
using Json = nlohmann::ordered_json;

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

Json toJson(const evaluation::DetectionCounts& counts) {
  return {{"recall", measure(counts.all.recall())},
          {"recall_image", measure(counts.images ? counts.images->recall() : std::nullopt)},
          {"recall_visible", measure(counts.visible.recall())},
          {"recall_passed", measure(counts.passed.recall())},
          {"precision", measure(counts.precision())},
          {"truth", counts.all.truth},
          {"truth_visible", counts.visible.truth},
          {"truth_passed", counts.passed.truth},
          {"right", counts.right},
          {"wrong", counts.wrong}};
}

Json toJson(const evaluation::DoorScore& score) {
  Json out = toJson(score.counts);
  out["centre_m"] = errorsOf(score.centre);
  out["normal_deg"] = errorsOf(score.normal, kDegreesPerRadian);
  out["width_m"] = errorsOf(score.width);
  out["height_m"] = errorsOf(score.height);
  out["hinge_side_right"] = measure(score.hingeSides.recall());
  out["state_right"] = measure(score.states.recall());
  return out;
}

Json toJson(const evaluation::StairsScore& score) {
  Json out = toJson(score.counts);
  out["foot_m"] = errorsOf(score.foot);
  out["direction_deg"] = errorsOf(score.direction, kDegreesPerRadian);
  out["width_m"] = errorsOf(score.width);
  out["height_m"] = errorsOf(score.height);
  return out;
}

Json toJson(const evaluation::NodeScore& score) {
  return {{"precision", measure(score.precision())},
          {"recall", measure(score.behindVisible.recall())},
          {"recall_adjacent", measure(score.adjacent.recall())},
          {"right", score.right},
          {"wrong", score.wrong},
          {"unseen_rooms", score.behindVisible.truth},
          {"unseen_rooms_adjacent", score.adjacent.truth}};
}

Json toJson(const evaluation::FreeSpaceScore& score) {
  Json out = Json::object();
  for (std::size_t i = 0; i < score.levels.size(); ++i) {
    const auto& level = score.levels[i];
    Json at = Json::object();
    for (const auto mobility : {map::Mobility::kStatic, map::Mobility::kQuasiStatic, map::Mobility::kDynamic}) {
      const auto& counts = level.byMobility[static_cast<std::size_t>(mobility)];
      at[std::string(toString(mobility))] = measure(counts.precision());
    }
    at["overall"] = measure(level.overall().precision());
    at["overall_furnished"] = measure(level.overall().furnishedPrecision());
    at["half_disc_equal_area"] = measure(level.halfDiscPrecision());
    at["area_gain_percent"] = measure(score.areaGainPercent(i));
    at["area_per_door_m2"] = measure(level.areaPerDoor());
    out[fixed(evaluation::kThresholds[i], 1)] = at;
  }
  return out;
}

Json toJson(const evaluation::RoomScore& score) {
  Json out = shapesToJson(score);
  out["doors"] = score.doors.truth;
  out["doors_predicted"] = score.doors.found;
  return out;
}

Json toJson(const PredictionScore& score) {
  return {{"doors", toJson(score.doors)},
          {"doorways", toJson(score.doorways)},
          {"stairs", toJson(score.stairs)},
          {"nodes", toJson(score.nodes)},
          {"free_space", toJson(score.freeSpace)},
          {"room_iou", toJson(score.rooms)},
          {"calibration", calibrationToJson(score.bets)}};
}

/// By measure the building that has the least of it.
Json worstBuildings(const std::vector<ScoredMap>& maps) {
  Json worst = Json::object();
  for (const auto& compared : evaluation::comparedMeasures()) {
    const auto* map = findWorst(maps, compared);
    if (map == nullptr) continue;
    worst[compared.name] = {{"building", map->building}, {"map", map->map}, {"value", *compared.value(map->score)}};
  }
  return worst;
}

Json reportOf(const PredictionScore& pooled, const std::vector<ScoredMap>& maps) {
  Json report = toJson(pooled);
  report["worst"] = worstBuildings(maps);
  report["buildings"] = Json::array();
  for (const auto& map : maps) {
    Json building = {{"building", map.building}, {"map", map.map}};
    building.update(toJson(map.score));
    report["buildings"].push_back(std::move(building));
  }
  return report;
}

ScoredMap scoreMap(const MapAndTruth& pair) {
  const auto truth = evaluation::readTruth(pair.truth);
  try {
    return {pair.map, truth.building, evaluation::scorePrediction(map::MapView::open(pair.map), truth)};
  } catch (const base::FileError&) {
    throw;
  } catch (const base::Error& fault) {
    throw base::FileError(pair.map + ", " + pair.truth + ": " + fault.what());
  }
}

void evaluatePrediction(const EvaluateOptions& options) {
  const auto files = mapsAndTruths(options);
  std::vector<ScoredMap> maps;
  PredictionScore pooled;
  for (const auto& pair : files) {
    maps.push_back(scoreMap(pair));
    pooled += maps.back().score;
  }
  const std::string title = "prediction of " + (maps.size() == 1 ? maps[0].map : std::to_string(maps.size()) + " maps");
  const Json report = reportOf(pooled, maps);
  if (!options.html.empty()) {
    std::vector<evaluation::ScorePicture> pictures;
    if (const auto calibration = evaluation::calibrationOf(pooled.bets)) {
      pictures.push_back(evaluation::reliabilityPicture(*calibration));
    }
    writeReportPage(options.html, title, report, std::move(pictures), files);
  }
  if (options.json) {
    std::cout << report.dump(2) << '\n';
  } else {
    printTable(title, pooled, maps);
  }
}

void addPrediction(CLI::App& kind, EvaluateOptions& /*options*/) {
  kind.footer(
      "Doors, stairs, predicted rooms and predicted free floor, as paper 002 counts them and beyond "
      "(docs/evaluation.md).\n"
      "Examples:\n"
      "  prodomos evaluate prediction office.prodomos --truth office.truth.json\n"
      "  prodomos evaluate prediction test/*.prodomos --json | jq .room_iou");
}

}  // namespace

constexpr Kind kPrediction = {"prediction", "doors, stairs, predicted rooms and free floor against the truth of a log",
                              addPrediction, evaluatePrediction, Against::kTruthOfLog};

}  // namespace prodomos::apps
