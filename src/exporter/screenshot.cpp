// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/exporter/view3d.hpp"

#include "exporter/picture.hpp"
#include "exporter/scene3d.hpp"
#include "exporter/write_file.hpp"

#include <mrpt/opengl/CFBORender.h>

#include <stdexcept>

namespace prodomos::exporter {
namespace {

mrpt::img::CImage render(const mrpt::opengl::COpenGLScene& scene, unsigned width, unsigned height) try {
  mrpt::opengl::CFBORender renderer(width, height);
  renderer.setCamera(scene, scene.getViewport()->getCamera());
  mrpt::img::CImage image;
  renderer.render_RGB(scene, image);
  return image;
} catch (const std::exception& fault) {
  throw base::Error(
      base::expectedFound("screenshot", "OpenGL without a display (EGL; package libgl1-mesa-dri)", fault.what()));
}

/// Twice the size, halved: lines and labels without stairs.
sensors::Image<map::Rgba> halved(const mrpt::img::CImage& image, int width, int height) {
  sensors::Image<map::Rgba> half(width, height);
  for (int y = 0; y < height; ++y) {
    const auto* upper = image.ptrLine<std::uint8_t>(static_cast<unsigned>(2 * y));
    const auto* lower = image.ptrLine<std::uint8_t>(static_cast<unsigned>(2 * y + 1));
    auto* pixel = half.row(y);
    for (int x = 0; x < width; ++x, upper += 6, lower += 6) {
      const auto mean = [&](int c) {
        return static_cast<std::uint8_t>((upper[c] + upper[c + 3] + lower[c] + lower[c + 3] + 2) / 4);
      };
      pixel[x] = {mean(2), mean(1), mean(0), 255};
    }
  }
  return half;
}

}  // namespace

void renderScreenshot(const map::MapView& view, const std::filesystem::path& png, int width, int height) {
  const auto scene = makeScene(view, Pen{.pixels = 2.0});
  setCamera(*scene.objects, overview(scene.extent_in_map, static_cast<double>(width) / height));
  // OpenGL pads rows to four bytes, which MRPT's buffer has no room for: whole groups of four pixels need no padding.
  const auto paddedWidth = (static_cast<unsigned>(2 * width) + 3U) / 4U * 4U;
  const auto image = render(*scene.objects, paddedWidth, static_cast<unsigned>(2 * height));
  writeFile(png, toPng(halved(image, width, height)));
}

}  // namespace prodomos::exporter
