// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/exporter/view3d.hpp"

#include "exporter/scene3d.hpp"

#include <mrpt/gui/CDisplayWindow3D.h>

#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace prodomos::exporter {
namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 800;
constexpr auto kPoll = std::chrono::milliseconds(50);
constexpr int kPollsBetweenLooks = 20;  // at a file that is followed: one second

/// Parts of the scene by the key that shows and hides them.
constexpr std::array<std::pair<int, const char*>, 6> kSwitches = {
    {{'g', "graph"}, {'l', "labels"}, {'p', "layers"}, {'w', "trajectory"}, {'f', "floors"}, {'e', "entities"}}};
constexpr const char* kHelp =
    "g graph   l labels   p points   w way   f floors   e entities   space: all of it   q: quit";

class Window {
 public:
  explicit Window(const std::string& title) : window_(title, kWidth, kHeight) {}

  bool isOpen() { return !quit_ && window_.isOpen(); }

  /// The camera moves only where its user has left it alone.
  void show(const map::MapView& view) {
    const auto [fresh, extent] = makeScene(view);
    const auto viewpoint = overview(extent, static_cast<double>(kWidth) / kHeight);
    setCamera(*fresh, viewpoint);
    fresh->getViewport()->addTextMessage(10, 10, kHelp, 0, helpFont());
    for (const auto& part : hidden_) fresh->getByName(part)->setVisibility(false);
    const bool untouched = !aimed_ || camera() == *aimed_;
    window_.get3DSceneAndLock() = fresh;
    window_.unlockAccess3DScene();
    all_ = viewpoint;
    if (untouched) aim();
    window_.forceRepaint();
  }

  void handleKeys() {
    while (window_.keyHit()) {
      const int key = std::tolower(window_.getPushedKey());
      if (key == 'q') quit_ = true;
      if (key == ' ') aim();
      for (const auto& [letter, part] : kSwitches) {
        if (key == letter) toggle(part);
      }
    }
    fitDepths();
    window_.forceRepaint();
  }

 private:
  static mrpt::opengl::TFontParams helpFont() {
    mrpt::opengl::TFontParams font;
    font.vfont_name = "sans";
    font.vfont_scale = 12;
    font.color = mrpt::img::TColorf(0.35F, 0.35F, 0.35F);
    return font;
  }

  Viewpoint camera() const {
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
    window_.getCameraPointingToPoint(x, y, z);
    return {.target = {x, y, z},
            .azimuth = window_.getCameraAzimuthDeg(),
            .elevation = window_.getCameraElevationDeg(),
            .distance = window_.getCameraZoom()};
  }

  void aim() {
    window_.setCameraPointingToPoint(static_cast<float>(all_.target.x()), static_cast<float>(all_.target.y()),
                                     static_cast<float>(all_.target.z()));
    window_.setCameraAzimuthDeg(static_cast<float>(all_.azimuth));
    window_.setCameraElevationDeg(static_cast<float>(all_.elevation));
    window_.setCameraZoom(static_cast<float>(all_.distance));
    window_.setFOV(static_cast<float>(all_.fieldOfView));
    fitDepths();
    aimed_ = camera();
  }

  /// Whoever zooms in comes nearer than the overview's range of depths allows.
  void fitDepths() {
    const auto viewpoint = camera();
    window_.setMinRange(static_cast<float>(viewpoint.leastDepth()));
    window_.setMaxRange(static_cast<float>(viewpoint.greatestDepth() + all_.distance));
  }

  void toggle(const std::string& part) {
    const bool show = hidden_.erase(part) > 0;
    if (!show) hidden_.insert(part);
    window_.get3DSceneAndLock()->getByName(part)->setVisibility(show);
    window_.unlockAccess3DScene();
  }

  mrpt::gui::CDisplayWindow3D window_;
  Viewpoint all_;
  std::optional<Viewpoint> aimed_;
  std::set<std::string> hidden_;
  bool quit_ = false;
};

}  // namespace

void showWindow(const std::filesystem::path& map, bool follow) {
  auto view = map::MapView::open(map);
  if (std::getenv("DISPLAY") == nullptr) {
    throw base::Error(base::expectedFound("view", "a display (DISPLAY is not set)", "none; --screenshot needs none"));
  }
  Window window("prodomos: " + map.filename().string());
  window.show(view);
  for (int poll = 1; window.isOpen(); ++poll) {
    std::this_thread::sleep_for(kPoll);
    window.handleKeys();
    if (follow && poll % kPollsBetweenLooks == 0 && view.changesSince(view.revision()).revision > view.revision()) {
      view = map::MapView::open(map);
      window.show(view);
    }
  }
}

}  // namespace prodomos::exporter
