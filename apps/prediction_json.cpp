// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction_json.hpp"

#include "score_report.hpp"

#include <nlohmann/json.hpp>

namespace prodomos::apps {

using Json = nlohmann::ordered_json;

Json shapesToJson(const evaluation::RoomShapes& shapes) {
  return {{"all", measure(shapes.all())},
          {"up_to_60_m2", measure(shapes.ordinary())},
          {"half_disc_equal_area", measure(shapes.halfDiscEqualArea())},
          {"half_disc_best", measure(shapes.halfDiscBest())},
          {"fixed_box", measure(shapes.fixedBox())},
          {"clipped_box", measure(shapes.clippedBox())},
          {"oracle_box", measure(shapes.oracleBox())},
          {"rooms", shapes.shapes.size()},
          {"rooms_up_to_60_m2", shapes.ordinaryCount()}};
}

Json calibrationToJson(const std::vector<evaluation::Bet>& bets) {
  const auto calibration = evaluation::calibrationOf(bets);
  if (!calibration) return {{"ece", nullptr}, {"brier", nullptr}, {"brier_skill", nullptr}, {"bins", nullptr}};
  Json bins = Json::array();
  for (const auto& bin : calibration->bins) {
    const auto ifAny = [&bin](double value) { return bin.count == 0 ? Json(nullptr) : Json(value); };
    bins.push_back({{"from", bin.from},
                    {"to", bin.to},
                    {"count", bin.count},
                    {"mean_probability", ifAny(bin.meanProbability)},
                    {"frequency", ifAny(bin.frequency)}});
  }
  return {{"ece", calibration->expectedError},
          {"brier", calibration->brier},
          {"brier_skill", measure(calibration->brierSkill)},
          {"base_rate", calibration->baseRate},
          {"count", calibration->count},
          {"bins", bins}};
}

}  // namespace prodomos::apps
