// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/svg.hpp"

#include <array>
#include <charconv>

namespace prodomos::evaluation {

namespace {

std::string quoted(double pixels) {
  return "\"" + fixed(pixels, 1) + "\"";
}

std::string listOf(const Svg::Points& points) {
  std::string list;
  for (const auto& point : points) {
    list += (list.empty() ? "" : " ") + fixed(point.x(), 1) + "," + fixed(point.y(), 1);
  }
  return "points=\"" + list + "\"";
}

}  // namespace

std::string fixed(double value, int decimals) {
  std::array<char, 400> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals).ptr;
  std::string text(buffer.data(), end);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

void Svg::open(std::string_view mark) {
  body_ += "<g class=\"" + std::string(mark) + "\">\n";
}

void Svg::close() {
  body_ += "</g>\n";
}

void Svg::add(std::string_view element, const std::string& attributes, std::string_view mark, std::string_view title) {
  body_ += "<" + std::string(element) + " class=\"" + std::string(mark) + "\" " + attributes;
  body_ += title.empty() ? "/>\n" : "><title>" + escaped(title) + "</title></" + std::string(element) + ">\n";
}

void Svg::polygon(const Points& corners, std::string_view mark, std::string_view title, std::string_view style) {
  const std::string styled = style.empty() ? "" : " style=\"" + std::string(style) + "\"";
  add("polygon", listOf(corners) + styled, mark, title);
}

void Svg::polyline(const Points& points, std::string_view mark, std::string_view title) {
  add("polyline", listOf(points), mark, title);
}

void Svg::circle(const Eigen::Vector2d& middle, double radius, std::string_view mark, std::string_view title) {
  add("circle", "cx=" + quoted(middle.x()) + " cy=" + quoted(middle.y()) + " r=" + quoted(radius), mark, title);
}

void Svg::text(const Eigen::Vector2d& at, std::string_view text, std::string_view mark) {
  body_ += "<text class=\"" + std::string(mark) + "\" x=" + quoted(at.x()) + " y=" + quoted(at.y()) + ">" +
           escaped(text) + "</text>\n";
}

std::string Svg::str(double width, double height, std::string_view name) const {
  return "<svg viewBox=\"0 0 " + fixed(width, 0) + " " + fixed(height, 0) + "\" width=" + quoted(width) +
         " role=\"img\" aria-label=\"" + escaped(name) + "\">\n" + body_ + "</svg>";
}

}  // namespace prodomos::evaluation
