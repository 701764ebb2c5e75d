// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/person_sighting.hpp"
#include "prodomos/sensors/reading.hpp"

#include <vector>

namespace prodomos::perception {

/// Legs: pairs of arcs of a level scan, as a person shows them. So do chairs: what is found here is a person only once
/// it moves (PersonSighting::mustMove). None in scans of a sensor that is tilted or more than 0.8 m above the floor.
std::vector<PersonSighting> findLegs(const sensors::LaserScan& scan, const geometry::Pose3& T_submap_body,
                                     base::Time time);

}  // namespace prodomos::perception
