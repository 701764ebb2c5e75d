// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "io/input_file.hpp"
#include "io/rgbd_folder.hpp"
#include "io/side_files.hpp"
#include "io/text_fields.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace prodomos::io {

namespace {

using Fields = std::vector<std::string_view>;

/// The readings of a CSV file, one for all lines of one time and sensor. `Format` says what a line is.
template <typename Format>
class SideReadings {
 public:
  using Data = typename Format::Data;

  explicit SideReadings(const std::filesystem::path& path) : file_(path) {
    if (!nextLine() || !line_.starts_with(Format::kHeader)) {
      throw base::FileError(base::expectedFound(place(path, std::max<std::size_t>(lineNumber_, 1)),
                                                "the header " + std::string(Format::kHeader), "`" + line_ + "`"));
    }
    readLine();
  }

  /// Of the next reading; nothing at the end of the file.
  std::optional<base::Time> time() const { return line_.empty() ? std::nullopt : std::optional(time_); }

  /// Malformed lines and lines of an earlier time are left out and told in the fault.
  sensors::Reading take() {
    sensors::Reading reading{time_, sensor_, Data{}};
    auto& data = std::get<Data>(reading.data);
    while (time() == reading.time && sensor_ == reading.sensor) {
      if (!Format::add(data, splitFields(line_, ',')) && fault_.empty()) setFault("`" + line_ + "`");
      readLine();
    }
    reading.fault = std::exchange(fault_, "");
    return reading;
  }

 private:
  bool nextLine() {
    do {
      if (!file_.readLine(line_)) {
        line_.clear();
        return false;
      }
      ++lineNumber_;
    } while (isComment(line_));
    return true;
  }

  void readLine() {
    while (nextLine()) {
      const auto fields = splitFields(line_, ',');
      const auto time = base::parseSeconds(fields[0]);
      const bool usable = time && fields.size() >= Format::kFields && (!any_ || *time >= time_);
      if (usable) {
        any_ = true;
        time_ = *time;
        sensor_ = fields.size() > Format::kFields ? std::string(fields[Format::kFields]) : kFolderCamera;
        return;
      }
      if (fault_.empty()) setFault("`" + line_ + "`");
    }
  }

  void setFault(const std::string& found) {
    fault_ = base::expectedFound(place(file_.path(), lineNumber_),
                                 "`" + std::string(Format::kHeader) + "` with times that do not go back", found);
  }

  InputFile file_;
  std::string line_;
  std::size_t lineNumber_ = 0;
  bool any_ = false;
  base::Time time_{};
  std::string sensor_;
  std::string fault_;
};

bool allFinite(const std::vector<double>& numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

struct DetectionFormat {
  using Data = sensors::Detections;
  static constexpr std::string_view kHeader = "time,class,score,x,y,width,height";
  static constexpr std::size_t kFields = 7;

  static bool add(Data& detections, const Fields& fields) {
    const auto id = parseNumber<int>(fields[1]);
    const auto v = parseNumbers(fields, 2, 5);
    if (!id || !v || !allFinite(*v)) return false;
    detections.boxes.push_back({*id, (*v)[0], (*v)[1], (*v)[2], (*v)[3], (*v)[4]});
    return true;
  }
};

struct KeyPointFormat {
  using Data = sensors::KeyPoints;
  static constexpr std::string_view kHeader = "time,person,joint,x,y,score";
  static constexpr std::size_t kFields = 6;

  static bool add(Data& keyPoints, const Fields& fields) {
    constexpr std::size_t kMostJoints = 1000;
    const auto person = parseNumber<int>(fields[1]);
    const auto joint = parseNumber<std::size_t>(fields[2]);
    const auto v = parseNumbers(fields, 3, 3);
    if (!person || !joint || *joint >= kMostJoints || !v || !allFinite(*v)) return false;
    auto& persons = keyPoints.persons;
    auto found = std::ranges::find(persons, *person, &sensors::PersonKeyPoints::person);
    if (found == persons.end()) found = persons.insert(persons.end(), {*person, {}});
    if (found->joints.size() <= *joint) found->joints.resize(*joint + 1);
    found->joints[*joint] = {(*v)[0], (*v)[1], (*v)[2]};
    return true;
  }
};

/// A side reading stands before the first item of the log that is later than it.
template <typename Format>
class MergedSource final : public sensors::SensorSource {
 public:
  MergedSource(std::unique_ptr<sensors::SensorSource> source, const std::filesystem::path& file)
      : source_(std::move(source)), side_(file) {}

  const sensors::SourceInfo& info() const override { return source_->info(); }
  base::Progress progress() const override { return source_->progress(); }

  sensors::SourceItem next() override {
    if (!held_) held_ = source_->next();
    if (side_.time() && comesFirst(*side_.time())) return side_.take();
    if (std::holds_alternative<sensors::EndOfLog>(*held_)) return *held_;
    return *std::exchange(held_, std::nullopt);
  }

 private:
  bool comesFirst(base::Time sideTime) const {
    if (const auto* reading = std::get_if<sensors::Reading>(&*held_)) return sideTime < reading->time;
    return std::holds_alternative<sensors::EndOfLog>(*held_);
  }

  std::unique_ptr<sensors::SensorSource> source_;
  SideReadings<Format> side_;
  std::optional<sensors::SourceItem> held_;
};

}  // namespace

std::unique_ptr<sensors::SensorSource> withDetections(std::unique_ptr<sensors::SensorSource> source,
                                                      const std::filesystem::path& file) {
  return std::make_unique<MergedSource<DetectionFormat>>(std::move(source), file);
}

std::unique_ptr<sensors::SensorSource> withKeyPoints(std::unique_ptr<sensors::SensorSource> source,
                                                     const std::filesystem::path& file) {
  return std::make_unique<MergedSource<KeyPointFormat>>(std::move(source), file);
}

}  // namespace prodomos::io
