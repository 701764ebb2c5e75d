// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "io/images.hpp"
#include "io/side_files.hpp"
#include "io/text_fields.hpp"

#include <yaml-cpp/yaml.h>

#include <map>

namespace prodomos::io {

namespace {

namespace fs = std::filesystem;

sensors::ClassTable readClasses(const fs::path& path) {
  if (!fs::exists(path))
    throw base::FileError(base::expectedFound(path.string(), "a file of `id: name` lines", "none"));
  try {
    auto classes = YAML::LoadFile(path.string()).as<sensors::ClassTable>();
    classes.emplace(0, "unlabeled");
    return classes;
  } catch (const YAML::Exception& fault) {
    throw base::FileError(
        base::expectedFound(place(path, static_cast<std::size_t>(fault.mark.line) + 1), "`id: name` lines", fault.msg));
  }
}

class LabelledSource final : public sensors::SensorSource {
 public:
  LabelledSource(std::unique_ptr<sensors::SensorSource> source, const fs::path& folder)
      : source_(std::move(source)), info_(source_->info()) {
    info_.classes = readClasses(folder / "classes.yaml");
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".png") continue;
      const auto stem = entry.path().stem().string();
      if (const auto number = parseNumber<std::size_t>(stem)) {
        byNumber_.emplace(*number, entry.path());
      } else if (const auto time = base::parseSeconds(stem)) {
        byTime_.emplace(*time, entry.path());
      }
    }
    if (byNumber_.empty() && byTime_.empty()) {
      throw base::FileError(base::expectedFound(folder.string(), "label images <seconds>.png or <number>.png", "none"));
    }
  }

  const sensors::SourceInfo& info() const override { return info_; }
  base::Progress progress() const override { return source_->progress(); }

  sensors::SourceItem next() override {
    auto item = source_->next();
    if (auto* reading = std::get_if<sensors::Reading>(&item)) {
      if (auto* frame = std::get_if<sensors::RgbdFrame>(&reading->data)) addLabels(*reading, *frame);
    }
    // A frame that could not be read still has its number.
    if (std::holds_alternative<sensors::Skipped>(item) && isImageReason(std::get<sensors::Skipped>(item).reason)) {
      ++frames_;
    }
    return item;
  }

 private:
  static bool isImageReason(const std::string& reason) {
    return reason.ends_with(" image") || reason.ends_with(" images");
  }

  std::optional<fs::path> find(base::Time time, std::size_t number) const {
    constexpr base::Duration kSameTime = std::chrono::microseconds(500);
    const auto after = byTime_.lower_bound(time - kSameTime);
    if (after != byTime_.end() && after->first <= time + kSameTime) return after->second;
    const auto numbered = byNumber_.find(number);
    return numbered == byNumber_.end() ? std::nullopt : std::optional(numbered->second);
  }

  void addLabels(sensors::Reading& reading, sensors::RgbdFrame& frame) {
    const auto file = find(reading.time, frames_++);
    if (!file) return;
    auto image = readLabelImage(*file);
    if (const auto* fault = std::get_if<ImageFault>(&image)) {
      reading.fault = fault->fault;
      return;
    }
    auto& classes = std::get<sensors::Image<std::uint16_t>>(image);
    const bool hasDepth = !frame.depth.empty();
    const int width = hasDepth ? frame.depth.width() : frame.color.width();
    const int height = hasDepth ? frame.depth.height() : frame.color.height();
    if (classes.width() != width || classes.height() != height) {
      reading.fault = base::expectedFound(
          file->string(), std::to_string(width) + "x" + std::to_string(height) + " pixels like the frame",
          std::to_string(classes.width()) + "x" + std::to_string(classes.height()));
      return;
    }
    frame.labels = sensors::LabelImage{std::move(classes), {}, {}};
  }

  std::unique_ptr<sensors::SensorSource> source_;
  sensors::SourceInfo info_;
  std::map<base::Time, fs::path> byTime_;
  std::map<std::size_t, fs::path> byNumber_;
  std::size_t frames_ = 0;
};

}  // namespace

std::unique_ptr<sensors::SensorSource> withLabels(std::unique_ptr<sensors::SensorSource> source,
                                                  const fs::path& folder) {
  return std::make_unique<LabelledSource>(std::move(source), folder);
}

}  // namespace prodomos::io
