// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/rawlog_source.hpp"

#include "prodomos/base/error.hpp"

#include "io/mrpt_readings.hpp"
#include "io/mrpt_values.hpp"
#include "io/object_stream.hpp"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <array>
#include <deque>
#include <optional>
#include <utility>

namespace prodomos::io {

namespace {

namespace fs = std::filesystem;
using mrpt::serialization::CSerializable;

/// MRPT's CRawlog::detectImagesDirectory() of 2.5.8 forgets a '/' and so finds none.
std::optional<fs::path> imagesBeside(const fs::path& log) {
  auto stem = log.filename().stem();
  if (stem.extension() == ".rawlog") stem = stem.stem();  // .rawlog.gz
  for (const auto* suffix : {"_Images", "_images", "_IMAGES"}) {
    const auto folder = log.parent_path() / (stem.string() + suffix);
    if (fs::is_directory(folder)) return folder;
  }
  const auto folder = log.parent_path() / "Images";
  return fs::is_directory(folder) ? std::optional(folder) : std::nullopt;
}

/// The motion since the action before: wheel odometry where there is some, else what was estimated in its place.
std::optional<geometry::Pose3> increment(const mrpt::obs::CAction& action) {
  if (const auto* planar = dynamic_cast<const mrpt::obs::CActionRobotMovement2D*>(&action)) {
    const bool measured = planar->estimationMethod == mrpt::obs::CActionRobotMovement2D::emOdometry;
    return toPose3(measured || !planar->poseChange ? planar->rawOdometryIncrementReading
                                                   : planar->poseChange->getMeanVal());
  }
  if (const auto* spatial = dynamic_cast<const mrpt::obs::CActionRobotMovement3D*>(&action)) {
    return toPose3(spatial->poseChange.mean);  // MRPT does not store the odometry of this class
  }
  return std::nullopt;
}

class RawlogSource final : public sensors::SensorSource {
 public:
  explicit RawlogSource(const fs::path& path) : objects_(InputFile(path)), images_(imagesBeside(path)) {
    info_.path = path.string();
    info_.kind = "MRPT rawlog";
    lookAhead(path);
  }

  const sensors::SourceInfo& info() const override { return info_; }
  base::Progress progress() const override { return objects_.progress(); }

  sensors::SourceItem next() override {
    auto entry = take();
    if (!entry) return sensors::EndOfLog{objects_.fault()};
    if (auto* item = std::get_if<sensors::SourceItem>(&entry->content)) return std::move(*item);
    return converted(*entry);
  }

  void skip(std::size_t count) override {
    for (std::size_t i = 0; i < count && take(); ++i) continue;
  }

 private:
  /// One item to come. Observations wait as they are: one that is passed over need not be converted.
  struct Entry {
    std::variant<sensors::SourceItem, mrpt::obs::CObservation::Ptr> content;
    base::Time time;
    std::string place;
  };

  void lookAhead(const fs::path& path);
  std::optional<Entry> take();
  void readObject();
  void add(const CSerializable::Ptr& object);
  void addObservation(const mrpt::obs::CObservation::Ptr& observation);
  void addActions(const mrpt::obs::CActionCollection& actions, std::optional<base::Time> frameTime);
  void addSkipped(const std::string& reason) {
    entries_.push_back({sensors::SourceItem(sensors::Skipped{reason, "", time_}), time_, ""});
  }
  sensors::SourceItem converted(const Entry& entry) const;

  sensors::SourceInfo info_;
  ObjectStream objects_;
  std::optional<fs::path> images_;
  std::deque<Entry> entries_;
  mrpt::obs::CActionCollection::Ptr actions_;  ///< waits for its sensory frame, which may have to lend it its time
  geometry::Pose3 T_odom_body_ = geometry::Pose3::Identity();
  base::Time time_{};  ///< of the last object that had one
};

/// Class names and whether poses were recorded must be known before the first reading; they show in the first objects.
void RawlogSource::lookAhead(const fs::path& path) {
  constexpr int kObjects = 50;
  ObjectStream objects{InputFile(path)};
  const auto look = [this](const mrpt::obs::CObservation& observation) {
    if (dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation) != nullptr) info_.hasRecordedPoses = true;
    info_.classes.merge(classTable(observation));
    return dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation) != nullptr;
  };
  bool sawImages = false;
  for (int i = 0; i < kObjects && !sawImages && !objects.atEnd(); ++i) {
    const auto object = objects.next();
    if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
      sawImages = look(*observation);
    } else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
      for (const auto& part : *frame) sawImages = look(*part) || sawImages;
    }
  }
}

std::optional<RawlogSource::Entry> RawlogSource::take() {
  while (entries_.empty()) {
    if (objects_.atEnd()) return std::nullopt;
    readObject();
  }
  auto entry = std::move(entries_.front());
  entries_.pop_front();
  return entry;
}

void RawlogSource::readObject() {
  const auto object = objects_.next();
  if (object) return add(object);
  if (!objects_.atEnd()) return addSkipped("empty object");
  if (actions_) addActions(*std::exchange(actions_, nullptr), std::nullopt);
}

void RawlogSource::add(const CSerializable::Ptr& object) {
  if (const auto whole = std::dynamic_pointer_cast<mrpt::obs::CRawlog>(object)) {
    for (const auto& part : *whole) add(part);
    return;
  }
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object);
  if (actions_) {
    const bool lends = frame && !frame->empty();
    addActions(*std::exchange(actions_, nullptr),
               lends ? toTime(frame->getObservationByIndex(0)->timestamp) : std::nullopt);
  }
  if (frame) {
    for (const auto& observation : *frame) addObservation(observation);
  } else if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
    actions_ = actions;
  } else if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
    addObservation(observation);
  } else {
    addSkipped("unsupported " + className(*object));
  }
}

void RawlogSource::addObservation(const mrpt::obs::CObservation::Ptr& observation) {
  time_ = toTime(observation->timestamp).value_or(time_);
  entries_.push_back({observation, time_, objects_.place()});
}

void RawlogSource::addActions(const mrpt::obs::CActionCollection& actions, std::optional<base::Time> frameTime) {
  bool moved = false;
  for (const auto& action : actions) {
    const auto T_before_after = increment(*action);
    if (!T_before_after || moved) {
      addSkipped(moved ? "second estimate of a movement" : "unsupported " + className(*action));
      continue;
    }
    moved = true;
    time_ = toTime(action->timestamp).value_or(frameTime.value_or(time_));
    if (!geometry::isFinite(*T_before_after)) {
      const auto fault = base::expectedFound(objects_.place(), "a finite movement", "NaN or infinity");
      entries_.push_back({sensors::SourceItem(sensors::Skipped{"damaged pose", fault, time_}), time_, ""});
      continue;
    }
    T_odom_body_ = T_odom_body_ * *T_before_after;
    entries_.push_back(
        {sensors::SourceItem(sensors::Reading{time_, "odometry", sensors::Odometry{T_odom_body_}}), time_, ""});
  }
}

sensors::SourceItem RawlogSource::converted(const Entry& entry) const {
  const auto& observation = *std::get<mrpt::obs::CObservation::Ptr>(entry.content);
  const auto skipped = [&](const std::string& reason, const std::string& expected, const std::string& found) {
    return sensors::Skipped{reason, base::expectedFound(entry.place, expected, found), entry.time};
  };
  const auto missing = [&] {
    const auto folder = images_ ? images_->string() : "a folder <log>_Images or Images beside it";
    return skipped("missing image", "its external image in " + folder, "none that is readable");
  };
  const MrptScope quiet(images_);
  try {
    observation.load();
  } catch (const std::exception&) {
    return missing();
  }
  try {
    return toItem(observation, entry.time, entry.place);
  } catch (const mrpt::img::CExceptionExternalImageNotFound&) {  // loaded when it is first used
    return missing();
  } catch (const std::exception&) {
    const auto name = className(observation);
    return skipped("damaged " + name, "a consistent " + name, "damaged content");
  }
}

}  // namespace

bool isRawlog(std::string_view begin) {
  const auto name = objectClass(begin);
  if (!name) return false;
  return name->starts_with("CObservation") || *name == "CSensoryFrame" || *name == "CActionCollection" ||
         *name == "CRawlog";
}

std::unique_ptr<sensors::SensorSource> openRawlog(const std::filesystem::path& path) {
  return std::make_unique<RawlogSource>(path);
}

}  // namespace prodomos::io
