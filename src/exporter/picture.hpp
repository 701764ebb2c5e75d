// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/drawing.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <variant>
#include <vector>

/// A drawing as a list of shapes on a page: described once, rendered as SVG or PNG. Units are those of the page (about
/// a pixel on a screen), x to the right, y down.
namespace prodomos::exporter {

using Point = Eigen::Vector2d;

struct Style {
  std::optional<map::Rgba> fill{};
  std::optional<map::Rgba> stroke{};
  double width = 1.0;            ///< of the stroke
  std::vector<double> dashes{};  ///< on, off, …; empty: solid
};

inline Style filled(map::Rgba color) {
  return {.fill = color};
}
inline Style stroked(map::Rgba color, double width, std::vector<double> dashes = {}) {
  return {.stroke = color, .width = width, .dashes = std::move(dashes)};
}
inline Style filledAndStroked(map::Rgba fill, map::Rgba stroke, double width, std::vector<double> dashes = {}) {
  return {.fill = fill, .stroke = stroke, .width = width, .dashes = std::move(dashes)};
}

struct Line {
  std::vector<Point> points{};
  bool closed = false;
  Style style;
  std::string tip{};  ///< shown by browsers when pointed at
};

struct Circle {
  Point centre = Point::Zero();
  double radius = 1.0;
  Style style;
  std::string tip{};
};

enum class Anchor { kStart, kMiddle, kEnd };

struct Text {
  Point at = Point::Zero();  ///< on the base line
  std::string text{};
  double size = 10.0;
  map::Rgba color{};
  Anchor anchor = Anchor::kStart;
  bool bold = false;
  bool halo = false;  ///< a white rim, for text over drawings
};

/// An image of square pixels, the first row on top.
struct Raster {
  Point corner = Point::Zero();  ///< upper left
  double pixelSize = 1.0;
  sensors::Image<map::Rgba> pixels{};
};

using Shape = std::variant<Line, Circle, Text, Raster>;

/// A layer of the drawing; its name is the id of its group in the SVG.
struct Group {
  std::string name;
  std::vector<Shape> shapes{};
};

struct Picture {
  double width = 0.0;
  double height = 0.0;
  std::string title{};
  std::vector<Group> groups{};
};

/// About how wide the text will be: rendering alone knows the font.
double textWidth(std::string_view text, double size);

std::string toSvg(const Picture& picture);
/// `scale` pixels a unit.
std::string toPng(const Picture& picture, double scale);
std::string toPng(const sensors::Image<map::Rgba>& image);

}  // namespace prodomos::exporter
