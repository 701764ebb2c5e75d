// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/renderer.hpp"

#include "simulation/sensing/light_field.hpp"
#include "simulation/sensing/parallel_rows.hpp"
#include "simulation/sensing/patterns.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace prodomos::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using sensors::Image;

constexpr float kLampGlow = 2.2F;    // of what is a lamp, times its colour
constexpr float kWindowGlow = 1.3F;  // of the sky behind windows
constexpr float kAmbientLight = 1.1F;
constexpr float kLampLight = 1.0F;

/// Of all texture coordinates of a surface: how large the poster is.
Vector2f extentOf(const Surface& surface) {
  Vector2f extent = Vector2f::Zero();
  for (const auto& point : surface.textureCoordinates) extent = extent.cwiseMax(point);
  return extent;
}

std::vector<Vector2f> extentsOf(const std::vector<Surface>& surfaces) {
  std::vector<Vector2f> extents;
  for (const Surface& surface : surfaces) {
    const Pattern pattern = surface.material.pattern;
    const bool sized = pattern == Pattern::kPoster || pattern == Pattern::kNoticeboard || pattern == Pattern::kBooks ||
                       pattern == Pattern::kSky;
    extents.push_back(sized ? extentOf(surface) : Vector2f(0.0F, 0.0F));
  }
  return extents;
}

/// Texture coordinates per metre, of the triangle.
float textureDensity(const Surface& surface, std::uint32_t triangle) {
  const auto& [a, b, c] = surface.triangles[triangle];
  const auto& uv = surface.textureCoordinates;
  const auto& xyz = surface.vertices;
  const Vector2f first = uv[b] - uv[a];
  const Vector2f second = uv[c] - uv[a];
  const float textureArea = std::abs(first.x() * second.y() - first.y() * second.x());
  const float area = (xyz[b] - xyz[a]).cross(xyz[c] - xyz[a]).norm();
  return area > 0.0F ? std::sqrt(textureArea / area) : 0.0F;
}

/// Whether two neighbouring pixels show what should not be mixed without looking closer.
bool areApart(const Hit& a, const Hit& b) {
  if (a.surface != b.surface) return true;
  if (!a) return false;
  return a.normal.dot(b.normal) < 0.9F || std::abs(a.distance - b.distance) > 0.1F * std::min(a.distance, b.distance);
}

/// Of a projector beside the camera, mirrored straight back.
float glare(float gloss, float cosine) {
  return gloss > 0.0F && cosine > 0.97F ? 30.0F * gloss * std::pow(cosine, 400.0F) : 0.0F;
}

/// Bright light is compressed rather than cut off.
float shoulder(float value) {
  constexpr float kKnee = 0.7F;
  return value < kKnee ? value : 1.0F - (1.0F - kKnee) * std::exp(-(value - kKnee) / (1.0F - kKnee));
}

}  // namespace

class Renderer::Impl {
 public:
  Impl(const RayScene& scene, const std::vector<Image<sensors::Rgb>>& textures, Lighting lighting, CameraModel camera,
       Exposure exposure)
      : scene_(scene),
        textures_(textures.begin(), textures.end()),
        lighting_(std::move(lighting)),
        camera_(camera),
        exposure_(exposure),
        fixedExtents_(extentsOf(scene.fixed())),
        movingExtents_(extentsOf(scene.moving())),
        lampClass_(classId("lamp")) {
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) directions_.push_back(directionThrough(camera_, {x, y}).cast<float>());
    }
  }

  const CameraModel& camera() const { return camera_; }

  Rendering render(const geometry::Pose3& T_world_camera, int threads) const {
    const int width = camera_.width;
    const int height = camera_.height;
    View view{.T_world_camera = T_world_camera.cast<float>(), .hits = std::vector<Hit>(directions_.size())};
    forRows((height + kBlock - 1) / kBlock, threads, [&](int block) { castBlock(block, view); });
    const LightField light(
        scene_, lighting_.lamps, width, height, [&](int x, int y) { return seenAt(view, x, y); }, threads);
    Rendering result = blank();
    Image<Vector3f> radiance(width, height, Vector3f::Zero());
    forRows(height, threads, [&](int y) {
      writeRow(view, y, result);
      shadeRow(view, light, y, radiance);
    });
    const float gain = gainFor(radiance);
    forRows(height, threads, [&](int y) { developRow(radiance, gain, y, result.color); });
    return result;
  }

 private:
  /// Pixels are cast in blocks of 4 x 4, whose rays run closest together.
  static constexpr int kBlock = 4;

  struct View {
    Eigen::Isometry3f T_world_camera;
    std::vector<Hit> hits;  ///< row by row
  };

  Ray rayThrough(const View& view, int x, int y) const {
    return {.origin = view.T_world_camera.translation(),
            .direction = view.T_world_camera.linear() * directions_[index(x, y)]};
  }

  std::optional<LitPoint> seenAt(const View& view, int x, int y) const {
    const Hit& hit = view.hits[index(x, y)];
    if (!hit) return std::nullopt;
    const Ray ray = rayThrough(view, x, y);
    return LitPoint{ray.origin + hit.distance * ray.direction, hit.normal};
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(x);
  }

  Rendering blank() const {
    const int w = camera_.width;
    const int h = camera_.height;
    return {.depth = Image<float>(w, h),
            .color = Image<sensors::Rgb>(w, h),
            .classes = Image<std::uint16_t>(w, h),
            .instances = Image<std::uint16_t>(w, h),
            .cosine = Image<float>(w, h),
            .infrared = Image<float>(w, h)};
  }

  void castBlock(int block, View& view) const {
    std::vector<Ray> rays;
    std::vector<std::size_t> pixels;
    for (int x0 = 0; x0 < camera_.width; x0 += kBlock) {
      for (int y = block * kBlock; y < std::min((block + 1) * kBlock, camera_.height); ++y) {
        for (int x = x0; x < std::min(x0 + kBlock, camera_.width); ++x) {
          pixels.push_back(index(x, y));
          rays.push_back(rayThrough(view, x, y));
        }
      }
    }
    std::vector<Hit> hits(rays.size());
    scene_.cast(rays, hits);
    for (std::size_t i = 0; i < pixels.size(); ++i) view.hits[pixels[i]] = hits[i];
  }

  void writeRow(const View& view, int y, Rendering& result) const {
    for (int x = 0; x < camera_.width; ++x) {
      const Hit& hit = view.hits[index(x, y)];
      if (!hit) continue;
      const Material& material = hit.surface->material;
      const float cosine = -hit.normal.dot(rayThrough(view, x, y).direction.normalized());
      result.depth(x, y) = hit.distance;  // since directions have z = 1
      result.classes(x, y) = hit.surface->classId;
      result.instances(x, y) = hit.surface->instance;
      result.cosine(x, y) = cosine;
      result.infrared(x, y) = material.infrared * (cosine + glare(material.gloss, cosine));
    }
  }

  void shadeRow(const View& view, const LightField& light, int y, Image<Vector3f>& radiance) const {
    std::vector<int> edges;
    for (int x = 0; x < camera_.width; ++x) {
      radiance(x, y) =
          shade(rayThrough(view, x, y), view.hits[index(x, y)], static_cast<float>(x), static_cast<float>(y), light);
      if (isEdge(view, x, y)) edges.push_back(x);
    }
    smoothEdges(view, light, y, edges, radiance);
  }

  bool isEdge(const View& view, int x, int y) const {
    const Hit& hit = view.hits[index(x, y)];
    return (x > 0 && areApart(hit, view.hits[index(x - 1, y)])) ||
           (y > 0 && areApart(hit, view.hits[index(x, y - 1)])) ||
           (x + 1 < camera_.width && areApart(hit, view.hits[index(x + 1, y)])) ||
           (y + 1 < camera_.height && areApart(hit, view.hits[index(x, y + 1)]));
  }

  /// The colour of edge pixels is the mean of four points within them.
  void smoothEdges(const View& view, const LightField& light, int y, const std::vector<int>& edges,
                   Image<Vector3f>& radiance) const {
    constexpr std::array<std::array<float, 2>, 4> kOffsets{
        {{-0.375F, -0.125F}, {0.125F, -0.375F}, {0.375F, 0.125F}, {-0.125F, 0.375F}}};
    std::vector<Ray> rays;
    for (const int x : edges) {
      const Vector3f alongX = stepAt(view, x, y, 1, 0);
      const Vector3f alongY = stepAt(view, x, y, 0, 1);
      for (const auto& [dx, dy] : kOffsets) {
        Ray ray = rayThrough(view, x, y);
        ray.direction += dx * alongX + dy * alongY;
        rays.push_back(ray);
      }
    }
    std::vector<Hit> hits(rays.size());
    scene_.cast(rays, hits);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      Vector3f sum = Vector3f::Zero();
      for (std::size_t part = 0; part < kOffsets.size(); ++part) {
        const std::size_t ray = i * kOffsets.size() + part;
        const auto x = static_cast<float>(edges[i]) + kOffsets[part][0];
        const auto row = static_cast<float>(y) + kOffsets[part][1];
        // What shines is cut off before it is averaged, or lamps would have jagged edges.
        sum += shade(rays[ray], hits[ray], x, row, light).cwiseMin(1.5F);
      }
      radiance(edges[i], y) = sum / static_cast<float>(kOffsets.size());
    }
  }

  /// How the ray's direction changes from a pixel to the next.
  Vector3f stepAt(const View& view, int x, int y, int dx, int dy) const {
    const int x0 = std::min(x, camera_.width - 1 - dx);
    const int y0 = std::min(y, camera_.height - 1 - dy);
    return rayThrough(view, x0 + dx, y0 + dy).direction - rayThrough(view, x0, y0).direction;
  }

  /// The light that comes back along the ray, linear; 1 is white paper in good light.
  Vector3f shade(const Ray& ray, const Hit& hit, float x, float y, const LightField& field) const {
    if (!hit) return Vector3f::Zero();
    const Material& material = hit.surface->material;
    const Vector3f towards = -ray.direction.normalized();
    const float cosine = std::max(0.0F, hit.normal.dot(towards));
    const Vector3f albedo = albedoOf(ray, hit, cosine);
    const auto brightness = static_cast<float>(lighting_.brightness);
    if (material.pattern == Pattern::kSky) return kWindowGlow * albedo;
    if (hit.surface->classId == lampClass_) return kLampGlow * brightness * albedo.cwiseProduct(lighting_.tint);

    const Light light = field.at(x, y, {ray.origin + hit.distance * ray.direction, hit.normal});
    const auto ambientShare = static_cast<float>(lighting_.ambient);
    // Ceilings see the lit floor; walls of a corner differ a little.
    const Vector3f& n = hit.normal;
    const float around = 1.0F + 0.06F * n.x() + 0.03F * n.y() + 0.45F * std::max(0.0F, -n.z());
    const float ambient = kAmbientLight * ambientShare * around * (0.45F + 0.55F * light.openness);
    const float lampShare = kLampLight * (1.0F - ambientShare);
    Vector3f result = albedo * (ambient + lampShare * std::max(0.0F, n.dot(light.lamps)));
    if (material.gloss > 0.02F) {
      const Vector3f mirrored = 2.0F * cosine * n - towards;
      const float strength = light.lamps.norm();
      const float along = strength > 0.0F ? std::max(0.0F, mirrored.dot(light.lamps) / strength) : 0.0F;
      const float highlight = 0.5F * lampShare * strength * std::pow(along, 40.0F);
      const float flat = (1.0F - cosine) * (1.0F - cosine);
      const float sheen = 0.5F * ambientShare * (0.04F + 0.5F * flat * flat);
      result += Vector3f::Constant(material.gloss * (highlight + sheen));
    }
    return brightness * result.cwiseProduct(lighting_.tint);
  }

  Vector3f albedoOf(const Ray& ray, const Hit& hit, float cosine) const {
    const Material& material = hit.surface->material;
    const float footprint = hit.distance * ray.direction.norm() / static_cast<float>(camera_.intrinsics.fx) /
                            std::sqrt(std::max(cosine, 0.02F));
    const auto texture = static_cast<std::size_t>(material.texture);
    if (material.pattern == Pattern::kImage && material.texture >= 0 && texture < textures_.size() &&
        !hit.surface->textureCoordinates.empty()) {
      return textures_[texture].sample(hit.textureCoordinates, footprint * textureDensity(*hit.surface, hit.triangle));
    }
    return patternColor(material, {hit.textureCoordinates, extentOfHit(hit), footprint});
  }

  Vector2f extentOfHit(const Hit& hit) const {
    const Surface* first = scene_.fixed().data();
    if (hit.surface >= first && hit.surface < first + scene_.fixed().size()) {
      return fixedExtents_[static_cast<std::size_t>(hit.surface - first)];
    }
    return movingExtents_[static_cast<std::size_t>(hit.surface - scene_.moving().data())];
  }

  float gainFor(const Image<Vector3f>& radiance) const {
    double sum = 0.0;
    for (const Vector3f& pixel : radiance.pixels()) sum += std::min(1.0F, pixel.mean());
    const double mean = sum / static_cast<double>(radiance.size());
    return static_cast<float>(std::clamp(exposure_.target / std::max(mean, 1e-6), exposure_.least, exposure_.most));
  }

  void developRow(const Image<Vector3f>& radiance, float gain, int y, Image<sensors::Rgb>& color) const {
    const Vector2f middle(static_cast<float>(camera_.width) / 2.0F, static_cast<float>(camera_.height) / 2.0F);
    for (int x = 0; x < camera_.width; ++x) {
      const Vector2f off = Vector2f(static_cast<float>(x), static_cast<float>(y)) - middle;
      const float dimmed = 1.0F - static_cast<float>(exposure_.vignetting) * off.squaredNorm() / middle.squaredNorm();
      color(x, y) = encodedColor((gain * dimmed * radiance(x, y)).unaryExpr(&shoulder));
    }
  }

  const RayScene& scene_;
  std::vector<MipMap> textures_;
  Lighting lighting_;
  CameraModel camera_;
  Exposure exposure_;
  std::vector<Vector2f> fixedExtents_;
  std::vector<Vector2f> movingExtents_;
  std::uint16_t lampClass_;
  std::vector<Vector3f> directions_;  ///< in camera axes, z = 1, row by row
};

Renderer::Renderer(const RayScene& scene, const std::vector<Image<sensors::Rgb>>& textures, Lighting lighting,
                   CameraModel camera, Exposure exposure)
    : impl_(std::make_unique<Impl>(scene, textures, std::move(lighting), camera, exposure)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const CameraModel& Renderer::camera() const {
  return impl_->camera();
}

Rendering Renderer::render(const geometry::Pose3& T_world_camera, int threads) const {
  return impl_->render(T_world_camera, threads);
}

}  // namespace prodomos::simulation
