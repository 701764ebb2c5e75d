// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/query/query.hpp"

#include <iostream>

int main(int, char** arguments) {
  const auto view = prodomos::map::MapView::open(arguments[1]);
  const auto start = prodomos::query::placeAt(view, {0.0, 0.0, {}});
  std::cout << view.graph().nodes().size() << " sub-maps; the origin lies in "
            << (start.submap ? toString(*start.submap) : "none") << "\n";
  return start.submap ? 0 : 1;
}
