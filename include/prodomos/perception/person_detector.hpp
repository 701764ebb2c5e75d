// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/debug_images.hpp"
#include "prodomos/perception/people_config.hpp"
#include "prodomos/perception/person_sighting.hpp"
#include "prodomos/perception/rgbd_view.hpp"

#include <memory>
#include <vector>

namespace prodomos::perception {

/// People in images (002 §II-E): boxes of one network, key points of another, depth. Not to be copied; throws
/// base::FileError naming the file where the folder lacks a model or one does not load.
class PersonDetector {
 public:
  explicit PersonDetector(const PeopleConfig& config);
  ~PersonDetector();
  PersonDetector(PersonDetector&&) noexcept;
  PersonDetector& operator=(PersonDetector&&) noexcept;

  /// None without networks, and none without colour or depth. `debug` may be null.
  std::vector<PersonSighting> find(const RgbdView& view, DebugImages* debug = nullptr);
  /// Key points of side files in place of those of the networks.
  std::vector<PersonSighting> find(const RgbdView& view, const sensors::KeyPoints& keyPoints,
                                   DebugImages* debug = nullptr) const;
  /// From the frame's label images, by class name "person".
  std::vector<PersonSighting> findInLabels(const RgbdView& view, const sensors::ClassTable& classes) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception
