// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "io/input_file.hpp"
#include "io/rgbd_folder.hpp"
#include "io/text_fields.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace prodomos::io {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> imagesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// The digits at the end of a file's stem: the "17" of rgb_0017.png.
std::optional<long long> frameNumber(const fs::path& file) {
  const auto stem = file.stem().string();
  const auto last = stem.find_last_not_of("0123456789");
  return parseNumber<long long>(std::string_view(stem).substr(last == std::string::npos ? 0 : last + 1));
}

/// By the numbers in their names where these are the same on both sides, else one after the other.
std::vector<std::pair<fs::path, fs::path>> pairImages(const fs::path& folder) {
  const auto colors = imagesIn(folder / "rgb");
  const auto depths = imagesIn(folder / "depth");
  std::map<long long, fs::path> depthOfNumber;
  for (const auto& depth : depths) {
    if (const auto number = frameNumber(depth)) depthOfNumber.emplace(*number, depth);
  }
  std::vector<std::pair<fs::path, fs::path>> pairs;
  bool anyMatch = false;
  for (const auto& color : colors) {
    const auto number = frameNumber(color);
    const auto match = number ? depthOfNumber.find(*number) : depthOfNumber.end();
    anyMatch = anyMatch || match != depthOfNumber.end();
    // A frame without depth is one with a missing image, told when its turn comes.
    pairs.emplace_back(
        color, match != depthOfNumber.end() ? match->second : folder / "depth" / (color.stem().string() + ".png"));
  }
  if (anyMatch) return pairs;
  pairs.clear();
  if (colors.size() != depths.size()) {
    throw base::FileError(base::expectedFound(folder.string(), "as many images in depth/ as in rgb/",
                                              std::to_string(depths.size()) + " and " + std::to_string(colors.size())));
  }
  for (std::size_t i = 0; i < colors.size(); ++i) pairs.emplace_back(colors[i], depths[i]);
  return pairs;
}

/// `name number` wherever they stand; all else is prose. "1-based" says that the centre counts pixels from one.
void readCamera(const fs::path& path, RgbdFolder& folder) {
  InputFile file(path);
  std::map<std::string, double, std::less<>> values;
  bool oneBased = false;
  std::string line;
  while (file.readLine(line)) {
    oneBased = oneBased || line.find("1-based") != std::string::npos;
    std::ranges::replace_if(
        line, [](char c) { return c == ':' || c == '=' || c == ',' || c == ';'; }, ' ');
    const auto fields = splitFields(line);
    for (std::size_t i = 0; i + 1 < fields.size(); ++i) {
      if (const auto number = parseNumber<double>(fields[i + 1])) values.emplace(fields[i], *number);
    }
  }
  const auto value = [&](std::string_view key, double otherwise) {
    const auto found = values.find(key);
    return found == values.end() ? otherwise : found->second;
  };
  for (const auto* key : {"fx", "fy", "cx", "cy"}) {
    if (!values.contains(key)) {
      throw base::FileError(base::expectedFound(path.string(), "`fx … fy … cx … cy …`", std::string("no ") + key));
    }
  }
  const double origin = oneBased ? 1.0 : 0.0;
  folder.camera = {value("fx", 0),
                   value("fy", 0),
                   value("cx", 0) - origin,
                   value("cy", 0) - origin,
                   {value("k1", 0), value("k2", 0), value("p1", 0), value("p2", 0), value("k3", 0)}};
  folder.depthScale = value("depth_scale", folder.depthScale);
  if (oneBased) folder.info.remarks.emplace_back("camera.txt counts pixels from 1: one taken off cx and cy");
}

}  // namespace

bool isPlainFolder(const fs::path& folder) {
  return fs::is_directory(folder / "rgb") && fs::is_directory(folder / "depth");
}

RgbdFolder readPlainFolder(const fs::path& path, const SourceOptions& options) {
  if (!(options.framesPerSecond > 0.0)) throw base::UsageError("frames per second: expected more than zero");
  RgbdFolder folder;
  folder.info.path = path.string();
  folder.info.kind = "RGB-D folder";
  folder.depthScale = 1000.0;  // millimetres
  if (fs::exists(path / "camera.txt")) {
    readCamera(path / "camera.txt", folder);
  } else if (!options.camera) {
    throw base::FileError(base::expectedFound(path.string(), "a camera.txt with `fx … fy … cx … cy …`", "none"));
  }
  folder.camera = options.camera.value_or(folder.camera);
  folder.depthScale = options.depthScale.value_or(folder.depthScale);

  const auto pairs = pairImages(path);
  if (pairs.empty()) throw base::FileError(base::expectedFound(path.string(), "images in rgb/ and depth/", "none"));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto time = base::Time(base::fromSeconds(static_cast<double>(i) / options.framesPerSecond));
    folder.frames.push_back({time, pairs[i].first, pairs[i].second});
  }
  auto rate = std::to_string(options.framesPerSecond);
  rate.erase(rate.find_last_not_of('0') + 1);
  if (rate.ends_with('.')) rate.pop_back();
  folder.info.remarks.push_back("no time stamps: assumed " + rate + " frames per second");
  return folder;
}

}  // namespace prodomos::io
