// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
//
// fit_rooms PLANS SPLIT.yaml > src/prediction/room_prior.inc
// fit_rooms PLANS SPLIT.yaml --test
//
// Learns what lies behind doors (docs/rooms.md) from the training plans; what the prior's expectations are worth, from
// training plans that were left out, a third at a time. Prints to stderr what is reached there, on the validation
// plans, and from schools to offices and back. With --test: what the prior that is compiled in reaches on the test
// plans.
#include "bench/boosted_trees.hpp"
#include "bench/room_cases.hpp"
#include "bench/room_scores.hpp"
#include "prediction/reachable_floor.hpp"
#include "prediction/room_boxes.hpp"
#include "prediction/room_features.hpp"

#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

namespace prodomos::bench {
namespace {

constexpr std::uint64_t kDraws = 2;  // of the rooms that were seen, in training
constexpr std::size_t kFolds = 3;
constexpr float kLargeRoom = 0.15F;  // weight of rooms of more than 60 m²: they are not what guesses are judged on
constexpr BoostOptions kWalls{.trees = 80, .rate = 0.09, .leastHessian = 15.0};
constexpr BoostOptions kSpace{.trees = 120, .rate = 0.1, .leastHessian = 10.0};

/// Questions of one plan, with the true answers.
struct Lessons {
  Samples side;
  Samples end;
  Samples space;

  void learn(const RoomCase& from) {
    const auto reachable = prediction::reachableFloor(from.around, prediction::kBehind);
    for (const bool mirrored : {false, true}) {
      prediction::RoomFeatures features(from.around, from.door->width, mirrored);
      space.add(features.ofSpace(prediction::areaOf(reachable)), from.isUnseen);
      if (!from.isClosed || !from.hasUnseenRoom()) continue;
      const float weight = from.area > evaluation::kLargestRoom ? kLargeRoom : 1.0F;
      const double own = mirrored ? from.bestBox.right : from.bestBox.left;
      const double other = mirrored ? from.bestBox.left : from.bestBox.right;
      for (const double told : {other, static_cast<double>(prediction::RoomFeatures::kFar)}) {
        ask(own, prediction::kSideBins, weight, side, [&](double across) { return features.ofSide(across, told); });
      }
      const double width = std::max(prediction::kLeastWidth, own + other);
      ask(from.bestBox.depth, prediction::kEndBins, weight, end,
          [&](double ahead) { return features.ofEnd(ahead, width); });
    }
  }
  void append(const Lessons& others) {
    side.append(others.side);
    end.append(others.end);
    space.append(others.space);
  }

 private:
  /// From bin to bin, as far as there is no wall.
  template <typename Features>
  static void ask(double wall, std::size_t bins, float weight, Samples& samples, const Features& features) {
    for (std::size_t bin = 0; bin < bins; ++bin) {
      const double from = prediction::kBin * static_cast<double>(bin);
      const bool ends = wall < from + prediction::kBin;
      samples.add(features(from), ends, weight);
      if (ends) return;
    }
  }
};

struct School {
  std::vector<Plan> plans;
  std::vector<Lessons> lessons;              ///< by plan
  std::vector<std::vector<RoomCase>> cases;  ///< by plan: those of the first draw
};

School readPlans(const std::filesystem::path& folder, const YAML::Node& names, std::uint64_t draws) {
  School school;
  for (const auto& name : names) school.plans.emplace_back(folder, name.as<std::string>());
  school.lessons.resize(school.plans.size());
  school.cases.resize(school.plans.size());
  for (std::size_t i = 0; i < school.plans.size(); ++i) {
    CaseMaker maker(school.plans[i]);
    for (std::uint64_t draw = 0; draw < std::max<std::uint64_t>(1, draws); ++draw) {
      for (const double share : test::kSharesSeen) {
        for (const auto knowledge : {Knowledge::kWholeRooms, Knowledge::kLaser}) {
          maker.visit(share, draw, knowledge, [&](RoomCase&& made) {
            if (draws > 0) school.lessons[i].learn(made);
            if (draw == 0) school.cases[i].push_back(std::move(made));
          });
        }
      }
    }
  }
  return school;
}

using Choice = std::function<bool(std::size_t plan)>;

prediction::RoomPrior train(const School& school, const Choice& uses) {
  Lessons all;
  for (std::size_t i = 0; i < school.plans.size(); ++i) {
    if (uses(i)) all.append(school.lessons[i]);
  }
  return {.side = Booster(all.side, kWalls, 1).train(),
          .end = Booster(all.end, kWalls, 2).train(),
          .space = Booster(all.space, kSpace, 3).train()};
}

/// By what is known.
struct Scores {
  RoomScores whole;
  RoomScores laser;

  void add(const School& school, const prediction::RoomPrior& prior, const Choice& uses) {
    for (std::size_t i = 0; i < school.plans.size(); ++i) {
      if (!uses(i)) continue;
      for (const auto& each : school.cases[i]) {
        (each.knowledge == Knowledge::kLaser ? laser : whole).add(each, prior);
      }
    }
  }
  void print(const std::string& name) const {
    whole.print(stderr, name + ", whole rooms");
    laser.print(stderr, name + ", laser");
  }
};

bool any(std::size_t) {
  return true;
}

void printForest(const char* name, const prediction::Forest& forest) {
  const auto print = [](const auto& values, double scale) {
    std::printf("{");
    for (const auto value : values) std::printf("%ld,", std::lround(scale * static_cast<double>(value)));
    std::printf("}");
  };
  std::printf("constexpr double k%sBias = %.4f;\nconstexpr StoredTree k%sTrees[] = {\n", name,
              static_cast<double>(forest.bias), name);
  for (const auto& tree : forest.trees) {
    std::printf("{");
    print(tree.feature, 1.0);
    std::printf(",");
    print(tree.threshold, 1000.0);
    std::printf(",");
    print(tree.leaf, 1000.0);
    std::printf("},\n");
  }
  std::printf("};\n");
}

void printReached(const char* what, const RoomScores& scores) {
  std::printf("//   %s: %zu rooms, %.3f (clipped box %.3f)\n", what, scores.rooms(), scores.outline(),
              scores.clippedBox());
}

void printPrior(const prediction::RoomPrior& prior, std::size_t plans, const Scores& leftOut,
                const Scores& validation) {
  std::printf(
      "// SPDX-FileCopyrightText: 2026 the prodomos authors\n"
      "// SPDX-License-Identifier: BSD-3-Clause\n"
      "//\n"
      "// Written by tests/bench/fit_rooms (docs/rooms.md) from the %zu training plans of datasets/plans_split.yaml:\n"
      "// corridors and 0, 30 and 60 %% of the other rooms seen, %d draws, each whole and as a laser shows it; seeds "
      "1\n"
      "// (sides), 2 (ends), 3 (space) of the trees. Expectations are corrected by what was reached on plans left out, "
      "a\n"
      "// third at a time. Mean IoU with rooms of at most 60 m²:\n",
      plans, static_cast<int>(kDraws));
  printReached("training plans left out, seen rooms known whole", leftOut.whole);
  printReached("training plans left out, as a laser shows them", leftOut.laser);
  printReached("validation plans, whole", validation.whole);
  printReached("validation plans, laser", validation.laser);
  std::printf(
      "// A tree: features, thresholds and leaves in thousandths.\n"
      "constexpr double kIouOffset = %.4f;\nconstexpr double kIouSlope = %.4f;\nconstexpr double kAreaSpread = %.4f;\n",
      prior.iouOffset, prior.iouSlope, prior.areaSpread);
  printForest("Side", prior.side);
  printForest("End", prior.end);
  printForest("Space", prior.space);
}

/// From one kind of building to the other.
void printOtherKind(const School& training, const School& validation) {
  for (const bool fromSchools : {true, false}) {
    const auto prior = train(training, [&](std::size_t i) { return training.plans[i].isSchool() == fromSchools; });
    Scores scores;
    for (const auto* school : {&training, &validation}) {
      scores.add(*school, prior, [&](std::size_t i) { return school->plans[i].isSchool() != fromSchools; });
    }
    scores.print(fromSchools ? "offices, learned from schools" : "schools, learned from offices");
  }
}

void fit(const std::filesystem::path& folder, const YAML::Node& split) {
  const auto training = readPlans(folder, split["train"], kDraws);
  Scores leftOut;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const auto prior = train(training, [&](std::size_t i) { return i % kFolds != fold; });
    leftOut.add(training, prior, [&](std::size_t i) { return i % kFolds == fold; });
  }
  auto prior = train(training, any);
  leftOut.laser.calibrate(prior);
  const auto validation = readPlans(folder, split["validation"], 0);
  Scores scores;
  scores.add(validation, prior, any);
  printPrior(prior, training.plans.size(), leftOut, scores);

  RoomScores::printHead(stderr);
  leftOut.print("training, left out (uncorrected)");
  scores.print("validation");
  scores.whole.printQuarters(stderr);
  scores.whole.printPrecisions(stderr);
  printOtherKind(training, validation);
}

void test(const std::filesystem::path& folder, const YAML::Node& split) {
  const auto school = readPlans(folder, split["test"], 0);
  Scores scores;
  scores.add(school, prediction::trainedRoomPrior(), any);
  RoomScores::printHead(stderr);
  scores.print("test");
}

}  // namespace
}  // namespace prodomos::bench

int main(int argc, char** argv) {
  if (argc != 3 && !(argc == 4 && std::strcmp(argv[3], "--test") == 0)) {
    std::cerr << "usage: fit_rooms PLANS SPLIT.yaml [--test]\n";
    return 2;
  }
  try {
    const auto split = YAML::LoadFile(argv[2]);
    (argc == 4 ? prodomos::bench::test : prodomos::bench::fit)(argv[1], split);
  } catch (const std::exception& fault) {
    std::cerr << "fit_rooms: " << fault.what() << '\n';
    return 1;
  }
  return 0;
}
