// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/trajectory_file.hpp"

#include "prodomos/base/error.hpp"

#include "io/input_file.hpp"
#include "io/text_fields.hpp"

#include <algorithm>
#include <cmath>

namespace prodomos::io {

namespace {

std::optional<TimedPose> parsePose(std::string_view line) {
  const auto fields = splitFields(line);
  if (fields.size() != 8) return std::nullopt;
  const auto time = base::parseSeconds(fields[0]);
  const auto v = parseNumbers(fields, 1, 7);
  if (!time || !v) return std::nullopt;
  const bool finite = std::ranges::all_of(*v, [](double number) { return std::isfinite(number); });
  const Eigen::Quaterniond rotation((*v)[6], (*v)[3], (*v)[4], (*v)[5]);
  if (!finite || rotation.norm() < 1e-6) return std::nullopt;
  return TimedPose{*time, geometry::fromQuaternion({(*v)[0], (*v)[1], (*v)[2]}, rotation)};
}

}  // namespace

std::vector<TimedPose> readTrajectory(const std::filesystem::path& path) {
  InputFile file(path);
  std::vector<TimedPose> poses;
  std::string line;
  for (std::size_t number = 1; file.readLine(line); ++number) {
    if (isComment(line)) continue;
    const auto pose = parsePose(line);
    if (!pose) {
      throw base::FileError(base::expectedFound(place(path, number), "`time x y z qx qy qz qw`", "`" + line + "`"));
    }
    if (!poses.empty() && pose->time < poses.back().time) {
      throw base::FileError(base::expectedFound(
          place(path, number), "a time not before " + base::toString(poses.back().time), base::toString(pose->time)));
    }
    poses.push_back(*pose);
  }
  if (!file.damage().empty()) throw base::FileError(base::expectedFound(path.string(), "a whole file", file.damage()));
  return poses;
}

}  // namespace prodomos::io
