// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "io/input_file.hpp"
#include "io/rgbd_folder.hpp"
#include "io/text_fields.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>

namespace prodomos::io {

namespace {

namespace fs = std::filesystem;
using Frame = RgbdFolder::Frame;

struct StampedFile {
  base::Time time;
  fs::path file;
};

/// Hands each line's fields to `read`, which says whether they are as expected, and gives their time, which must grow.
template <typename Read>
void readList(const fs::path& path, const std::string& expected, Read read) {
  InputFile file(path);
  std::optional<base::Time> last;
  std::string line;
  for (std::size_t number = 1; file.readLine(line); ++number) {
    if (isComment(line)) continue;
    const std::optional<base::Time> time = read(splitFields(line));
    if (!time) throw base::FileError(base::expectedFound(place(path, number), expected, "`" + line + "`"));
    if (last && *time < *last) {
      throw base::FileError(base::expectedFound(place(path, number), "a time not before " + base::toString(*last),
                                                base::toString(*time)));
    }
    last = time;
  }
}

std::vector<StampedFile> readFileList(const fs::path& path) {
  std::vector<StampedFile> files;
  readList(path, "`time file`", [&](const auto& fields) -> std::optional<base::Time> {
    const auto time = fields.size() == 2 ? base::parseSeconds(fields[0]) : std::nullopt;
    if (time) files.push_back({*time, path.parent_path() / fields[1]});
    return time;
  });
  return files;
}

/// `time file time file`, colour before depth or after it: their folders or names tell. A frame has its colour's time.
std::vector<Frame> readAssociations(const fs::path& path) {
  std::vector<Frame> frames;
  readList(path, "`time rgb-file time depth-file`, or depth first",
           [&](const auto& fields) -> std::optional<base::Time> {
             if (fields.size() != 4) return std::nullopt;
             const auto first = base::parseSeconds(fields[0]);
             const auto second = base::parseSeconds(fields[2]);
             if (!first || !second) return std::nullopt;
             const bool depthFirst = fields[1].find("depth") != std::string_view::npos;
             const auto folder = path.parent_path();
             frames.push_back(depthFirst ? Frame{*second, folder / fields[3], folder / fields[1]}
                                         : Frame{*first, folder / fields[1], folder / fields[3]});
             return frames.back().time;
           });
  return frames;
}

/// Nearest in time first, each file once, none further apart than the TUM tools allow.
std::vector<Frame> associate(const std::vector<StampedFile>& colors, const std::vector<StampedFile>& depths) {
  constexpr base::Duration kMostApart = std::chrono::milliseconds(20);
  struct Pair {
    base::Duration apart;
    std::size_t color;
    std::size_t depth;
    auto operator<=>(const Pair&) const = default;
  };
  std::vector<Pair> pairs;
  auto first = depths.begin();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    while (first != depths.end() && first->time < colors[i].time - kMostApart) ++first;
    for (auto depth = first; depth != depths.end() && depth->time <= colors[i].time + kMostApart; ++depth) {
      pairs.push_back(
          {std::chrono::abs(depth->time - colors[i].time), i, static_cast<std::size_t>(depth - depths.begin())});
    }
  }
  std::ranges::sort(pairs);

  std::vector<std::optional<std::size_t>> depthOfColor(colors.size());
  std::vector<bool> used(depths.size(), false);
  for (const auto& pair : pairs) {
    if (depthOfColor[pair.color] || used[pair.depth]) continue;
    depthOfColor[pair.color] = pair.depth;
    used[pair.depth] = true;
  }
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (depthOfColor[i]) frames.push_back({colors[i].time, colors[i].file, depths[*depthOfColor[i]].file});
  }
  return frames;
}

/// fx fy cx cy [k1 k2 p1 p2 k3] [depth_scale]
void readCamera(const fs::path& path, RgbdFolder& folder) {
  try {
    const YAML::Node camera = YAML::LoadFile(path.string());
    const auto value = [&](const char* key, std::optional<double> otherwise = std::nullopt) {
      if (camera[key]) return camera[key].as<double>();
      if (!otherwise) throw base::FileError(base::expectedFound(path.string(), std::string("the key ") + key, "none"));
      return *otherwise;
    };
    folder.camera = {value("fx"),
                     value("fy"),
                     value("cx"),
                     value("cy"),
                     {value("k1", 0), value("k2", 0), value("p1", 0), value("p2", 0), value("k3", 0)}};
    folder.depthScale = value("depth_scale", folder.depthScale);
  } catch (const YAML::Exception& fault) {
    throw base::FileError(base::expectedFound(place(path, static_cast<std::size_t>(fault.mark.line) + 1),
                                              "`key: number` lines", fault.msg));
  }
}

void chooseCamera(const fs::path& path, const SourceOptions& options, RgbdFolder& folder) {
  constexpr sensors::CameraIntrinsics kKinect = {525.0, 525.0, 319.5, 239.5, {}};
  folder.camera = kKinect;
  folder.depthScale = 5000.0;  // of all TUM sequences
  const auto file = path / "camera.yaml";
  if (fs::exists(file)) {
    readCamera(file, folder);
  } else if (!options.camera) {
    folder.info.remarks.emplace_back(
        "no camera.yaml: assumed the intrinsics of a Kinect (fx 525 fy 525 cx 319.5 cy 239.5) and 5000 depth units a "
        "metre");
  }
  folder.camera = options.camera.value_or(folder.camera);
  folder.depthScale = options.depthScale.value_or(folder.depthScale);
  if (!(folder.camera.fx > 0.0 && folder.camera.fy > 0.0 && folder.depthScale > 0.0)) {
    throw base::FileError(base::expectedFound(file.string(), "positive fx, fy and depth_scale", "others"));
  }
}

}  // namespace

bool isTumFolder(const fs::path& folder) {
  return fs::exists(folder / "associations.txt") ||
         (fs::exists(folder / "rgb.txt") && fs::exists(folder / "depth.txt"));
}

RgbdFolder readTumFolder(const fs::path& path, const SourceOptions& options) {
  RgbdFolder folder;
  folder.info.path = path.string();
  folder.info.kind = "TUM RGB-D folder";
  chooseCamera(path, options, folder);
  const bool associated = fs::exists(path / "associations.txt");
  folder.frames = associated ? readAssociations(path / "associations.txt")
                             : associate(readFileList(path / "rgb.txt"), readFileList(path / "depth.txt"));
  if (folder.frames.empty()) {
    throw base::FileError(base::expectedFound(path.string(), "pairs of colour and depth images", "none"));
  }
  if (!fs::exists(path / "groundtruth.txt")) return folder;
  // TUM's poses are those of the camera with the axes of an image; its body has them x ahead, y left, z up.
  folder.poses = readTrajectory(path / "groundtruth.txt");
  const geometry::Pose3 T_camera_body = sensors::cameraAxesInBody().inverse();
  for (auto& pose : folder.poses) pose.T_world_body = pose.T_world_body * T_camera_body;
  return folder;
}

}  // namespace prodomos::io
