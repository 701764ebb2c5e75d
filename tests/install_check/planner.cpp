// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

#include <iostream>

int main(int, char** arguments) {
  const auto view = prodomos::map::MapView::open(arguments[1]);
  const auto ahead = prodomos::query::placeAt(view, {1.0, 0.0, {}});
  std::cout << view.graph().nodes().size() << " sub-maps; what lies a metre ahead of the start is in "
            << (ahead.submap ? toString(*ahead.submap) : "none") << "\n";
  return ahead.submap ? 0 : 1;
}
