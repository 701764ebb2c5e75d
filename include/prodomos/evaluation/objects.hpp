// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/evaluation/statistics.hpp"
#include "prodomos/evaluation/truth.hpp"
#include "prodomos/geometry/overlap.hpp"
#include "prodomos/map/map_view.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// Things as oriented boxes (000 §III-C, 001) against the true boxes. docs/evaluation.md defines every measure.
namespace prodomos::evaluation {

/// A box of the map; of one that moves, where it was last.
struct MappedObject {
  std::string className;  ///< empty: not known
  geometry::OrientedBox box_in_world;
  base::Time time{};  ///< when it was there
};

/// Cuboids and boxes of moving things, but for persons; each brought into the world with its sub-map.
std::vector<MappedObject> objectsOf(const map::MapView& view, const Truth& truth);

struct ObjectOptions {
  double leastSeen = 0.1;  ///< m² of a thing's surface that must have been seen; less, and it counts neither way
  double leastIou = 0.25;  ///< of boxes that are taken for the same thing
  double goodIou = 0.5;    ///< of the stricter recall and precision
};

struct ObjectCounts {
  std::size_t truth = 0;   ///< seen well enough
  std::size_t mapped = 0;  ///< but for those of things barely seen
  std::size_t found = 0;   ///< pairs of both
};

struct ObjectScore {
  ObjectCounts all;
  std::size_t foundWell = 0;                    ///< pairs whose boxes share ObjectOptions::goodIou
  std::size_t classesKnown = 0;                 ///< pairs whose class the map tells
  std::size_t classesRight = 0;                 ///< of them
  std::vector<double> centreErrors;             ///< of pairs, metres
  std::vector<double> overlaps;                 ///< of pairs: intersection over union in 3D
  std::map<std::string, ObjectCounts> byClass;  ///< the true class where there is one, else the map's

  std::optional<double> recall() const { return shareOf(all.found, all.truth); }
  std::optional<double> precision() const { return shareOf(all.found, all.mapped); }
  std::optional<double> goodRecall() const { return shareOf(foundWell, all.truth); }
  std::optional<double> goodPrecision() const { return shareOf(foundWell, all.mapped); }
  std::optional<double> classAccuracy() const { return shareOf(classesRight, classesKnown); }
  /// For scores over several maps.
  ObjectScore& operator+=(const ObjectScore& other);
};

/// Boxes are paired one to one for the greatest sum of IoUs; of equal ones, those of the same class.
ObjectScore scoreObjects(const std::vector<MappedObject>& mapped, const Truth& truth,
                         const ObjectOptions& options = {});

/// Where a true thing was at that time: its pose nearest to it. It must have one.
geometry::OrientedBox boxAt(const TrueObject& object, base::Time time);

}  // namespace prodomos::evaluation
