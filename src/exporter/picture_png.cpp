// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"

#include "exporter/picture.hpp"

#include <cairo.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace prodomos::exporter {
namespace {

constexpr const char* kFont = "DejaVu Sans";

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) throw base::Error(std::string("drawing: ") + cairo_status_to_string(status));
}

Surface makeSurface(int width, int height) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height), cairo_surface_destroy);
  check(cairo_surface_status(surface.get()));
  return surface;
}

/// Cairo's pixels are native 32-bit numbers with the colours multiplied by the opacity.
std::uint32_t premultiplied(map::Rgba color) {
  const auto part = [&](std::uint32_t value) { return (value * color.a + 127U) / 255U; };
  return std::uint32_t{color.a} << 24U | part(color.r) << 16U | part(color.g) << 8U | part(color.b);
}

Surface makeSurface(const sensors::Image<map::Rgba>& image) {
  auto surface = makeSurface(image.width(), image.height());
  auto* const data = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::ptrdiff_t>(cairo_image_surface_get_stride(surface.get()));
  for (int y = 0; y < image.height(); ++y) {
    auto* const row = reinterpret_cast<std::uint32_t*>(data + y * stride);
    for (int x = 0; x < image.width(); ++x) row[x] = premultiplied(image(x, y));
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

std::string encode(const Surface& surface) {
  std::string bytes;
  const auto append = [](void* closure, const unsigned char* data, unsigned int size) {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
  };
  check(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  return bytes;
}

void setColor(cairo_t* cairo, map::Rgba color) {
  cairo_set_source_rgba(cairo, color.r / 255.0, color.g / 255.0, color.b / 255.0, color.a / 255.0);
}

void stroke(cairo_t* cairo, const Style& style) {
  setColor(cairo, *style.stroke);
  cairo_set_line_width(cairo, style.width);
  cairo_set_dash(cairo, style.dashes.data(), static_cast<int>(style.dashes.size()), 0.0);
  cairo_stroke_preserve(cairo);
}

void paint(cairo_t* cairo, const Style& style) {
  if (style.fill) {
    setColor(cairo, *style.fill);
    cairo_fill_preserve(cairo);
  }
  if (style.stroke) stroke(cairo, style);
  cairo_new_path(cairo);
}

struct Painter {
  cairo_t* cairo;

  void operator()(const Line& line) const {
    for (const auto& point : line.points) cairo_line_to(cairo, point.x(), point.y());
    if (line.closed) cairo_close_path(cairo);
    paint(cairo, line.style);
  }
  void operator()(const Circle& circle) const {
    cairo_new_sub_path(cairo);
    cairo_arc(cairo, circle.centre.x(), circle.centre.y(), circle.radius, 0.0, 2.0 * std::numbers::pi);
    paint(cairo, circle.style);
  }
  void operator()(const Text& text) const {
    cairo_select_font_face(cairo, kFont, CAIRO_FONT_SLANT_NORMAL,
                           text.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, text.size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, text.text.c_str(), &extents);
    const double shift = text.anchor == Anchor::kStart ? 0.0 : text.anchor == Anchor::kMiddle ? 0.5 : 1.0;
    cairo_move_to(cairo, text.at.x() - shift * extents.x_advance, text.at.y());
    cairo_text_path(cairo, text.text.c_str());

    if (text.halo) stroke(cairo, stroked({255, 255, 255, 255}, text.size / 4));  // below the letters
    paint(cairo, filled(text.color));
  }
  void operator()(const Raster& raster) const {
    const auto surface = makeSurface(raster.pixels);
    cairo_save(cairo);
    cairo_translate(cairo, raster.corner.x(), raster.corner.y());
    cairo_scale(cairo, raster.pixelSize, raster.pixelSize);
    cairo_set_source_surface(cairo, surface.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
    cairo_paint(cairo);
    cairo_restore(cairo);
  }
};

}  // namespace

std::string toPng(const Picture& picture, double scale) {
  const auto surface = makeSurface(static_cast<int>(std::lround(picture.width * scale)),
                                   static_cast<int>(std::lround(picture.height * scale)));
  const Context cairo(cairo_create(surface.get()), cairo_destroy);
  cairo_scale(cairo.get(), scale, scale);
  cairo_set_line_cap(cairo.get(), CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo.get(), CAIRO_LINE_JOIN_ROUND);
  for (const auto& group : picture.groups) {
    for (const auto& shape : group.shapes) std::visit(Painter{cairo.get()}, shape);
  }
  check(cairo_status(cairo.get()));
  return encode(surface);
}

std::string toPng(const sensors::Image<map::Rgba>& image) {
  return encode(makeSurface(image));
}

}  // namespace prodomos::exporter
