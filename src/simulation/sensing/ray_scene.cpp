// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/simulation/ray_scene.hpp"

#include "prodomos/base/error.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr std::size_t kPacket = 16;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using Scene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

void check(const Surface& surface, const std::string& name) {
  const auto fail = [&](const std::string& part, const std::string& expected, std::size_t found) {
    throw base::Error(base::expectedFound(name, expected + " " + part, std::to_string(found)));
  };
  const std::size_t count = surface.vertices.size();
  if (!surface.textureCoordinates.empty() && surface.textureCoordinates.size() != count) {
    fail("texture coordinates", std::to_string(count), surface.textureCoordinates.size());
  }
  if (!surface.normals.empty() && surface.normals.size() != count) {
    fail("normals", std::to_string(count), surface.normals.size());
  }
  for (const auto& triangle : surface.triangles) {
    const std::uint32_t last = *std::ranges::max_element(triangle);
    if (last >= count) fail("as a triangle's vertex", "an index below " + std::to_string(count), last);
  }
  if (!std::ranges::all_of(surface.vertices, [](const auto& vertex) { return vertex.allFinite(); })) {
    throw base::Error(base::expectedFound(name, "finite vertices", "one that is not"));
  }
}

std::string sizes(const Surface& surface) {
  return std::to_string(surface.vertices.size()) + " vertices and " + std::to_string(surface.triangles.size()) +
         " triangles";
}

/// Threes of numbers, one after the other.
template <typename Number, typename Element>
void copyNumbers(const std::vector<Element>& elements, void* buffer) {
  static_assert(sizeof(Element) == 3 * sizeof(Number));
  std::copy_n(elements.front().data(), 3 * elements.size(), static_cast<Number*>(buffer));
}

template <typename Number, typename Element>
void fillBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<Element>& elements) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), elements.size());
  if (buffer == nullptr) throw base::Error("no memory for a surface of " + std::to_string(elements.size()) + " parts");
  copyNumbers<Number>(elements, buffer);
}

/// Weights of a triangle's three vertices at a hit.
template <typename Vector>
Vector blend(const std::vector<Vector>& values, const std::array<std::uint32_t, 3>& triangle, float u, float v) {
  return (1.0F - u - v) * values[triangle[0]] + u * values[triangle[1]] + v * values[triangle[2]];
}

RTCIntersectContext contextOf(RayOrder order) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      order == RayOrder::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

/// Fills the packet's rays; lanes beyond the last ray are switched off.
void fillPacket(std::span<const Ray> rays, RTCRay16& packet, std::array<int, kPacket>& valid) {
  for (std::size_t lane = 0; lane < kPacket; ++lane) {
    valid[lane] = lane < rays.size() ? -1 : 0;
    const Ray& ray = rays[std::min(lane, rays.size() - 1)];
    packet.org_x[lane] = ray.origin.x();
    packet.org_y[lane] = ray.origin.y();
    packet.org_z[lane] = ray.origin.z();
    packet.dir_x[lane] = ray.direction.x();
    packet.dir_y[lane] = ray.direction.y();
    packet.dir_z[lane] = ray.direction.z();
    packet.tnear[lane] = 0.0F;
    packet.tfar[lane] = ray.maxDistance;
    packet.time[lane] = 0.0F;
    packet.mask[lane] = 0xffffffffU;
    packet.id[lane] = static_cast<unsigned>(lane);
    packet.flags[lane] = 0;
  }
}

}  // namespace

/// Fixed and moving surfaces are two scenes asked one after the other: a commit rebuilds the second alone. Geometry ids
/// count through both.
class RayScene::Impl {
 public:
  Impl(std::vector<Surface> fixed, std::vector<Surface> moving)
      // One thread builds the trees, so that they never depend on a machine's load.
      : device_(rtcNewDevice("threads=1,user_threads=1")), fixed_(std::move(fixed)), moving_(std::move(moving)) {
    if (device_ == nullptr) throw base::Error("Embree does not start on this machine");
    fixedScene_ = sceneOf(fixed_, 0, RTC_SCENE_FLAG_ROBUST, RTC_BUILD_QUALITY_HIGH, "fixed");
    movingScene_ = sceneOf(moving_, fixed_.size(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC,
                           RTC_BUILD_QUALITY_LOW, "moving");
  }

  void move(std::size_t index, const Surface& surface) {
    Surface& moved = moving_.at(index);
    if (surface.vertices.size() != moved.vertices.size() || surface.triangles.size() != moved.triangles.size()) {
      throw base::Error(base::expectedFound("moving surface " + std::to_string(index), sizes(moved), sizes(surface)));
    }
    check(surface, "moving surface " + std::to_string(index));
    moved = surface;
    if (moved.triangles.empty()) return;
    RTCGeometry geometry = rtcGetGeometry(movingScene_.get(), static_cast<unsigned>(fixed_.size() + index));
    copyNumbers<float>(moved.vertices, rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
  }

  void commit() { rtcCommitScene(movingScene_.get()); }

  const std::vector<Surface>& fixed() const { return fixed_; }
  const std::vector<Surface>& moving() const { return moving_; }

  void cast(std::span<const Ray> rays, std::span<Hit> hits, RayOrder order) const {
    RTCIntersectContext context = contextOf(order);
    alignas(64) RTCRayHit16 packet;
    alignas(64) std::array<int, kPacket> valid;
    for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
      const auto chunk = rays.subspan(begin, std::min(kPacket, rays.size() - begin));
      fillPacket(chunk, packet.ray, valid);
      std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
      rtcIntersect16(valid.data(), fixedScene_.get(), &context, &packet);
      if (!moving_.empty()) rtcIntersect16(valid.data(), movingScene_.get(), &context, &packet);
      for (std::size_t lane = 0; lane < chunk.size(); ++lane) {
        hits[begin + lane] = hitOf(packet, lane, chunk[lane].direction);
      }
    }
  }

  void areOccluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, RayOrder order) const {
    RTCIntersectContext context = contextOf(order);
    alignas(64) RTCRay16 packet;
    alignas(64) std::array<int, kPacket> valid;
    for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
      const auto chunk = rays.subspan(begin, std::min(kPacket, rays.size() - begin));
      fillPacket(chunk, packet, valid);
      rtcOccluded16(valid.data(), fixedScene_.get(), &context, &packet);
      // A ray that is occluded has tfar = -inf, and is passed over.
      if (!moving_.empty()) rtcOccluded16(valid.data(), movingScene_.get(), &context, &packet);
      for (std::size_t lane = 0; lane < chunk.size(); ++lane) occluded[begin + lane] = packet.tfar[lane] < 0.0F;
    }
  }

 private:
  Scene sceneOf(const std::vector<Surface>& surfaces, std::size_t firstId, int flags, RTCBuildQuality quality,
                const std::string& kind) const {
    Scene scene(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(flags));
    rtcSetSceneBuildQuality(scene.get(), quality);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      check(surfaces[i], kind + " surface " + std::to_string(i));
      if (surfaces[i].triangles.empty()) continue;
      RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetGeometryBuildQuality(geometry, quality);
      fillBuffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, surfaces[i].vertices);
      fillBuffer<std::uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, surfaces[i].triangles);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(scene.get(), geometry, static_cast<unsigned>(firstId + i));
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene.get());
    return scene;
  }

  Hit hitOf(const RTCRayHit16& packet, std::size_t lane, const Eigen::Vector3f& direction) const {
    Hit hit;
    const unsigned id = packet.hit.geomID[lane];
    if (id == RTC_INVALID_GEOMETRY_ID) return hit;
    const Surface& surface = id < fixed_.size() ? fixed_[id] : moving_[id - fixed_.size()];
    const float u = packet.hit.u[lane];
    const float v = packet.hit.v[lane];
    hit.distance = packet.ray.tfar[lane];
    hit.surface = &surface;
    hit.triangle = packet.hit.primID[lane];
    const auto& triangle = surface.triangles[hit.triangle];
    if (!surface.textureCoordinates.empty()) {
      hit.textureCoordinates = blend(surface.textureCoordinates, triangle, u, v);
    }
    const Eigen::Vector3f face(packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]);
    Eigen::Vector3f normal = surface.normals.empty() ? face : blend(surface.normals, triangle, u, v);
    if (face.dot(direction) > 0.0F) normal = -normal;
    const float length = normal.norm();
    hit.normal = length > 0.0F ? Eigen::Vector3f(normal / length) : Eigen::Vector3f(-direction.normalized());
    return hit;
  }

  Device device_;
  std::vector<Surface> fixed_;
  std::vector<Surface> moving_;
  Scene fixedScene_;
  Scene movingScene_;
};

RayScene::RayScene(std::vector<Surface> fixed, std::vector<Surface> moving)
    : impl_(std::make_unique<Impl>(std::move(fixed), std::move(moving))) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

void RayScene::move(std::size_t index, const Surface& surface) {
  impl_->move(index, surface);
}
void RayScene::commit() {
  impl_->commit();
}
const std::vector<Surface>& RayScene::fixed() const {
  return impl_->fixed();
}
const std::vector<Surface>& RayScene::moving() const {
  return impl_->moving();
}

Hit RayScene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double maxDistance) const {
  const Ray ray{origin.cast<float>(), direction.cast<float>(), static_cast<float>(maxDistance)};
  Hit hit;
  impl_->cast({&ray, 1}, {&hit, 1}, RayOrder::kAny);
  return hit;
}

bool RayScene::isOccluded(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double maxDistance) const {
  const Ray ray{origin.cast<float>(), direction.cast<float>(), static_cast<float>(maxDistance)};
  std::uint8_t occluded = 0;
  impl_->areOccluded({&ray, 1}, {&occluded, 1}, RayOrder::kAny);
  return occluded != 0;
}

void RayScene::cast(std::span<const Ray> rays, std::span<Hit> hits, RayOrder order) const {
  impl_->cast(rays, hits, order);
}

void RayScene::areOccluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, RayOrder order) const {
  impl_->areOccluded(rays, occluded, order);
}

}  // namespace prodomos::simulation
