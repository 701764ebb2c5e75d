// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/rgbd_keyframes.hpp"

#include <algorithm>

namespace prodomos::localization::rgbd {

void KeyFrames::add(KeyFrame frame) {
  if (frames_.size() == most_) frames_.erase(frames_.begin());
  frames_.push_back(std::move(frame));
}

void KeyFrames::transform(const geometry::Pose3& T_new_old) {
  for (auto& frame : frames_) frame.T_world_camera = T_new_old * frame.T_world_camera;
}

std::vector<std::pair<std::size_t, double>> KeyFrames::byOverlap(const View& view,
                                                                 const geometry::Pose3& T_world_camera) const {
  std::vector<std::pair<std::size_t, double>> shares;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const geometry::Pose3 T_key_camera = frames_[i].T_world_camera.inverse() * T_world_camera;
    const double falls = overlap(view, frames_[i].view, T_key_camera);
    // A camera that walks ahead stays within what it saw from afar: both must see the other's surfaces.
    shares.emplace_back(i, falls > 0.0 ? std::min(falls, overlap(frames_[i].view, view, T_key_camera.inverse())) : 0.0);
  }
  std::ranges::stable_sort(shares, [](const auto& a, const auto& b) { return a.second > b.second; });
  return shares;
}

std::vector<std::size_t> KeyFrames::nearestFirst(const View& view, const geometry::Pose3& T_world_camera,
                                                 std::size_t first) const {
  std::vector<std::size_t> order{first};
  for (const auto& [index, share] : byOverlap(view, T_world_camera)) {
    if (index != first) order.push_back(index);
  }
  return order;
}

void KeyFrames::save(base::ByteWriter& out) const {
  out << static_cast<std::uint64_t>(frames_.size());
  for (const auto& frame : frames_) {
    out << frame.frame;
    out.append(frame.T_world_camera.matrix().data(), 16 * sizeof(double));
    out << frame.view.points;
    frame.view.depth.save(out);
  }
}

void KeyFrames::load(base::ByteReader& in) {
  frames_.clear();
  const auto count = in.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    KeyFrame frame;
    in >> frame.frame;
    in.take(frame.T_world_camera.matrix().data(), 16 * sizeof(double));
    in >> frame.view.points;
    frame.view.depth.load(in);
    frame.view.camera = frame.view.depth.camera();
    frames_.push_back(std::move(frame));
  }
}

}  // namespace prodomos::localization::rgbd
