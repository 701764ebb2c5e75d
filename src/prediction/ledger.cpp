// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prediction/ledger.hpp"

#include "prodomos/geometry/polygon.hpp"

#include <iomanip>
#include <locale>
#include <sstream>

namespace prodomos::prediction {

namespace {

void write(std::ostream& out, const geometry::Polygon& polygon) {
  const char* separator = "";
  out << '[';
  for (const auto& corner : polygon) {
    out << separator << '[' << corner.x() << ',' << corner.y() << ']';
    separator = ",";
  }
  out << ']';
}

/// Later the ledger tells only what is then likely, and whoever judges a bet must know what it was on.
void writeShape(std::ostream& out, const map::Prediction& prediction) {
  const auto inSubmap = [&](const geometry::Polygon& polygon_in_node) {
    return geometry::transformed(prediction.T_submap_node, polygon_in_node);
  };
  const char* separator = "";
  out << R"(,"submap":)" << prediction.submap.value << R"(,"areas":[)";
  for (const auto& area : prediction.areas) {
    out << separator << R"({"threshold":)" << area.threshold << R"(,"outline":)";
    write(out, inSubmap(area.outline_in_node));
    out << '}';
    separator = ",";
  }
  out << R"(],"room":)";
  write(out, inSubmap(prediction.room_in_node));
}

}  // namespace

map::Event eventOf(const map::Prediction& prediction, base::SessionId session, base::Time time) {
  const bool isOpen = prediction.state == map::PredictionState::kOpen;
  std::ostringstream payload;
  payload.imbue(std::locale::classic());
  payload << std::fixed << std::setprecision(3) << R"({"state":")" << toString(prediction.state) << '"';
  if (isOpen) writeShape(payload, prediction);
  payload << '}';
  return {time, session, isOpen ? "prediction_made" : "prediction_settled", toString(prediction.id), payload.str()};
}

}  // namespace prodomos::prediction
