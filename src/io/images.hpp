// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/sensors/reading.hpp"

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

/// OpenCV's images and files of images, as our own.
namespace prodomos::io {

/// From one (grey), three (BGR) or four channels (BGRA) of 8 bits; empty where the image is of another kind.
sensors::Image<sensors::Rgb> toColor(const cv::Mat& image);
/// To BGR.
cv::Mat toBgr(const sensors::Image<sensors::Rgb>& image);

/// A matrix that shares the image's pixels, which nobody may write to.
template <typename Pixel>
cv::Mat wrap(const sensors::Image<Pixel>& image) {
  return cv::Mat(image.height(), image.width(), cv::traits::Type<Pixel>::value, const_cast<Pixel*>(image.data()));
}

/// Why an image file gives no image.
struct ImageFault {
  std::string reason;  ///< "missing image", "unreadable image"
  std::string fault;   ///< the line for the user
};

template <typename Pixel>
using ImageResult = std::variant<sensors::Image<Pixel>, ImageFault>;

ImageResult<sensors::Rgb> readColorImage(const std::filesystem::path& path);
/// Of 16 bits a pixel in units of 1/scale metres.
ImageResult<float> readDepthImage(const std::filesystem::path& path, double unitsPerMetre);
/// Of 8 or 16 bits a pixel: class ids.
ImageResult<std::uint16_t> readLabelImage(const std::filesystem::path& path);

}  // namespace prodomos::io
