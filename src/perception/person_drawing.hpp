// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/debug_images.hpp"

#include "perception/person_location.hpp"

namespace prodomos::perception {

/// The picture "people" of one frame: boxes with scores, green where a person is believed and red where depth speaks
/// against one, joints, and an arrow where the torso looks.
class PeopleDrawing {
 public:
  /// Nothing is drawn where `debug` is null or does not want the frame.
  PeopleDrawing(const UprightView& view, DebugImages* debug);

  void add(const PicturedPerson& person, const std::optional<PersonSighting>& sighting);
  void finish();

 private:
  void drawSkeleton(const ImageJoints& joints, const std::optional<PersonSighting>& sighting);
  void drawHeading(const PersonSighting& sighting);

  const UprightView& view_;
  DebugImages* debug_;
  cv::Mat picture_;
};

}  // namespace prodomos::perception
