// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/error.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace prodomos::base {

static_assert(std::endian::native == std::endian::little, "blobs are little endian");

/// Appends plain values in little-endian order; strings and vectors with their length (uint64) before them.
class ByteWriter {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> ByteWriter& operator<<(T value) {
    append(&value, sizeof value);
    return *this;
  }
  ByteWriter& operator<<(std::string_view text) {
    *this << static_cast<std::uint64_t>(text.size());
    append(text.data(), text.size());
    return *this;
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T> ByteWriter& operator<<(const std::vector<T>& values) {
    *this << static_cast<std::uint64_t>(values.size());
    append(values.data(), values.size() * sizeof(T));
    return *this;
  }

  /// As they are, without a length.
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const auto at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, data, size);
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads what ByteWriter wrote; throws Error at the first byte that is missing.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> ByteReader& operator>>(T& value) {
    take(&value, sizeof value);
    return *this;
  }
  ByteReader& operator>>(std::string& text) {
    text.resize(takeCount(1));
    take(text.data(), text.size());
    return *this;
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T> ByteReader& operator>>(std::vector<T>& values) {
    values.resize(takeCount(sizeof(T)));
    take(values.data(), values.size() * sizeof(T));
    return *this;
  }
  template <typename T>
  T read() {
    T value{};
    *this >> value;
    return value;
  }

  /// What append() wrote.
  void take(void* data, std::size_t size) {
    if (size > bytes_.size())
      throw Error("expected " + std::to_string(size) + " more bytes, found " + std::to_string(left()));
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::size_t takeCount(std::size_t elementSize) {
    const auto count = read<std::uint64_t>();
    if (count > left() / elementSize)
      throw Error("expected " + std::to_string(count) + " elements, found " + std::to_string(left()) + " bytes");
    return static_cast<std::size_t>(count);
  }
  std::span<const std::byte> bytes_;
};

}  // namespace prodomos::base
