// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "localization/largest_clique.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace prodomos::localization {

void Agreement::set(std::size_t a, std::size_t b) {
  bits_[a * words_ + b / 64] |= 1ULL << (b % 64);
  bits_[b * words_ + a / 64] |= 1ULL << (a % 64);
}

namespace {

using Bits = std::vector<unsigned long long>;

class Search {
 public:
  Search(const Agreement& agreement, std::size_t mostBranches) : agreement_(agreement), branchesLeft_(mostBranches) {}

  std::vector<std::size_t> run() {
    Bits all(agreement_.words(), 0);
    for (std::size_t member = 0; member < agreement_.size(); ++member) all[member / 64] |= 1ULL << (member % 64);
    expand(all);
    std::ranges::sort(best_);
    return best_;
  }

 private:
  struct Coloured {
    std::size_t member = 0;
    std::size_t colours = 0;  ///< of it and those before: no clique among them is larger
  };

  /// Groups in which no two agree, one after the other.
  std::vector<Coloured> coloured(Bits candidates) const {
    std::vector<Coloured> order;
    for (std::size_t colour = 1; std::ranges::any_of(candidates, [](auto word) { return word != 0; }); ++colour) {
      Bits group = candidates;
      for (std::size_t word = 0; word < group.size(); ++word) {
        while (group[word] != 0) {
          const auto bit = static_cast<std::size_t>(std::countr_zero(group[word]));
          const auto member = word * 64 + bit;
          order.push_back({member, colour});
          candidates[word] &= ~(1ULL << bit);
          group[word] &= ~(1ULL << bit);
          for (std::size_t i = word; i < group.size(); ++i) group[i] &= ~agreement_.row(member)[i];
        }
      }
    }
    return order;
  }

  void expand(Bits candidates) {
    const auto order = coloured(candidates);
    for (std::size_t at = order.size(); at-- > 0;) {
      const auto& next = order[at];
      if (chosen_.size() + next.colours <= best_.size()) return;
      if (branchesLeft_ == 0) return;
      --branchesLeft_;
      chosen_.push_back(next.member);
      Bits rest = candidates;
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] &= agreement_.row(next.member)[i];
      if (std::ranges::any_of(rest, [](auto word) { return word != 0; })) {
        expand(std::move(rest));
      } else if (chosen_.size() > best_.size()) {
        best_ = chosen_;
      }
      chosen_.pop_back();
      candidates[next.member / 64] &= ~(1ULL << (next.member % 64));
    }
  }

  const Agreement& agreement_;
  std::size_t branchesLeft_;
  std::vector<std::size_t> chosen_;
  std::vector<std::size_t> best_;
};

}  // namespace

std::vector<std::size_t> largestClique(const Agreement& agreement, std::size_t mostBranches) {
  return Search(agreement, mostBranches).run();
}

}  // namespace prodomos::localization
