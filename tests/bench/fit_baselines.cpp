// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// fit_baselines PLANS SPLIT.yaml > src/evaluation/trained_baselines.hpp
//
// Fits the trivial predictors of rooms (evaluation/baselines.hpp) to the training plans. Corridors count as seen, and
// of the other rooms 0, 30 and 60 %, drawn by seed: what is seen is known with its walls, 0.1 m thick. Each door with a
// leaf between a seen room and an unseen one of at most 60 m², no corridor and no stairwell, is a case; its pose is the
// true one. Prints what the sizes reach on training, validation and test plans to stderr.
#include "prodomos/base/random.hpp"
#include "prodomos/evaluation/baselines.hpp"
#include "prodomos/evaluation/room_shapes.hpp"
#include "prodomos/simulation/floor_plan.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>

namespace prodomos {
namespace {

constexpr double kResolution = 0.1;  // metres, of cells; finer ones change the sizes by no step
constexpr std::array kSharesSeen = {0.0, 0.3, 0.6};

using Visit = std::function<void(const evaluation::DoorView&)>;

std::vector<bool> drawSeen(const simulation::Building& building, double share) {
  base::Random random(static_cast<std::uint64_t>(100 * share), "fit_baselines " + building.name);
  std::vector<bool> seen;
  for (const auto& room : building.rooms) {
    seen.push_back(room.use == simulation::RoomUse::kCorridor || random.uniform() < share);
  }
  return seen;
}

/// Cells of the seen rooms and of the walls around them.
evaluation::CellMap<std::uint8_t> knownCells(const simulation::Building& building, const std::vector<bool>& seen) {
  std::vector<evaluation::Polygon> outlines;
  for (const auto& room : building.rooms) outlines.push_back(room.outline);
  evaluation::CellMap<std::uint8_t> known(evaluation::boxOf(outlines, kResolution), 0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) continue;
    for (const auto cell : evaluation::cellsIn(outlines[i], kResolution)) {
      for (const int dy : {-1, 0, 1}) {
        for (const int dx : {-1, 0, 1}) {
          if (auto* value = known.find({cell.x + dx, cell.y + dy})) *value = 1;
        }
      }
    }
  }
  return known;
}

bool isOrdinary(const simulation::Room& room) {
  return room.use == simulation::RoomUse::kRoom &&
         std::abs(simulation::signedArea(room.outline)) <= evaluation::kLargestRoom;
}

void visitDoors(const simulation::Building& building, double shareSeen, const Visit& visit) {
  const auto seen = drawSeen(building, shareSeen);
  const auto known = knownCells(building, seen);
  const auto isKnown = [&known](const Eigen::Vector2d& point) {
    return known.at(geometry::cellAt(point.x(), point.y(), kResolution)) != 0;
  };
  for (const auto& door : building.doors) {
    if (door.leaves == 0) continue;
    for (const std::size_t far : {0U, 1U}) {
      const int room = door.rooms[far];
      const int other = door.rooms[1 - far];
      if (room == simulation::kOutside || other == simulation::kOutside) continue;
      if (seen[static_cast<std::size_t>(room)] || !seen[static_cast<std::size_t>(other)]) continue;
      const auto& unseen = building.rooms[static_cast<std::size_t>(room)];
      if (!isOrdinary(unseen)) continue;
      const double turn = far == 1 ? 0.0 : std::numbers::pi;
      visit({door.pose * geometry::Pose2{0.0, 0.0, turn}, unseen.outline, isKnown, kResolution});
    }
  }
}

void visitPlans(const std::filesystem::path& plans, const YAML::Node& names, const Visit& visit) {
  for (const auto& name : names) {
    const auto plan = plans / name.as<std::string>();
    try {
      const auto building = simulation::readFloorPlan(plan, {});
      for (const double share : kSharesSeen) visitDoors(building, share, visit);
    } catch (const std::exception& fault) {
      std::cerr << fault.what() << '\n';
    }
  }
}

struct Reached {
  std::size_t count = 0;
  double halfDisc = 0.0;  ///< sums of IoUs
  double fixedBox = 0.0;
  double clippedBox = 0.0;
  double oracleBox = 0.0;

  void add(const evaluation::DoorView& view, const evaluation::Baselines& sizes) {
    ++count;
    const auto radius = static_cast<std::size_t>(std::lround(sizes.halfDiscRadius / evaluation::kRadiusStep)) - 1;
    halfDisc += view.iousOfHalfDiscs()[radius];
    fixedBox += view.iou(sizes.fixedBox);
    clippedBox += view.iouClipped(sizes.clippedBox);
    oracleBox += view.iou(view.bestBox());
  }
};

std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string braced(const evaluation::DoorBox& box) {
  return "{" + fixed(box.left, 1) + ", " + fixed(box.right, 1) + ", " + fixed(box.depth, 1) + "}";
}

void printHeader(const evaluation::BaselineFit& fit) {
  const auto best = fit.best();
  std::cout << "// SPDX-FileCopyrightText: 2026 the prodomos authors\n"
               "// SPDX-License-Identifier: BSD-3-Clause\n"
               "#pragma once\n\n"
               "#include \"prodomos/evaluation/baselines.hpp\"\n\n"
               "namespace prodomos::evaluation {\n\n"
               "/// Written by tests/bench/fit_baselines, from the training plans of datasets/plans_split.yaml: "
            << fit.count() << " doors.\n/// Mean IoU there: half-disc " << fixed(best.halfDisc, 3) << ", fixed box "
            << fixed(best.fixedBox, 3) << ", clipped box " << fixed(best.clippedBox, 3) << ".\n"
            << "inline constexpr Baselines kTrainedBaselines = {.halfDiscRadius = "
            << fixed(best.sizes.halfDiscRadius, 2)
            << ",\n                                                .fixedBox = " << braced(best.sizes.fixedBox)
            << ",\n                                                .clippedBox = " << braced(best.sizes.clippedBox)
            << "};\n\n}  // namespace prodomos::evaluation\n";
}

int run(const std::filesystem::path& plans, const std::string& splitFile) {
  const auto split = YAML::LoadFile(splitFile);
  evaluation::BaselineFit fit;
  visitPlans(plans, split["train"], [&](const evaluation::DoorView& view) { fit.add(view); });
  if (fit.count() == 0) {
    std::cerr << "no door in the training plans\n";
    return 1;
  }
  printHeader(fit);
  for (const char* part : {"train", "validation", "test"}) {
    Reached reached;
    visitPlans(plans, split[part], [&](const evaluation::DoorView& view) { reached.add(view, fit.best().sizes); });
    const auto mean = [&](double sum) { return fixed(sum / static_cast<double>(reached.count), 3); };
    std::cerr << part << ": " << reached.count << " doors; mean IoU of half-disc " << mean(reached.halfDisc)
              << ", fixed box " << mean(reached.fixedBox) << ", clipped box " << mean(reached.clippedBox)
              << ", oracle box " << mean(reached.oracleBox) << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: fit_baselines PLANS SPLIT.yaml > src/evaluation/trained_baselines.hpp\n";
    return 2;
  }
  return prodomos::run(argv[1], argv[2]);
}
