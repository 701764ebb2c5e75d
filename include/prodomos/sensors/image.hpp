// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace prodomos::sensors {

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  bool operator==(const Rgb&) const = default;
};

/// A row-major image, rows without padding, so that cv::Mat(height(), width(), type, data()) wraps it without a copy.
/// Copies share their pixels (cheap); nobody writes to an image once it is part of a reading. clone() copies.
template <typename Pixel>
class Image {
 public:
  Image() = default;
  Image(int width, int height, Pixel fill = Pixel{})
      : width_(width), height_(height), pixels_(std::make_shared<Pixel[]>(size(), fill)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return width_ == 0 || height_ == 0; }
  std::size_t size() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }

  Pixel* data() { return pixels_.get(); }
  const Pixel* data() const { return pixels_.get(); }
  Pixel* row(int y) { return data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_); }
  const Pixel* row(int y) const { return data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_); }
  std::span<const Pixel> pixels() const { return {data(), size()}; }

  Pixel& operator()(int x, int y) { return row(y)[checked(x, y)]; }
  const Pixel& operator()(int x, int y) const { return row(y)[checked(x, y)]; }

  Image clone() const {
    Image copy(width_, height_);
    std::copy_n(data(), size(), copy.data());
    return copy;
  }

 private:
  std::size_t checked(int x, [[maybe_unused]] int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    return static_cast<std::size_t>(x);
  }

  int width_ = 0;
  int height_ = 0;
  std::shared_ptr<Pixel[]> pixels_;
};

}  // namespace prodomos::sensors
