// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string_view>

namespace prodomos::io {

/// Turns stored bytes into plain ones, block by block, and keeps all that came before a damaged place.
class Decompressor {
 public:
  struct Step {
    std::size_t consumed = 0;
    std::size_t produced = 0;
    bool damaged = false;
  };

  virtual ~Decompressor() = default;

  virtual Step step(std::span<const char> stored, std::span<char> plain) = 0;
  /// True where the stored bytes may end: not within a compressed stream.
  virtual bool complete() const = 0;
};

/// Recognised by the first (three) bytes: gzip, bzip2, or none.
std::unique_ptr<Decompressor> makeDecompressor(std::string_view magic);

}  // namespace prodomos::io
