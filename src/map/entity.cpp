// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/map/entity.hpp"

#include "prodomos/map/prediction.hpp"
#include "prodomos/map/records.hpp"

#include "map/names.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prodomos::map {

namespace {

using nlohmann::json;

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// JSON has no NaN: written as null, read back here.
double real(const json& number) {
  return number.is_null() ? std::numeric_limits<double>::quiet_NaN() : number.get<double>();
}

json toArray(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector3d toVector(const json& array) {
  return {real(array.at(0)), real(array.at(1)), real(array.at(2))};
}

Staircase staircaseFrom(const json& in) {
  return {real(in.at("height")), real(in.at("step_width")), real(in.at("step_height")), real(in.at("step_depth")),
          in.at("step_count")};
}

Door doorFrom(const json& in) {
  Door door{real(in.at("width")), real(in.at("height")), in.at("has_leaf"), {}, {}};
  door.hingeSide = fromName(in.at("hinge_side").get<std::string>(), HingeSide::kRight);
  door.state = fromName(in.at("state").get<std::string>(), DoorState::kOpen);
  return door;
}

PlanePatch planePatchFrom(const json& in) {
  PlanePatch patch{real(in.at("area")), {}};
  for (const auto& point : in.at("outline")) patch.outline_in_patch.emplace_back(real(point.at(0)), real(point.at(1)));
  return patch;
}

}  // namespace

std::optional<double> runOf(const Entity& entity) {
  const auto* stairs = std::get_if<Staircase>(&entity.attributes);
  if (stairs == nullptr) return std::nullopt;
  if (stairs->stepHeight > 0.0 && stairs->stepDepth > 0.0 && std::isfinite(stairs->height)) {
    return std::abs(stairs->height) * stairs->stepDepth / stairs->stepHeight;
  }
  if (entity.points_in_submap.empty()) return std::nullopt;
  const Eigen::Vector3f uphill = entity.T_submap_entity.linear().col(0).cast<float>();
  const auto [least, most] =
      std::ranges::minmax(entity.points_in_submap, {}, [&uphill](const auto& point) { return uphill.dot(point); });
  return uphill.dot(most - least);
}

std::string_view className(const EntityAttributes& attributes) {
  static constexpr std::array<std::string_view, std::variant_size_v<EntityAttributes>> kNames = {
      "staircase", "door", "human", "object_box", "cuboid", "plane_patch"};
  return kNames[attributes.index()];
}

Mobility mobility(const EntityAttributes& attributes) {
  return std::visit(
      Overloaded{[](const Staircase&) { return Mobility::kStatic; }, [](const Door&) { return Mobility::kQuasiStatic; },
                 [](const Human&) { return Mobility::kDynamic; }, [](const ObjectBox&) { return Mobility::kDynamic; },
                 [](const Cuboid&) { return Mobility::kStatic; }, [](const PlanePatch&) { return Mobility::kStatic; }},
      attributes);
}

std::string toJson(const EntityAttributes& attributes) {
  const json out = std::visit(
      Overloaded{
          [](const Staircase& stairs) {
            return json{{"height", stairs.height},
                        {"step_width", stairs.stepWidth},
                        {"step_height", stairs.stepHeight},
                        {"step_depth", stairs.stepDepth},
                        {"step_count", stairs.stepCount}};
          },
          [](const Door& door) {
            return json{{"width", door.width},
                        {"height", door.height},
                        {"has_leaf", door.hasLeaf},
                        {"hinge_side", toString(door.hingeSide)},
                        {"state", toString(door.state)}};
          },
          [](const Human& human) {
            return json{{"dominant_side", human.dominantSide}, {"velocity", toArray(human.velocity)}};
          },
          [](const ObjectBox& box) {
            return json{{"class", box.classId}, {"size", toArray(box.size)}, {"velocity", toArray(box.velocity)}};
          },
          [](const Cuboid& box) {
            return json{{"class", box.classId}, {"size", toArray(box.size)}};
          },
          [](const PlanePatch& patch) {
            json outline = json::array();
            for (const auto& point : patch.outline_in_patch) outline.push_back({point.x(), point.y()});
            return json{{"area", patch.area}, {"outline", outline}};
          }},
      attributes);
  return out.dump();
}

EntityAttributes entityAttributesFromJson(std::string_view className, std::string_view json) {
  try {
    const auto in = nlohmann::json::parse(json);
    if (className == "staircase") return staircaseFrom(in);
    if (className == "door") return doorFrom(in);
    if (className == "human") return Human{in.at("dominant_side"), toVector(in.at("velocity"))};
    if (className == "object_box")
      return ObjectBox{in.at("class"), toVector(in.at("size")), toVector(in.at("velocity"))};
    if (className == "cuboid") return Cuboid{in.at("class"), toVector(in.at("size"))};
    if (className == "plane_patch") return planePatchFrom(in);
  } catch (const nlohmann::json::exception& fault) {
    throw base::Error("attributes of a " + std::string(className) + ": " + fault.what());
  }
  throw base::Error("expected a known class of entities, found '" + std::string(className) + "'");
}

std::string_view toString(Mobility mobility) {
  static constexpr std::array<std::string_view, 3> kNames = {"static", "quasi_static", "dynamic"};
  return kNames[static_cast<std::size_t>(mobility)];
}

std::string_view toString(HingeSide side) {
  static constexpr std::array<std::string_view, 3> kNames = {"unknown", "left", "right"};
  return kNames[static_cast<std::size_t>(side)];
}

std::string_view toString(DoorState state) {
  static constexpr std::array<std::string_view, 4> kNames = {"unknown", "closed", "ajar", "open"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string_view toString(PredictionState state) {
  static constexpr std::array<std::string_view, 4> kNames = {"open", "confirmed", "refuted", "merged"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string_view toString(SessionState state) {
  return state == SessionState::kRunning ? "running" : "complete";
}

}  // namespace prodomos::map
