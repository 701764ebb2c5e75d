// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/images.hpp"

#include "prodomos/base/error.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace prodomos::io {

namespace {

using Bytes = std::vector<unsigned char>;

std::uint32_t bigEndian(const unsigned char* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) << 24 | static_cast<std::uint32_t>(bytes[1]) << 16 |
         static_cast<std::uint32_t>(bytes[2]) << 8 | bytes[3];
}

/// Every chunk is there and its checksum is right.
bool isWholePng(std::span<const unsigned char> bytes) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kFrame = 12;  // length, type, checksum
  for (std::size_t at = kSignature; bytes.size() >= at + kFrame;) {
    const std::size_t length = bigEndian(&bytes[at]);
    if (length > bytes.size() - at - kFrame) return false;
    const auto* type = &bytes[at + 4];
    if (crc32(0, type, static_cast<uInt>(length + 4)) != bigEndian(type + 4 + length)) return false;
    if (std::string_view(reinterpret_cast<const char*>(type), 4) == "IEND") return true;
    at += kFrame + length;
  }
  return false;
}

/// Ends as it must, padding aside.
bool isWholeJpeg(std::span<const unsigned char> bytes) {
  constexpr std::array<unsigned char, 2> kEnd = {0xff, 0xd9};
  return std::find_end(bytes.begin(), bytes.end(), kEnd.begin(), kEnd.end()) != bytes.end();
}

/// OpenCV's decoders write to stderr about images that are cut: those are told apart before.
bool isWhole(const Bytes& bytes) {
  const std::string_view magic(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 4));
  if (magic == "\x89PNG") return isWholePng(bytes);
  if (magic.starts_with("\xff\xd8")) return isWholeJpeg(bytes);
  return true;
}

using MatResult = std::variant<cv::Mat, ImageFault>;

ImageFault unreadable(const std::filesystem::path& path, const std::string& expected, const std::string& found) {
  return {"unreadable image", base::expectedFound(path.string(), expected, found)};
}

MatResult readMat(const std::filesystem::path& path, int flags) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return ImageFault{"missing image", base::expectedFound(path.string(), "an image", "none")};
  const Bytes bytes((std::istreambuf_iterator<char>(file)), {});
  if (bytes.empty()) return unreadable(path, "an image", "an empty file");
  if (!isWhole(bytes)) return unreadable(path, "a whole image", "a cut or damaged one");
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) return unreadable(path, "an image", "other or damaged content");
  return image;
}

template <typename Pixel>
sensors::Image<Pixel> converted(const cv::Mat& source, double factor) {
  sensors::Image<Pixel> image(source.cols, source.rows);
  cv::Mat target = wrap(image);
  source.convertTo(target, target.type(), factor);
  return image;
}

}  // namespace

sensors::Image<sensors::Rgb> toColor(const cv::Mat& image) {
  if (image.empty() || image.depth() != CV_8U || image.channels() == 2 || image.channels() > 4) return {};
  sensors::Image<sensors::Rgb> color(image.cols, image.rows);
  cv::Mat target(image.rows, image.cols, CV_8UC3, color.data());
  const auto code = image.channels() == 1   ? cv::COLOR_GRAY2RGB
                    : image.channels() == 3 ? cv::COLOR_BGR2RGB
                                            : cv::COLOR_BGRA2RGB;
  cv::cvtColor(image, target, code);
  return color;
}

cv::Mat toBgr(const sensors::Image<sensors::Rgb>& image) {
  static_assert(sizeof(sensors::Rgb) == 3);
  const cv::Mat source(image.height(), image.width(), CV_8UC3, const_cast<sensors::Rgb*>(image.data()));
  cv::Mat bgr;
  cv::cvtColor(source, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

ImageResult<sensors::Rgb> readColorImage(const std::filesystem::path& path) {
  const auto result = readMat(path, cv::IMREAD_COLOR);
  if (const auto* fault = std::get_if<ImageFault>(&result)) return *fault;
  return toColor(std::get<cv::Mat>(result));
}

ImageResult<float> readDepthImage(const std::filesystem::path& path, double unitsPerMetre) {
  const auto result = readMat(path, cv::IMREAD_UNCHANGED);
  if (const auto* fault = std::get_if<ImageFault>(&result)) return *fault;
  const auto& image = std::get<cv::Mat>(result);
  if (image.type() != CV_16UC1) return unreadable(path, "a depth image of one channel of 16 bits", "another kind");
  return converted<float>(image, 1.0 / unitsPerMetre);
}

ImageResult<std::uint16_t> readLabelImage(const std::filesystem::path& path) {
  const auto result = readMat(path, cv::IMREAD_UNCHANGED);
  if (const auto* fault = std::get_if<ImageFault>(&result)) return *fault;
  const auto& image = std::get<cv::Mat>(result);
  if (image.type() != CV_16UC1 && image.type() != CV_8UC1) {
    return unreadable(path, "a label image of one channel of 8 or 16 bits", "another kind");
  }
  return converted<std::uint16_t>(image, 1.0);
}

}  // namespace prodomos::io
