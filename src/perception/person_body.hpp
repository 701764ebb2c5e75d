// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/people_networks.hpp"
#include "perception/upright_view.hpp"

#include <optional>
#include <vector>

namespace prodomos::perception {

/// A person in an upright picture.
struct PicturedPerson {
  PersonBox box;
  std::optional<ImageJoints> joints;
  bool knowsSides = false;        ///< right and left of the joints can be believed
  const cv::Mat* mask = nullptr;  ///< non-zero where the person is, as large as the picture; null: not known
};

struct BodySample {
  cv::Point pixel;
  Eigen::Vector3d point_in_submap;
};

/// What depth shows of a body, and how it lies before the camera: `away` from it and `left` as the camera sees it, both
/// level.
struct Body {
  std::vector<BodySample> samples;
  std::vector<BodySample> torso;
  double top_z = 0.0;                                ///< of what is seen, in the sub-map
  bool topIsSeen = false;                            ///< not cut by the picture's edge
  bool footIsInPicture = false;                      ///< likewise, if nothing were before it
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of the torso's surface, in the sub-map
  Eigen::Vector2d away = Eigen::Vector2d::UnitX();
  Eigen::Vector2d left = Eigen::Vector2d::UnitY();
};

/// None where depth shows no body there.
std::optional<Body> bodyOf(const UprightView& view, const PicturedPerson& person, double floor_z);
/// The depth about which most of the chest lies: neither a hole nor what stands before it or behind it.
std::optional<double> torsoDepth(const UprightView& view, const PicturedPerson& person);
/// Of the torso across the view, metres, but for a little at both sides.
double widthOf(const Body& body);
/// A head at a human's height, as wide as humans are.
bool isOfHumanSize(const Body& body, double floor_z);
/// Whether the torso is a piece of a plane that goes on beside it: a poster, a screen.
bool isFlat(const UprightView& view, const PicturedPerson& person, const Body& body);

}  // namespace prodomos::perception
