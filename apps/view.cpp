// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/exporter/view3d.hpp"

#include "commands.hpp"
#include "overwriting.hpp"

#include <charconv>
#include <iostream>
#include <optional>

namespace prodomos::apps {

namespace {

struct ViewOptions {
  std::string map;
  std::string screenshot;
  std::string size = "1280x800";
  bool follow = false;
};

struct Size {
  int width = 0;
  int height = 0;
};

/// "1280x800".
Size parseSize(const std::string& text) {
  constexpr int kLeast = 16;
  constexpr int kMost = 8192;  // twice as many pixels are rendered, and graphics drivers end at 16384
  const char* const end = text.data() + text.size();
  Size size;
  const auto width = std::from_chars(text.data(), end, size.width);
  const bool apart = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
  const auto height = apart ? std::from_chars(width.ptr + 1, end, size.height) : width;
  const auto fits = [](int pixels) { return pixels >= kLeast && pixels <= kMost; };
  if (!apart || height.ec != std::errc{} || height.ptr != end || !fits(size.width) || !fits(size.height)) {
    throw base::UsageError(base::expectedFound("--size", "WIDTHxHEIGHT of 16 to 8192 pixels", "'" + text + "'"));
  }
  return size;
}

void view(const ViewOptions& options) {
  if (options.screenshot.empty()) {
    exporter::showWindow(options.map, options.follow);
    return;
  }
  requireOtherFile("--screenshot", options.screenshot, options.map, "the map itself");
  const auto [width, height] = parseSize(options.size);
  exporter::renderScreenshot(map::MapView::open(options.map), options.screenshot, width, height);
  std::cout << options.screenshot << '\n';
}

}  // namespace

void addView(CLI::App& program) {
  auto* command = program.add_subcommand("view", "look at a map in three dimensions");
  command->footer(
      "Examples:\n"
      "  prodomos view office.prodomos --follow      while replay writes it\n"
      "  prodomos view office.prodomos --screenshot office.png --size 1920x1080");
  auto options = std::make_shared<ViewOptions>();
  command->add_option("MAP", options->map, "the map file")->required();
  auto* screenshot = command->add_option("--screenshot", options->screenshot, "write a PNG; needs no display");
  command->add_option("--size", options->size, "of the screenshot in pixels")->capture_default_str()->needs(screenshot);
  command->add_flag("--follow", options->follow, "show what is added to the file")->excludes(screenshot);
  command->callback([options] { view(*options); });
}

}  // namespace prodomos::apps
