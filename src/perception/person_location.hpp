// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/person_sighting.hpp"

#include "perception/person_body.hpp"

#include <optional>

namespace prodomos::perception {

/// As `box`, but down to where the feet would be, were nothing before them and did the person stand: networks find more
/// joints in it. None where depth is not known.
std::optional<cv::Rect2d> wholeBodyBox(const UprightView& view, const PersonBox& box);

/// Where that person stands, and which way it looks: position, heading, joints, clothes. None where depth tells of
/// none, of something flat as a picture on a wall, or of something that is no human's size.
std::optional<PersonSighting> locate(const UprightView& view, const PicturedPerson& person, double floor_z);

}  // namespace prodomos::perception
