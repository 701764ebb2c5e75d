// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/boosted_trees.hpp"
#include "prediction/room_features.hpp"
#include "prediction/room_outline.hpp"
#include "prediction/room_prior.hpp"
#include "prodomos/evaluation/baselines.hpp"
#include "prodomos/evaluation/calibration.hpp"
#include "prodomos/prediction/room_guess.hpp"
#include "prodomos/simulation/floor_plan.hpp"
#include "prodomos/simulation/furniture.hpp"
#include "support/plan_doors.hpp"
#include "support/seen_world.hpp"

#include <yaml-cpp/yaml.h>

#include <ctime>
#include <sstream>
#include <memory>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>

namespace prodomos {
const prediction::RoomPrior& prediction::trainedRoomPrior() { static RoomPrior p; return p; }
namespace {

using prediction::Surroundings;

struct Plan {
  std::string name;
  simulation::Building building;
  simulation::Building furnished;
  bool isSchool = false;
};

struct Case {
  const Plan* plan = nullptr;
  std::size_t door = 0, far = 0;
  geometry::Pose2 T_world_here;
  Surroundings around;
  evaluation::DoorBox truth;
  double area = 0;
  bool isLaser = false;
  std::shared_ptr<test::SeenWorld> world;
};

std::vector<Plan> readPlans(const std::filesystem::path& folder, const YAML::Node& names, bool furnish) {
  std::vector<Plan> plans;
  for (const auto& node : names) {
    const auto name = node.as<std::string>();
    Plan plan{name, simulation::readFloorPlan(folder / name, {}), {}, name.starts_with("school")};
    plan.furnished = plan.building;
    if (furnish) simulation::furnish(plan.furnished, 1);
    plans.push_back(std::move(plan));
  }
  return plans;
}

std::map<std::tuple<const Plan*, std::size_t, std::size_t>, std::pair<evaluation::DoorBox,double>> boxes;
std::pair<evaluation::DoorBox,double> trueBox(const Plan& plan, std::size_t door, std::size_t far) {
  const auto key = std::tuple(&plan, door, far);
  if (const auto f = boxes.find(key); f != boxes.end()) return f->second;
  const auto& d = plan.building.doors[door];
  const evaluation::DoorView view(test::poseTowards(d, far), plan.building.rooms[static_cast<std::size_t>(d.rooms[far])].outline, [](const auto&) { return false; }, 0.1);
  return boxes[key] = {view.bestBox(), view.roomArea()};
}

void addOpenings(Case& c, const test::SeenWorld& world, double missing, double noise, base::Random& random) {
  const auto& doors = c.plan->building.doors;
  const auto T_here_world = geometry::inverse(c.T_world_here);
  for (std::size_t i = 0; i < doors.size(); ++i) {
    if (i == c.door || random.uniform() < missing) continue;
    const auto pose = T_here_world * doors[i].pose;
    if (pose.x < -7 || pose.x > 13 || std::abs(pose.y) > 10) continue;
    const auto side = [&](double step) {
      const auto p = doors[i].pose * geometry::Pose2{step, 0, 0};
      return world.at({p.x, p.y}) == map::CellState::kFree;
    };
    if (!side(0.5) && !side(-0.5)) continue;
    c.around.openings.push_back({{}, {pose.x + random.normal(0, noise), pose.y + random.normal(0, noise), pose.theta}, doors[i].width, doors[i].leaves > 0});
  }
}

void visitCases(const Plan& plan, double share, std::uint64_t seed, bool laser, const std::function<void(Case&&)>& visit) {
  base::Random random(seed, "fit_rooms " + plan.name);
  const auto seen = test::drawSeen(plan.building, share, seed);
  std::vector<bool> isOpen;
  for (const auto& door : plan.building.doors) isOpen.push_back(door.leaves == 0 || (laser && random.uniform() < 0.2));
  test::LaserRounds::Options options{.spacing = 1.5, .range = random.uniform(8.0, 25.0), .peeked = 0.5};
  auto world = std::make_shared<test::SeenWorld>(laser ? test::LaserRounds(random.uniform() < 0.5 ? plan.furnished : plan.building, isOpen).seenFrom(plan.building, seen, options, random) : test::wholeRooms(plan.building, seen));
  test::visitDoorsToUnseen(plan.building, seen, [&](std::size_t i, std::size_t far) {
    const auto& door = plan.building.doors[i];
    const auto& room = plan.building.rooms[static_cast<std::size_t>(door.rooms[far])];
    if (room.use != simulation::RoomUse::kRoom) return;
    if (laser && isOpen[i]) return;
    Case c{&plan, i, far, test::poseTowards(door, far), {}, {}, 0, laser, world};
    const auto front = c.T_world_here * geometry::Pose2{-0.6, 0, 0};
    if (laser) {
      if (world->at({front.x, front.y}) != map::CellState::kFree) return;
      c.T_world_here = c.T_world_here * geometry::Pose2{random.normal(0, 0.03), random.normal(0, 0.03), random.normal(0, 0.035)};
    }
    c.around = world->around(c.T_world_here);
    std::tie(c.truth, c.area) = trueBox(plan, i, far);
    addOpenings(c, *world, laser ? 0.33 : 0.0, laser ? 0.05 : 0.0, random);
    visit(std::move(c));
  });
}

float largeWeight = 0.5F;
struct TrainingSamples {
  bench::Samples side, end;
};

void addSamples(const Case& c, TrainingSamples& out) {
  const float weight = c.area > evaluation::kLargestRoom ? -1.0F : 1.0F;
  for (const bool mirrored : {false, true}) {
    const double width = c.plan->building.doors[c.door].width;
    prediction::RoomFeatures features(c.around, width, mirrored);
    const double side = mirrored ? c.truth.right : c.truth.left;
    for (std::size_t bin = 0; bin < prediction::kSideBins; ++bin) {
      const double from = prediction::kBin * static_cast<double>(bin);
      const bool ends = side < from + prediction::kBin;
      out.side.add(features.ofSide(from), ends, weight);
      if (ends) break;
    }
    for (std::size_t bin = 0; bin < prediction::kEndBins; ++bin) {
      const double from = prediction::kBin * static_cast<double>(bin);
      const bool ends = c.truth.depth < from + prediction::kBin;
      out.end.add(features.ofEnd(from, std::max(0.5, c.truth.left + c.truth.right)), ends, weight);
      if (ends) break;
    }
  }
}

void append(bench::Samples& to, const bench::Samples& from) {
  for (std::size_t i = 0; i < from.count(); ++i) {
    if (from.weights[i] < 0 && largeWeight == 0) continue;
    to.add(std::span(from.values).subspan(i * from.features, from.features), from.isTrue[i] != 0, from.weights[i] < 0 ? largeWeight : 1.0F);
  }
}

struct Score {
  std::size_t n = 0;
  double halfDisc = 0, fixedBox = 0, clipped = 0, learned = 0, cellsIou = 0, oracle = 0, expected = 0, us = 0, areaErr = 0, trueEnd = 0, trueSides = 0, areaZ = 0, area=0, trueArea=0;
  std::vector<std::pair<double,double>> ious;
  std::vector<evaluation::Bet> bets;

  void add(const Case& c, const prediction::RoomPrior& prior) {
    const auto& room = c.plan->building.rooms[static_cast<std::size_t>(c.plan->building.doors[c.door].rooms[c.far])];
    if (!test::isOrdinary(room)) return;
    const evaluation::DoorView view(c.T_world_here, room.outline, [&](const Eigen::Vector2d& p) { return c.world->at(p) != map::CellState::kUnknown; }, 0.1);
    const auto& base = evaluation::trainedBaselines();
    ++n;
    halfDisc += view.iousOfHalfDiscs()[static_cast<std::size_t>(std::lround(base.halfDiscRadius / evaluation::kRadiusStep)) - 1];
    fixedBox += view.iou(base.fixedBox);
    clipped += view.iouClipped(base.clippedBox);
    oracle += view.iou(c.truth);
    const auto t0 = std::clock();
    const auto guess = prediction::guessRoom(c.around, c.plan->building.doors[c.door].width, prior);
    us += 1e6 * static_cast<double>(std::clock() - t0) / CLOCKS_PER_SEC;
    const double iou = view.iou(geometry::transformed(c.T_world_here, guess.outline_here));
    learned += iou;
    trueEnd += view.iouClipped({guess.left, guess.right, c.truth.depth});
    trueSides += view.iouClipped({c.truth.left, c.truth.right, guess.depth});
    expected += guess.expectedIou;
    ious.emplace_back(guess.expectedIou, iou);
    // cells
    const auto roomHere = geometry::cellsIn(geometry::transformed(geometry::inverse(c.T_world_here), room.outline), 0.1);
    geometry::CellMap<std::uint8_t> inRoom(Surroundings::kBox, 0);
    for (const auto cell : roomHere) if (auto* f = inRoom.find(cell)) *f = 1;
    double both = 0, shape = 0;
    for (int y = -90; y < 90; ++y) for (int x = 1; x < 120; ++x) {
      const float p = guess.probability.at({x, y});
      if (p >= 0.1F && (x + y) % 4 == 0) bets.push_back({p, inRoom.at({x, y}) != 0});
      if (p >= 0.5F) { ++shape; both += inRoom.at({x, y}); }
    }
    cellsIou += both / (shape + static_cast<double>(roomHere.size()) - both);
    areaErr += std::abs(guess.expectedArea - view.roomArea());
    areaZ += std::pow((guess.expectedArea - view.roomArea()) / std::max(0.5, guess.areaDeviation), 2);
    area += guess.expectedArea; trueArea += view.roomArea();
  }
  void print(const char* name) const {
    const double d = static_cast<double>(n);
    const auto cal = evaluation::calibrationOf(bets);
    std::printf("%-16s %5zu half %.3f fixed %.3f clipped %.3f | cells %.3f LEARNED %.3f (true end %.3f true sides %.3f) | oracle %.3f expected %.3f ece %.3f area %.1f/%.1f err %.1f z2 %.2f us %.0f\n", name, n, halfDisc / d, fixedBox / d, clipped / d, cellsIou / d, learned / d, trueEnd / d, trueSides / d, oracle / d, expected / d, cal ? cal->expectedError : 0, area / d, trueArea / d, areaErr / d, areaZ / d, us / d);
  }
};

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

int run(const std::filesystem::path& folder, const std::string& splitFile, int argc, char** argv) {
  bench::BoostOptions boost;
  int draws = 1; int folds = 4; bool useLaser = true; 
  bool cross = false;
  const auto set = [&](const std::string& key, const std::string& v) {
    const double value = std::atof(v.c_str());
    if (key == "trees") boost.trees = static_cast<std::size_t>(value);
    if (key == "rate") boost.rate = value;
    if (key == "hess") boost.leastHessian = value;
    if (key == "ridge") boost.ridge = value;
    if (key == "draws") draws = static_cast<int>(value);
    if (key == "laser") useLaser = value > 0;
    if (key == "feat") boost.featureShare = value;
    if (key == "samp") boost.sampleShare = value;
    if (key == "large") largeWeight = static_cast<float>(value);
    if (key == "folds") folds = static_cast<int>(value);
    if (key == "cross") cross = value > 0;
  };
  std::vector<std::string> configs;
  for (int i = 3; i < argc; ++i) {
    const std::string key = argv[i];
    if (key.find(':') != std::string::npos) { configs.push_back(key); continue; }
    set(key, argv[i + 1]); ++i;
  }
  const auto split = YAML::LoadFile(splitFile);
  const auto train = readPlans(folder, split["train"], true);
  const auto validation = readPlans(folder, split["validation"], true);
  std::printf("plans %.1f s\n", seconds());
  std::vector<TrainingSamples> byPlan(train.size());
  std::vector<Case> evaluated;
  std::size_t cases = 0, large = 0;
  for (std::size_t p = 0; p < train.size(); ++p) {
    for (int draw = 0; draw < draws; ++draw) {
      for (const double share : test::kSharesSeen) {
        const auto seed = static_cast<std::uint64_t>(100 * share) + 1000 * static_cast<std::uint64_t>(draw);
        for (const bool laser : {false, true}) {
          if (laser && !useLaser) continue;
          visitCases(train[p], share, seed, laser, [&](Case&& c) {
            addSamples(c, byPlan[p]);
            ++cases;
            large += c.area > evaluation::kLargestRoom;
            if (draw == 0) evaluated.push_back(std::move(c));
          });
        }
      }
    }
  }
  std::printf("cases %zu (large %zu) %.1f s\n", cases, large, seconds());
  std::vector<Case> held;
  for (const auto& plan : validation) for (const double share : test::kSharesSeen) for (const bool laser : {false, true}) visitCases(plan, share, static_cast<std::uint64_t>(100 * share), laser, [&](Case&& c) { held.push_back(std::move(c)); });
  const auto fit = [&](const std::function<bool(std::size_t)>& use) {
    TrainingSamples all;
    for (std::size_t p = 0; p < train.size(); ++p) if (use(p)) { append(all.side, byPlan[p].side); append(all.end, byPlan[p].end); }
    prediction::RoomPrior prior;
    prior.side = bench::Booster(all.side, boost, 1).train();
    prior.end = bench::Booster(all.end, boost, 2).train();
    if (false) std::printf("fit %zu + %zu rows, %zu + %zu features, %.1f s\n", all.side.count(), all.end.count(), all.side.features, all.end.features, seconds());
    return prior;
  };
  const auto evaluateAll = [&](const std::string& what) {
    std::printf("--- %s\n", what.c_str());
    Score whole, laser;
    for (int f = 0; f < folds; ++f) {
      const auto prior = fit([&](std::size_t p) { return static_cast<int>(p) % folds != f; });
      for (const auto& c : evaluated) if (static_cast<int>(c.plan - train.data()) % folds == f) (c.isLaser ? laser : whole).add(c, prior);
    }
    const auto prior = fit([](std::size_t) { return true; });
    if (folds) { whole.print("cv whole"); laser.print("cv laser"); }
    Score w, l;
    for (const auto& c : held) (c.isLaser ? l : w).add(c, prior);
    w.print("val whole"); l.print("val laser");
    if (cross) for (const bool school : {true, false}) {
      const auto p = fit([&](std::size_t i) { return train[i].isSchool == school; });
      Score s;
      for (const auto& c : evaluated) if (!c.isLaser && c.plan->isSchool != school) s.add(c, p);
      for (const auto& c : held) if (!c.isLaser && c.plan->isSchool != school) s.add(c, p);
      s.print(school ? "school->office" : "office->school");
    }
    std::printf("end %.1f s\n", seconds());
    std::fflush(stdout);
  };
  // configs: words after the options, "trees:60,hess:20,large:0.1"
  for (const auto& text : configs) {
    std::stringstream in(text); std::string item;
    while (std::getline(in, item, ',')) set(item.substr(0, item.find(':')), item.substr(item.find(':') + 1));
    evaluateAll(text);
  }
  return 0;
}

}  // namespace
}  // namespace prodomos

int main(int argc, char** argv) { return prodomos::run(argv[1], argv[2], argc, argv); }
