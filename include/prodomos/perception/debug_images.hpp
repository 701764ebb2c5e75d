// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/image.hpp"

#include <filesystem>
#include <string>

namespace prodomos::perception {

/// Where detectors put pictures of how they came to their verdicts: FOLDER/<frame>_<name>.png, for one frame in
/// `every`. Made by `replay --debug-images`.
class DebugImages {
 public:
  /// Makes the folder. Throws base::FileError where it cannot be written.
  explicit DebugImages(std::filesystem::path folder, int every = 1);

  /// To be called before the detectors look at a frame, counted from 0.
  void beginFrame(int frame) { frame_ = frame; }
  /// Detectors draw nothing where it is false.
  bool isWanted() const { return frame_ % every_ == 0; }
  /// Throws base::FileError where it cannot be written.
  void add(const std::string& name, const sensors::Image<sensors::Rgb>& picture);

 private:
  std::filesystem::path folder_;
  int every_;
  int frame_ = 0;
};

}  // namespace prodomos::perception
