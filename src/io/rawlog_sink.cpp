// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/io/rawlog_sink.hpp"

#include "prodomos/base/error.hpp"

#include "io/mrpt_values.hpp"
#include "io/object_file.hpp"
#include "io/to_mrpt.hpp"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>

namespace prodomos::io {

namespace {

class ObservationSink final : public sensors::SensorSink {
 public:
  ObservationSink(const std::filesystem::path& path, sensors::ClassTable classes)
      : file_(path), classes_(std::move(classes)) {}

  void write(const sensors::Reading& reading) override { file_.write(*toMrpt(reading, classes_)); }
  void close() override { file_.close(); }

 private:
  ObjectFile file_;
  sensors::ClassTable classes_;
};

class ActionSink final : public sensors::SensorSink {
 public:
  ActionSink(const std::filesystem::path& path, sensors::ClassTable classes)
      : file_(path), classes_(std::move(classes)) {}

  void write(const sensors::Reading& reading) override {
    const auto* odometry = std::get_if<sensors::Odometry>(&reading.data);
    if (odometry == nullptr) {
      frame_.push_back(toMrpt(reading, classes_));
      return;
    }
    const auto T_odom_body = planarPose(*odometry);
    writeFrame();
    mrpt::obs::CActionRobotMovement2D action;
    action.computeFromOdometry(T_odom_body - T_odom_body_, {});
    action.timestamp = toMrpt(reading.time);
    T_odom_body_ = T_odom_body;
    mrpt::obs::CActionCollection actions;
    actions.insert(action);
    file_.write(actions);
    moved_ = true;
  }

  void close() override {
    writeFrame();
    file_.close();
  }

 private:
  /// MRPT's readers expect a frame after each action, be it empty.
  void writeFrame() {
    if (!moved_ && frame_.empty()) return;
    file_.write(frame_);
    frame_.clear();
    moved_ = false;
  }

  ObjectFile file_;
  sensors::ClassTable classes_;
  mrpt::obs::CSensoryFrame frame_;
  mrpt::poses::CPose2D T_odom_body_;
  bool moved_ = false;  ///< since the last frame
};

}  // namespace

std::unique_ptr<sensors::SensorSink> createRawlog(const std::filesystem::path& path, RawlogFlavour flavour,
                                                  const sensors::ClassTable& classes) {
  if (flavour == RawlogFlavour::kObservations) return std::make_unique<ObservationSink>(path, classes);
  return std::make_unique<ActionSink>(path, classes);
}

}  // namespace prodomos::io
