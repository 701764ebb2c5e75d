// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/label_degradation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace prodomos::simulation {

namespace {

using sensors::LabelImage;

/// Values that change smoothly over an image: normal numbers on a coarse lattice, in between bilinear.
class SmoothField {
 public:
  SmoothField(int width, int height, double sigma, base::Random& random)
      : columns_(width / kSpacing + 2), values_(static_cast<std::size_t>(columns_ * (height / kSpacing + 2))) {
    for (double& value : values_) value = random.normal(0.0, sigma);
  }

  double operator()(int x, int y) const {
    const double u = static_cast<double>(x % kSpacing) / kSpacing;
    const double v = static_cast<double>(y % kSpacing) / kSpacing;
    const auto columns = static_cast<std::size_t>(columns_);
    const auto at = static_cast<std::size_t>(y / kSpacing) * columns + static_cast<std::size_t>(x / kSpacing);
    const auto below = at + columns;
    return std::lerp(std::lerp(values_[at], values_[at + 1], u), std::lerp(values_[below], values_[below + 1], u), v);
  }

 private:
  static constexpr int kSpacing = 8;  // pixels: outlines of nets wander over about that length
  int columns_;
  std::vector<double> values_;
};

LabelImage emptyLike(const LabelImage& labels) {
  LabelImage copy{.classes = labels.classes.clone()};
  if (!labels.instances.empty()) copy.instances = labels.instances.clone();
  return copy;
}

LabelImage withWanderingOutlines(const LabelImage& labels, double sigma, base::Random& random) {
  const int width = labels.classes.width();
  const int height = labels.classes.height();
  const SmoothField right(width, height, sigma, random);
  const SmoothField down(width, height, sigma, random);
  auto wandered = emptyLike(labels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int fromX = std::clamp(x + static_cast<int>(std::lround(right(x, y))), 0, width - 1);
      const int fromY = std::clamp(y + static_cast<int>(std::lround(down(x, y))), 0, height - 1);
      wandered.classes(x, y) = labels.classes(fromX, fromY);
      if (!labels.instances.empty()) wandered.instances(x, y) = labels.instances(fromX, fromY);
    }
  }
  return wandered;
}

struct Ellipse {
  double x, y, radiusX, radiusY;
};

Ellipse somewhere(const LabelImage& labels, double leastRadius, double mostRadius, base::Random& random) {
  const double x = random.uniform(0.0, labels.classes.width());
  const double y = random.uniform(0.0, labels.classes.height());
  const double radiusX = random.uniform(leastRadius, mostRadius);
  return {x, y, radiusX, random.uniform(leastRadius, mostRadius)};
}

/// How many pixels it covers.
int paint(LabelImage& labels, const Ellipse& ellipse, std::uint16_t classId) {
  const auto clampX = [&](double x) { return std::clamp(static_cast<int>(x), 0, labels.classes.width() - 1); };
  const auto clampY = [&](double y) { return std::clamp(static_cast<int>(y), 0, labels.classes.height() - 1); };
  int painted = 0;
  for (int y = clampY(ellipse.y - ellipse.radiusY); y <= clampY(ellipse.y + ellipse.radiusY); ++y) {
    for (int x = clampX(ellipse.x - ellipse.radiusX); x <= clampX(ellipse.x + ellipse.radiusX); ++x) {
      if (std::hypot((x - ellipse.x) / ellipse.radiusX, (y - ellipse.y) / ellipse.radiusY) > 1.0) continue;
      labels.classes(x, y) = classId;
      if (!labels.instances.empty()) labels.instances(x, y) = 0;
      ++painted;
    }
  }
  return painted;
}

/// A class of the image other than the one at its middle; that one where there is no other.
std::uint16_t otherClass(const LabelImage& labels, const std::vector<std::uint16_t>& classes, const Ellipse& ellipse,
                         base::Random& random) {
  const auto here = labels.classes(std::min(static_cast<int>(ellipse.x), labels.classes.width() - 1),
                                   std::min(static_cast<int>(ellipse.y), labels.classes.height() - 1));
  std::vector<std::uint16_t> others;
  std::ranges::copy_if(classes, std::back_inserter(others), [&](auto id) { return id != here; });
  return others.empty() ? here
                        : others[static_cast<std::size_t>(random.integer(0, static_cast<int>(others.size()) - 1))];
}

void miss(LabelImage& labels, double probability, base::Random& random) {
  std::map<std::uint16_t, bool> isMissed;  // ordered: each instance draws in the order of its number
  for (const auto instance : std::set(labels.instances.pixels().begin(), labels.instances.pixels().end())) {
    isMissed[instance] = instance != 0 && random.uniform() < probability;
  }
  for (int y = 0; y < labels.classes.height(); ++y) {
    std::uint16_t around = 0;
    for (int x = 0; x < labels.classes.width(); ++x) {
      if (isMissed[labels.instances(x, y)]) {
        labels.classes(x, y) = around;
        labels.instances(x, y) = 0;
      } else {
        around = labels.classes(x, y);
      }
    }
  }
}

}  // namespace

sensors::LabelImage degraded(const sensors::LabelImage& labels, const LabelDegradation& degradation,
                             base::Random& random) {
  auto image = emptyLike(labels);
  if (image.classes.empty()) return image;
  const std::set<std::uint16_t> present(labels.classes.pixels().begin(), labels.classes.pixels().end());
  const std::vector<std::uint16_t> classes(present.begin(), present.end());
  if (degradation.missed > 0.0 && !image.instances.empty()) miss(image, degradation.missed, random);
  if (degradation.boundaryNoise > 0.0) image = withWanderingOutlines(image, degradation.boundaryNoise, random);
  const auto flipped = static_cast<int>(degradation.flips * static_cast<double>(image.classes.size()));
  for (int done = 0; done < flipped;) {
    const auto patch = somewhere(image, 2.0, 8.0, random);
    done += std::max(1, paint(image, patch, otherClass(image, classes, patch, random)));
  }
  const int invented = static_cast<int>(degradation.falseThings) +
                       (random.uniform() < degradation.falseThings - std::floor(degradation.falseThings) ? 1 : 0);
  for (int i = 0; i < invented; ++i) {
    const auto thing = somewhere(image, 20.0, 60.0, random);
    paint(image, thing, otherClass(image, classes, thing, random));
  }
  return image;
}

}  // namespace prodomos::simulation
