// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/renderer.hpp"

#include "prodomos/simulation/color_noise.hpp"

#include "simulation/sensing/patterns.hpp"
#include "support/simulated_rooms.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

namespace prodomos::simulation {
namespace {

using sensors::Image;
using sensors::Rgb;

const CameraModel kSmall{.width = 160, .height = 120, .intrinsics = {131.25, 131.25, 79.5, 59.5, {}}};

/// At a place, looking along the world's x-axis turned by yaw and tilted down by pitch.
geometry::Pose3 lookFrom(const Eigen::Vector3d& position, double yaw = 0.0, double pitch = 0.0) {
  return geometry::fromYawPitchRoll(position, yaw, pitch, 0.0) * sensors::cameraAxesInBody();
}

Lighting oneLamp(const Eigen::Vector3d& lamp) {
  return {.lamps = {lamp}};
}

bool areEqual(const auto& a, const auto& b) {
  return std::ranges::equal(a.pixels(), b.pixels());
}

double brightnessOf(const Rgb& color) {
  return (color.r + color.g + color.b) / 3.0;
}

double meanBrightness(const Image<Rgb>& color, int x0, int y0, int width, int height) {
  double sum = 0.0;
  for (int y = y0; y < y0 + height; ++y) {
    for (int x = x0; x < x0 + width; ++x) sum += brightnessOf(color(x, y));
  }
  return sum / (width * height);
}

TEST(Camera, PixelsAndDirectionsAreEachOthersInverseThroughABentLens) {
  // The lens of rgbd/icsl_corridor, one bent far more, and none.
  for (const auto& distortion : {std::array{0.0354, -0.0476, 0.00107, 0.00127, -0.207},
                                 std::array{-0.25, 0.08, 0.001, -0.001, 0.0}, std::array{0.0, 0.0, 0.0, 0.0, 0.0}}) {
    CameraModel camera;
    camera.intrinsics.distortion = distortion;
    for (int y = 0; y < camera.height; y += 37) {
      for (int x = 0; x < camera.width; x += 41) {
        const Eigen::Vector3d direction = directionThrough(camera, {x, y});
        EXPECT_EQ(direction.z(), 1.0);
        EXPECT_LT((project(camera, 2.7 * direction) - Eigen::Vector2d(x, y)).norm(), 0.01) << x << ' ' << y;
      }
    }
  }
}

TEST(Camera, TheDefaultIsAnXtion) {
  const Eigen::Vector2d pixel = project({}, {0.5, -0.25, 2.0});
  EXPECT_NEAR(pixel.x(), 319.5 + 525.0 * 0.25, 1e-9);
  EXPECT_NEAR(pixel.y(), 239.5 - 525.0 * 0.125, 1e-9);
}

TEST(Renderer, DepthIsAlongTheOpticalAxis) {
  const RayScene scene(test::emptyRoom({8.0, 6.0, 3.0}));
  const Renderer renderer(scene, {}, oneLamp({0.0, 0.0, 2.7}));
  const auto picture = renderer.render(lookFrom({1.0, 0.5, 1.2}));
  for (const int y : {0, 100, 239, 300, 479}) {
    for (const int x : {0, 100, 320, 500, 639}) {
      const Eigen::Vector3d ray((x - 319.5) / 525.0, (y - 239.5) / 525.0, 1.0);
      // Wall 3 m ahead, left wall 2.5 m aside, right 3.5 m; ceiling 1.8 m above, floor 1.2 m below.
      const double expected = std::min(
          {3.0, ray.x() > 0.0 ? 3.5 / ray.x() : 2.5 / -ray.x(), ray.y() > 0.0 ? 1.2 / ray.y() : 1.8 / -ray.y()});
      EXPECT_NEAR(picture.depth(x, y), expected, 1e-4) << x << ' ' << y;
    }
  }
  EXPECT_NEAR(picture.cosine(320, 240), 1.0, 1e-4);
  EXPECT_NEAR(picture.infrared(320, 240), 0.8, 1e-3);
}

TEST(Renderer, DepthFollowsTheLens) {
  const RayScene scene(test::emptyRoom({8.0, 6.0, 3.0}));
  CameraModel camera = kSmall;
  camera.intrinsics.distortion = {-0.2, 0.05, 0.001, 0.0, 0.0};
  const auto picture = Renderer(scene, {}, {}, camera).render(lookFrom({0.0, 0.0, 1.5}));
  for (int y = 0; y < camera.height; y += 7) {
    for (int x = 0; x < camera.width; x += 7) {
      const Eigen::Vector3d point = picture.depth(x, y) * directionThrough(camera, {x, y});
      // Every point lies on a side of the room: x right, y down, z ahead.
      const double off = std::min(
          {std::abs(4.0 - point.z()), std::abs(3.0 - std::abs(point.x())), std::abs(1.5 - std::abs(point.y()))});
      EXPECT_NEAR(off, 0.0, 1e-3);
    }
  }
}

TEST(Renderer, NamesClassesAndInstances) {
  auto surfaces = test::emptyRoom({8.0, 6.0, 3.0});
  surfaces.push_back(boxSurface(geometry::fromYawPitchRoll({3.0, 0.5, 1.5}, 0.0, 0.0, 0.0), {0.2, 0.5, 0.5}, {},
                                classId("shelf"), 42));
  const RayScene scene(surfaces);
  const auto picture = Renderer(scene, {}, {}).render(lookFrom({0.0, 0.0, 1.5}));
  // The box's front is 2.9 m ahead, from 0.25 to 0.75 m on the left.
  const auto pixel = [](double left, double up) {
    return std::pair{static_cast<int>(319.5 - 525.0 * left / 2.9), static_cast<int>(239.5 - 525.0 * up / 2.9)};
  };
  for (const auto& [left, up, inside] :
       {std::tuple{0.5, 0.0, true}, std::tuple{0.27, 0.23, true}, std::tuple{0.73, -0.23, true},
        std::tuple{0.20, 0.0, false}, std::tuple{0.80, 0.0, false}, std::tuple{0.5, 0.28, false}}) {
    const auto [x, y] = pixel(left, up);
    EXPECT_EQ(picture.classes(x, y), inside ? classId("shelf") : classId("wall"));
    EXPECT_EQ(picture.instances(x, y), inside ? 42 : 0);
  }
  EXPECT_EQ(picture.classes(320, 479), classId("floor"));
  EXPECT_EQ(picture.classes(320, 0), classId("ceiling"));
}

TEST(Renderer, DrawsNothingWhereNothingIs) {
  const RayScene scene({});
  const auto picture = Renderer(scene, {}, oneLamp({0.0, 0.0, 2.0}), kSmall).render(lookFrom({0.0, 0.0, 1.0}));
  EXPECT_EQ(std::ranges::count(picture.depth.pixels(), 0.0F), 160 * 120);
  EXPECT_EQ(std::ranges::count(picture.classes.pixels(), 0), 160 * 120);
  EXPECT_EQ(picture.color(80, 60), Rgb{});
}

TEST(Renderer, IsTheSameForAnyNumberOfThreads) {
  const auto hall = test::furnishedHall(20);
  const RayScene scene(hall.imported);
  const Renderer renderer(scene, {}, hall.lighting);
  const auto one = renderer.render(lookFrom({-6.0, -2.0, 1.3}, 1.0, 0.1), 1);
  for (const int threads : {2, 5, 0}) {
    const auto many = renderer.render(lookFrom({-6.0, -2.0, 1.3}, 1.0, 0.1), threads);
    EXPECT_TRUE(areEqual(one.color, many.color));
    EXPECT_TRUE(areEqual(one.depth, many.depth));
    EXPECT_TRUE(areEqual(one.classes, many.classes));
    EXPECT_TRUE(areEqual(one.infrared, many.infrared));
  }
}

TEST(Renderer, HasNoPixelThatIsNotANumber) {
  const auto hall = test::furnishedHall(20);
  const RayScene scene(hall.imported);
  const Renderer renderer(scene, {}, hall.lighting);
  for (const double yaw : {0.0, 1.6, 3.1, 4.7}) {
    const auto picture = renderer.render(lookFrom({2.0, -1.0, 1.0}, yaw, 0.2));
    for (const auto* image : {&picture.depth, &picture.cosine, &picture.infrared}) {
      EXPECT_TRUE(std::ranges::all_of(image->pixels(), [](float value) { return std::isfinite(value); }));
    }
    EXPECT_EQ(std::ranges::count(picture.depth.pixels(), 0.0F), 0) << "a closed room has no holes";
  }
}

TEST(Renderer, ThingsThrowShadows) {
  auto surfaces = test::emptyRoom({8.0, 6.0, 3.0});
  const auto brightness = [&] {
    const RayScene scene(surfaces);
    const Renderer renderer(scene, {}, oneLamp({2.0, 0.0, 2.8}), kSmall, {.least = 1.0, .most = 1.0});
    const auto picture = renderer.render(lookFrom({0.0, 0.0, 1.2}, 0.0, 0.6));
    // The floor below the lamp, 2 m ahead and 1.2 m below.
    const Eigen::Vector2d pixel =
        project(kSmall, lookFrom({0.0, 0.0, 1.2}, 0.0, 0.6).inverse() * Eigen::Vector3d(2.0, 0.0, 0.0));
    return meanBrightness(picture.color, static_cast<int>(pixel.x()) - 3, static_cast<int>(pixel.y()) - 2, 6, 4);
  };
  const double lit = brightness();
  surfaces.push_back(boxSurface(geometry::fromYawPitchRoll({2.0, 0.0, 2.2}, 0.0, 0.0, 0.0), {1.0, 1.0, 0.05}, {},
                                classId("shelf"), 1));
  EXPECT_LT(brightness(), 0.8 * lit);
}

TEST(Renderer, BrighterLampsAreSeenAndCornersOfThePictureAreDimmer) {
  const RayScene scene(test::emptyRoom({8.0, 6.0, 3.0}));
  const auto render = [&](double brightness, double vignetting) {
    Lighting lighting = oneLamp({0.0, 0.0, 2.8});
    lighting.brightness = brightness;
    return Renderer(scene, {}, lighting, kSmall, {.least = 1.0, .most = 1.0, .vignetting = vignetting})
        .render(lookFrom({0.0, 0.0, 1.5}))
        .color;
  };
  EXPECT_GT(meanBrightness(render(1.2, 0.0), 60, 40, 40, 40), 1.05 * meanBrightness(render(0.8, 0.0), 60, 40, 40, 40));
  const auto even = render(1.0, 0.0);
  const auto dimmed = render(1.0, 0.4);
  EXPECT_LT(meanBrightness(dimmed, 0, 0, 10, 10), 0.9 * meanBrightness(even, 0, 0, 10, 10));
  EXPECT_NEAR(meanBrightness(dimmed, 76, 56, 8, 8), meanBrightness(even, 76, 56, 8, 8), 3.0);
}

TEST(Renderer, ShowsTexturesTheRightWayUp) {
  Image<Rgb> texture(64, 64, {255, 255, 255});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) texture(x, y) = {200, 20, 20};  // the upper half red
  }
  Surface poster{.material = {.pattern = Pattern::kImage, .texture = 0}, .classId = classId("poster")};
  addRectangle(poster, {2.0, 0.5, 1.0}, {0.0, -1.0, 0.0}, {0.0, 0.0, 1.0});
  for (auto& point : poster.textureCoordinates) point = point.cwiseMin(1.0F);
  const RayScene scene({poster});
  const auto color = Renderer(scene, {texture}, oneLamp({1.0, 0.0, 2.5})).render(lookFrom({0.0, 0.0, 1.5})).color;
  EXPECT_GT(color(320, 180).r, 2 * color(320, 180).g);
  EXPECT_NEAR(color(320, 300).r, color(320, 300).g, 10);
}

TEST(Renderer, FarPatternsTendToTheirMean) {
  // What is finer than a pixel is averaged rather than sampled, or pictures would flicker.
  for (const Pattern pattern :
       {Pattern::kPlain, Pattern::kSpeckle, Pattern::kWood, Pattern::kTiles, Pattern::kCarpet}) {
    const Material material{.color = {220, 210, 200}, .accent = {60, 60, 80}, .pattern = pattern, .scale = 0.3};
    const auto spread = [&](float footprint) {
      float least = 10.0F;
      float most = 0.0F;
      for (int i = 0; i < 400; ++i) {
        const Eigen::Vector2f point(0.37F * static_cast<float>(i % 20), 0.23F * static_cast<float>(i) / 20.0F);
        const float value = patternColor(material, {point, {1.0F, 1.0F}, footprint}).mean();
        EXPECT_TRUE(value >= 0.0F && value < 2.0F);
        least = std::min(least, value);
        most = std::max(most, value);
      }
      return most - least;
    };
    EXPECT_LT(spread(2.0F), 0.12F) << static_cast<int>(pattern);
    EXPECT_LE(spread(2.0F), spread(0.001F)) << static_cast<int>(pattern);
  }
}

TEST(Patterns, AreAFunctionOfTheirSeed) {
  const auto row = [](Pattern pattern, std::uint32_t seed) {
    std::vector<float> values;
    const Material material{
        .color = {230, 228, 210}, .accent = {40, 60, 130}, .pattern = pattern, .scale = 0.3, .seed = seed};
    for (int i = 0; i < 600; ++i) {
      const Eigen::Vector2f point(0.013F * static_cast<float>(i % 60), 0.08F * static_cast<float>(i) / 60.0F);
      values.push_back(patternColor(material, {point, {0.8F, 0.8F}, 0.002F}).mean());
    }
    return values;
  };
  for (int pattern = 0; pattern < static_cast<int>(Pattern::kImage); ++pattern) {
    EXPECT_EQ(row(static_cast<Pattern>(pattern), 1), row(static_cast<Pattern>(pattern), 1)) << pattern;
    EXPECT_NE(row(static_cast<Pattern>(pattern), 1), row(static_cast<Pattern>(pattern), 2)) << pattern;
  }
}

TEST(ColorNoise, HasItsSigmaAndNoBias) {
  const Image<Rgb> grey(640, 480, {120, 130, 140});
  base::Random random(1, "color test");
  const auto noisy = noisyColor(grey, {.brightnessSigma = 3.0, .channelSigma = 2.0}, random);
  double sum = 0.0;
  double squares = 0.0;
  for (const Rgb& pixel : noisy.pixels()) {
    sum += pixel.g - 130.0;
    squares += (pixel.g - 130.0) * (pixel.g - 130.0);
  }
  const auto count = static_cast<double>(noisy.size());
  EXPECT_NEAR(sum / count, 0.0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / count), std::sqrt(9.0 + 4.0), 0.1);
}

TEST(ColorNoise, IsTheSameForAnyNumberOfThreadsAndStaysInRange) {
  const Image<Rgb> edges(64, 48, {0, 255, 128});
  const auto noisy = [&](int threads) {
    base::Random random(5, "color test");
    return noisyColor(edges, {.brightnessSigma = 20.0}, random, threads);
  };
  EXPECT_TRUE(areEqual(noisy(1), noisy(3)));
  const auto one = noisy(1);
  for (const Rgb& pixel : one.pixels()) {
    EXPECT_LT(pixel.r, 128);
    EXPECT_GT(pixel.g, 128);
  }
}

TEST(MotionBlur, SmearsAlongTheMotionAlone) {
  // A wall at 2 m, its left half black; the camera moved sidewards by as much as 10 pixels.
  Rendering picture{.depth = Image<float>(160, 120, 2.0F), .color = Image<Rgb>(160, 120, {250, 250, 250})};
  for (int y = 0; y < 120; ++y) std::fill_n(picture.color.row(y), 80, Rgb{});
  geometry::Pose3 T_end_begin = geometry::Pose3::Identity();
  EXPECT_TRUE(areEqual(motionBlurred(picture, kSmall, T_end_begin), picture.color)) << "at rest";
  const double step = 10.0 * 2.0 / kSmall.intrinsics.fx;
  T_end_begin.translation() = Eigen::Vector3d(0.0, step, 0.0);
  EXPECT_TRUE(areEqual(motionBlurred(picture, kSmall, T_end_begin), picture.color)) << "along the edge";
  T_end_begin.translation() = Eigen::Vector3d(step, 0.0, 0.0);
  const auto blurred = motionBlurred(picture, kSmall, T_end_begin);
  const auto mixed = std::count_if(blurred.row(60), blurred.row(60) + 160,
                                   [](const Rgb& pixel) { return pixel.r > 0 && pixel.r < 250; });
  EXPECT_NEAR(static_cast<double>(mixed), 10.0, 1.0);
}

}  // namespace
}  // namespace prodomos::simulation
