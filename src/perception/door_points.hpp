// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/door_candidates.hpp"
#include "perception/door_handle.hpp"
#include "perception/rectified_wall.hpp"

#include <opencv2/core.hpp>

#include <vector>

/// 002 §II-D to the letter: doors of salient points alone.
namespace prodomos::perception {

/// Corners in a wall's image (Shi and Tomasi 1994), pixels.
std::vector<cv::Point2f> salientPoints(const RectifiedWall& wall);

/// The two groups of 002 §II-D: candidates for corners at a door's bottom and at its top.
struct PointGroups {
  std::vector<cv::Point2f> bottom;
  std::vector<cv::Point2f> top;
};
PointGroups groupsOf(const RectifiedWall& wall, const std::vector<cv::Point2f>& points);

/// Pairs of vertically aligned points of the two groups, two of them at a door's width from each other. Of doors that
/// overlap, the one whose width is most usual.
std::vector<DoorCandidate> pairPoints(const RectifiedWall& wall, const PointGroups& groups);

/// The side's strength is the number of points there.
Handle countPoints(const RectifiedWall& wall, const DoorCandidate& candidate, const std::vector<cv::Point2f>& points);

}  // namespace prodomos::perception
