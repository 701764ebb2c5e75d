// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"
#include "prodomos/simulation/ray_scene.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace prodomos::simulation {

/// The building as rays meet it, at one time after the other.
class Stage {
 public:
  Stage(const Building& building, std::uint64_t seed);

  /// Doors swing, people move to where they are then, seconds since the log began: all whom one can see from `eye`, on
  /// the same storey or near by. The others stay as they were.
  void setTime(double seconds, const Eigen::Vector3d& eye, int threads = 0);
  const RayScene& scene() const { return *scene_; }

 private:
  /// Surfaces that move together: those of a door's leaves, those of a person.
  struct Moving {
    std::size_t index;  ///< of the door or the person
    std::size_t first;  ///< of its surfaces in the scene
  };

  std::vector<Surface> leaves(std::size_t door, double seconds) const;
  std::vector<Surface> body(std::size_t person, double seconds) const;
  bool canBeSeen(const Person& person, double seconds, const Eigen::Vector3d& eye) const;
  void move(const Moving& moving, const std::vector<Surface>& surfaces);

  const Building& building_;
  std::uint64_t seed_;
  std::vector<Moving> doors_;
  std::vector<Moving> people_;
  std::vector<double> angles_;  ///< of doors_, as they stand in the scene
  std::unique_ptr<RayScene> scene_;
};

}  // namespace prodomos::simulation
