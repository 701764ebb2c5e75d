// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/palette.hpp"
#include "exporter/picture.hpp"
#include "exporter/text.hpp"

#include <algorithm>

namespace prodomos::exporter {
namespace {

std::string attribute(std::string_view name, std::string_view value) {
  return ' ' + std::string(name) + "=\"" + xml(value) + '"';
}

std::string attribute(std::string_view name, double value) {
  return attribute(name, brief(value, 2));
}

std::string paint(std::string_view name, const std::optional<map::Rgba>& color) {
  if (!color) return attribute(name, "none");
  std::string text = attribute(name, hex(*color));
  if (color->a != 255) text += attribute(std::string(name) + "-opacity", color->a / 255.0);
  return text;
}

std::string attributes(const Style& style) {
  std::string text = paint("fill", style.fill);
  if (!style.stroke) return text;
  text += paint("stroke", style.stroke) + attribute("stroke-width", style.width);
  std::string dashes;
  for (const double dash : style.dashes) dashes += (dashes.empty() ? "" : " ") + brief(dash, 2);
  return dashes.empty() ? text : text + attribute("stroke-dasharray", dashes);
}

std::string element(std::string_view name, const std::string& attributes, std::string_view tip) {
  const std::string start = "<" + std::string(name) + attributes;
  if (tip.empty()) return start + "/>\n";
  return start + "><title>" + xml(tip) + "</title></" + std::string(name) + ">\n";
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      triple = triple << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[triple >> (18U - 6U * k) & 63U] : '=';
  }
  return text;
}

struct SvgElement {
  std::string operator()(const Line& line) const {
    std::string path;
    for (const auto& point : line.points) {
      path += (path.empty() ? 'M' : 'L') + brief(point.x(), 2) + ' ' + brief(point.y(), 2);
    }
    return element("path", attribute("d", line.closed ? path + 'Z' : path) + attributes(line.style), line.tip);
  }
  std::string operator()(const Circle& circle) const {
    return element("circle",
                   attribute("cx", circle.centre.x()) + attribute("cy", circle.centre.y()) +
                       attribute("r", circle.radius) + attributes(circle.style),
                   circle.tip);
  }
  std::string operator()(const Text& text) const {
    constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
    std::string start = attribute("x", text.at.x()) + attribute("y", text.at.y()) + attribute("font-size", text.size) +
                        paint("fill", text.color);
    if (text.anchor != Anchor::kStart) start += attribute("text-anchor", kAnchors[static_cast<int>(text.anchor)]);
    if (text.bold) start += attribute("font-weight", "bold");
    if (text.halo) {
      start += attribute("stroke", "#ffffff") + attribute("stroke-width", text.size / 4) +
               attribute("paint-order", "stroke") + attribute("stroke-linejoin", "round");
    }
    return "<text" + start + '>' + xml(text.text) + "</text>\n";
  }
  std::string operator()(const Raster& raster) const {
    return element("image",
                   attribute("x", raster.corner.x()) + attribute("y", raster.corner.y()) +
                       attribute("width", raster.pixels.width() * raster.pixelSize) +
                       attribute("height", raster.pixels.height() * raster.pixelSize) +
                       attribute("preserveAspectRatio", "none") + attribute("style", "image-rendering:pixelated") +
                       attribute("href", "data:image/png;base64," + base64(toPng(raster.pixels))),
                   "");
  }
};

}  // namespace

double textWidth(std::string_view text, double size) {
  const auto isStart = [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; };  // of a character
  return 0.6 * size * static_cast<double>(std::ranges::count_if(text, isStart));
}

std::string toSvg(const Picture& picture) {
  const std::string width = brief(picture.width, 2);
  const std::string height = brief(picture.height, 2);
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"" +
      attribute("width", width) + attribute("height", height) + attribute("viewBox", "0 0 " + width + ' ' + height) +
      attribute("font-family", "DejaVu Sans, Verdana, sans-serif") + attribute("stroke-linecap", "round") +
      attribute("stroke-linejoin", "round") + ">\n<title>" + xml(picture.title) + "</title>\n";
  for (const auto& group : picture.groups) {
    text += "<g" + attribute("id", group.name) + ">\n";
    for (const auto& shape : group.shapes) text += std::visit(SvgElement{}, shape);
    text += "</g>\n";
  }
  return text + "</svg>\n";
}

}  // namespace prodomos::exporter
