// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/stairwells.hpp"

#include "simulation/worlds/flights.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr double kKneeHeight = 0.5;  ///< walls are looked for at this height: below windows, above skirtings
constexpr double kSameLevel = 0.1;

std::vector<Segment> wallsOf(const StoreyMesh& mesh) {
  return sliceOf(mesh, "wall", kKneeHeight);
}

/// Takes the stairs' pieces for which the test holds out of the storey.
template <typename Test>
std::vector<Flight> takeFlights(StoreyMesh& mesh, Test isWanted, bool removes) {
  std::vector<Flight> flights;
  for (auto& surface : mesh.surfaces) {
    if (surface.classId != classId("stairs")) continue;
    Surface kept{.material = surface.material, .classId = surface.classId};
    for (const auto& piece : connectedPieces(surface)) {
      const auto flight = flightOf(piece);
      const bool wanted = flight && isWanted(*flight);
      if (wanted) flights.push_back(*flight);
      if (!wanted || !removes) append(kept, piece);
    }
    surface = std::move(kept);
  }
  return flights;
}

bool leadsUp(const StoreyMesh& mesh, const Flight& flight) {
  return std::abs(flight.stairs.foot.z() - mesh.floor()) < kSameLevel;
}

bool leadsDown(const StoreyMesh& mesh, const Flight& flight) {
  return std::abs(headOf(flight.stairs).z() - mesh.floor()) < kSameLevel;
}

Eigen::AlignedBox3d raised(const Eigen::AlignedBox2d& plan, double least, double most) {
  return {Eigen::Vector3d(plan.min().x(), plan.min().y(), least),
          Eigen::Vector3d(plan.max().x(), plan.max().y(), most)};
}

/// From where a flight goes down to the walls round it, or to where the floor begins.
Eigen::AlignedBox2d wellAround(const StoreyMesh& mesh, const Flight& flight) {
  constexpr double kStep = 0.01;
  const auto walls = wallsOf(mesh);
  const Eigen::Vector2d middle = flight.steps.center();
  Eigen::AlignedBox2d well = flight.steps;
  for (const auto& direction :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, -1)}) {
    const double wall = distanceTo(walls, middle, direction);
    double reach = 0.0;
    while (reach < wall && reach < 20.0 && !hasFloorAt(mesh, middle + reach * direction)) reach += kStep;
    well.extend(Eigen::Vector2d(middle + std::min(reach, wall) * direction));
  }
  return well;
}

/// Four walls seen from inside, and a lid at one end.
void addWell(StoreyMesh& mesh, const Eigen::AlignedBox2d& plan, double lid_z, double open_z) {
  const double bottom = std::min(lid_z, open_z);
  const Eigen::Vector3d up(0.0, 0.0, std::abs(open_z - lid_z));
  Surface walls = emptySurface(mesh, "wall");
  const Polygon corners = cornersOf(plan);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& from = corners[(i + 1) % corners.size()];
    const Eigen::Vector2d along = corners[i] - from;
    addRectangle(walls, {from.x(), from.y(), bottom}, {along.x(), along.y(), 0.0}, up);
  }
  const bool isCeiling = lid_z > open_z;
  Surface lid = emptySurface(mesh, isCeiling ? "ceiling" : "floor");
  const Eigen::Vector3d x(plan.sizes().x(), 0.0, 0.0);
  const Eigen::Vector3d y(0.0, plan.sizes().y(), 0.0);
  addRectangle(lid, {plan.min().x(), plan.min().y(), lid_z}, isCeiling ? y : x, isCeiling ? x : y);
  mesh.surfaces.push_back(std::move(walls));
  mesh.surfaces.push_back(std::move(lid));
}

/// Where a wall stands between a landing and a floor beside it, the wall is opened along the landing. Without a landing
/// the head lies on the storey's own floor.
void openLanding(StoreyMesh& upper, const Flight& flight, std::vector<std::string>& remarks) {
  constexpr double kThickestWall = 0.5;
  constexpr double kRails = 0.12;  // that a wall carries stand out by this at most
  const auto walls = wallsOf(upper);
  const Eigen::Vector2d uphill(std::cos(flight.stairs.direction), std::sin(flight.stairs.direction));
  const Eigen::Vector2d head = headOf(flight.stairs).head<2>();
  const double end =
      uphill.cwiseProduct(uphill.x() + uphill.y() > 0.0 ? flight.extent.max() : flight.extent.min()).sum();
  const double length = end - uphill.dot(head);
  if (length < 2.0 * flight.stairs.stepDepth) return;
  const Eigen::Vector2d middle = head + uphill * (length + flight.stairs.stepDepth) / 2.0;
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector2d aside(-side * uphill.y(), side * uphill.x());
    const double face = distanceTo(walls, middle, aside);
    const Eigen::Vector2d beyond = middle + aside * (face + kThickestWall);
    if (!std::isfinite(face) || !hasFloorAt(upper, beyond)) continue;
    const double thickness = kThickestWall - distanceTo(walls, beyond, -aside);
    const double opening = length - flight.stairs.stepDepth;
    Eigen::AlignedBox2d gap;
    for (const double along : {-0.5, 0.5}) {
      for (const double across : {face, face + thickness})
        gap.extend(middle + uphill * along * opening + aside * across);
    }
    const Eigen::Vector2d margin = aside.cwiseAbs() * kRails;
    const Eigen::AlignedBox2d cut(gap.min() - margin, gap.max() + margin);
    cutAway(upper, raised(cut, upper.floor() - 0.01, upper.ceiling() + 0.1), {"wall", "handrail", "skirting", "sign"});
    addFloor(upper, gap);
    // The wall is hollow: its end is closed.
    Surface cap = emptySurface(upper, "wall");
    const Eigen::Vector2d corner = middle - uphill * opening / 2.0 + aside * face;
    const Eigen::Vector2d across = aside * thickness;
    addRectangle(cap, {corner.x(), corner.y(), upper.floor()}, {across.x(), across.y(), 0.0},
                 {0.0, 0.0, upper.storey.ceilingHeight});
    upper.surfaces.push_back(std::move(cap));
    remarks.push_back("the wall beside a landing of storey " + std::to_string(flight.stairs.upperStorey) +
                      " is opened: it left no way off it");
    return;
  }
}

/// The lowest storey's flights down, in wells; those of the others go, and floor takes their place.
void settleFlightsDown(std::vector<StoreyMesh>& storeys, std::vector<Staircase>& stairs,
                       std::vector<std::string>& remarks) {
  for (std::size_t k = 0; k < storeys.size(); ++k) {
    auto& mesh = storeys[k];
    const auto isDown = [&](const Flight& flight) { return leadsDown(mesh, flight); };
    for (auto& flight : takeFlights(mesh, isDown, k > 0)) {
      const auto well = wellAround(mesh, flight);
      if (k > 0) {
        addFloor(mesh, well);
        remarks.push_back("a flight down from storey " + std::to_string(k) +
                          " is left out: the storey below has one up beside it");
        continue;
      }
      flight.stairs.lowerStorey = -1;
      flight.stairs.upperStorey = 0;
      addWell(mesh, well, flight.stairs.foot.z(), mesh.floor());
      stairs.push_back(flight.stairs);
    }
  }
}

/// Cuts the way of a flight up, or gives it a well above the highest storey.
void openWayUp(std::vector<StoreyMesh>& storeys, std::size_t k, const Flight& flight,
               std::vector<std::string>& remarks) {
  constexpr double kMargin = 0.05;
  auto& mesh = storeys[k];
  const double top = headOf(flight.stairs).z();
  const bool isHighest = k + 1 == storeys.size();
  cutAway(mesh, raised(isHighest ? flight.extent : flight.steps, mesh.ceiling() - kMargin, top + kMargin), {"ceiling"});
  if (isHighest) {
    addWell(mesh, flight.extent, top + mesh.storey.ceilingHeight, mesh.ceiling());
    return;
  }
  cutAway(storeys[k + 1], raised(flight.extent, top - kMargin, top + kMargin), {"floor"});
  openLanding(storeys[k + 1], flight, remarks);
}

}  // namespace

std::vector<Staircase> joinByStairs(std::vector<StoreyMesh>& storeys, std::vector<std::string>& remarks) {
  std::vector<Staircase> stairs;
  settleFlightsDown(storeys, stairs, remarks);
  for (std::size_t k = 0; k < storeys.size(); ++k) {
    const auto isUp = [&](const Flight& flight) { return leadsUp(storeys[k], flight); };
    for (auto& flight : takeFlights(storeys[k], isUp, false)) {
      flight.stairs.lowerStorey = static_cast<int>(k);
      flight.stairs.upperStorey = static_cast<int>(k) + 1;
      openWayUp(storeys, k, flight, remarks);
      stairs.push_back(flight.stairs);
    }
  }
  return stairs;
}

}  // namespace prodomos::simulation
