// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace prodomos::localization {

/// Who agrees with whom; symmetric.
class Agreement {
 public:
  explicit Agreement(std::size_t size) : size_(size), words_((size + 63) / 64), bits_(size * words_, 0) {}

  void set(std::size_t a, std::size_t b);
  bool operator()(std::size_t a, std::size_t b) const { return (row(a)[b / 64] >> (b % 64) & 1U) != 0; }
  std::size_t size() const { return size_; }
  std::size_t words() const { return words_; }
  const unsigned long long* row(std::size_t a) const { return bits_.data() + a * words_; }

 private:
  std::size_t size_;
  std::size_t words_;
  std::vector<unsigned long long> bits_;
};

/// The largest set that agrees throughout, ascending: branch and bound, with colours as the bound (Tomita and Kameda
/// 2007). Of several that found first; after so many branches the best so far.
std::vector<std::size_t> largestClique(const Agreement& agreement, std::size_t mostBranches = 200'000);

}  // namespace prodomos::localization
