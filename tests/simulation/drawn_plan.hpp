// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace prodomos::test {

/// An XML floor plan drawn by a test: 10 pixels are 1 m (9 are "90 cm"), y downwards as in images.
class DrawnPlan {
 public:
  using Points = std::vector<std::pair<int, int>>;

  struct Portal {
    std::string from;
    std::string to;
    std::pair<int, int> point;
    std::string type = "EXPLICIT";
    std::string features = "NORMAL";
    std::pair<int, int> shift{0, 0};  ///< of the point that the second space has
  };

  std::string scale =
      "<scale><represented_distance><value>9</value><um>pixel</um></represented_distance>"
      "<real_distance><value>90</value><um>cm</um></real_distance></scale>";

  DrawnPlan& space(const std::string& id, const std::string& label, const Points& points) {
    spaces_.push_back({id, label, points});
    return *this;
  }
  DrawnPlan& room(const std::string& id, const std::string& label, std::array<int, 4> leftTopRightBottom) {
    const auto& [left, top, right, bottom] = leftTopRightBottom;
    return space(id, label, {{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}});
  }
  DrawnPlan& portal(Portal portal) {
    portals_.push_back(std::move(portal));
    return *this;
  }

  std::string xml() const {
    std::ostringstream text;
    text << "<?xml version=\"1.0\"?>\n<building id=\"b\">" << scale << "<floor><spaces>\n";
    for (const auto& space : spaces_) write(text, space);
    text << "</spaces></floor></building>\n";
    return text.str();
  }

 private:
  struct Space {
    std::string id;
    std::string label;
    Points points;
  };

  static void writePoint(std::ostringstream& text, std::pair<int, int> point) {
    text << "<point x=\"" << point.first << "\" y=\"" << point.second << "\"/>";
  }

  void write(std::ostringstream& text, const Space& space) const {
    text << "<space id=\"" << space.id << "\"><labels><type>R</type><label>" << space.label << "</label></labels>";
    if (!space.points.empty()) {
      text << "<bounding_polygon>";
      for (const auto& point : space.points) writePoint(text, point);
      text << "</bounding_polygon>";
    }
    std::ostringstream portals;
    text << "<space_representation>";
    for (std::size_t i = 0; i < portals_.size(); ++i) {
      const Portal& portal = portals_[i];
      if (portal.from != space.id && portal.to != space.id) continue;
      auto point = portal.point;
      if (portal.to == space.id) point = {point.first + portal.shift.first, point.second + portal.shift.second};
      text << "<linesegment id=\"p" << i << "\">";
      writePoint(text, point);
      writePoint(text, point);
      text << "<class>PORTAL</class></linesegment>";
      portals << "<portal><linesegment>p" << i << "</linesegment><type>" << portal.type << "</type><features>"
              << portal.features << "</features><target><id>" << portal.from << "</id><id>" << portal.to
              << "</id></target></portal>";
    }
    text << "</space_representation><portals>" << portals.str() << "</portals></space>\n";
  }

  std::vector<Space> spaces_;
  std::vector<Portal> portals_;
};

/// A corridor of 12 x 2 m with two classrooms above it (in the image) and a stairwell, a closet and a lift below.
inline DrawnPlan smallSchool() {
  DrawnPlan plan;
  plan.room("corridor", "CORRIDOR", {0, 60, 120, 80})
      .room("left", "CLASSROOM", {0, 0, 60, 60})
      .room("right", "CLASSROOM", {60, 0, 120, 60})
      .room("stairs", "STAIRS", {0, 80, 30, 140})
      .room("closet", "CLOSET", {30, 80, 60, 110})
      .room("lift", "ELEVATOR", {60, 80, 80, 100})
      .portal({"corridor", "left", {50, 60}})
      .portal({"corridor", "right", {90, 60}, "EXPLICIT", "DOUBLE"})
      .portal({"corridor", "stairs", {15, 80}, "IMPLICIT"})
      .portal({"corridor", "closet", {45, 80}})
      .portal({"corridor", "lift", {70, 80}});
  return plan;
}

}  // namespace prodomos::test
