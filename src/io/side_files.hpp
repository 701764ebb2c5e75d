// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/source.hpp"

#include <filesystem>
#include <memory>

namespace prodomos::io {

/// Adds to each RGB-D frame the label image of its time or, by number, of its place among the frames of the log.
/// `folder` holds <seconds>.png or <number>.png, and classes.yaml with `id: name` lines.
std::unique_ptr<sensors::SensorSource> withLabels(std::unique_ptr<sensors::SensorSource> source,
                                                  const std::filesystem::path& folder);

/// Merges the boxes of a CSV file, `time,class,score,x,y,width,height[,sensor]` with the lines of one time together,
/// into the log: each after the reading that it belongs to.
std::unique_ptr<sensors::SensorSource> withDetections(std::unique_ptr<sensors::SensorSource> source,
                                                      const std::filesystem::path& file);

/// The same for joints: `time,person,joint,x,y,score[,sensor]`.
std::unique_ptr<sensors::SensorSource> withKeyPoints(std::unique_ptr<sensors::SensorSource> source,
                                                     const std::filesystem::path& file);

}  // namespace prodomos::io
