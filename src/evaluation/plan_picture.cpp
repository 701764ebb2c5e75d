// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/evaluation/claims.hpp"
#include "prodomos/evaluation/detections.hpp"
#include "prodomos/evaluation/humans.hpp"
#include "prodomos/evaluation/objects.hpp"
#include "prodomos/evaluation/score_page.hpp"

#include "evaluation/svg.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace prodomos::evaluation {

namespace {

using Points = Svg::Points;

/// What of a map is drawn, in the world.
struct Mapped {
  Claims claims;
  std::vector<ClaimMatch> doorMatches;
  std::vector<ClaimMatch> stairsMatches;
  std::vector<MappedObject> objects;
  std::vector<MappedPerson> people;
  std::vector<TimedPose> way;
};

Mapped mappedIn(const map::MapView& view, const Truth& truth) {
  Mapped mapped{.claims = claimsOf(view, truth), .objects = objectsOf(view, truth), .people = peopleOf(view, truth)};
  mapped.doorMatches = matchDoors(mapped.claims.doors, truth);
  mapped.stairsMatches = matchStairs(mapped.claims.stairs, truth);
  mapped.way = bodyPoses(view.trajectory(), Poses::kRefined);
  const auto T_world_map = truthFromMap(mapped.way, truth);
  for (auto& pose : mapped.way) pose.pose = T_world_map * pose.pose;
  return mapped;
}

std::string_view markOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRight:
      return "claim right";
    case Verdict::kWrong:
      return "claim wrong";
    case Verdict::kNeither:
      return "claim neither";
  }
  return "";
}

/// Even-odd.
bool isIn(const Points& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

/// One storey, drawn layer by layer.
class PlanDrawer {
 public:
  PlanDrawer(const Truth& truth, const Mapped& mapped, int storey) : truth_(truth), mapped_(mapped), storey_(storey) {
    Eigen::AlignedBox2d bounds;
    for (const auto& room : truth.rooms) {
      if (room.storey != storey) continue;
      for (const auto& corner : room.outline) bounds.extend(corner);
    }
    for (const auto& pose : truth.trajectory) {
      if (isHere(pose.pose.translation().z())) bounds.extend(pose.pose.translation().head<2>());
    }
    // What is predicted may reach beyond the walls, but not so far that the building becomes small.
    corner_ = {bounds.min().x() - kBeyond, bounds.max().y() + kBeyond};
    size_ = bounds.sizes() + Eigen::Vector2d::Constant(2.0 * kBeyond);
    scale_ = std::clamp(kWidth / size_.x(), 6.0, 45.0);
  }

  ScorePicture draw() {
    drawRooms();
    drawThings();
    drawStairs();
    drawPredictions();
    drawDoors();
    drawWays();
    drawPeople();
    drawClaims();
    drawNames();
    drawScale();
    const double height = scale_ * size_.y() + 26.0;
    return {.title = "storey " + std::to_string(storey_),
            .svg = svg_.str(scale_ * size_.x(), height, "plan of storey " + std::to_string(storey_)),
            .legend = legend()};
  }

 private:
  static constexpr double kWidth = 1150.0;  // pixels
  static constexpr double kBeyond = 1.0;    // metres around the building
  static constexpr double kLetter = 6.6;    // pixels that a letter of a name takes
  static constexpr double kLine = 13.0;     // and its line

  bool isHere(double z) const { return storeyAt(truth_, z) == storey_; }

  Eigen::Vector2d pixel(const Eigen::Vector2d& spot) const {
    return scale_ * Eigen::Vector2d(spot.x() - corner_.x(), corner_.y() - spot.y());
  }
  Points pixels(const Points& spots) const {
    Points points;
    std::ranges::transform(spots, std::back_inserter(points), [&](const auto& spot) { return pixel(spot); });
    return points;
  }
  Points rectangle(const geometry::Pose2& T_world_middle, double length, double width) const {
    Points corners;
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
      const auto corner = T_world_middle * geometry::Pose2{x * length, y * width, 0.0};
      corners.push_back(pixel({corner.x, corner.y}));
    }
    return corners;
  }

  void drawRooms() {
    for (const auto& room : truth_.rooms) {
      if (room.storey != storey_) continue;
      svg_.polygon(pixels(room.outline), room.entered ? "room entered" : "room",
                   room.label + " " + room.id + (room.entered ? ", entered" : ""));
    }
  }

  void drawThings() {
    for (const auto& object : truth_.objects) {
      if (object.storey != storey_ || object.poses.empty()) continue;
      const auto& last = object.poses.back().T_world_object;
      svg_.polygon(rectangle(geometry::toPose2(last), object.size.x(), object.size.y()), "thing", object.id);
    }
    for (const auto& object : mapped_.objects) {
      const auto& box = object.box_in_world;
      if (!isHere(box.T_frame_box.translation().z() - 0.5 * box.size.z())) continue;
      svg_.polygon(rectangle(geometry::toPose2(box.T_frame_box), box.size.x(), box.size.y()), "mapped-thing",
                   object.className);
    }
  }

  void drawStairs() {
    for (const auto& stairs : truth_.stairs) {
      if (std::ranges::find(stairs.storeys, storey_) == stairs.storeys.end()) continue;
      const geometry::Pose2 foot{stairs.foot.x(), stairs.foot.y(), stairs.direction};
      const double run = (stairs.head - stairs.foot).head<2>().norm();
      svg_.polygon(rectangle(foot * geometry::Pose2{0.5 * run, 0.0, 0.0}, run, stairs.width), "stairs", stairs.id);
      for (int step = 1; step < stairs.stepCount; ++step) {
        const double x = run * step / stairs.stepCount;
        const auto left = foot * geometry::Pose2{x, 0.5 * stairs.width, 0.0};
        const auto right = foot * geometry::Pose2{x, -0.5 * stairs.width, 0.0};
        svg_.polyline({pixel({left.x, left.y}), pixel({right.x, right.y})}, "step");
      }
    }
  }

  void drawPredictions() {
    for (const auto& space : mapped_.claims.spaces) {
      if (space.storey != storey_ || space.areas_in_world.empty()) continue;
      hasPredictions_ = true;
      const auto& [threshold, area] = *space.areas_in_world.begin();
      svg_.polygon(
          pixels(area), "bet",
          toString(space.id) + ": probability " + fixed(space.probability, 2) + ", drawn at " + fixed(threshold, 1),
          "fill-opacity:" + fixed(0.1 + 0.35 * std::clamp(space.probability, 0.0, 1.0), 2));
    }
  }

  void drawDoors() {
    for (std::size_t i = 0; i < truth_.doors.size(); ++i) {
      const auto& door = truth_.doors[i];
      if (door.storey != storey_) continue;
      const auto pose = poseOf(door);
      const auto left = pose * geometry::Pose2{0.0, 0.5 * door.width, 0.0};
      const auto right = pose * geometry::Pose2{0.0, -0.5 * door.width, 0.0};
      const char* mark = door.leaves == 0 ? "doorway" : door.sighting.visible ? "door" : "door unseen";
      svg_.polyline({pixel({left.x, left.y}), pixel({right.x, right.y})}, mark,
                    door.id + (door.sighting.visible ? ", visible" : ", not visible enough"));
      if (door.leaves > 0 && door.sighting.visible && !isFound(mapped_.doorMatches, i)) {
        svg_.circle(pixel({pose.x, pose.y}), 9.0, "missed", door.id + " is missed");
      }
    }
  }

  static bool isFound(const std::vector<ClaimMatch>& matches, std::size_t index) {
    return std::ranges::any_of(
        matches, [&](const ClaimMatch& match) { return match.verdict == Verdict::kRight && match.truth == index; });
  }

  void drawWay(const std::vector<TimedPose>& way, std::string_view mark) {
    Points points;
    const auto flush = [&] {
      if (points.size() > 1) svg_.polyline(points, mark);
      points.clear();
    };
    for (const auto& pose : way) {
      if (!isHere(pose.pose.translation().z())) {
        flush();
        continue;
      }
      const auto point = pixel(pose.pose.translation().head<2>());
      if (points.empty() || (point - points.back()).norm() >= 2.0) points.push_back(point);
    }
    flush();
  }

  void drawWays() {
    drawWay(truth_.trajectory, "way");
    drawWay(mapped_.way, "mapped-way");
  }

  void drawPeople() {
    for (const auto& person : mapped_.people) {
      std::vector<TimedPose> way;
      for (const auto& state : person.states) way.push_back({state.time, state.T_world_person});
      drawWay(way, "mapped-person");
    }
    for (const auto& person : truth_.people) {
      std::vector<TimedPose> way;
      for (const auto& state : person.states) {
        way.push_back({state.time, geometry::Pose3(Eigen::Translation3d(state.position))});
      }
      drawWay(way, "person");
      if (!way.empty() && isHere(way.back().pose.translation().z())) {
        svg_.circle(pixel(way.back().pose.translation().head<2>()), 3.0, "person", person.id);
      }
    }
  }

  void drawClaims() {
    for (std::size_t i = 0; i < mapped_.claims.doors.size(); ++i) {
      const auto& claim = mapped_.claims.doors[i];
      if (claim.storey != storey_) continue;
      const auto ahead = claim.T_world_door * geometry::Pose2{0.5, 0.0, 0.0};
      const auto middle = pixel({claim.T_world_door.x, claim.T_world_door.y});
      const auto mark = markOf(mapped_.doorMatches[i].verdict);
      svg_.polyline({middle, pixel({ahead.x, ahead.y})}, mark);
      svg_.circle(middle, 4.0, mark, "door " + toString(claim.id));
    }
    for (std::size_t i = 0; i < mapped_.claims.stairs.size(); ++i) {
      const auto& claim = mapped_.claims.stairs[i];
      if (claim.storey != storey_) continue;
      const auto uphill = claim.T_world_stairs * geometry::Pose2{0.8, 0.0, 0.0};
      const auto middle = pixel({claim.T_world_stairs.x, claim.T_world_stairs.y});
      const auto mark = markOf(mapped_.stairsMatches[i].verdict);
      svg_.polyline({middle, pixel({uphill.x, uphill.y})}, mark);
      svg_.circle(middle, 4.0, mark, "stairs " + toString(claim.id));
    }
  }

  bool hasStairs(const TrueRoom& room) const {
    return std::ranges::any_of(truth_.stairs, [&](const TrueStaircase& stairs) {
      return stairs.rooms[0] == room.id || stairs.rooms[1] == room.id || isIn(room.outline, stairs.foot.head<2>());
    });
  }

  /// Where a name fits into its room; stairs need none.
  void drawNames() {
    for (const auto& room : truth_.rooms) {
      if (room.storey != storey_ || room.label.empty() || hasStairs(room)) continue;
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      const auto outline = pixels(room.outline);
      for (const auto& corner : outline) middle += corner / static_cast<double>(outline.size());
      const Eigen::Vector2d half(0.5 * kLetter * static_cast<double>(room.label.size()) + 3.0, 0.5 * kLine);
      bool fits = true;
      for (const double x : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        for (const double y : {-1.0, 1.0}) fits &= isIn(outline, middle + half.cwiseProduct(Eigen::Vector2d(x, y)));
      }
      if (fits) svg_.text(middle, room.label, "name");
    }
  }

  void drawScale() {
    const double y = scale_ * size_.y() + 12.0;
    constexpr double kLength = 5.0;  // metres
    svg_.polyline({{8.0, y - 4.0}, {8.0, y}, {8.0 + kLength * scale_, y}, {8.0 + kLength * scale_, y - 4.0}}, "axis");
    svg_.text({14.0 + kLength * scale_, y}, "5 m", "left");
  }

  std::vector<LegendEntry> legend() const {
    std::vector<LegendEntry> entries = {{"room entered", "room that was entered"}, {"room", "room that was not"}};
    const auto addIf = [&](bool isThere, const char* mark, const char* text, bool isLine = false) {
      if (isThere) entries.push_back({mark, text, isLine});
    };
    addIf(!truth_.doors.empty(), "door", "door", true);
    addIf(!truth_.doors.empty(), "door unseen", "door not visible enough to be found", true);
    addIf(true, "claim right", "found");
    addIf(true, "claim wrong", "found, but it is not there");
    addIf(true, "missed", "visible, but missed");
    addIf(hasPredictions_, "bet", "predicted floor");
    addIf(!truth_.objects.empty(), "thing", "thing");
    addIf(!mapped_.objects.empty(), "mapped-thing", "thing in the map");
    addIf(true, "way", "way of the robot", true);
    addIf(true, "mapped-way", "the same in the map", true);
    addIf(!truth_.people.empty(), "person", "way of a person", true);
    addIf(!mapped_.people.empty(), "mapped-person", "the same in the map", true);
    return entries;
  }

  const Truth& truth_;
  const Mapped& mapped_;
  int storey_;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();  // upper left, metres
  Eigen::Vector2d size_ = Eigen::Vector2d::Zero();    // metres
  double scale_ = 1.0;                                // pixels a metre
  bool hasPredictions_ = false;
  Svg svg_;
};

}  // namespace

std::vector<ScorePicture> planPictures(const map::MapView& view, const Truth& truth) {
  const auto mapped = mappedIn(view, truth);
  std::set<int> storeys;
  for (const auto& pose : truth.trajectory) storeys.insert(storeyAt(truth, pose.pose.translation().z()));
  std::vector<ScorePicture> pictures;
  std::ranges::transform(storeys, std::back_inserter(pictures),
                         [&](int storey) { return PlanDrawer(truth, mapped, storey).draw(); });
  return pictures;
}

}  // namespace prodomos::evaluation
