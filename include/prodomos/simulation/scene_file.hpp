// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/simulation/building.hpp"

#include <cstdint>
#include <filesystem>

namespace prodomos::simulation {

/// Does the file begin with the key `scene`, comments and `---` aside?
bool isSceneFile(const std::filesystem::path& path);

/// A building as a person has written it down (docs/scene-files.md). Of a door, the state, the hinge side and the side
/// it opens to are drawn by seed where the file does not give them; furniture is left to furnish(), which spares what
/// the file gives. Throws base::FileError where the file cannot be read or is not YAML, and one base::UsageError with
/// all other faults, each naming file, line, key, expected and found.
Building readSceneFile(const std::filesystem::path& path, std::uint64_t seed);

}  // namespace prodomos::simulation
