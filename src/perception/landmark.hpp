// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/perception/entity_memory.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// What doors and staircases that are remembered have in common.
namespace prodomos::perception {

/// What readings from nearly one place say of a landmark. Such readings err alike, so they are summed up here, and
/// count little more than one of them.
struct Look {
  base::SubMapId submap;
  bool ofGrid = false;                                         ///< the sub-map's grid, wherever the robot is
  Eigen::Vector3d sensor_in_submap = Eigen::Vector3d::Zero();  ///< of the first reading
  int sightings = 0;
  int misses = 0;         ///< readings that should have shown it
  double evidence = 0.0;  ///< sum of log-odds, of sightings and misses

  /// The number of independent readings that n of this look are worth: 1 … 1 / correlation.
  static double worth(int n, double correlation) { return n / (1.0 + (n - 1) * correlation); }
  /// Log-odds that all of this look is worth.
  double logOdds(double correlation) const {
    const int n = sightings + misses;
    return n == 0 ? 0.0 : evidence / n * worth(n, correlation);
  }

  static void fields(auto& archive, auto& self) {
    archive(self.submap, self.ofGrid, self.sensor_in_submap, self.sightings, self.misses, self.evidence);
  }
};

/// Something that changed of a landmark at a time, to be told once the landmark is sure.
struct Tiding {
  base::Time time{};
  map::DoorState state = map::DoorState::kUnknown;  ///< of "door_state"; unknown: it was detected

  static void fields(auto& archive, auto& self) { archive(self.time, self.state); }
};

struct Landmark {
  std::optional<base::EntityId> id;  ///< from when it is sure
  base::SubMapId submap;             ///< in which it was seen best: its estimate is in that frame
  double logOdds = 0.0;              ///< that it is there
  int observations = 0;
  base::Time firstSeen{};
  base::Time lastSeen{};
  base::Time lastDetected{};    ///< by a detector
  std::vector<Tiding> tidings;  ///< not yet told
  bool isTold = false;          ///< the map knows of it
  bool hasChanged = false;      ///< since it was told last

  /// One more reading in which it was detected.
  void noteDetection(base::Time time);
  /// What is known of another one that turned out to be this one.
  void takeOver(const Landmark& other);
  /// All but pose and attributes.
  map::Entity entity() const;

  static void fields(auto& archive, auto& self) {
    archive(self.id, self.submap, self.logOdds, self.observations, self.firstSeen, self.lastSeen, self.lastDetected,
            self.tidings, self.isTold, self.hasChanged);
  }
};

/// Of two that turn out to be one the older is kept: first the one that the map has, then the one seen first.
bool isOlder(const Landmark& a, const Landmark& b);

/// Where sub-maps lie, seen from one of them.
class Frames {
 public:
  Frames(base::SubMapId submap, const EntityMemory::SubMapPoses& poses)
      : submap_(submap), T_submap_map_(poses(submap).inverse()), poses_(poses) {}

  base::SubMapId submap() const { return submap_; }
  const geometry::Pose3& T_submap_other(base::SubMapId other) const;
  Frames seenFrom(base::SubMapId submap) const { return {submap, poses_}; }

 private:
  base::SubMapId submap_;
  geometry::Pose3 T_submap_map_;
  const EntityMemory::SubMapPoses& poses_;
  mutable std::map<base::SubMapId, geometry::Pose3> others_;
};

/// Of readings; each sub-map's grid has one more.
inline constexpr std::size_t kMostLooks = 24;

template <typename AnyLook>
std::size_t countOfReadings(const std::vector<AnyLook>& looks) {
  return looks.size() - static_cast<std::size_t>(std::ranges::count_if(looks, &AnyLook::ofGrid));
}

/// The one with the fewest sightings. There must be one.
template <typename AnyLook>
auto poorestOfReadings(std::vector<AnyLook>& looks) {
  const auto sightings = [](const AnyLook& look) {
    return look.ofGrid ? std::numeric_limits<int>::max() : look.sightings;
  };
  return std::ranges::min_element(looks, {}, sightings);
}

/// The look that a reading from there belongs to, a new one where the robot has moved on. There are at most
/// `kMostLooks`: beyond, what lies nearest takes it.
template <typename AnyLook>
AnyLook& lookFrom(std::vector<AnyLook>& looks, base::SubMapId submap, const Eigen::Vector3d& sensor_in_submap,
                  double spacing) {
  AnyLook* nearest = nullptr;
  double least = 0.0;
  for (auto& look : looks) {
    if (look.ofGrid || look.submap != submap) continue;
    const double distance = (look.sensor_in_submap - sensor_in_submap).norm();
    if (nearest != nullptr && distance >= least) continue;
    nearest = &look;
    least = distance;
  }
  const bool areMany = countOfReadings(looks) >= kMostLooks;
  if (nearest != nullptr && (least < spacing || areMany)) return *nearest;
  if (areMany) looks.erase(poorestOfReadings(looks));  // all of other sub-maps: the poorest one goes
  auto& look = looks.emplace_back();
  look.submap = submap;
  look.sensor_in_submap = sensor_in_submap;
  return look;
}

template <typename AnyLook>
AnyLook& lookOfGrid(std::vector<AnyLook>& looks, base::SubMapId submap) {
  const auto found = std::ranges::find_if(looks, [submap](const auto& l) { return l.ofGrid && l.submap == submap; });
  if (found != looks.end()) return *found;
  auto& look = looks.emplace_back();
  look.submap = submap;
  look.ofGrid = true;
  return look;
}

/// Sum over independent looks.
template <typename AnyLook>
double logOddsOf(const std::vector<AnyLook>& looks, const EntityMemoryConfig& config) {
  double sum = config.prior;
  for (const auto& look : looks) sum += look.logOdds(config.correlation);
  return sum;
}

/// A look at where it should be, and is not: that much log-odds speak against it.
template <typename AnyLandmark>
void countMiss(AnyLandmark& landmark, base::SubMapId submap, const Eigen::Vector3d& sensor_in_submap, double evidence,
               const EntityMemoryConfig& config) {
  auto& look = lookFrom(landmark.looks, submap, sensor_in_submap, config.lookSpacing);
  look.evidence -= evidence;
  ++look.misses;
  landmark.logOdds = logOddsOf(landmark.looks, config);
  landmark.hasChanged = true;
}

/// Of (x, y, z, yaw) of a sub-map against another one, for a thing `reach` metres from the origin.
Eigen::Matrix4d uncertaintyBetween(const EntityMemoryConfig& config, double reach);

using Vector4 = Eigen::Vector4d;  ///< x, y, z, yaw
Vector4 vectorOf(const geometry::Pose3& pose);
geometry::Pose3 poseOf(const Vector4& vector);
/// Of (x, y, z, yaw), from b's axes into a's.
Eigen::Matrix4d turned(const geometry::Pose3& T_a_b, const Eigen::Matrix4d& covariance_in_b);
/// As map::Entity has it; roll and pitch of a level thing are known.
Eigen::Matrix<double, 6, 6> covariance6(const Eigen::Matrix4d& covariance);

bool isCovariance(const Eigen::Matrix4d& covariance);

inline double logistic(double logOdds) {
  return 1.0 / (1.0 + std::exp(-logOdds));
}

}  // namespace prodomos::perception
