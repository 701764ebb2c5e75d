// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/evaluation/humans.hpp"
#include "prodomos/evaluation/labels.hpp"
#include "prodomos/evaluation/noise.hpp"
#include "prodomos/evaluation/objects.hpp"
#include "prodomos/evaluation/planes.hpp"
#include "prodomos/map/map_view.hpp"

#include "evaluate_kinds.hpp"
#include "score_report.hpp"

#include <nlohmann/json.hpp>

#include <iostream>
#include <numbers>

namespace prodomos::apps {

namespace {

using Json = nlohmann::ordered_json;
using evaluation::Truth;
using map::MapView;

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

/// Null where the truth has nothing to be counted.
Json countIf(bool countable, std::size_t count) {
  return countable ? Json(count) : Json(nullptr);
}

/// Errors name the map and the truth.
template <typename Score>
Score scoreMap(const MapAndTruth& files, const Truth& truth, const EvaluateOptions& options,
               Score (*score)(const MapView&, const Truth&, const EvaluateOptions&)) {
  try {
    return score(MapView::open(files.map), truth, options);
  } catch (const base::FileError&) {
    throw;
  } catch (const base::Error& fault) {
    throw base::FileError(files.map + ", " + files.truth + ": " + fault.what());
  }
}

/// What every kind does: scores each map, adds up, reports.
template <typename Score>
void evaluateMaps(const std::string& kind, const EvaluateOptions& options,
                  Score (*score)(const MapView&, const Truth&, const EvaluateOptions&),
                  Json (*toJson)(const Score&, const EvaluateOptions&)) {
  const auto maps = mapsAndTruths(options);
  Score sum;
  Json buildings = Json::array();
  for (const auto& files : maps) {
    const auto truth = evaluation::readTruth(files.truth);
    const auto part = scoreMap(files, truth, options, score);
    sum += part;
    Json entry = {{"building", truth.building}, {"map", files.map}};
    entry.update(toJson(part, options));
    buildings.push_back(std::move(entry));
  }
  Json report = toJson(sum, options);
  report["buildings"] = std::move(buildings);

  const std::string title = kind + " of " + (maps.size() == 1 ? maps[0].map : std::to_string(maps.size()) + " maps");
  if (!options.html.empty()) writeReportPage(options.html, title, report, {}, maps);
  if (options.json) {
    std::cout << report.dump(2) << '\n';
  } else {
    printReport(title, report);
  }
}

// --- noise

evaluation::NoiseScore scoreNoiseOf(const MapView& view, const Truth& truth, const EvaluateOptions& /*options*/) {
  return evaluation::scoreNoise(view, truth);
}

Json noiseCounts(const std::optional<evaluation::NoiseCounts>& counts, const evaluation::NoiseScore& score) {
  if (!counts) return nullptr;
  const bool anything = score.hasPersons || score.hasMovedThings || score.hasTurnedLeaves;
  return {{"occupied", counts->occupied},
          {"noise", countIf(anything, counts->noise())},
          {"persons", countIf(score.hasPersons, counts->persons)},
          {"moved_things", countIf(score.hasMovedThings, counts->movedThings)},
          {"door_leaves", countIf(score.hasTurnedLeaves, counts->doorLeaves)},
          {"last_persons", countIf(score.hasPersons, counts->lastPersons)},
          {"others", counts->others}};
}

Json noiseToJson(const evaluation::NoiseScore& score, const EvaluateOptions& /*options*/) {
  const bool anything = score.hasPersons || score.hasMovedThings || score.hasTurnedLeaves;
  return {{"cells", noiseCounts(score.cells, score)},
          {"free_floor", countIf(score.cells.has_value(), score.freeFloor)},
          {"noise_share", anything ? measure(score.noiseShare()) : Json(nullptr)},
          {"walls", countIf(score.cells.has_value(), score.walls)},
          {"walls_kept", measure(score.wallsKeptShare())},
          {"points", noiseCounts(score.points, score)}};
}

void evaluateNoise(const EvaluateOptions& options) {
  evaluateMaps("noise", options, scoreNoiseOf, noiseToJson);
}

void addNoise(CLI::App& kind, EvaluateOptions& /*options*/) {
  kind.footer(
      "Cells and voxels that are occupied where in the end nothing stands, by what has left them (000, table I).\n"
      "Examples:\n"
      "  prodomos evaluate noise office.prodomos\n"
      "  prodomos evaluate noise office.prodomos --truth office.truth.json --json | jq .cells.persons");
}

// --- labels

/// A map without labels has no score, but is no error.
struct OptionalLabelScore {
  std::optional<evaluation::LabelScore> score;

  OptionalLabelScore& operator+=(const OptionalLabelScore& other) {
    if (other.score) (score ? *score : score.emplace()) += *other.score;
    return *this;
  }
};

OptionalLabelScore scoreLabelsOf(const MapView& view, const Truth& truth, const EvaluateOptions& /*options*/) {
  const auto voxels = evaluation::labelledVoxelsOf(view, truth);
  return {voxels ? std::optional(evaluation::scoreLabels(*voxels, truth)) : std::nullopt};
}

std::string nameOf(const sensors::ClassTable& classes, int id) {
  const auto entry = classes.find(id);
  return entry == classes.end() ? std::to_string(id) : entry->second;
}

Json labelsToJson(const OptionalLabelScore& optional, const EvaluateOptions& /*options*/) {
  if (!optional.score) {
    return {{"why", "the map has no layer that holds classes"},
            {"voxels", nullptr},
            {"unlabeled", nullptr},
            {"stray", nullptr},
            {"accuracy", nullptr},
            {"miou", nullptr},
            {"iou", nullptr},
            {"confusion", nullptr}};
  }
  const auto& score = *optional.score;
  Json iou = Json::object();
  for (const auto& [id, name] : score.classes) {
    if (id != evaluation::kUnlabeled) iou[name] = measure(score.iou(id));
  }
  Json confusion = Json::object();
  for (const auto& [pair, count] : score.confusion) {
    confusion[nameOf(score.classes, pair.first)][nameOf(score.classes, pair.second)] = count;
  }
  return {{"why", nullptr},
          {"voxels", score.compared()},
          {"unlabeled", score.unlabeled},
          {"stray", score.stray},
          {"accuracy", measure(score.accuracy())},
          {"miou", measure(score.meanIou())},
          {"iou", iou},
          {"confusion", confusion}};
}

void evaluateLabels(const EvaluateOptions& options) {
  evaluateMaps("labels", options, scoreLabelsOf, labelsToJson);
}

void addLabels(CLI::App& kind, EvaluateOptions& /*options*/) {
  kind.footer(
      "Classes of voxels against the true surfaces: accuracy, mIoU, confusion.\n"
      "Examples:\n"
      "  prodomos evaluate labels office.prodomos\n"
      "  prodomos evaluate labels office.prodomos --truth office.truth.json --json | jq .miou");
}

// --- planes

evaluation::PlaneScore scorePlanesOf(const MapView& view, const Truth& truth, const EvaluateOptions& /*options*/) {
  return evaluation::scorePlanes(evaluation::planesOf(view, truth), truth);
}

Json planesToJson(const evaluation::PlaneScore& score, const EvaluateOptions& /*options*/) {
  const bool any = score.truth > 0;
  const auto countsToJson = [&](const evaluation::PlaneCounts& counts) {
    return Json{{"threshold", counts.threshold},
                {"correct", countIf(any, counts.correct)},
                {"over_segmented", countIf(any, counts.over)},
                {"under_segmented", countIf(any, counts.under)},
                {"missed", countIf(any, counts.missed)},
                {"noise", counts.noise}};
  };
  const double reported = evaluation::PlaneOptions{}.reported;
  const auto* counts = score.at(reported);
  Json report = {{"truth", score.truth}, {"mapped", score.mapped}};
  report.update(countsToJson(counts == nullptr ? evaluation::PlaneCounts{.threshold = reported} : *counts));
  report["correct_share"] = measure(evaluation::shareOf(counts == nullptr ? 0 : counts->correct, score.truth));
  report["angle_deg"] = errorsOf(score.angleErrors, kDegreesPerRadian);
  report["offset_m"] = errorsOf(score.offsetErrors);
  report["curve"] = Json::array();
  for (const auto& at : score.curve) report["curve"].push_back(countsToJson(at));
  return report;
}

void evaluatePlanes(const EvaluateOptions& options) {
  evaluateMaps("planes", options, scorePlanesOf, planesToJson);
}

void addPlanes(CLI::App& kind, EvaluateOptions& /*options*/) {
  kind.footer(
      "Plane patches against the true planes, as SegComp counts them (Hoover et al. 1996).\n"
      "Examples:\n"
      "  prodomos evaluate planes office.prodomos\n"
      "  prodomos evaluate planes office.prodomos --truth office.truth.json --json | jq .curve");
}

// --- objects

evaluation::ObjectScore scoreObjectsOf(const MapView& view, const Truth& truth, const EvaluateOptions& /*options*/) {
  return evaluation::scoreObjects(evaluation::objectsOf(view, truth), truth);
}

Json objectsToJson(const evaluation::ObjectScore& score, const EvaluateOptions& /*options*/) {
  Json byClass = Json::object();
  for (const auto& [name, counts] : score.byClass) {
    byClass[name.empty() ? "unknown" : name] = {{"truth", counts.truth},
                                                {"mapped", counts.mapped},
                                                {"found", counts.found},
                                                {"recall", measure(evaluation::shareOf(counts.found, counts.truth))}};
  }
  return {{"truth", score.all.truth},
          {"mapped", score.all.mapped},
          {"found", score.all.found},
          {"recall", measure(score.recall())},
          {"precision", measure(score.precision())},
          {"recall_50", measure(score.goodRecall())},
          {"precision_50", measure(score.goodPrecision())},
          {"class_accuracy", measure(score.classAccuracy())},
          {"centre_m", errorsOf(score.centreErrors)},
          {"iou", errorsOf(score.overlaps)},
          {"by_class", byClass}};
}

void evaluateObjects(const EvaluateOptions& options) {
  evaluateMaps("objects", options, scoreObjectsOf, objectsToJson);
}

void addObjects(CLI::App& kind, EvaluateOptions& /*options*/) {
  kind.footer(
      "Things as oriented boxes: found, false, how far off, how much of the boxes they share.\n"
      "Examples:\n"
      "  prodomos evaluate objects office.prodomos\n"
      "  prodomos evaluate objects office.prodomos --truth office.truth.json --json | jq .by_class.chair");
}

// --- humans

evaluation::HumanScore scoreHumansOf(const MapView& view, const Truth& truth, const EvaluateOptions& options) {
  return evaluation::scoreHumans(evaluation::peopleOf(view, truth), truth,
                                 {.leastPixels = options.leastPixels, .range = options.range});
}

Json humansToJson(const evaluation::HumanScore& score, const EvaluateOptions& options) {
  const bool any = score.seen > 0;
  return {{"frames", score.frames},
          {"seen", score.seen},
          {"matches", countIf(any, score.matches)},
          {"false_positives", score.falsePositives},
          {"false_negatives", countIf(any, score.falseNegatives())},
          {"identity_switches", countIf(any, score.identitySwitches)},
          {"recall", measure(score.recall())},
          {"precision", measure(score.precision())},
          {"mota", measure(score.mota())},
          {"motp_m", measure(score.motp())},
          {"position_m", errorsOf(score.positionErrors)},
          {"heading_deg", errorsOf(score.headingErrors, kDegreesPerRadian)},
          {"joint_m", errorsOf(score.jointErrors)},
          {"least_pixels", options.leastPixels},
          {"range_m", options.range}};
}

void evaluateHumans(const EvaluateOptions& options) {
  evaluateMaps("humans", options, scoreHumansOf, humansToJson);
}

void addHumans(CLI::App& kind, EvaluateOptions& options) {
  kind.footer(
      "Persons that were followed, frame by frame (CLEAR MOT, Bernardin and Stiefelhagen 2008).\n"
      "Examples:\n"
      "  prodomos evaluate humans office.prodomos\n"
      "  prodomos evaluate humans office.prodomos --truth office.truth.json --range 4 --json | jq .mota");
  kind.add_option("--least-pixels", options.leastPixels,
                  "pixels of a person that the camera must have seen; fewer, and it counts neither way (1000)")
      ->check(CLI::NonNegativeNumber);
  kind.add_option("--range", options.range, "metres from the robot; farther ones count neither way (5)")
      ->check(CLI::PositiveNumber);
}

}  // namespace

constexpr Kind kNoise = {"noise", "what moving things left behind, against the truth of a log", addNoise, evaluateNoise,
                         Against::kTruthOfLog};
constexpr Kind kLabels = {"labels", "classes of voxels against the truth of a log", addLabels, evaluateLabels,
                          Against::kTruthOfLog};
constexpr Kind kPlanes = {"planes", "plane patches against the truth of a log", addPlanes, evaluatePlanes,
                          Against::kTruthOfLog};
constexpr Kind kObjects = {"objects", "things as boxes against the truth of a log", addObjects, evaluateObjects,
                           Against::kTruthOfLog};
constexpr Kind kHumans = {"humans", "persons that were followed against the truth of a log", addHumans, evaluateHumans,
                          Against::kTruthOfLog};

}  // namespace prodomos::apps
