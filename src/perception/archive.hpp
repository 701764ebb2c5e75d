// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/bytes.hpp"
#include "prodomos/base/id.hpp"
#include "prodomos/base/time.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

/// Running state bit by bit, from one list of fields for both ways: a struct has
///
///     static void fields(auto& archive, auto& self) { archive(self.first, self.second); }
///
namespace prodomos::perception {

class Saving {
 public:
  explicit Saving(base::ByteWriter& out) : out_(out) {}
  template <typename... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }

 private:
  template <typename T>
  void write(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      out_ << value;
    } else {
      T::fields(*this, value);
    }
  }
  void write(const base::Time& time) { out_ << base::toNanoseconds(time); }
  template <char Letter>
  void write(const base::Id<Letter>& id) {
    out_ << id.value;
  }
  template <typename Scalar, int kRows, int kColumns>
  void write(const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (const Scalar value : matrix.reshaped()) out_ << value;
  }
  template <typename T>
  void write(const std::optional<T>& value) {
    out_ << value.has_value();
    if (value) write(*value);
  }
  template <typename T>
  void write(const std::vector<T>& values) {
    out_ << static_cast<std::uint64_t>(values.size());
    for (const T& value : values) write(value);
  }
  template <typename T, std::size_t kSize>
  void write(const std::array<T, kSize>& values) {
    for (const T& value : values) write(value);
  }

  base::ByteWriter& out_;
};

/// Throws base::Error at the first byte that is missing.
class Loading {
 public:
  explicit Loading(base::ByteReader& in) : in_(in) {}
  template <typename... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }

 private:
  template <typename T>
  void read(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      in_ >> value;
    } else {
      T::fields(*this, value);
    }
  }
  void read(base::Time& time) { time = base::fromNanoseconds(in_.read<std::int64_t>()); }
  template <char Letter>
  void read(base::Id<Letter>& id) {
    in_ >> id.value;
  }
  template <typename Scalar, int kRows, int kColumns>
  void read(Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    for (Scalar& value : matrix.reshaped()) in_ >> value;
  }
  template <typename T>
  void read(std::optional<T>& value) {
    if (in_.read<bool>()) {
      read(value.emplace());
    } else {
      value.reset();
    }
  }
  template <typename T>
  void read(std::vector<T>& values) {
    const auto count = in_.read<std::uint64_t>();
    values.clear();
    for (std::uint64_t i = 0; i < count; ++i) read(values.emplace_back());  // ends at the first byte that is missing
  }
  template <typename T, std::size_t kSize>
  void read(std::array<T, kSize>& values) {
    for (T& value : values) read(value);
  }

  base::ByteReader& in_;
};

}  // namespace prodomos::perception
