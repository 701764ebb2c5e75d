// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/calibration.hpp"
#include "prodomos/evaluation/room_shapes.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

/// What reports on predictions have in common, whatever they are compared with (docs/evaluation.md).
namespace prodomos::apps {

nlohmann::ordered_json shapesToJson(const evaluation::RoomShapes& shapes);
nlohmann::ordered_json calibrationToJson(const std::vector<evaluation::Bet>& bets);

}  // namespace prodomos::apps
