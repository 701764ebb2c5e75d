// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace prodomos::map {

/// CRC-32 of zlib: what the column crc32 holds of the bytes beside it.
std::int64_t checksum(std::span<const std::byte> bytes);

std::vector<std::byte> compress(std::span<const std::byte> raw);
/// Throws base::Error where the bytes are no zlib stream of that many.
std::vector<std::byte> decompress(std::span<const std::byte> packed, std::size_t rawSize);

}  // namespace prodomos::map
