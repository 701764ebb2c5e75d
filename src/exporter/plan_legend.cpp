// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/palette.hpp"
#include "exporter/plan.hpp"
#include "exporter/text.hpp"

#include <array>
#include <functional>
#include <set>

namespace prodomos::exporter {
namespace {

constexpr double kRow = 22.0;
constexpr double kTextSize = 11.0;
constexpr double kSymbolWidth = 30.0;

/// One symbol, drawn around a centre, and what it means.
struct Entry {
  std::string text;
  std::function<std::vector<Shape>(const Point& centre)> symbol;
};

Entry lineEntry(const std::string& text, const Style& style) {
  return {text, [style](const Point& centre) -> std::vector<Shape> {
            const Point half(kSymbolWidth / 2 - 2.0, 0.0);
            return {Line{.points = {centre - half, centre + half}, .style = style}};
          }};
}

Entry circleEntry(const std::string& text, const Style& style) {
  return {text, [style](const Point& centre) -> std::vector<Shape> {
            return {Circle{.centre = centre, .radius = 6.0, .style = style}};
          }};
}

Entry swatchEntry(const std::string& text, const map::Rgba& color) {
  return {text, [color](const Point& centre) -> std::vector<Shape> {
            const Style style = filledAndStroked(color, withAlpha(kMutedColor, 0.6), 0.6);
            const double x = 8.0;
            const double y = 6.0;
            return {Line{
                .points = {centre + Point(-x, -y), centre + Point(x, -y), centre + Point(x, y), centre + Point(-x, y)},
                .closed = true,
                .style = style}};
          }};
}

/// Drawn facing up the page, so small that it fits into a row.
Entry entityEntry(const std::string& text, const map::EntityAttributes& attributes, double scale, const Point& shift) {
  return {text, [=](const Point& centre) {
            Eigen::Affine2d T_page_entity = Eigen::Affine2d::Identity();
            T_page_entity.linear() << 0.0, -scale, -scale, 0.0;
            T_page_entity.translation() = centre + shift;
            return entitySymbol(attributes, T_page_entity);
          }};
}

/// The five places that come first stand for all.
Entry placesEntry(const PlanContents& plan) {
  std::set<int> places;
  for (const auto& placed : plan.nodes) {
    if (placed.node.place && placed.node.kind == map::SubMapKind::kObserved) places.insert(*placed.node.place);
  }
  if (places.size() < 2)
    return circleEntry("sub-map", observedNodeStyle(places.empty() ? std::optional<int>() : *places.begin()));
  return {"sub-maps, a colour a place", [places](const Point& centre) {
            std::vector<Shape> shapes;
            double x = -7.0;
            for (const int place : places) {
              shapes.emplace_back(
                  Circle{.centre = centre + Point(x, 0.0), .radius = 5.0, .style = observedNodeStyle(place)});
              x += 7.0;
              if (shapes.size() == 3) break;
            }
            return shapes;
          }};
}

void addEdgeEntries(const PlanContents& plan, std::vector<Entry>& entries) {
  const auto& graph = plan.view.graph();
  std::set<map::EdgeKind> kinds;
  for (const auto id : graph.edges()) {
    const auto& edge = graph.getEdge(id);
    const bool predicted = graph.getNode(edge.from).kind == map::SubMapKind::kPredicted ||
                           graph.getNode(edge.to).kind == map::SubMapKind::kPredicted;
    if (!predicted) kinds.insert(edge.kind);
  }
  constexpr std::array<std::pair<map::EdgeKind, std::string_view>, 6> kNames = {
      {{map::EdgeKind::kTravelled, "travelled"},
       {map::EdgeKind::kDoor, "through a door"},
       {map::EdgeKind::kStairs, "over stairs"},
       {map::EdgeKind::kLoop, "loop closure"},
       {map::EdgeKind::kLift, "by lift"},
       {map::EdgeKind::kOverlap, "overlap"}}};
  for (const auto& [kind, name] : kNames) {
    if (kinds.contains(kind)) entries.push_back(lineEntry(std::string(name), edgeStyle(kind)));
  }
}

void addEntityEntries(const PlanContents& plan, std::vector<Entry>& entries) {
  std::set<std::size_t> classes;
  for (const auto& entity : plan.view.entities()) classes.insert(entity.attributes.index());
  const std::array<Entry, std::variant_size_v<map::EntityAttributes>> all = {
      entityEntry("stairs, uphill", map::Staircase{.height = 1, .stepWidth = 1.1, .stepDepth = 0.28, .stepCount = 6},
                  9.0, {0, 0}),
      entityEntry("door", map::Door{.width = 1.0, .hingeSide = map::HingeSide::kLeft, .state = map::DoorState::kAjar},
                  15.0, {0, 6}),
      entityEntry("person", map::Human{}, 18.0, {0, 2}),
      entityEntry("moving object", map::ObjectBox{.size = {1, 1.4, 1}}, 10.0, {0, 0}),
      entityEntry("object", map::Cuboid{.size = {1, 1.4, 1}}, 10.0, {0, 0}),
      entityEntry("plane", map::PlanePatch{.outline_in_patch = {{-.5, -.8}, {.5, -.8}, {.5, .8}, {-.5, .8}}}, 10.0,
                  {0, 0}),
  };
  for (const std::size_t index : classes) entries.push_back(all.at(index));
}

std::vector<Entry> entriesOf(const PlanContents& plan) {
  std::vector<Entry> entries = {swatchEntry("free", kFreeColor), swatchEntry("occupied", kOccupiedColor),
                                swatchEntry("unknown", kUnknownColor)};
  bool predicted = false;
  bool observed = false;
  for (const auto& placed : plan.nodes) {
    (placed.node.kind == map::SubMapKind::kPredicted ? predicted : observed) = true;
  }
  if (observed) entries.push_back(placesEntry(plan));
  addEdgeEntries(plan, entries);
  entries.push_back(lineEntry("trajectory", stroked(kTrajectoryColor, 1.2)));
  addEntityEntries(plan, entries);
  if (predicted) entries.push_back(circleEntry("predicted, not yet seen", predictedNodeStyle()));
  return entries;
}

/// As long as is round and handy. Returns its length on the page.
double drawScaleBar(const Panel& panel, double left, double middle, Group& group) {
  constexpr double kMost = 170.0;
  double metres = 0.1;
  for (const double length : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    if (length * panel.scale <= kMost) metres = length;
  }
  const double length = metres * panel.scale;
  const Style style = stroked(kInkColor, 1.6);
  const Point end(left + length, middle);
  group.shapes.emplace_back(Line{.points = {{left, middle - 4}, {left, middle + 4}}, .style = style});
  group.shapes.emplace_back(Line{.points = {{left, middle}, end}, .style = style});
  group.shapes.emplace_back(Line{.points = {end + Point(0, -4), end + Point(0, 4)}, .style = style});
  const std::string text = brief(metres, 1) + " m";
  group.shapes.emplace_back(Text{.at = end + Point(7.0, 4.0), .text = text, .size = kTextSize, .color = kInkColor});
  return length + 7.0 + textWidth(text, kTextSize);
}

}  // namespace

std::pair<Group, double> drawLegend(const PlanContents& plan, double left, double top, double width) {
  Group group{"legend"};
  double x = left + drawScaleBar(plan.panels.front(), left, top + kRow / 2, group) + 26.0;
  double middle = top + kRow / 2;
  for (const auto& entry : entriesOf(plan)) {
    const double needed = kSymbolWidth + 5.0 + textWidth(entry.text, kTextSize);
    if (x + needed > left + width) {
      x = left;
      middle += kRow;
    }
    for (auto& shape : entry.symbol({x + kSymbolWidth / 2, middle})) group.shapes.push_back(std::move(shape));
    group.shapes.emplace_back(
        Text{.at = {x + kSymbolWidth + 5.0, middle + 4.0}, .text = entry.text, .size = kTextSize, .color = kInkColor});
    x += needed + 16.0;
  }
  return {std::move(group), middle + kRow / 2 - top};
}

}  // namespace prodomos::exporter
