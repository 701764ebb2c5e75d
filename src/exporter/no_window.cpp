// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/base/error.hpp"
#include "prodomos/exporter/view3d.hpp"

namespace prodomos::exporter {

void showWindow(const std::filesystem::path& map, bool /*follow*/) {
  map::MapView::open(map);
  throw base::Error(base::expectedFound("view", "a build with windows (PRODOMOS_GUI=ON)",
                                        "one without; --screenshot works in every build"));
}

}  // namespace prodomos::exporter
