// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/calibration.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/map/map_view.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Scores as people look at them: tables and pictures on one page that needs no network, in light and in dark.
namespace prodomos::evaluation {

/// All plain text. The first cell of a row names it, the others are set as figures.
struct ScoreTable {
  std::string title;
  std::string text;  ///< below the title; may be empty
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// An entry of a legend: the class that marks are drawn with, and what they mean.
struct LegendEntry {
  std::string mark;
  std::string text;
  bool isLine = false;  ///< else an area
};

struct ScorePicture {
  std::string title;
  std::string svg;  ///< one <svg> element, its colours by the classes of the page
  std::vector<LegendEntry> legend;
};

struct ScorePage {
  std::string title;
  std::vector<std::string> lines;  ///< below the title
  std::vector<ScoreTable> tables;
  std::vector<ScorePicture> pictures;
};

/// Throws base::FileError where it cannot be written. Same page, same bytes.
void writeScorePage(const ScorePage& page, const std::filesystem::path& path);

/// One a storey that the robot was on: rooms, doors, stairs, things, ways and people as they are and as the map has
/// them, and the floor that it predicts at the least threshold. Throws base::Error where map and truth have no time in
/// common.
std::vector<ScorePicture> planPictures(const map::MapView& view, const Truth& truth);

/// How often what was said to be so likely came true.
ScorePicture reliabilityPicture(const Calibration& calibration);

/// "0.912"; "–" where there is none.
std::string figure(const std::optional<double>& value, int decimals = 3);

}  // namespace prodomos::evaluation
