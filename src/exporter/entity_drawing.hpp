// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/map/drawing.hpp"
#include "prodomos/map/entity.hpp"

namespace prodomos::exporter {

/// What the entity looks like in three dimensions, in the frame of its sub-map.
map::Drawing drawEntity(const map::Entity& entity);

}  // namespace prodomos::exporter
