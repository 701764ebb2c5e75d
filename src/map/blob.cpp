// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map/blob.hpp"

#include "prodomos/base/error.hpp"

#include <zlib.h>

namespace prodomos::map {

namespace {
const Bytef* toZlib(const std::byte* bytes) {
  return reinterpret_cast<const Bytef*>(bytes);
}
}  // namespace

std::int64_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::int64_t>(crc32_z(0, toZlib(bytes.data()), bytes.size()));
}

std::vector<std::byte> compress(std::span<const std::byte> raw) {
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  std::vector<std::byte> packed(size);
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, toZlib(raw.data()), static_cast<uLong>(raw.size()),
            Z_BEST_SPEED);
  packed.resize(size);
  return packed;
}

std::vector<std::byte> decompress(std::span<const std::byte> packed, std::size_t rawSize) {
  constexpr std::size_t kGreatestRatio = 1032;  // of deflate; more is not worth asking memory for
  if (rawSize / kGreatestRatio <= packed.size()) {
    std::vector<std::byte> raw(rawSize);
    uLongf size = static_cast<uLongf>(rawSize);
    const int code = uncompress(reinterpret_cast<Bytef*>(raw.data()), &size, toZlib(packed.data()),
                                static_cast<uLong>(packed.size()));
    if (code == Z_OK && size == rawSize) return raw;
  }
  throw base::Error("expected " + std::to_string(rawSize) + " compressed bytes, found a damaged stream");
}

}  // namespace prodomos::map
