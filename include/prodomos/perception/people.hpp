// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/config.hpp"
#include "prodomos/map/map_store.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/perception/debug_images.hpp"
#include "prodomos/perception/rgbd_view.hpp"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace prodomos::perception {

struct PeopleConfig {
  bool enabled = true;
  std::string models;       ///< folder of the networks (datasets/README); empty: people are not looked for in images
  bool fromLabels = false;  ///< from label images in place of the networks
  bool fromLaser = true;    ///< legs in laser scans, where the log has no images
};

void describe(base::ConfigVisitor& visitor, PeopleConfig& config);

inline constexpr int kJointCount = 14;  ///< in the order of docs/people.md

/// A person as one reading shows it.
struct PersonSighting {
  base::Time time{};
  Eigen::Vector3d position_in_submap = Eigen::Vector3d::Zero();  ///< below the middle of the body, on the floor, metres
  double positionSigma = 0.0;                                    ///< metres, in the plane
  std::optional<double> heading;                                 ///< of the torso in the sub-map, radians
  double headingSigma = 0.0;
  double score = 0.0;  ///< 0 … 1
  std::array<std::optional<Eigen::Vector3d>, kJointCount> joints_in_submap{};
  std::array<float, 24> appearance{};  ///< of the clothes; all 0: not known
};

/// People in images: boxes of one network, key points of another, depth. Not to be copied; throws base::FileError
/// naming the file where the folder lacks a model or one does not load.
class PersonDetector {
 public:
  explicit PersonDetector(const PeopleConfig& config);
  ~PersonDetector();
  PersonDetector(PersonDetector&&) noexcept;
  PersonDetector& operator=(PersonDetector&&) noexcept;

  std::vector<PersonSighting> find(const RgbdView& view, DebugImages* debug = nullptr);
  /// Key points and boxes of side files in place of those of the networks.
  std::vector<PersonSighting> find(const RgbdView& view, const sensors::KeyPoints& keyPoints,
                                   DebugImages* debug = nullptr) const;
  /// From the frame's label images, by class name "person".
  std::vector<PersonSighting> findInLabels(const RgbdView& view, const sensors::ClassTable& classes) const;

 private:
  class Networks;
  std::unique_ptr<Networks> networks_;
};

/// Legs: pairs of arcs of a level scan, as a person shows them.
std::vector<PersonSighting> findLegs(const sensors::LaserScan& scan, const geometry::Pose3& T_submap_body,
                                     base::Time time);

/// Follows persons: identity, smoothed position, heading, velocity (002 §II-E).
class PersonTracker {
 public:
  PersonTracker(base::SessionId session, std::int64_t firstTrack);
  ~PersonTracker();
  PersonTracker(PersonTracker&&) noexcept;
  PersonTracker& operator=(PersonTracker&&) noexcept;

  /// The sightings of one reading, none included, in time. `grid`: of the sub-map, for the dominant side; may be null.
  void add(base::SubMapId submap, base::Time time, const std::vector<PersonSighting>& sightings,
           const geometry::Pose3& T_submap_sensor, const map::OccupancyGrid* grid);
  /// The robot goes on into another sub-map: those followed come along.
  void enter(base::SubMapId submap, const geometry::Pose3& T_submap_before);

  /// Those followed long enough, as map::Human entities where they were last seen; ids as their tracks'.
  std::vector<map::Entity> entities() const;
  /// Tracks with the states since the last call, and entities that changed.
  void addTo(map::MapChange& change);

  void save(base::ByteWriter& out) const;
  void load(base::ByteReader& in);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace prodomos::perception
