// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/io/open_source.hpp"
#include "prodomos/perception/rgbd_view.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <variant>

namespace prodomos::test {

/// Metres above the origin of the world, of the storey nearest to that height; 0 in a world of none.
inline double floorBelow(const evaluation::Truth& truth, double z) {
  if (truth.storeys.empty()) return 0.0;
  return truth.storeys[static_cast<std::size_t>(storeyAt(truth, z))].floor_z;
}

/// Every `every`-th camera image of a simulated log whose true pose is known, seen from there: the sub-map is the
/// world.
inline void forEachTrueView(const std::string& log, const evaluation::Truth& truth, int every,
                            const std::function<void(const perception::RgbdView&, int frame)>& look) {
  const auto source = io::openSource(log);
  int frame = -1;
  for (auto item = source->next(); !std::holds_alternative<sensors::EndOfLog>(item); item = source->next()) {
    const auto* reading = std::get_if<sensors::Reading>(&item);
    const auto* image = reading == nullptr ? nullptr : std::get_if<sensors::RgbdFrame>(&reading->data);
    if (image == nullptr || ++frame % every != 0) continue;
    const auto* body = evaluation::findNearest(truth.trajectory, reading->time, std::chrono::milliseconds(20));
    if (body == nullptr) continue;
    look({.time = reading->time,
          .frame = *image,
          .T_submap_camera = body->pose * image->T_body_camera,
          .floor_z = floorBelow(truth, body->pose.translation().z())},
         frame);
  }
}

}  // namespace prodomos::test
