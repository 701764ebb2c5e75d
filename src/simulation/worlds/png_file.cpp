// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/png_file.hpp"

#include "prodomos/base/error.hpp"

#include <png.h>

namespace prodomos::simulation {

sensors::Image<sensors::Rgb> readPng(const std::filesystem::path& path) {
  static_assert(sizeof(sensors::Rgb) == 3);
  constexpr png_color kWhite{255, 255, 255};
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto fail = [&] {
    const std::string found = png.message;
    png_image_free(&png);
    throw base::FileError(base::expectedFound(path.string(), "a PNG image", found));
  };
  if (png_image_begin_read_from_file(&png, path.c_str()) == 0) fail();
  png.format = PNG_FORMAT_RGB;
  sensors::Image<sensors::Rgb> image(static_cast<int>(png.width), static_cast<int>(png.height));
  if (png_image_finish_read(&png, &kWhite, image.data(), 0, nullptr) == 0) fail();
  return image;
}

}  // namespace prodomos::simulation
