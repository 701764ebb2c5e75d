// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/upright_view.hpp"

#include <utility>
#include <vector>

namespace prodomos::perception {

/// A person in a label image, turned as the view: where it is not zero, and the box around.
struct PersonMask {
  cv::Mat mask;
  cv::Rect box;
};

/// By instance where the label image tells instances, else by connected region. None where no class is a person, or the
/// label image is of another size.
std::vector<PersonMask> personMasks(const UprightView& view, const sensors::LabelImage& labels,
                                    const sensors::ClassTable& classes);

}  // namespace prodomos::perception
