// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/map/drawing.hpp"
#include "prodomos/sensors/reading.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prodomos::map {

/// A reading together with where the robot stood.
struct PlacedReading {
  const sensors::Reading& reading;
  geometry::Pose3 T_submap_body = geometry::Pose3::Identity();
  /// Of the body while the reading was taken, in its own axes: x and y in metres a second, yaw in radians a second.
  /// What sweeps while it moves is put right by it.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  const sensors::Mask* movers = nullptr;  ///< pixels, points or beams that are of something that moves; null: none
};

/// One representation of a sub-map, in the sub-map's frame. The map file, the exporters and the viewers know no more of
/// a layer than this. A new one is a class, and a line in the table of src/map/layers.cpp.
class MapLayer {
 public:
  virtual ~MapLayer() = default;

  virtual std::string_view typeId() const = 0;  ///< "occupancy_grid"; never changes, it stands in map files
  virtual int version() const = 0;              ///< of what save() writes
  virtual std::unique_ptr<MapLayer> clone() const = 0;

  /// Takes from the reading what this layer can use. False: nothing.
  virtual bool integrate(const PlacedReading& placed) = 0;
  /// Adds another layer of the same type, seen under a pose.
  virtual void merge(const MapLayer& other, const geometry::Pose3& T_this_other) = 0;

  virtual void save(base::ByteWriter& out) const = 0;
  /// Throws base::Error where the bytes are not what save() of this or an older version wrote.
  virtual void load(base::ByteReader& in, int version) = 0;

  virtual Drawing draw() const = 0;
  /// What it holds in a few words and numbers, for `info` and the web page: {"free area", "41.2 m²"}.
  virtual std::vector<std::pair<std::string, std::string>> summary() const = 0;
};

struct LayersConfig;

/// An empty layer; null where the type is not known (a map of a later version may hold such).
std::unique_ptr<MapLayer> makeLayer(std::string_view typeId, const LayersConfig& config);

/// All types, in the order in which they are drawn.
std::vector<std::string_view> layerTypes();

}  // namespace prodomos::map
