// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/perception/person_detector.hpp"

#include "perception/people_networks.hpp"
#include "perception/person_drawing.hpp"
#include "perception/person_location.hpp"
#include "perception/person_masks.hpp"
#include "perception/upright_view.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace prodomos::perception {

namespace {

constexpr double kSamePerson = 0.45;  ///< IoU of boxes
/// Scores above this share of the least are told, too: not enough for someone new, but for someone who is followed.
constexpr double kDoubtful = 0.5;
constexpr double kPersonalSpace = 0.4;  ///< metres between middles: no two bodies are nearer

/// What either network finds; where both do, it is the surer.
std::vector<PersonBox> united(const std::vector<PersonBox>& bodies, const std::vector<PersonBox>& others) {
  std::vector<PersonBox> all;
  std::vector<bool> used(others.size(), false);
  for (PersonBox body : bodies) {
    for (std::size_t i = 0; i < others.size(); ++i) {
      if (used[i] || overlap(body.box, others[i].box) < kSamePerson) continue;
      used[i] = true;
      const double score = 1.0 - (1.0 - body.score) * (1.0 - others[i].score);
      if (others[i].score > body.score) body = others[i];
      body.score = score;
      break;
    }
    all.push_back(body);
  }
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (!used[i]) all.push_back(others[i]);
  }
  return withoutDoubles(std::move(all), kSamePerson);
}

/// Of two sightings of one body the surer.
std::vector<PersonSighting> withoutDoubles(std::vector<PersonSighting> sightings) {
  std::ranges::stable_sort(sightings, std::greater{}, &PersonSighting::score);
  std::vector<PersonSighting> kept;
  for (auto& sighting : sightings) {
    const auto isSame = [&](const PersonSighting& other) {
      return (sighting.position_in_submap - other.position_in_submap).head<2>().norm() < kPersonalSpace;
    };
    if (std::ranges::none_of(kept, isSame)) kept.push_back(std::move(sighting));
  }
  return kept;
}

/// Locates each, and draws what became of it.
std::vector<PersonSighting> located(const RgbdView& view, const UprightView& upright,
                                    const std::vector<PicturedPerson>& people, DebugImages* debug) {
  std::vector<PersonSighting> sightings;
  PeopleDrawing drawing(upright, debug);
  for (const auto& person : people) {
    auto sighting = locate(upright, person, view.floor_z);
    drawing.add(person, sighting);
    if (!sighting) continue;
    sighting->time = view.time;
    sightings.push_back(std::move(*sighting));
  }
  drawing.finish();
  return withoutDoubles(std::move(sightings));
}

/// Around the joints that were seen, with room for what is around bones.
cv::Rect2d boxOf(const ImageJoints& joints) {
  cv::Rect2d box;
  bool first = true;
  for (const auto& joint : joints) {
    if (joint.score <= 0.0) continue;
    const cv::Rect2d pixel(joint.pixel, cv::Size2d(1.0, 1.0));
    box = std::exchange(first, false) ? pixel : box | pixel;
  }
  const double margin = 0.1 * std::max(box.width, box.height);
  return {box.x - margin, box.y - margin, box.width + 2.0 * margin, box.height + 2.0 * margin};
}

double meanScore(const ImageJoints& joints) {
  double sum = 0.0;
  int seen = 0;
  for (const auto& joint : joints) {
    if (joint.score <= 0.0) continue;
    sum += joint.score;
    ++seen;
  }
  return seen > 0 ? sum / seen : 0.0;
}

}  // namespace

class PersonDetector::Implementation {
 public:
  explicit Implementation(const PeopleConfig& config) : config_(config) {
    if (!config.enabled || config.models.empty() || config.fromLabels) return;
    boxes_.emplace(config.models);
    joints_.emplace(config.models);
  }

  const PeopleConfig& config() const { return config_; }

  std::vector<PicturedPerson> find(const UprightView& view) {
    const cv::Mat& picture = view.picture();
    std::vector<PicturedPerson> people;
    if (!boxes_ || picture.empty()) return people;
    for (const auto& box : united(boxes_->byBody(picture), boxes_->byClass(picture))) {
      if (box.score < kDoubtful * config_.leastScore) continue;
      // Without depth nobody is located anyway.
      const auto whole = wholeBodyBox(view, box);
      if (whole) people.push_back({.box = box, .joints = joints_->find(picture, *whole)});
    }
    return people;
  }

 private:
  PeopleConfig config_;
  std::optional<PersonBoxes> boxes_;
  std::optional<JointFinder> joints_;
};

PersonDetector::PersonDetector(const PeopleConfig& config)
    : implementation_(std::make_unique<Implementation>(config)) {}
PersonDetector::~PersonDetector() = default;
PersonDetector::PersonDetector(PersonDetector&&) noexcept = default;
PersonDetector& PersonDetector::operator=(PersonDetector&&) noexcept = default;

std::vector<PersonSighting> PersonDetector::find(const RgbdView& view, DebugImages* debug) {
  const auto upright = UprightView::of(view);
  if (!upright) return {};
  return located(view, *upright, implementation_->find(*upright), debug);
}

std::vector<PersonSighting> PersonDetector::find(const RgbdView& view, const sensors::KeyPoints& keyPoints,
                                                 DebugImages* debug) const {
  const auto upright = UprightView::of(view);
  if (!upright) return {};
  std::vector<PicturedPerson> people;
  for (const auto& person : keyPoints.persons) {
    ImageJoints joints;
    for (std::size_t i = 0; i < std::min(joints.size(), person.joints.size()); ++i) {
      const auto& joint = person.joints[i];
      joints[i] = {upright->fromFrame({joint.x, joint.y}), joint.score};
    }
    const double score = meanScore(joints);
    if (score >= implementation_->config().leastScore)
      people.push_back({.box = {boxOf(joints), score}, .joints = joints, .knowsSides = true});
  }
  return located(view, *upright, people, debug);
}

std::vector<PersonSighting> PersonDetector::findInLabels(const RgbdView& view,
                                                         const sensors::ClassTable& classes) const {
  const auto upright = UprightView::of(view);
  if (!upright || !view.frame.labels) return {};
  std::vector<PicturedPerson> people;
  const auto masks = personMasks(*upright, *view.frame.labels, classes);
  people.reserve(masks.size());
  for (const auto& [mask, box] : masks) people.push_back({.box = {box, 1.0}, .mask = &mask});
  return located(view, *upright, people, nullptr);
}

}  // namespace prodomos::perception
