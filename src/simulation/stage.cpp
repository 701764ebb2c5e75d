// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/stage.hpp"

#include "prodomos/simulation/furniture.hpp"
#include "prodomos/simulation/person.hpp"
#include "prodomos/simulation/shell.hpp"

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

void Stage::setTime(double seconds) {
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const double angle = openingAngle(building_.doors[doors_[i].index], seconds);
    if (angle == angles_[i]) continue;
    angles_[i] = angle;
    move(doors_[i], leaves(doors_[i].index, seconds));
  }
  for (const auto& person : people_) move(person, body(person.index, seconds));
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

void Stage::move(const Moving& moving, const std::vector<Surface>& surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) scene_->move(moving.first + i, surfaces[i]);
}

}  // namespace prodomos::simulation
