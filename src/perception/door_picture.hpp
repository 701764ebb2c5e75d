// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_candidates.hpp"
#include "perception/door_points.hpp"
#include "perception/rectified_wall.hpp"

#include <string>
#include <vector>

namespace prodomos::perception {

/// A pair of lines and what was made of it.
struct Judged {
  DoorCandidate candidate;
  double evidence = 0.0;
  bool accepted = false;
  std::string word;  ///< why not
};

/// How the detector came to its verdict on a wall: its rectified image with salient points, the groups near the floor
/// and near door height, upright lines, pairs and verdicts.
sensors::Image<sensors::Rgb> drawVerdict(const RectifiedWall& wall, const std::vector<cv::Point2f>& points,
                                         const std::vector<UprightLine>& lines, const std::vector<Judged>& pairs);

}  // namespace prodomos::perception
