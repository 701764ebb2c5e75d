// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>

namespace prodomos::exporter {

/// The object as a gzip'd stream, which is what MRPT's files are. Whole or not at all; throws base::FileError.
void writeMrptFile(const std::filesystem::path& path, const mrpt::serialization::CSerializable& object);

}  // namespace prodomos::exporter
