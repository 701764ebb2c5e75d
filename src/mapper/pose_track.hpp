// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"

#include <deque>
#include <optional>

namespace prodomos::mapper {

/// The poses of one source over time, to be asked for moments in between.
class PoseTrack {
 public:
  /// Stamps may come a little out of order; of two equal ones the later call counts.
  void add(base::Time time, const geometry::Pose3& pose);

  bool empty() const { return poses_.empty(); }
  /// Is there a pose at this time or after it?
  bool reaches(base::Time time) const { return !empty() && poses_.back().time >= time; }
  /// Interpolated; before the first and after the last that one. Identity where there is none at all.
  geometry::Pose3 at(base::Time time) const;
  /// To the nearest pose, in time; none where there is no pose.
  std::optional<base::Duration> distanceTo(base::Time time) const;
  /// Drops what is not needed for moments from `time` on. A margin is kept for readings that come late.
  void forgetBefore(base::Time time);
  /// Keeps the latest ones.
  void forgetAllBut(std::size_t count);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  struct TimedPose {
    base::Time time;
    geometry::Pose3 pose;
  };
  std::deque<TimedPose>::const_iterator firstFrom(base::Time time) const;

  std::deque<TimedPose> poses_;  // ascending
};

}  // namespace prodomos::mapper
