// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/id.hpp"
#include "prodomos/geometry/pose.hpp"
#include "prodomos/map/entity.hpp"
#include "prodomos/map/occupancy_grid.hpp"
#include "prodomos/map/records.hpp"
#include "prodomos/perception/person_sighting.hpp"

#include <array>
#include <optional>
#include <vector>

namespace prodomos::perception {

/// Where a person was at one time, as written to the map.
struct FollowedState {
  base::Time time{};
  base::SubMapId submap;
  Eigen::Vector3d position_in_submap = Eigen::Vector3d::Zero();
  double heading = 0.0;
  double sureOfFront = 0.0;  ///< log-odds of the heading against its opposite
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  std::array<std::optional<Eigen::Vector3d>, kJointCount> joints_in_submap{};

  static void fields(auto& archive, auto& self) {
    archive(self.time, self.submap, self.position_in_submap, self.heading, self.sureOfFront, self.velocity,
            self.joints_in_submap);
  }
};

/// One person that is followed. Position and velocity: a Kalman filter of constant velocity; heading: one on the
/// circle, whose front and back are told by all that speaks for either.
class PersonTrack {
 public:
  PersonTrack() = default;
  PersonTrack(base::SubMapId submap, const PersonSighting& sighting);

  /// Of the sighting's position from where the person is expected at that time, in standard deviations, squared.
  double distance(const PersonSighting& sighting) const;
  /// In metres from the filter's position.
  double metresFrom(const PersonSighting& sighting) const;
  /// Of clothes, 0 … 1; none where either is not known.
  std::optional<double> likeness(const Appearance& appearance) const;

  /// Moves the filter on to that time.
  void predict(base::Time time);
  void update(base::SubMapId submap, const PersonSighting& sighting);
  /// In that reading it was not seen, though it is expected to be there.
  void miss(base::Time time);
  /// 002 §II-E: the side with the smaller clearance.
  void lookAround(const map::OccupancyGrid& grid);
  /// Into another sub-map's frame.
  void enter(const geometry::Pose3& T_submap_before);
  /// Goes on as the person that `other` followed before.
  void takeOver(PersonTrack&& other);

  base::Time lastSeen() const { return last_.time; }
  Eigen::Vector2d position() const { return state_.head<2>(); }
  const Appearance& appearance() const { return appearance_; }
  bool isConfirmed() const { return track.value >= 0; }
  /// Seen often enough, and, where it must, on the move.
  bool isConvincing() const;

  map::Entity entity() const;
  /// What there is to be written, and is not yet.
  std::vector<map::TrackState> takeStates();

  static void fields(auto& archive, auto& self) {
    archive(self.track, self.entityId, self.hasChanged, self.state_, self.covariance_, self.floor_z_, self.time_,
            self.heading_, self.headingVariance_, self.front_, self.hasHeading_, self.appearance_, self.doubt_,
            self.sightings_, self.mustMove_, self.start_, self.startTime_, self.firstSeen_, self.sides_, self.last_,
            self.missed_, self.pending_);
  }

  base::TrackId track{-1};
  base::EntityId entityId{-1};
  bool hasChanged = false;  ///< since the entity was written

 private:
  void watchForMotion(const PersonSighting& sighting);
  void updatePosition(const PersonSighting& sighting);
  void updateHeading(const PersonSighting& sighting);
  void mergeHeading(double heading, double sigma, double facing);
  void turnRound();
  void fillGap(const FollowedState& now);
  FollowedState stateNow(base::SubMapId submap, const PersonSighting& sighting) const;

  Eigen::Vector4d state_ = Eigen::Vector4d::Zero();  ///< x, y and their velocities, in the current sub-map
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Identity();
  double floor_z_ = 0.0;
  base::Time time_{};  ///< of the filter
  double heading_ = 0.0;
  double headingVariance_ = 0.0;
  double front_ = 0.0;  ///< log-odds of the heading against its opposite
  bool hasHeading_ = false;
  Appearance appearance_{};
  double doubt_ = 1.0;  ///< probability that all sightings were of something else
  int sightings_ = 0;
  bool mustMove_ = false;
  Eigen::Vector2d start_ = Eigen::Vector2d::Zero();  ///< where it was a moment ago,
  base::Time startTime_{};                           ///< and when
  base::Time firstSeen_{};
  double sides_ = 0.0;  ///< readings in which the right side was nearer to something, less those with the left
  FollowedState last_;  ///< where it was seen last
  std::vector<base::Time> missed_;  ///< readings since
  std::vector<FollowedState> pending_;
};

}  // namespace prodomos::perception
