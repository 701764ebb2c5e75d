// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/contents.hpp"
#include "exporter/drawn_objects.hpp"
#include "exporter/formats.hpp"
#include "exporter/mrpt_file.hpp"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

namespace prodomos::exporter {
namespace {

/// MRPT counts steps of 100 ns since 1601.
mrpt::Clock::time_point toMrpt(base::Time time) {
  constexpr std::int64_t kEpoch = 116'444'736'000'000'000;
  return mrpt::Clock::time_point(mrpt::Clock::duration(base::toNanoseconds(time) / 100 + kEpoch));
}

/// All points that the layers of the sub-map draw.
mrpt::maps::CPointsMap::Ptr pointsOf(const map::MapView& view, base::SubMapId submap) {
  constexpr float kUnit = 1.0F / 255.0F;
  auto points = mrpt::maps::CColouredPointsMap::Create();
  for (const auto& type : view.layersOf(submap)) {
    const auto layer = view.findLayer(submap, type);
    if (!layer) continue;
    for (const auto& [position, color] : layer->draw().points) {
      points->insertPointRGB(position.x(), position.y(), position.z(), static_cast<float>(color.r) * kUnit,
                             static_cast<float>(color.g) * kUnit, static_cast<float>(color.b) * kUnit);
    }
  }
  return points;
}

}  // namespace

void writeSimplemap(const map::MapView& view, const Path& path) {
  mrpt::maps::CSimpleMap simplemap;
  for (const auto& node : observedNodes(view)) {
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->sensorLabel = toString(node.id);
    cloud->timestamp = toMrpt(node.begin);
    cloud->pointcloud = pointsOf(view, node.id);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(cloud);
    simplemap.insert(mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(node.T_map_submap)), frame);
  }
  writeMrptFile(path, simplemap);
}

}  // namespace prodomos::exporter
