// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"

/// Running state is saved bit by bit, so that a resumed run goes on exactly as the one that was interrupted.
namespace prodomos::mapper {

inline void savePose(base::ByteWriter& out, const geometry::Pose3& pose) {
  for (int i = 0; i < 16; ++i) out << pose.matrix().data()[i];
}

inline geometry::Pose3 loadPose(base::ByteReader& in) {
  geometry::Pose3 pose;
  for (int i = 0; i < 16; ++i) in >> pose.matrix().data()[i];
  return pose;
}

inline void saveTime(base::ByteWriter& out, base::Time time) {
  out << base::toNanoseconds(time);
}
inline base::Time loadTime(base::ByteReader& in) {
  return base::fromNanoseconds(in.read<std::int64_t>());
}

}  // namespace prodomos::mapper
