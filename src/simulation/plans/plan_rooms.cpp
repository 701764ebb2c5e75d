// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plans/plan_rooms.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/polygons.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace prodomos::simulation {

namespace {

constexpr double kSame = 0.005;          // Metres, between corners.
constexpr double kFaceTolerance = 0.02;  // Of faces: little, since walls must keep their thickness.
constexpr double kMostSmoothing = 0.1;   // Of outlines, whatever a pixel is.
constexpr double kLeastArea = 0.4;       // m², of a room.
constexpr double kNotableOverlap = 1.0;  // m²; less is how hands draw.

std::string squareMetres(double area) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f m²", area);
  return text.data();
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool cross(const Edge& a, const Edge& b) {
  return turn(a.from, a.to, b.from) * turn(a.from, a.to, b.to) < 0.0 &&
         turn(b.from, b.to, a.from) * turn(b.from, b.to, a.to) < 0.0;
}

/// Edges that touch or run over each other are a thin wall drawn into the room; edges that cross have no inside.
void refuseCrossing(const DrawnSpace& space, const std::string& file) {
  const auto& outline = space.outline;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (std::size_t j = i + 1; j < outline.size(); ++j) {
      if (!cross(edgeOf(outline, i), edgeOf(outline, j))) continue;
      throw base::FileError(
          base::expectedFound(file + ": space " + space.id + " (" + space.label + "): bounding_polygon",
                              "an outline that does not cross itself",
                              "edges " + std::to_string(i + 1) + " and " + std::to_string(j + 1) + " that cross"));
    }
  }
}

class FaceMaker {
 public:
  FaceMaker(const PlanDrawing& drawing, double wallThickness, std::vector<std::string>& remarks)
      : drawing_(drawing), wallThickness_(wallThickness), remarks_(remarks), faces_(drawing.spaces.size()) {}

  std::vector<std::optional<Polygon>> make() {
    for (std::size_t i = 0; i < faces_.size(); ++i) shrink(i);
    // Small rooms keep their shape: closets are drawn into halls, not halls into closets.
    std::vector<std::size_t> order(faces_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return faces_[i] ? signedArea(*faces_[i]) : 0.0; });
    for (std::size_t greater = 1; greater < order.size(); ++greater) {
      for (std::size_t smaller = 0; smaller < greater; ++smaller) separate(order[greater], order[smaller]);
    }
    return std::move(faces_);
  }

 private:
  void remark(std::size_t space, const std::string& what) {
    remarks_.push_back("space " + drawing_.spaces[space].id + " (" + drawing_.spaces[space].label + ") " + what);
  }

  void shrink(std::size_t space) {
    Polygon outline = cleaned(drawing_.spaces[space].outline, kSame);
    if (outline.empty()) return remark(space, "is left out: its outline has no area");
    // A kink of one pixel in a wall is the drawing's, not the house's.
    outline = simplified(outline, std::min(1.01 * drawing_.metresPerPixel, kMostSmoothing));
    keepGreatest(space, inset(outline, wallThickness_ / 2.0));
  }

  /// Of what is left of a space.
  void keepGreatest(std::size_t space, const std::vector<Polygon>& pieces) {
    faces_[space].reset();
    if (pieces.empty() || signedArea(pieces.front()) < kLeastArea) {
      return remark(space, "is left out: it is too thin for walls of " + std::to_string(wallThickness_) + " m");
    }
    const double lost = std::accumulate(pieces.begin() + 1, pieces.end(), 0.0,
                                        [](double sum, const Polygon& piece) { return sum + signedArea(piece); });
    if (lost > kLeastArea) remark(space, "falls apart: " + squareMetres(lost) + " behind a narrow place are left out");
    const Polygon face = simplified(cleaned(pieces.front(), kSame), kFaceTolerance);
    if (face.empty() || findSelfCrossing(face)) return remark(space, "is left out: its walls touch each other");
    faces_[space] = face;
  }

  /// Takes the smaller room and its wall out of the greater one where the two are drawn nearer than half a wall.
  void separate(std::size_t greater, std::size_t smaller) {
    if (!faces_[greater] || !faces_[smaller]) return;
    const auto reach = inset(*faces_[smaller], -wallThickness_ / 2.0);
    if (reach.empty() || overlapArea(*faces_[greater], reach.front()) <= 0.0) return;
    const double overlap = overlapArea(*faces_[greater], *faces_[smaller]);
    const auto rest = difference(*faces_[greater], inset(*faces_[smaller], -wallThickness_).front());
    if (rest.hasHole) {
      remark(smaller, "is left out: it stands free within " + drawing_.spaces[greater].label);
      faces_[smaller].reset();
      return;
    }
    if (overlap > kNotableOverlap) {
      remark(greater, "is drawn over a " + drawing_.spaces[smaller].label + ": it loses " + squareMetres(overlap));
    }
    keepGreatest(greater, rest.pieces);
  }

  const PlanDrawing& drawing_;
  double wallThickness_;
  std::vector<std::string>& remarks_;
  std::vector<std::optional<Polygon>> faces_;
};

}  // namespace

std::vector<std::optional<Polygon>> wallFacesOf(const PlanDrawing& drawing, double wallThickness,
                                                const std::string& file, std::vector<std::string>& remarks) {
  for (const auto& space : drawing.spaces) refuseCrossing(space, file);
  return FaceMaker(drawing, wallThickness, remarks).make();
}

}  // namespace prodomos::simulation
