// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/extrapolation.hpp"

#include "prediction/free_floor.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace prodomos::prediction {

namespace {

using geometry::Pose3;

constexpr double kUsualSlope = 0.17 / 0.29;  // of flights that nobody measured
constexpr double kLeastHeight = 0.1;         // metres; less is no flight
constexpr double kLeastLevel = 0.5;          // cosine of the x-axis' slope; where it is steeper it has no heading

/// At that height over the sub-map's floor, heading as the entity does.
Pose3 levelPose(const map::Entity& entity, double floor_z) {
  return geometry::toPose3(geometry::toPose2(entity.T_submap_entity), floor_z);
}

/// 002 eq. (2): where one comes off the flight, at its top or, where it descends, at its foot.
Pose3 unseenEndOf(const map::Entity& entity, const map::Staircase& stairs) {
  const geometry::Pose2 turn{0.0, 0.0, stairs.height > 0.0 ? 0.0 : std::numbers::pi};
  const double run = map::runOf(entity).value_or(std::abs(stairs.height) / kUsualSlope);
  const geometry::Pose2 along{run / 2.0, 0.0, 0.0};
  return levelPose(entity, stairs.height) * geometry::toPose3(turn) * geometry::toPose3(along);
}

bool isPositive(double value) {
  return std::isfinite(value) && value > 0.0;
}

/// Says what makes no sense in an entity; empty: nothing.
class Fault {
 public:
  explicit Fault(const Pose3& T_submap_entity) : pose_(T_submap_entity) {}

  std::string operator()(const map::Door& door) const {
    return isPositive(door.width) ? ofPose() : "a door without width";
  }
  std::string operator()(const map::Staircase& stairs) const {
    if (!isPositive(stairs.stepWidth)) return "a staircase without width of its steps";
    if (!std::isfinite(stairs.height) || std::abs(stairs.height) < kLeastHeight) return "a staircase without height";
    return ofPose();
  }
  std::string operator()(const map::Human& human) const {
    return human.velocity.allFinite() ? ofPose() : "a human whose velocity is no number";
  }
  std::string operator()(const map::ObjectBox&) const { return ""; }
  std::string operator()(const map::Cuboid&) const { return ""; }
  std::string operator()(const map::PlanePatch&) const { return ""; }

 private:
  std::string ofPose() const {
    if (!geometry::isFinite(pose_)) return "an entity whose pose is no number";
    return pose_.linear().col(0).head<2>().norm() > kLeastLevel ? "" : "an entity without a heading";
  }

  const Pose3& pose_;
};

/// The entity as told in S_j (002 §II-C, §II-D).
map::Entity shared(map::Entity entity, const Pose3& T_i_j) {
  const Pose3 T_j_i = T_i_j.inverse();
  entity.T_submap_entity = T_j_i * entity.T_submap_entity;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T_j_i.linear();
  entity.covariance = turn * entity.covariance * turn.transpose();
  const Eigen::Isometry3f T_j_points = T_j_i.cast<float>();
  for (auto& point : entity.points_in_submap) point = T_j_points * point;
  return entity;
}

/// One model for each class.
class Model {
 public:
  Model(const map::Entity& entity, const Surroundings& around, const RoomGuess* guess,
        const ExtrapolationConfig& config)
      : entity_(entity), around_(around), guess_(guess), config_(config), T_i_here_(T_submap_here(entity)) {}

  /// 002 eq. (3), (4).
  Extrapolation operator()(const map::Door& door) const {
    const double side = door.hingeSide == map::HingeSide::kLeft    ? 1.0
                        : door.hingeSide == map::HingeSide::kRight ? -1.0
                                                                   : 0.0;
    const Eigen::Vector2d hinge(0.0, side * door.width / 2.0);
    const Eigen::Vector2d shape(config_.doorSkew * door.width, 0.0);
    return submapAhead(map::EdgeKind::kDoor, config_.doorDistance, {.width = door.width, .wall = config_.wall},
                       {hinge, config_.doorSigma, shape});
  }

  /// 002 eq. (2). Nothing is claimed over the flight itself: there is no floor at that height.
  Extrapolation operator()(const map::Staircase& stairs) const {
    return submapAhead(map::EdgeKind::kStairs, 0.0, {.width = stairs.stepWidth},
                       {Eigen::Vector2d::Zero(), config_.stairsSigma * stairs.stepWidth});
  }

  /// 002 eq. (5).
  Extrapolation operator()(const map::Human& human) const {
    const Walk walk{.states = {{.time = entity_.lastSeen,
                                .T_submap_person = geometry::toPose2(entity_.T_submap_entity),
                                .velocity_in_submap = human.velocity.head<2>()}},
                    .dominantSide = human.dominantSide,
                    .left = true};
    return std::visit([](auto&& told) -> Extrapolation { return told; },
                      prediction::extrapolate(walk, around_, config_));
  }

  Extrapolation operator()(const map::ObjectBox&) const { return NothingBeyond{}; }
  Extrapolation operator()(const map::Cuboid&) const { return NothingBeyond{}; }
  Extrapolation operator()(const map::PlanePatch&) const { return NothingBeyond{}; }

 private:
  PredictedSubMap submapAhead(map::EdgeKind kind, double distance, const Lookout& lookout,
                              const geometry::SkewNormal& density) const {
    const geometry::Pose2 T_j_here{-distance, 0.0, 0.0};
    PredictedSubMap predicted;
    predicted.T_i_j = T_i_here_ * geometry::toPose3(geometry::inverse(T_j_here));
    predicted.kind = kind;
    predicted.shared_in_j = shared(entity_, predicted.T_i_j);
    const auto* room = guess_ == nullptr ? nullptr : &guess_->probability;
    const auto pieces =
        areasOf(claimsAhead(around_, lookout, density, room, config_.leastProbability), config_.leastArea);
    if (!pieces.empty()) predicted.areas = pieces.front();
    for (auto& area : predicted.areas) area.outline_in_node = transformed(T_j_here, area.outline_in_node);
    if (guess_ != nullptr) {
      predicted.room_in_j = geometry::transformed(T_j_here, guess_->outline_here);
      predicted.expectedArea = guess_->expectedArea;
    } else if (!predicted.areas.empty()) {
      predicted.expectedArea = std::abs(geometry::signedArea(predicted.areas.front().outline_in_node));
    }
    return predicted;
  }

  const map::Entity& entity_;
  const Surroundings& around_;
  const RoomGuess* guess_;
  const ExtrapolationConfig& config_;
  Pose3 T_i_here_;
};

}  // namespace

void describe(base::ConfigVisitor& visitor, ExtrapolationConfig& config) {
  visitor.section("prediction", "what lies behind doors, beyond stairs and along people's ways");
  visitor.key("door_distance", config.doorDistance, "m", {0.0, 3.0}, "from a door to the sub-map predicted behind it");
  visitor.key("door_sigma", config.doorSigma, "m", {0.05, 10.0}, "spread of the floor predicted behind a door");
  visitor.key("door_skew", config.doorSkew, "1/m", {0.0, 100.0}, "how much of it lies ahead, by the door's width");
  visitor.key("wall", config.wall, "m", {0.0, 1.0},
              "from a leaf, and from the side of a wall that was seen, to its other side");
  visitor.key("least_probability", config.leastProbability, "", {0.0, 1.0},
              "floor behind a door is told where it is as likely to be that of the room");
  visitor.key("stairs_sigma", config.stairsSigma, "", {0.05, 10.0},
              "spread of the floor predicted beyond stairs, in widths of their steps");
  visitor.key("person_sigma", config.personSigma, "m", {0.05, 2.0}, "spread of a person's space");
  visitor.key("person_skew", config.personSkew, "", {0.0, 100.0}, "how much of it lies on the side with more room");
  visitor.key("horizon", config.horizon, "s", {0.0, 10.0}, "time that a person's way is extrapolated by");
  visitor.key("least_speed", config.leastSpeed, "m/s", {0.0, 5.0}, "who is slower stands");
  visitor.key("least_area", config.leastArea, "m²", {0.0, 10.0}, "a predicted area that is smaller is not told");
  visitor.key("range", config.range, "m", {1.0, 500.0},
              "entities farther from their sub-map's origin are refused where nothing is known about them");
  visitor.endSection();
}

std::string faultOf(const map::Entity& entity) {
  return std::visit(Fault(entity.T_submap_entity), entity.attributes);
}

Pose3 T_submap_here(const map::Entity& entity) {
  if (!faultOf(entity).empty()) return Pose3::Identity();
  const auto* stairs = std::get_if<map::Staircase>(&entity.attributes);
  return stairs != nullptr ? unseenEndOf(entity, *stairs) : levelPose(entity, 0.0);
}

Extrapolation extrapolate(const map::Entity& entity, const Surroundings& around, const RoomGuess* guess,
                          const ExtrapolationConfig& config) {
  if (auto fault = faultOf(entity); !fault.empty()) return Refusal{std::move(fault)};
  if (entity.T_submap_entity.translation().head<2>().norm() > config.range && !around.isAnythingKnown()) {
    return Refusal{"an entity outside of its sub-map"};
  }
  return std::visit(Model(entity, around, guess, config), entity.attributes);
}

}  // namespace prodomos::prediction
