// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/stage.hpp"

#include "prodomos/simulation/furniture.hpp"
#include "prodomos/simulation/person.hpp"
#include "prodomos/simulation/population.hpp"
#include "prodomos/simulation/shell.hpp"

#include "simulation/sensing/parallel_rows.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace prodomos::simulation {

namespace {

void addAll(std::vector<Surface>& all, std::vector<Surface> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<Surface> fixedSurfaces(const Building& building, std::uint64_t seed) {
  auto surfaces = shellOf(building, seed);
  addAll(surfaces, building.imported);
  for (std::size_t i = 0; i < building.things.size(); ++i) addAll(surfaces, surfacesOf(building, i, seed));
  return surfaces;
}

}  // namespace

Stage::Stage(const Building& building, std::uint64_t seed) : building_(building), seed_(seed) {
  std::vector<Surface> moving;
  for (std::size_t i = 0; i < building.doors.size(); ++i) {
    auto surfaces = leaves(i, 0.0);
    if (surfaces.empty()) continue;  // a doorway
    doors_.push_back({i, moving.size()});
    angles_.push_back(openingAngle(building.doors[i], 0.0));
    addAll(moving, std::move(surfaces));
  }
  for (std::size_t i = 0; i < building.people.size(); ++i) {
    people_.push_back({i, moving.size()});
    addAll(moving, body(i, 0.0));
  }
  scene_ = std::make_unique<RayScene>(fixedSurfaces(building, seed), std::move(moving));
}

void Stage::setTime(double seconds, const Eigen::Vector3d& eye, int threads) {
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const double angle = openingAngle(building_.doors[doors_[i].index], seconds);
    if (angle == angles_[i]) continue;
    angles_[i] = angle;
    move(doors_[i], leaves(doors_[i].index, seconds));
  }
  std::vector<Moving> seen;
  std::ranges::copy_if(people_, std::back_inserter(seen),
                       [&](const Moving& person) { return canBeSeen(building_.people[person.index], seconds, eye); });
  std::vector<std::vector<Surface>> bodies(seen.size());
  forRows(static_cast<int>(seen.size()), threads, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    bodies[at] = body(seen[at].index, seconds);
  });
  for (std::size_t i = 0; i < seen.size(); ++i) move(seen[i], bodies[i]);
  scene_->commit();
}

std::vector<Surface> Stage::leaves(std::size_t door, double seconds) const {
  return leavesAt(building_, door, seconds, seed_);
}

std::vector<Surface> Stage::body(std::size_t person, double seconds) const {
  const auto& one = building_.people[person];
  return bodyAt(one, building_.storeys[static_cast<std::size_t>(one.storey)].floor_z, seconds,
                personInstance(building_, person));
}

bool Stage::canBeSeen(const Person& person, double seconds, const Eigen::Vector3d& eye) const {
  constexpr double kNear = 12.0;  // metres: through a stairwell
  const double floor_z = building_.storeys[static_cast<std::size_t>(person.storey)].floor_z;
  const double above = eye.z() - floor_z;
  return (above > 0.0 && above < 2.5) || (positionAt(person, seconds) - eye.head<2>()).norm() < kNear;
}

void Stage::move(const Moving& moving, const std::vector<Surface>& surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) scene_->move(moving.first + i, surfaces[i]);
}

}  // namespace prodomos::simulation
