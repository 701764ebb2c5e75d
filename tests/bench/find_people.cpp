// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

/// Do detectors that were trained on photographs find simulated people? Puts people into a plain room, one a picture,
/// and runs two person detectors and a pose estimator over the pictures.
///
///     find_people MODELS [--looks 8] [--seed 1] [--pictures FOLDER] [--every N]
///
/// MODELS holds yolo-fastest-1.1_body, yolo-fastest-1.1 (.cfg, .weights) and hourglass_pose14.pb. A person counts as
/// found where a detection with a score above 0.5 overlaps the box of its pixels by IoU >= 0.5. The pose estimator gets
/// that box; its joints count where they are well seen: in the picture, and not behind anything but the person's own
/// flesh. PCK is the share of them within 0.2 torso lengths (left shoulder to right hip) of the true joint.

#include "prodomos/base/random.hpp"
#include "prodomos/simulation/person.hpp"
#include "prodomos/simulation/ray_scene.hpp"
#include "prodomos/simulation/renderer.hpp"

#include "perception/people_networks.hpp"

#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace prodomos;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr std::uint16_t kInstance = 1;

// --- What is shown ---------------------------------------------------------------------------------------------------

enum class Act { kStands, kWalks, kSits, kBehindDesk };
enum class View { kFront, kSide, kBack };
constexpr std::array kActs = {"standing", "walking", "seated", "behind a desk"};
constexpr std::array kViews = {"front", "side", "back"};

struct Shot {
  Act act;
  View view;
  int distance;  ///< metres
  std::uint64_t look;
};

geometry::Pose3 at(double x, double y, double z) {
  return geometry::Pose3(Eigen::Translation3d(x, y, z));
}

/// A room of 9 m by 6 m, the camera near its left end, the person ahead of it at (0, 0).
std::vector<simulation::Surface> room(const Shot& shot) {
  using simulation::Pattern;
  const auto classOf = simulation::classId;
  std::vector<simulation::Surface> all;
  const auto add = [&](const geometry::Pose3& T_world_box, const Vector3d& size, const simulation::Material& material,
                       const char* name) {
    all.push_back(simulation::boxSurface(T_world_box, size, material, classOf(name), 0));
  };
  const simulation::Material paint{.color = {214, 210, 198}};
  const simulation::Material wood{
      .color = {150, 110, 70}, .accent = {120, 85, 52}, .pattern = Pattern::kWood, .scale = 0.15};
  add(at(-1.0, 0.0, -0.05), {9.2, 6.2, 0.1},
      {.color = {128, 122, 112}, .accent = {112, 106, 98}, .pattern = Pattern::kCarpet, .scale = 0.5}, "floor");
  add(at(-1.0, 0.0, 2.75), {9.2, 6.2, 0.1}, {.color = {235, 235, 230}}, "ceiling");
  add(at(3.5, 0.0, 1.35), {0.1, 6.0, 2.7}, paint, "wall");
  add(at(-5.5, 0.0, 1.35), {0.1, 6.0, 2.7}, paint, "wall");
  add(at(-1.0, 3.0, 1.35), {9.0, 0.1, 2.7}, paint, "wall");
  add(at(-1.0, -3.0, 1.35), {9.0, 0.1, 2.7}, paint, "wall");
  add(at(3.43, 1.6, 1.0), {0.06, 0.9, 2.0}, wood, "door");
  add(at(3.43, -1.6, 1.5), {0.03, 1.4, 0.9}, {.color = {70, 95, 80}}, "board");
  add(at(2.2, -2.0, 0.72), {0.8, 1.6, 0.04}, wood, "table");
  add(at(2.2, -2.0, 0.36), {0.7, 0.06, 0.7}, wood, "table");
  const simulation::Material chair{.color = {60, 66, 78}, .pattern = Pattern::kFabric, .scale = 0.02};
  const double away = shot.view == View::kFront ? 1.0 : -1.0;
  if (shot.act == Act::kSits || shot.act == Act::kBehindDesk) {
    const bool side = shot.view == View::kSide;
    const Vector3d back = side ? Vector3d(0.0, -0.26, 0.72) : Vector3d(0.26 * away, 0.0, 0.72);
    add(at(0.0, 0.0, 0.42), {0.44, 0.44, 0.06}, chair, "chair");
    add(at(back.x(), back.y(), back.z()), side ? Vector3d(0.4, 0.04, 0.3) : Vector3d(0.04, 0.4, 0.3), chair, "chair");
    add(at(0.0, 0.0, 0.2), {0.06, 0.06, 0.4}, chair, "chair");
  }
  if (shot.act == Act::kBehindDesk) {
    add(at(-0.55, 0.0, 0.72), {0.6, 1.5, 0.04}, wood, "table");
    add(at(-0.8, 0.0, 0.36), {0.03, 1.5, 0.7}, wood, "table");
  }
  return all;
}

simulation::Person personOf(const Shot& shot, double& time) {
  base::Random random(shot.look * 977 + static_cast<std::uint64_t>(shot.distance), "a shot");
  simulation::Person person{.id = "someone", .height = random.uniform(1.55, 1.9), .look = shot.look};
  // The camera looks along x: who faces it looks back.
  const double view = shot.view == View::kFront ? kPi : (shot.view == View::kSide ? kPi / 2.0 : 0.0);
  person.heading = view + random.uniform(-0.3, 0.3);
  person.sits = shot.act == Act::kSits || shot.act == Act::kBehindDesk;
  time = random.uniform(10.0, 20.0);
  if (shot.act == Act::kWalks) {
    const Eigen::Vector2d velocity =
        random.uniform(0.8, 1.4) * Eigen::Vector2d(std::cos(person.heading), std::sin(person.heading));
    person.way = {{0.0, -time * velocity}, {2.0 * time, time * velocity}};
  } else {
    person.way = {{0.0, Eigen::Vector2d::Zero()}};
  }
  return person;
}

// --- What is found ---------------------------------------------------------------------------------------------------

cv::Mat bgrOf(const sensors::Image<sensors::Rgb>& image) {
  cv::Mat bgr(image.height(), image.width(), CV_8UC3);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto& pixel = image(x, y);
      bgr.at<cv::Vec3b>(y, x) = {pixel.b, pixel.g, pixel.r};
    }
  }
  return bgr;
}

double overlap(const cv::Rect2d& a, const cv::Rect2d& b) {
  const double common = (a & b).area();
  return common / (a.area() + b.area() - common);
}

bool isFound(const std::vector<perception::PersonBox>& boxes, const cv::Rect2d& box) {
  return std::ranges::any_of(boxes,
                             [&](const auto& found) { return found.score > 0.5 && overlap(found.box, box) >= 0.5; });
}

// --- Scores ----------------------------------------------------------------------------------------------------------

struct Score {
  int shots = 0;
  int foundByBody = 0;
  int foundByClass = 0;
  int joints = 0;
  int jointsNear = 0;
  int jointsNearEitherSide = 0;  ///< where right and left may be exchanged
  double jointError = 0.0;       ///< sum, pixels

  void add(const Score& other) {
    shots += other.shots;
    foundByBody += other.foundByBody;
    foundByClass += other.foundByClass;
    joints += other.joints;
    jointsNear += other.jointsNear;
    jointsNearEitherSide += other.jointsNearEitherSide;
    jointError += other.jointError;
  }
};

constexpr int kDistances = 5;  ///< 1 m to 5 m
using Scores = std::array<Score, kDistances>;

double percent(int part, int whole) {
  return whole > 0 ? 100.0 * part / whole : std::nan("");
}

void print(const std::string& name, const Scores& scores) {
  Score all;
  for (const auto& score : scores) all.add(score);
  std::printf("%-22s %4d |", name.c_str(), all.shots);
  for (const auto& score : scores) std::printf(" %4.0f", percent(score.foundByBody, score.shots));
  std::printf(" | %4.0f  %4.0f |", percent(all.foundByBody, all.shots), percent(all.foundByClass, all.shots));
  for (const auto& score : scores) std::printf(" %4.0f", percent(score.jointsNear, score.joints));
  std::printf(" | %4.0f  %4.0f  %5.1f %6d\n", percent(all.jointsNear, all.joints),
              percent(all.jointsNearEitherSide, all.joints), all.jointError / all.joints, all.joints);
}

void printHead() {
  std::printf("%-27s | found by body, 1 ... 5 m | body class | PCK, 1 ... 5 m          |  PCK  l=r error px joints\n",
              "");
}

struct Models {
  explicit Models(const std::filesystem::path& folder) : boxes(folder), joints(folder) {}

  perception::PersonBoxes boxes;
  perception::JointFinder joints;
};

struct Picture {
  cv::Mat image;
  cv::Rect2d box;                                                          ///< of the person's pixels
  std::array<std::optional<cv::Point2d>, evaluation::kJointCount> joints;  ///< those well seen
  double torso = 0.0;                                                      ///< pixels
};

Picture take(const Shot& shot) {
  double time = 0.0;
  const simulation::Person person = personOf(shot, time);
  std::vector<simulation::Surface> surfaces = room(shot);
  for (auto& part : simulation::bodyAt(person, 0.0, time, kInstance)) surfaces.push_back(std::move(part));
  const simulation::RayScene scene(std::move(surfaces));
  const simulation::Lighting lighting{
      .lamps = {{-3.5, -1.2, 2.65}, {-3.5, 1.2, 2.65}, {0.0, -1.2, 2.65}, {0.0, 1.2, 2.65}, {2.5, 0.0, 2.65}}};
  const simulation::Renderer renderer(scene, {}, lighting);
  geometry::Pose3 T_world_camera = at(-shot.distance, 0.0, 1.2);
  T_world_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  const auto rendering = renderer.render(T_world_camera);

  Picture picture{.image = bgrOf(rendering.color)};
  cv::Rect box;
  for (int y = 0; y < rendering.instances.height(); ++y) {
    for (int x = 0; x < rendering.instances.width(); ++x) {
      if (rendering.instances(x, y) == kInstance) box |= cv::Rect(x, y, 1, 1);
    }
  }
  picture.box = box;

  const auto state = simulation::stateOf(person, 0.0, time);
  const double focal = renderer.camera().intrinsics.fx;
  picture.torso =
      (state.joints[simulation::kLeftShoulder] - state.joints[simulation::kRightHip]).norm() * focal / shot.distance;
  constexpr double kFlesh = 0.2;  // metres before a joint, at most
  for (std::size_t j = 0; j < state.joints.size(); ++j) {
    const Vector3d joint_in_camera = T_world_camera.inverse() * state.joints[j];
    if (joint_in_camera.z() < 0.1) continue;
    const Eigen::Vector2d pixel = simulation::project(renderer.camera(), joint_in_camera);
    const int x = static_cast<int>(std::lround(pixel.x()));
    // The top of the head lies on the outline.
    const int y = static_cast<int>(std::lround(pixel.y())) + (j == simulation::kHeadTop ? 3 : 0);
    if (x < 0 || x >= picture.image.cols || y < 0 || y >= picture.image.rows) continue;
    if (rendering.instances(x, y) != kInstance) continue;
    if (rendering.depth(x, y) < joint_in_camera.z() - kFlesh) continue;
    picture.joints[j] = cv::Point2d(pixel.x(), pixel.y());
  }
  return picture;
}

/// The same joint of the other side.
std::size_t opposite(std::size_t joint) {
  if (joint < simulation::kRightShoulder) return joint;
  const std::size_t inPairs = joint - simulation::kRightShoulder;
  return simulation::kRightShoulder + (inPairs % 6 < 3 ? inPairs + 3 : inPairs - 3);
}

using JointOffsets = std::array<std::pair<cv::Point2d, int>, evaluation::kJointCount>;

Score scoreOf(const Picture& picture, Models& models, JointOffsets& offsets, cv::Mat& drawing) {
  Score score{.shots = 1};
  const auto byBody = models.boxes.byBody(picture.image);
  score.foundByBody = isFound(byBody, picture.box) ? 1 : 0;
  score.foundByClass = isFound(models.boxes.byClass(picture.image), picture.box) ? 1 : 0;
  const auto joints = models.joints.find(picture.image, picture.box);
  drawing = picture.image.clone();
  cv::rectangle(drawing, picture.box, {0, 200, 0});
  for (const auto& found : byBody) {
    cv::rectangle(drawing, found.box, {0, 0, 255}, found.score > 0.5 ? 2 : 1);
    cv::putText(drawing, cv::format("%.2f", found.score), found.box.tl() + cv::Point2d(2, 12), cv::FONT_HERSHEY_PLAIN,
                1.0, {0, 0, 255});
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!picture.joints[j]) continue;
    const cv::Point2d off = joints[j].pixel - *picture.joints[j];
    const double error = std::hypot(off.x, off.y);
    ++score.joints;
    score.jointError += error;
    const double near = 0.2 * picture.torso;
    const cv::Point2d other = joints[opposite(j)].pixel - *picture.joints[j];
    if (error <= near) ++score.jointsNear;
    if (std::min(error, std::hypot(other.x, other.y)) <= near) ++score.jointsNearEitherSide;
    offsets[j].first += off / picture.torso;
    ++offsets[j].second;
    cv::circle(drawing, *picture.joints[j], 2, {0, 255, 0}, cv::FILLED);
    cv::line(drawing, *picture.joints[j], joints[j].pixel, {255, 0, 255});
  }
  return score;
}

struct Options {
  std::string models;
  int looks = 8;
  std::uint64_t seed = 1;
  std::string pictures;
  int every = 1;
};

std::vector<Shot> shotsOf(const Options& options) {
  std::vector<Shot> shots;
  for (const Act act : {Act::kStands, Act::kWalks, Act::kSits, Act::kBehindDesk}) {
    for (const View view : {View::kFront, View::kSide, View::kBack}) {
      if (act == Act::kBehindDesk && view != View::kFront) continue;
      for (int distance = 1; distance <= kDistances; ++distance) {
        for (int look = 0; look < options.looks; ++look) {
          shots.push_back({act, view, distance, options.seed * 1000 + static_cast<std::uint64_t>(look)});
        }
      }
    }
  }
  return shots;
}

void printOffsets(const JointOffsets& offsets) {
  std::printf("\nmean offset of found joints, in torso lengths (right, down)\n");
  for (std::size_t j = 0; j < offsets.size(); ++j) {
    const auto& [sum, number] = offsets[j];
    std::printf("%-16s %6d %7.3f %7.3f\n", std::string(simulation::kJointNames[j]).c_str(), number, sum.x / number,
                sum.y / number);
  }
}

void run(const Options& options) {
  Models models(options.models);
  std::vector<std::pair<std::string, Scores>> rows;
  Scores all{};
  JointOffsets offsets{};
  int count = 0;
  for (const Shot& shot : shotsOf(options)) {
    const std::string name =
        std::string(kActs[static_cast<std::size_t>(shot.act)]) + ", " + kViews[static_cast<std::size_t>(shot.view)];
    if (rows.empty() || rows.back().first != name) rows.emplace_back(name, Scores{});
    const Picture picture = take(shot);
    cv::Mat drawing;
    const Score score = scoreOf(picture, models, offsets, drawing);
    const auto column = static_cast<std::size_t>(shot.distance - 1);
    rows.back().second[column].add(score);
    all[column].add(score);
    if (!options.pictures.empty() && count++ % options.every == 0) {
      cv::imwrite(cv::format("%s/%03d %s %d m.png", options.pictures.c_str(), count - 1, name.c_str(), shot.distance),
                  drawing);
    }
  }
  printHead();
  for (const auto& [name, scores] : rows) print(name, scores);
  print("all", all);
  printOffsets(offsets);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Do detectors that were trained on photographs find simulated people?");
  Options options;
  app.add_option("MODELS", options.models, "folder of the models")->required()->check(CLI::ExistingDirectory);
  app.add_option("--looks", options.looks, "different people")->check(CLI::Range(1, 1000));
  app.add_option("--seed", options.seed, "of the people");
  app.add_option("--pictures", options.pictures, "where to leave pictures with what was found")
      ->check(CLI::ExistingDirectory);
  app.add_option("--every", options.every, "leave each N-th picture only")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "find_people: %s\n", error.what());
    return 1;
  }
}
