// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "localization/rgbd_alignment.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace prodomos::localization::rgbd {

/// A view that later ones are aligned with.
struct KeyFrame {
  std::uint64_t frame = 0;  ///< running number
  View view;
  geometry::Pose3 T_world_camera = geometry::Pose3::Identity();
};

/// The last so many key frames.
class KeyFrames {
 public:
  explicit KeyFrames(int most) : most_(static_cast<std::size_t>(most)) {}

  bool empty() const { return frames_.empty(); }
  std::size_t size() const { return frames_.size(); }
  const KeyFrame& operator[](std::size_t i) const { return frames_[i]; }

  void add(KeyFrame frame);
  void clear() { frames_.clear(); }
  /// Moves all of them: the world has become another.
  void transform(const geometry::Pose3& T_new_old);

  /// Indices, and how much each has in common with the view (0 … 1, the smaller of both shares), the most first.
  std::vector<std::pair<std::size_t, double>> byOverlap(const View& view, const geometry::Pose3& T_world_camera) const;
  /// All indices: `first`, then those most likely to show what the view shows.
  std::vector<std::size_t> nearestFirst(const View& view, const geometry::Pose3& T_world_camera,
                                        std::size_t first) const;

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  std::size_t most_;
  std::vector<KeyFrame> frames_;
};

}  // namespace prodomos::localization::rgbd
