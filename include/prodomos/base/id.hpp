// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

namespace prodomos::base {

/// A stable number of one kind of thing. Ids never change and are never used twice within a map, over all its
/// sessions. Prints as its kind's letter and the number: `s12`.
template <char Letter>
struct Id {
  std::int64_t value = 0;

  auto operator<=>(const Id&) const = default;
};

using SubMapId = Id<'s'>;
using EdgeId = Id<'e'>;
using EntityId = Id<'o'>;  ///< "o" as in object
using PredictionId = Id<'p'>;
using SessionId = Id<'r'>;  ///< "r" as in run
using TrackId = Id<'t'>;

template <char Letter>
std::string toString(Id<Letter> id) {
  return Letter + std::to_string(id.value);
}

template <char Letter>
std::ostream& operator<<(std::ostream& out, Id<Letter> id) {
  return out << toString(id);
}

/// Reads what toString() writes; nothing else.
template <typename IdType>
std::optional<IdType> parseId(std::string_view text) {
  IdType id{1};
  const std::string letter = toString(id).substr(0, 1);
  if (text.size() < 2 || text.size() > 19 || text.substr(0, 1) != letter) return std::nullopt;
  id.value = 0;
  for (const char digit : text.substr(1)) {
    if (digit < '0' || digit > '9') return std::nullopt;
    id.value = id.value * 10 + (digit - '0');
  }
  return id;
}

}  // namespace prodomos::base

template <char Letter>
struct std::hash<prodomos::base::Id<Letter>> {
  std::size_t operator()(prodomos::base::Id<Letter> id) const noexcept { return std::hash<std::int64_t>{}(id.value); }
};
