// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/score_page.hpp"

#include "prodomos/base/error.hpp"

#include "evaluation/svg.hpp"

#include <cmath>
#include <fstream>

namespace prodomos::evaluation {

namespace {

/// Hues that also those tell apart who see fewer of them (Okabe and Ito 2008), darker on light and lighter on dark.
constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark; --bg: #fff; --ink: #1c2127; --soft: #59636e; --line: #d8dde3; --band: #f5f7f9;
  --room: #eceff2; --entered: #fff; --wall: #77818c; --thing: #c9d0d7; --true: #59636e; --map: #0067a8;
  --right: #00805e; --wrong: #c04a00; --missed: #b3134a; --bet: #d98e00; --person: #a8468c; }
@media (prefers-color-scheme: dark) { :root { --bg: #14181d; --ink: #e6eaee; --soft: #a2acb7; --line: #343c45;
  --band: #1b2027; --room: #1c2229; --entered: #29313a; --wall: #8a96a3; --thing: #46505b; --true: #a2acb7;
  --map: #56b4e9; --right: #2fc79b; --wrong: #f08a4b; --missed: #ff6b97; --bet: #f0b429; --person: #e08cc8; } }
body { margin: 0 auto; padding: 1.5rem; max-width: 76rem; background: var(--bg); color: var(--ink);
  font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: 0 0 .3rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .4rem; }
p { margin: .2rem 0; color: var(--soft); overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: .4rem 0; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .8rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; color: var(--soft); } th:first-child, td:first-child { text-align: left; padding-left: .2rem; }
tbody tr:hover { background: var(--band); }
figure { margin: .4rem 0; } svg { display: block; max-width: 100%; height: auto; }
figcaption { display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; margin-top: .5rem; font-size: .85rem; color: var(--soft); }
figcaption span { display: inline-flex; align-items: center; gap: .4rem; } figcaption svg { display: inline; flex: none; }
svg text { font: 11px system-ui, sans-serif; fill: var(--soft); text-anchor: middle; dominant-baseline: central; }
svg text.left { text-anchor: start; } svg text.right-end { text-anchor: end; }
svg text.name { paint-order: stroke; stroke: var(--room); stroke-width: 3px; stroke-linejoin: round; }
.room { fill: var(--room); stroke: var(--wall); stroke-width: 1.5; } .room.entered { fill: var(--entered); }
.seen { fill: var(--room); } .seen-wall { fill: var(--wall); }
.thing { fill: var(--thing); stroke: none; } .mapped-thing { fill: none; stroke: var(--map); stroke-width: 1.2; }
.stairs, .step { fill: none; stroke: var(--true); stroke-width: 1; }
.door { stroke: var(--true); stroke-width: 5; fill: none; } .door.unseen { opacity: .35; }
.doorway { stroke: var(--true); stroke-width: 1.5; stroke-dasharray: 3 3; fill: none; }
.way { fill: none; stroke: var(--true); stroke-width: 1.2; }
.mapped-way { fill: none; stroke: var(--map); stroke-width: 1.6; stroke-dasharray: 5 3; }
.person { fill: none; stroke: var(--person); stroke-width: 1.6; stroke-linecap: round; }
.mapped-person { fill: none; stroke: var(--person); stroke-width: 4; opacity: .4; stroke-linecap: round; }
.bet { fill: var(--bet); stroke: var(--bet); stroke-width: 1; }
.right { fill: var(--right); stroke: var(--right); } .wrong { fill: var(--wrong); stroke: var(--wrong); }
.neither { fill: var(--bg); stroke: var(--map); } .claim { stroke-width: 2; } .outline { fill-opacity: .15; }
.missed { fill: none; stroke: var(--missed); stroke-width: 2.5; }
.axis { stroke: var(--wall); stroke-width: 1; fill: none; } .grid { stroke: var(--line); stroke-width: 1; fill: none; }
.diagonal { stroke: var(--soft); stroke-dasharray: 4 4; fill: none; }
.bar { fill: var(--map); opacity: .3; } .dot { fill: var(--map); }
)css";

std::string tableIn(const ScoreTable& table) {
  std::string html = "<section>\n<h2>" + escaped(table.title) + "</h2>\n";
  if (!table.text.empty()) html += "<p>" + escaped(table.text) + "</p>\n";
  html += "<div class=\"scroll\"><table>\n<thead><tr>";
  for (const auto& column : table.columns) html += "<th>" + escaped(column) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const auto& cell : row) html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n</section>\n";
}

std::string pictureIn(const ScorePicture& picture) {
  std::string html = "<section>\n<h2>" + escaped(picture.title) + "</h2>\n<figure>\n<div class=\"scroll\">" +
                     picture.svg + "</div>\n<figcaption>";
  for (const auto& entry : picture.legend) {
    html += "<span><svg viewBox=\"0 0 22 12\" width=\"22\" aria-hidden=\"true\"><path class=\"" + escaped(entry.mark) +
            "\" d=\"" + (entry.isLine ? "M1 6 H21" : "M3 2 H19 V10 H3 Z") + "\"/></svg>" + escaped(entry.text) +
            "</span>\n";
  }
  return html + "</figcaption>\n</figure>\n</section>\n";
}

}  // namespace

void writeScorePage(const ScorePage& page, const std::filesystem::path& path) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(page.title) + "</title>\n<style>" + std::string(kStyle) + "</style>\n</head>\n<body>\n<h1>" +
      escaped(page.title) + "</h1>\n";
  for (const auto& line : page.lines) html += "<p>" + escaped(line) + "</p>\n";
  for (const auto& table : page.tables) html += tableIn(table);
  for (const auto& picture : page.pictures) html += pictureIn(picture);
  html += "</body>\n</html>\n";

  std::ofstream file(path, std::ios::binary);
  file << html;
  file.close();
  if (!file) throw base::FileError(path.string() + ": cannot be written");
}

std::string figure(const std::optional<double>& value, int decimals) {
  return value && std::isfinite(*value) ? fixed(*value, decimals) : "–";
}

ScorePicture reliabilityPicture(const Calibration& calibration) {
  constexpr double kSide = 320.0;
  constexpr double kMargin = 44.0;
  constexpr double kBars = 60.0;  // below the diagram: how many bets there are
  const auto at = [&](double x, double y) {
    return Eigen::Vector2d(kMargin + kSide * x, kMargin / 2 + kSide * (1.0 - y));
  };
  std::size_t most = 1;
  for (const auto& bin : calibration.bins) most = std::max(most, bin.count);

  Svg svg;
  for (const double tick : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    svg.polyline({at(0, tick), at(1, tick)}, "grid");
    svg.polyline({at(tick, 0), at(tick, 1)}, "grid");
    svg.text(at(0, tick) - Eigen::Vector2d(8, 0), fixed(tick, 2), "right-end");
    svg.text(at(tick, 0) + Eigen::Vector2d(0, kBars + 24), fixed(tick, 2), "tick");
  }
  svg.polyline({at(0, 0), at(1, 1)}, "diagonal");
  const double floor = at(0, 0).y() + kBars + 8;
  svg.polyline({{at(0, 0).x(), floor}, {at(1, 0).x(), floor}}, "axis");
  for (const auto& bin : calibration.bins) {
    if (bin.count == 0) continue;
    const std::string title =
        std::to_string(bin.count) + " said " + fixed(bin.meanProbability, 2) + ", came true " + fixed(bin.frequency, 2);
    const double height = kBars * static_cast<double>(bin.count) / static_cast<double>(most);
    const double left = at(bin.from, 0).x() + 2;
    const double right = at(bin.to, 0).x() - 2;
    svg.polygon({{left, floor}, {right, floor}, {right, floor - height}, {left, floor - height}}, "bar", title);
    svg.circle(at(bin.meanProbability, bin.frequency), 5, "dot", title);
  }
  svg.text({kMargin + kSide / 2, floor + 34}, "probability that was said", "axis-name");
  return {.title = "Reliability: Brier " + figure(calibration.brier) + ", skill " + figure(calibration.brierSkill) +
                   ", ECE " + figure(calibration.expectedError) + " of " + std::to_string(calibration.count) + " bets",
          .svg = svg.str(kSide + 2 * kMargin, floor + 48, "reliability diagram"),
          .legend = {{"dot", "share that came true, of bets said to be so likely"},
                     {"diagonal", "as it should be", true},
                     {"bar", "how many bets, at most " + std::to_string(most)}}};
}

}  // namespace prodomos::evaluation
