// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/png_image.hpp"

#include "prodomos/base/error.hpp"

#include <png.h>

#include <memory>
#include <vector>

namespace prodomos::exporter {
namespace {

// libpng leaves its functions by longjmp on errors unless told to do otherwise; C++ wants an exception.
[[noreturn]] void fail(png_structp, png_const_charp text) {
  throw base::Error(std::string("PNG: ") + text);
}
void ignore(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}
void flush(png_structp) {}

/// One file in the making.
class PngWriter {
 public:
  PngWriter(int width, int height, int bitDepth, int colorType)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore)),
        info_(png_create_info_struct(png_)) {
    png_set_write_fn(png_, &bytes_, append, flush);
    png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bitDepth, colorType,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  png_structp png() { return png_; }
  png_infop info() { return info_; }
  std::string finish() {
    png_write_end(png_, nullptr);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
  png_structp png_;
  png_infop info_;
};

}  // namespace

std::string encodePng(const sensors::Image<map::Rgba>& pixels) {
  static_assert(sizeof(map::Rgba) == 4);
  PngWriter writer(pixels.width(), pixels.height(), 8, PNG_COLOR_TYPE_RGBA);
  png_write_info(writer.png(), writer.info());
  for (int y = 0; y < pixels.height(); ++y) {
    png_write_row(writer.png(), reinterpret_cast<png_const_bytep>(pixels.row(y)));
  }
  return writer.finish();
}

std::string encodePng(const sensors::Image<std::uint8_t>& indices, const Palette& palette) {
  PngWriter writer(indices.width(), indices.height(), 4, PNG_COLOR_TYPE_PALETTE);
  std::array<png_color, 16> colors{};
  for (std::size_t i = 0; i < palette.size(); ++i) colors[i] = {palette[i].r, palette[i].g, palette[i].b};
  png_set_PLTE(writer.png(), writer.info(), colors.data(), static_cast<int>(colors.size()));
  png_set_compression_level(writer.png(), 9);
  png_write_info(writer.png(), writer.info());
  png_set_packing(writer.png());
  for (int y = 0; y < indices.height(); ++y) png_write_row(writer.png(), indices.row(y));
  return writer.finish();
}

}  // namespace prodomos::exporter
