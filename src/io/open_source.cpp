// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/open_source.hpp"

#include "prodomos/base/error.hpp"

#include "io/carmen_source.hpp"
#include "io/input_file.hpp"
#include "io/rawlog_source.hpp"
#include "io/rgbd_folder.hpp"
#include "io/side_files.hpp"

namespace prodomos::io {

namespace {

std::unique_ptr<sensors::SensorSource> openFolder(const std::filesystem::path& folder, const SourceOptions& options) {
  if (isTumFolder(folder)) return openRgbdFolder(readTumFolder(folder, options));
  if (isPlainFolder(folder)) return openRgbdFolder(readPlainFolder(folder, options));
  throw base::FileError(base::expectedFound(
      folder.string(),
      "a TUM folder (associations.txt, or rgb.txt and depth.txt) or an RGB-D folder (rgb/, depth/, camera.txt)",
      "neither"));
}

std::unique_ptr<sensors::SensorSource> openFile(const std::filesystem::path& path) {
  InputFile file(path);
  const auto begin = file.peek(InputFile::kBufferSize);
  if (isRawlog(begin)) return openRawlog(path);
  if (isCarmenLog(begin)) return openCarmenLog(path);
  const auto found = !begin.empty() ? "other content" : file.damage().empty() ? "an empty file" : file.damage();
  throw base::FileError(base::expectedFound(
      path.string(), "an MRPT rawlog, a CARMEN log (either may be gzip'd, a CARMEN log bzip2'd), or a folder of images",
      found));
}

}  // namespace

std::unique_ptr<sensors::SensorSource> openSource(const std::filesystem::path& log, const SourceOptions& options) {
  std::error_code fault;
  if (!std::filesystem::exists(log, fault)) {
    throw base::FileError(
        base::expectedFound(log.string(), "an MRPT rawlog, a CARMEN log, or a folder of images", "no such file"));
  }
  auto source = std::filesystem::is_directory(log) ? openFolder(log, options) : openFile(log);
  if (options.labels) source = withLabels(std::move(source), *options.labels);
  if (options.detections) source = withDetections(std::move(source), *options.detections);
  if (options.keyPoints) source = withKeyPoints(std::move(source), *options.keyPoints);
  return source;
}

}  // namespace prodomos::io
