// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/drawn_objects.hpp"

#include "exporter/palette.hpp"

#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/opengl/CTexturedPlane.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace prodomos::exporter {
namespace {

using mrpt::opengl::CSetOfObjects;

// Textures are filled up to powers of two; small tiles waste little, and those where nothing is known are left out.
constexpr int kTile = 256;

struct Tile {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

mrpt::opengl::CTexturedPlane::Ptr toPlane(const map::DrawnRaster& raster, const Tile& tile) {
  mrpt::img::CImage color(tile.width, tile.height, mrpt::img::CH_RGB);
  mrpt::img::CImage opacity(tile.width, tile.height, mrpt::img::CH_GRAY);
  bool visible = false;
  for (int y = 0; y < tile.height; ++y) {
    const auto* pixel = raster.pixels.row(tile.y + y) + tile.x;
    auto* bgr = color.ptrLine<std::uint8_t>(static_cast<unsigned>(y));
    auto* alpha = opacity.ptrLine<std::uint8_t>(static_cast<unsigned>(y));
    for (int x = 0; x < tile.width; ++x, ++pixel) {
      // Between pixels colours are mixed: transparent black would draw dark rims.
      const auto shown = pixel->a == 0 ? kFreeColor : *pixel;
      *bgr++ = shown.b;
      *bgr++ = shown.g;
      *bgr++ = shown.r;
      *alpha++ = pixel->a;
      visible |= pixel->a != 0;
    }
  }
  if (!visible) return nullptr;
  const auto at = [&](double corner, int cells) { return static_cast<float>(corner + cells * raster.resolution); };
  auto plane = mrpt::opengl::CTexturedPlane::Create(
      at(raster.corner_in_submap.x(), tile.x), at(raster.corner_in_submap.x(), tile.x + tile.width),
      at(raster.corner_in_submap.y(), tile.y), at(raster.corner_in_submap.y(), tile.y + tile.height));
  plane->assignImage(std::move(color), std::move(opacity));
  return plane;
}

void addRaster(const map::DrawnRaster& raster, CSetOfObjects& objects) {
  for (int y = 0; y < raster.pixels.height(); y += kTile) {
    for (int x = 0; x < raster.pixels.width(); x += kTile) {
      const Tile tile{x, y, std::min(kTile, raster.pixels.width() - x), std::min(kTile, raster.pixels.height() - y)};
      if (auto plane = toPlane(raster, tile)) objects.insert(plane);
    }
  }
}

void addPoints(const std::vector<map::DrawnPoint>& points, const Pen& pen, CSetOfObjects& objects) {
  if (points.empty()) return;
  auto cloud = mrpt::opengl::CPointCloudColoured::Create();
  cloud->reserve(points.size());
  for (const auto& [position, color] : points) {
    cloud->insertPoint({position.x(), position.y(), position.z(), color.r, color.g, color.b, color.a});
  }
  cloud->setPointSize(pen.line(1.2));
  cloud->enableVariablePointSize(false);
  objects.insert(cloud);
}

void addBox(const map::DrawnBox& box, const Pen& pen, CSetOfObjects& objects) {
  const Eigen::Vector3d half = 0.5 * box.size;
  auto object = mrpt::opengl::CBox::Create(toMrpt(Eigen::Vector3d(-half)), toMrpt(half));
  object->setPose(toMrpt(box.T_submap_box));
  object->setColor_u8(toMrpt(box.color));
  object->enableBoxBorder(true);
  object->setBoxBorderColor(toMrpt(map::Rgba{box.color.r, box.color.g, box.color.b, 255}));
  objects.insert(object);
  if (box.label.empty()) return;
  const Eigen::Vector3d top = box.T_submap_box * Eigen::Vector3d(0.0, 0.0, half.z());
  objects.insert(toLabel(box.label, top, box.color, pen));
}

/// Lines of one colour are one object: a scene of many small objects draws slowly.
void addLines(const std::vector<map::DrawnLine>& lines, const Pen& pen, CSetOfObjects& objects) {
  std::map<std::tuple<int, int, int, int>, mrpt::opengl::CSetOfLines::Ptr> byColor;
  for (const auto& line : lines) {
    auto& set = byColor[{line.color.r, line.color.g, line.color.b, line.color.a}];
    if (!set) {
      set = mrpt::opengl::CSetOfLines::Create();
      set->setColor_u8(toMrpt(line.color));
      set->setLineWidth(pen.line(1.8));
      objects.insert(set);
    }
    for (std::size_t i = 1; i < line.points_in_submap.size(); ++i) {
      set->appendLine(toMrpt(line.points_in_submap[i - 1]), toMrpt(line.points_in_submap[i]));
    }
    if (!line.label.empty() && !line.points_in_submap.empty()) {
      objects.insert(toLabel(line.label, line.points_in_submap.front(), line.color, pen));
    }
  }
}

}  // namespace

mrpt::poses::CPose3D toMrpt(const geometry::Pose3& pose) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(pose.matrix()));
}

mrpt::math::TPoint3D toMrpt(const Eigen::Vector3d& point) {
  return {point.x(), point.y(), point.z()};
}

mrpt::img::TColor toMrpt(map::Rgba color) {
  return {color.r, color.g, color.b, color.a};
}

mrpt::opengl::CRenderizable::Ptr toLabel(const std::string& text, const Eigen::Vector3d& position, map::Rgba color,
                                         const Pen& pen) {
  auto label = mrpt::opengl::CText::Create(text);
  label->setFont("sans", pen.text());
  label->setColor_u8(color.r, color.g, color.b);
  label->setLocation(toMrpt(position));
  return label;
}

mrpt::opengl::CSetOfObjects::Ptr toObjects(const map::Drawing& drawing, const Pen& pen) {
  auto objects = CSetOfObjects::Create();
  for (const auto& raster : drawing.rasters) addRaster(raster, *objects);
  addPoints(drawing.points, pen, *objects);
  for (const auto& box : drawing.boxes) addBox(box, pen, *objects);
  addLines(drawing.lines, pen, *objects);
  return objects;
}

}  // namespace prodomos::exporter
