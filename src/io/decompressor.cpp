// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/decompressor.hpp"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>

namespace prodomos::io {

namespace {

class PlainBytes final : public Decompressor {
 public:
  Step step(std::span<const char> stored, std::span<char> plain) override {
    const std::size_t count = std::min(stored.size(), plain.size());
    std::copy_n(stored.begin(), count, plain.begin());
    return {count, count, false};
  }
  bool complete() const override { return true; }
};

/// Files of several gzip members, one after the other, are one file.
class GzipBytes final : public Decompressor {
 public:
  GzipBytes() { inflateInit2(&state_, kGzipOnly); }
  GzipBytes(const GzipBytes&) = delete;
  GzipBytes& operator=(const GzipBytes&) = delete;
  ~GzipBytes() override { inflateEnd(&state_); }

  Step step(std::span<const char> stored, std::span<char> plain) override {
    if (complete_ && stored.empty()) return {};
    if (complete_) inflateReset(&state_);
    // zlib's interface lacks const; it does not write to its input.
    state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data()));
    state_.avail_in = static_cast<uInt>(stored.size());
    state_.next_out = reinterpret_cast<Bytef*>(plain.data());
    state_.avail_out = static_cast<uInt>(plain.size());
    const int result = inflate(&state_, Z_NO_FLUSH);
    complete_ = result == Z_STREAM_END;
    return {stored.size() - state_.avail_in, plain.size() - state_.avail_out,
            result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR};
  }
  bool complete() const override { return complete_; }

 private:
  static constexpr int kGzipOnly = 16 + MAX_WBITS;
  z_stream state_{};
  bool complete_ = false;
};

class Bzip2Bytes final : public Decompressor {
 public:
  Bzip2Bytes() { BZ2_bzDecompressInit(&state_, 0, 0); }
  Bzip2Bytes(const Bzip2Bytes&) = delete;
  Bzip2Bytes& operator=(const Bzip2Bytes&) = delete;
  ~Bzip2Bytes() override { BZ2_bzDecompressEnd(&state_); }

  Step step(std::span<const char> stored, std::span<char> plain) override {
    if (complete_ && stored.empty()) return {};
    if (complete_) {
      BZ2_bzDecompressEnd(&state_);
      state_ = {};
      BZ2_bzDecompressInit(&state_, 0, 0);
    }
    state_.next_in = const_cast<char*>(stored.data());
    state_.avail_in = static_cast<unsigned>(stored.size());
    state_.next_out = plain.data();
    state_.avail_out = static_cast<unsigned>(plain.size());
    const int result = BZ2_bzDecompress(&state_);
    complete_ = result == BZ_STREAM_END;
    return {stored.size() - state_.avail_in, plain.size() - state_.avail_out,
            result != BZ_OK && result != BZ_STREAM_END};
  }
  bool complete() const override { return complete_; }

 private:
  bz_stream state_{};
  bool complete_ = false;
};

}  // namespace

std::unique_ptr<Decompressor> makeDecompressor(std::string_view magic) {
  if (magic.starts_with("\x1f\x8b")) return std::make_unique<GzipBytes>();
  if (magic.starts_with("BZh")) return std::make_unique<Bzip2Bytes>();
  return std::make_unique<PlainBytes>();
}

}  // namespace prodomos::io
