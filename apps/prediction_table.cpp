// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction_table.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <numbers>

namespace prodomos::apps {

namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

std::string shown(std::optional<double> value, int decimals = 2) {
  return value ? fixed(*value, decimals) : "-";
}

/// Flush right, by what one sees: bytes that continue a character take no room.
std::string padded(const std::string& text, std::size_t width) {
  const auto seen = static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  return std::string(width > seen ? width - seen : 0, ' ') + text;
}

void printRow(const std::string& name, const std::vector<std::string>& columns) {
  std::cout << "  " << std::left << std::setw(13) << name << std::right;
  for (const auto& column : columns) std::cout << padded(column, 11);
  std::cout << '\n';
}

std::string median(const std::vector<double>& errors, int decimals, const std::string& unit, double scale = 1.0) {
  if (errors.empty()) return "-";
  return fixed(evaluation::statisticsOf(errors).median * scale, decimals) + unit;
}

void printDetections(const std::string& name, const evaluation::DetectionCounts& counts) {
  printRow(name, {std::to_string(counts.all.found) + "/" + std::to_string(counts.all.truth), shown(counts.all.recall()),
                  shown(counts.visible.recall()), shown(counts.passed.recall()),
                  shown(counts.images ? counts.images->recall() : std::nullopt), shown(counts.precision())});
}

void printDetections(const evaluation::PredictionScore& score) {
  printRow("detections", {"found", "recall", "of visible", "of passed", "of images", "precision"});
  printDetections("doors", score.doors.counts);
  printDetections("doorways", score.doorways.counts);
  printDetections("stairs", score.stairs.counts);
  const auto& doors = score.doors;
  const auto& stairs = score.stairs;
  std::cout << "  medians of doors: centre " << median(doors.centre, 3, " m") << ", normal "
            << median(doors.normal, 1, "°", kDegreesPerRadian) << ", width " << median(doors.width, 3, " m")
            << ", height " << median(doors.height, 3, " m") << "; hinge side right " << shown(doors.hingeSides.recall())
            << ", state right " << shown(doors.states.recall()) << '\n'
            << "  medians of stairs: foot " << median(stairs.foot, 3, " m") << ", direction "
            << median(stairs.direction, 1, "°", kDegreesPerRadian) << ", width " << median(stairs.width, 3, " m")
            << ", height of the new floor " << median(stairs.height, 3, " m") << '\n';
}

void printNodes(const evaluation::NodeScore& score) {
  std::cout << "  predicted rooms: precision " << shown(score.precision()) << " of " << score.right + score.wrong
            << ", recall " << shown(score.behindVisible.recall()) << " of " << score.behindVisible.truth
            << " unseen ones behind something visible, " << shown(score.adjacent.recall()) << " of "
            << score.adjacent.truth << " next to seen ones\n";
}

void printFreeSpace(const evaluation::FreeSpaceScore& score) {
  printRow("free floor", {"static", "quasi-st.", "dynamic", "overall", "furnished", "half-disc", "gained", "a door"});
  for (std::size_t i = 0; i < score.levels.size(); ++i) {
    const auto& level = score.levels[i];
    const auto gain = score.areaGainPercent(i);
    const auto perDoor = level.areaPerDoor();
    printRow("p > " + fixed(evaluation::kThresholds[i], 1),
             {shown(level.byMobility[0].precision(), 3), shown(level.byMobility[1].precision(), 3),
              shown(level.byMobility[2].precision(), 3), shown(level.overall().precision(), 3),
              shown(level.overall().furnishedPrecision(), 3), shown(level.halfDiscPrecision(), 3),
              gain ? fixed(*gain, 1) + " %" : "-", perDoor ? fixed(*perDoor, 1) + " m²" : "-"});
  }
}

void printRooms(const evaluation::RoomScore& score) {
  std::cout << "  IoU of rooms behind closed doors: " << shown(score.all(), 3) << " of " << score.shapes.size()
            << ", up to 60 m² " << shown(score.ordinary(), 3) << " of " << score.ordinaryCount() << '\n'
            << "    there: half-disc of equal area " << shown(score.halfDiscEqualArea(), 3) << ", best half-disc "
            << shown(score.halfDiscBest(), 3) << ", fixed box " << shown(score.fixedBox(), 3) << ", clipped box "
            << shown(score.clippedBox(), 3) << ", oracle's box " << shown(score.oracleBox(), 3) << '\n';
}

void printCalibration(const std::vector<evaluation::Bet>& bets) {
  const auto calibration = evaluation::calibrationOf(bets);
  if (!calibration) {
    std::cout << "  probabilities: none\n";
    return;
  }
  std::cout << "  probabilities: Brier " << fixed(calibration->brier, 3) << ", skill " << shown(calibration->brierSkill)
            << " over the base rate of " << fixed(calibration->baseRate, 2) << ", ECE "
            << fixed(calibration->expectedError, 3) << ", of " << calibration->count << " predictions\n";
}

}  // namespace

const ScoredMap* findWorst(const std::vector<ScoredMap>& maps, const evaluation::Measure& measure) {
  const ScoredMap* worst = nullptr;
  for (const auto& map : maps) {
    const auto value = measure.value(map.score);
    if (value && (worst == nullptr || *value < *measure.value(worst->score))) worst = &map;
  }
  return worst;
}

void printTable(const std::string& title, const evaluation::PredictionScore& pooled,
                const std::vector<ScoredMap>& maps) {
  std::cout << title << '\n';
  printDetections(pooled);
  printNodes(pooled.nodes);
  printFreeSpace(pooled.freeSpace);
  printRooms(pooled.rooms);
  printCalibration(pooled.bets);
  if (maps.size() < 2) return;
  std::cout << "  worst buildings\n";
  for (const auto& measure : evaluation::comparedMeasures()) {
    const auto* worst = findWorst(maps, measure);
    if (worst == nullptr) continue;
    std::cout << "    " << std::left << std::setw(24) << measure.name << std::right
              << fixed(*measure.value(worst->score), 3) << "  " << worst->building << " (" << worst->map << ")\n";
  }
}

}  // namespace prodomos::apps
