// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/objects.hpp"

#include "prodomos/evaluation/alignment.hpp"
#include "prodomos/geometry/assignment.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace prodomos::evaluation {

namespace {

constexpr int kUnlabeledClass = 0;

/// By which label tables know those whom evaluation of humans judges.
bool isPerson(std::string_view className) {
  constexpr std::array<std::string_view, 3> kNames = {"person", "human", "pedestrian"};
  return std::ranges::find(kNames, className) != kNames.end();
}

/// Empty where the class is not known.
std::string classNameOf(const sensors::ClassTable& classes, int id) {
  const auto entry = classes.find(id);
  return id == kUnlabeledClass || entry == classes.end() ? std::string() : entry->second;
}

const sensors::ClassTable& classesOf(const map::MapView& view, base::SubMapId submap) {
  const auto session = view.graph().getNode(submap).session;
  return std::ranges::find(view.sessions(), session, &map::Session::id)->classes;
}

/// The box of an entity that is one.
struct Box {
  int classId = 0;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};
std::optional<Box> boxOf(const map::EntityAttributes& attributes) {
  if (const auto* thing = std::get_if<map::Cuboid>(&attributes)) return Box{thing->classId, thing->size};
  if (const auto* mover = std::get_if<map::ObjectBox>(&attributes)) return Box{mover->classId, mover->size};
  return std::nullopt;
}

/// Could boxes of that distance touch at all?
bool mayTouch(const geometry::OrientedBox& a, const geometry::OrientedBox& b) {
  const double apart = (a.T_frame_box.translation() - b.T_frame_box.translation()).norm();
  return apart < 0.5 * (a.size.norm() + b.size.norm());
}

/// By mapped object (row) and true one: IoU, 0 where they have nothing in common.
Eigen::MatrixXd overlapsOf(const std::vector<MappedObject>& mapped, const std::vector<TrueObject>& objects) {
  Eigen::MatrixXd overlaps = Eigen::MatrixXd::Zero(std::ssize(mapped), std::ssize(objects));
  for (Eigen::Index m = 0; m < overlaps.rows(); ++m) {
    for (Eigen::Index t = 0; t < overlaps.cols(); ++t) {
      const auto& found = mapped[static_cast<std::size_t>(m)];
      const auto& object = objects[static_cast<std::size_t>(t)];
      if (object.poses.empty()) continue;
      const auto box = boxAt(object, found.time);
      if (mayTouch(found.box_in_world, box)) overlaps(m, t) = geometry::intersectionOverUnion(found.box_in_world, box);
    }
  }
  return overlaps;
}

}  // namespace

geometry::OrientedBox boxAt(const TrueObject& object, base::Time time) {
  const auto nearest =
      std::ranges::min_element(object.poses, {}, [&](const auto& pose) { return std::chrono::abs(pose.time - time); });
  return {nearest->T_world_object, object.size};
}

std::vector<MappedObject> objectsOf(const map::MapView& view, const Truth& truth) {
  std::vector<MappedObject> objects;
  const auto T_world_submap = truthFromSubMaps(view, truth);
  for (const auto& entity : view.entities()) {
    const auto box = boxOf(entity.attributes);
    if (!box || !T_world_submap.contains(entity.submap)) continue;
    const auto className = classNameOf(classesOf(view, entity.submap), box->classId);
    if (isPerson(className)) continue;
    objects.push_back(
        {className, {T_world_submap.at(entity.submap) * entity.T_submap_entity, box->size}, entity.lastSeen});
  }
  return objects;
}

ObjectScore scoreObjects(const std::vector<MappedObject>& mapped, const Truth& truth, const ObjectOptions& options) {
  const auto overlaps = overlapsOf(mapped, truth.objects);
  const auto trueClass = [&](std::size_t t) { return classNameOf(truth.classes, truth.objects[t].classId); };
  const auto counts = [&](std::size_t t) { return truth.objects[t].seen >= options.leastSeen; };

  // Of two ways to pair that overlap alike, one in which things are what they are; never one with less overlap.
  constexpr double kOtherClass = 1e-6;
  Eigen::MatrixXd costs(overlaps.rows(), overlaps.cols());
  for (Eigen::Index m = 0; m < costs.rows(); ++m) {
    for (Eigen::Index t = 0; t < costs.cols(); ++t) {
      const bool sameClass = mapped[static_cast<std::size_t>(m)].className == trueClass(static_cast<std::size_t>(t));
      costs(m, t) = overlaps(m, t) < options.leastIou ? geometry::kForbidden
                                                      : 1.0 - overlaps(m, t) + (sameClass ? 0.0 : kOtherClass);
    }
  }

  ObjectScore score;
  for (std::size_t t = 0; t < truth.objects.size(); ++t) {
    if (!counts(t)) continue;
    ++score.all.truth;
    ++score.byClass[trueClass(t)].truth;
  }
  const auto pairs = geometry::assign(costs);
  for (std::size_t m = 0; m < mapped.size(); ++m) {
    const auto& found = mapped[m];
    if (!pairs[m]) {
      ++score.all.mapped;
      ++score.byClass[found.className].mapped;
      continue;
    }
    const auto t = static_cast<std::size_t>(*pairs[m]);
    if (!counts(t)) continue;
    for (auto* part : {&score.all, &score.byClass[trueClass(t)]}) {
      ++part->mapped;
      ++part->found;
    }
    const double overlap = overlaps(static_cast<Eigen::Index>(m), *pairs[m]);
    if (overlap >= options.goodIou) ++score.foundWell;
    if (!found.className.empty()) {
      ++score.classesKnown;
      if (found.className == trueClass(t)) ++score.classesRight;
    }
    const auto box = boxAt(truth.objects[t], found.time);
    score.overlaps.push_back(overlap);
    score.centreErrors.push_back((found.box_in_world.T_frame_box.translation() - box.T_frame_box.translation()).norm());
  }
  return score;
}

ObjectScore& ObjectScore::operator+=(const ObjectScore& other) {
  const auto add = [](ObjectCounts& sum, const ObjectCounts& part) {
    sum.truth += part.truth;
    sum.mapped += part.mapped;
    sum.found += part.found;
  };
  add(all, other.all);
  for (const auto& [name, counts] : other.byClass) add(byClass[name], counts);
  foundWell += other.foundWell;
  classesKnown += other.classesKnown;
  classesRight += other.classesRight;
  centreErrors.insert(centreErrors.end(), other.centreErrors.begin(), other.centreErrors.end());
  overlaps.insert(overlaps.end(), other.overlaps.begin(), other.overlaps.end());
  return *this;
}

}  // namespace prodomos::evaluation
