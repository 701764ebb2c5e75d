// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What stands in an XML floor plan, without its meaning for a building (docs/floor-plans.md). Metres, y upwards.
namespace prodomos::simulation {

struct DrawnSpace {
  std::string id;
  std::string label;
  Polygon outline;  ///< the middle of its walls, as drawn; empty where the file has fewer than three corners
};

/// Where one can pass from one space into another.
struct DrawnPortal {
  std::string id;                                      ///< of its line segment in the first space
  std::array<std::size_t, 2> spaces{};                 ///< indices
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< the mean of the two points that the two spaces give
  bool isOpen = false;                                 ///< drawn as a mere boundary ("IMPLICIT"), without a door
  std::optional<bool> isDouble;                        ///< none: the plan does not tell kinds of doors
};

struct PlanDrawing {
  std::string name;
  double metresPerPixel = 0.0;
  std::vector<DrawnSpace> spaces;
  std::vector<DrawnPortal> portals;
  std::vector<std::string> remarks;
};

/// Throws base::FileError naming file, element, expected and found.
PlanDrawing readDrawing(const std::filesystem::path& xml);

}  // namespace prodomos::simulation
