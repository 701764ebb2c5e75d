// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plans/plan_drawing.hpp"

#include "prodomos/base/error.hpp"

#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace prodomos::simulation {

namespace {

using Node = pugi::xml_node;

/// A portal as one of its two spaces has it.
struct Entry {
  std::string id;
  std::optional<Eigen::Vector2d> position;
  bool isOpen = false;
  std::optional<bool> isDouble;
};

std::optional<double> numberIn(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::string quoted(const std::string& text) {
  return text.empty() ? "nothing" : "\"" + text + "\"";
}

class DrawingReader {
 public:
  explicit DrawingReader(const std::filesystem::path& file) : file_(file) {}

  PlanDrawing read() {
    const pugi::xml_parse_result parsed = document_.load_file(file_.c_str());
    if (parsed.status == pugi::status_file_not_found || parsed.status == pugi::status_io_error) {
      throw base::FileError(base::expectedFound(file_.string(), "a floor plan", "no readable file"));
    }
    if (!parsed) {
      throw base::FileError(
          base::expectedFound(file_.string() + ": byte " + std::to_string(parsed.offset), "XML", parsed.description()));
    }
    const Node building = document_.child("building");
    if (!building) fail("root", "<building>", "<" + std::string(document_.document_element().name()) + ">");
    drawing_.metresPerPixel = readScale(building.child("scale"));
    drawing_.name = file_.stem().string();
    const Node spaces = building.child("floor").child("spaces");
    for (const Node space : spaces.children("space")) readSpace(space);
    if (drawing_.spaces.empty()) fail("building/floor/spaces", "spaces with a bounding_polygon", "none");
    moveToOrigin();
    for (const Node space : spaces.children("space")) readPortals(space);
    joinEntries();
    return std::move(drawing_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& expected, const std::string& found) const {
    throw base::FileError(base::expectedFound(file_.string() + ": " + place, expected, found));
  }

  double lengthOf(const Node& node, const std::string& place) const {
    const std::string text = node.child_value("value");
    const auto length = numberIn(text);
    if (!length || *length <= 0.0) fail(place + "/value", "a positive number", quoted(text));
    return *length;
  }

  double readScale(const Node& scale) const {
    if (!scale) fail("building", "<scale>", "none");
    const auto unitOf = [&](const char* name, const char* unit) {
      const std::string found = scale.child(name).child_value("um");
      if (found != unit) fail("scale/" + std::string(name) + "/um", quoted(unit), quoted(found));
    };
    unitOf("represented_distance", "pixel");
    unitOf("real_distance", "cm");
    constexpr double kMetresPerCentimetre = 0.01;
    return kMetresPerCentimetre * lengthOf(scale.child("real_distance"), "scale/real_distance") /
           lengthOf(scale.child("represented_distance"), "scale/represented_distance");
  }

  /// Image y points down: turned over, so that the building is not its own mirror image.
  Eigen::Vector2d readPoint(const Node& point, const std::string& place) const {
    const auto coordinate = [&](const char* name) {
      const std::string text = point.attribute(name).value();
      const auto value = numberIn(text);
      if (!value) fail(place, "points with numbers x and y", std::string(name) + "=" + quoted(text));
      return *value;
    };
    return drawing_.metresPerPixel * Eigen::Vector2d(coordinate("x"), -coordinate("y"));
  }

  void readSpace(const Node& node) {
    DrawnSpace space{.id = node.attribute("id").value(), .label = node.child("labels").child_value("label")};
    if (!known_.insert(space.id).second) fail("space " + space.id, "ids that differ", "this one twice");
    const Node polygon = node.child("bounding_polygon");
    if (!polygon) return;  // A part of another space, drawn without an outline of its own.
    for (const Node point : polygon.children("point")) {
      space.outline.push_back(readPoint(point, "space " + space.id + ": bounding_polygon"));
    }
    indexOf_[space.id] = drawing_.spaces.size();
    drawing_.spaces.push_back(std::move(space));
  }

  void moveToOrigin() {
    Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    for (const auto& space : drawing_.spaces) {
      for (const auto& corner : space.outline) least = least.cwiseMin(corner);
    }
    origin_ = least;
    for (auto& space : drawing_.spaces) {
      for (auto& corner : space.outline) corner -= origin_;
    }
  }

  void readPortals(const Node& space) {
    const std::string here = space.attribute("id").value();
    if (!indexOf_.contains(here)) return;
    for (const Node portal : space.child("portals").children("portal")) {
      const std::string id = portal.child_value("linesegment");
      const std::string place = "space " + here + ": portal " + id;
      std::vector<std::string> targets;
      for (const Node target : portal.child("target").children("id")) targets.emplace_back(target.child_value());
      for (const auto& target : targets) {
        if (!known_.contains(target)) fail(place + ": target", "the id of a space", "\"" + target + "\"");
      }
      if (targets.size() != 2 || targets[0] == targets[1] || (targets[0] != here && targets[1] != here)) {
        fail(place + ": target", "this space and one other", std::to_string(targets.size()) + " ids that are not so");
      }
      const std::string& there = targets[targets[0] == here ? 1 : 0];
      if (!indexOf_.contains(there)) {
        drawing_.remarks.push_back(place + " leads into a space without an outline: left out");
        continue;
      }
      const std::string features = portal.child_value("features");
      Entry entry{.id = id, .position = positionOf(space, id, place)};
      entry.isOpen = std::string_view(portal.child_value("type")) == "IMPLICIT";
      if (!features.empty()) entry.isDouble = features == "DOUBLE";
      const std::size_t our = indexOf_.at(here);
      const std::size_t their = indexOf_.at(there);
      entries_[{std::min(our, their), std::max(our, their)}][our < their ? 0 : 1].push_back(entry);
    }
  }

  std::optional<Eigen::Vector2d> positionOf(const Node& space, const std::string& id, const std::string& place) const {
    const Node segment = space.child("space_representation").find_child_by_attribute("id", id.c_str());
    if (!segment) return std::nullopt;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int count = 0;
    for (const Node point : segment.children("point")) {
      sum += readPoint(point, place) - origin_;
      ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
  }

  /// A portal stands in both of its spaces, in some plans as the two jambs of one door: entries nearest to each other
  /// belong together.
  void joinEntries() {
    for (auto& [spaces, sides] : entries_) {
      auto& [ours, theirs] = sides;
      for (const auto& entry : ours) {
        const auto apart = [&](const Entry& other) {
          return entry.position && other.position ? (*entry.position - *other.position).norm() : 0.0;
        };
        const auto other = std::ranges::min_element(theirs, {}, apart);
        std::optional<Entry> partner;
        if (other != theirs.end()) {
          partner = *other;
          theirs.erase(other);
        }
        addPortal({spaces.first, spaces.second}, entry, partner);
      }
      for (const auto& entry : theirs) addPortal({spaces.first, spaces.second}, entry, std::nullopt);
    }
  }

  void addPortal(std::array<std::size_t, 2> spaces, const Entry& entry, const std::optional<Entry>& partner) {
    if (!partner) drawing_.remarks.push_back("portal " + entry.id + " stands in one of its two spaces only");
    std::vector<Eigen::Vector2d> points;
    if (entry.position) points.push_back(*entry.position);
    if (partner && partner->position) points.push_back(*partner->position);
    if (points.empty()) {
      drawing_.remarks.push_back("portal " + entry.id + " has no line segment: left out");
      return;
    }
    const Eigen::Vector2d position = (points.front() + points.back()) / 2.0;
    // Where the two disagree, a door outweighs a mere boundary, and a double door a single one.
    DrawnPortal portal{.id = entry.id, .spaces = spaces, .position = position, .isOpen = entry.isOpen};
    portal.isDouble = entry.isDouble;
    if (partner) {
      portal.isOpen = portal.isOpen && partner->isOpen;
      if (partner->isDouble) portal.isDouble = portal.isDouble.value_or(false) || *partner->isDouble;
    }
    drawing_.portals.push_back(std::move(portal));
  }

  std::filesystem::path file_;
  pugi::xml_document document_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  std::set<std::string> known_;
  std::map<std::string, std::size_t> indexOf_;
  std::map<std::pair<std::size_t, std::size_t>, std::array<std::vector<Entry>, 2>> entries_;
  PlanDrawing drawing_;
};

}  // namespace

PlanDrawing readDrawing(const std::filesystem::path& xml) {
  return DrawingReader(xml).read();
}

}  // namespace prodomos::simulation
