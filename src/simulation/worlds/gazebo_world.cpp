// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/gazebo_world.hpp"

#include "prodomos/base/error.hpp"

#include <pugixml.hpp>

#include <array>
#include <sstream>

namespace prodomos::simulation {
namespace {

[[noreturn]] void fail(const std::string& place, const std::string& expected, const std::string& found) {
  throw base::FileError(base::expectedFound(place, expected, found));
}

/// "x y z roll pitch yaw", metres and radians; none: where its parent is.
geometry::Pose3 poseOf(const pugi::xml_node& node, const std::string& place) {
  const auto element = node.child("pose");
  if (!element) return geometry::Pose3::Identity();
  const std::string text = element.text().as_string();
  std::istringstream numbers(text);
  std::array<double, 6> values{};
  std::string rest;
  for (auto& value : values) numbers >> value;
  if (numbers.fail() || numbers >> rest) fail(place, "a <pose> of six numbers", "\"" + text + "\"");
  const auto& [x, y, z, roll, pitch, yaw] = values;
  return geometry::fromYawPitchRoll({x, y, z}, yaw, pitch, roll);
}

void addIncluded(const pugi::xml_node& include, const std::string& parent, const geometry::Pose3& T_world_parent,
                 const std::filesystem::path& path, GazeboWorld& world) {
  const std::string uri = include.child("uri").text().as_string();
  const std::string model = uri.substr(uri.find_last_of('/') + 1);
  const std::string own = include.child("name").text().as_string();
  const std::string name = !parent.empty() ? parent : !own.empty() ? own : model;
  const std::string place = path.string() + ": model \"" + name + "\"";
  if (model.empty()) fail(place, "an <include> with <uri>model://NAME</uri>", "\"" + uri + "\"");
  world.models.push_back({.name = name, .model = model, .T_world_model = T_world_parent * poseOf(include, place)});
}

}  // namespace

bool isGazeboWorld(const std::filesystem::path& path) {
  pugi::xml_document document;
  return document.load_file(path.c_str()) && document.child("sdf").child("world");
}

GazeboWorld readGazeboWorld(const std::filesystem::path& path) {
  pugi::xml_document document;
  const auto parsed = document.load_file(path.c_str());
  if (!parsed) fail(path.string(), "a Gazebo world (XML)", parsed.description());
  const auto root = document.child("sdf").child("world");
  if (!root) {
    fail(path.string(), "a Gazebo world: <sdf> with <world>",
         "<" + std::string(document.document_element().name()) + ">");
  }
  GazeboWorld world;
  for (const auto& child : root.children()) {
    const std::string kind = child.name();
    if (kind == "include") addIncluded(child, "", geometry::Pose3::Identity(), path, world);
    if (kind != "model") continue;
    const std::string name = child.attribute("name").as_string();
    if (child.child("link")) {
      world.remarks.push_back("model \"" + name + "\" is described in the world itself: passed over");
    }
    const geometry::Pose3 T_world_model = poseOf(child, path.string() + ": model \"" + name + "\"");
    for (const auto& include : child.children("include")) addIncluded(include, name, T_world_model, path, world);
  }
  return world;
}

}  // namespace prodomos::simulation
