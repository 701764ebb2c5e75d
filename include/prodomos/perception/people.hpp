// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/perception/leg_detector.hpp"
#include "prodomos/perception/people_config.hpp"
#include "prodomos/perception/person_detector.hpp"
#include "prodomos/perception/person_sighting.hpp"
#include "prodomos/perception/person_tracker.hpp"
