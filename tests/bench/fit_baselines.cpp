// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// fit_baselines PLANS SPLIT.yaml > src/evaluation/trained_baselines.hpp
//
// Fits the trivial predictors of rooms (evaluation/baselines.hpp) to the training plans. Corridors count as seen, and
// of the other rooms 0, 30 and 60 %, drawn by seed: what is seen is known with its walls, 0.1 m thick. Each door with a
// leaf between a seen room and an unseen one of at most 60 m², no corridor and no stairwell, is a case; its pose is the
// true one. Prints what the sizes reach on training, validation and test plans to stderr.
#include "prodomos/evaluation/baselines.hpp"
#include "prodomos/evaluation/room_shapes.hpp"
#include "prodomos/simulation/floor_plan.hpp"

#include "support/plan_doors.hpp"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace prodomos {
namespace {

using Visit = std::function<void(const evaluation::DoorView&)>;

void visitDoors(const simulation::Building& building, double shareSeen, const Visit& visit) {
  const auto seen = test::drawSeen(building, shareSeen);
  const auto known = test::seenCells(building, seen);
  const auto isKnown = [&known](const Eigen::Vector2d& point) {
    return known.at(geometry::cellAt(point.x(), point.y(), test::kPlanResolution)) != test::SeenCell::kUnknown;
  };
  test::visitDoorsToUnseen(building, seen, [&](const simulation::Door& door, std::size_t far) {
    const auto& unseen = building.rooms[static_cast<std::size_t>(door.rooms[far])];
    if (!test::isOrdinary(unseen)) return;
    visit({test::poseTowards(door, far), unseen.outline, isKnown, test::kPlanResolution});
  });
}

void visitPlans(const std::filesystem::path& plans, const YAML::Node& names, const Visit& visit) {
  for (const auto& name : names) {
    const auto plan = plans / name.as<std::string>();
    try {
      const auto building = simulation::readFloorPlan(plan, {});
      for (const double share : test::kSharesSeen) visitDoors(building, share, visit);
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
