// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/storey_mesh.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/worlds/mesh_file.hpp"
#include "simulation/worlds/png_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace prodomos::simulation {
namespace {

constexpr double kSameLevel = 0.5;    ///< between the floors of one storey, metres
constexpr double kCeilingGap = 0.02;  ///< between a ceiling and the floor upon it
constexpr double kTallestBuilding = 500.0;

/// A part of a storey: how its node's name ends, its class, and what it looks like where its texture is missing.
struct PartKind {
  std::string_view word;
  std::string_view className;
  Material fallback;
};

const std::vector<PartKind>& partKinds() {
  static const std::vector<PartKind> kKinds{
      {"walls", "wall", {.color = {226, 224, 216}}},
      {"floor",
       "floor",
       {.color = {168, 172, 170},
        .accent = {140, 146, 146},
        .pattern = Pattern::kSpeckle,
        .scale = 0.5,
        .gloss = 0.25F}},
      {"ceiling", "ceiling", {.color = {235, 235, 232}}},
      {"stairs", "stairs", {.color = {160, 158, 152}}},
      {"windows", "window", {.color = {200, 200, 205}}},
      {"doorframes", "door_frame", {.color = {120, 96, 74}}},
      {"handrail", "handrail", {.color = {170, 140, 100}}},
      {"bumprail", "skirting", {.color = {150, 150, 150}}},
      {"doorsign", "sign", {.color = {60, 90, 140}}},
  };
  return kKinds;
}

/// The kind whose word stands last in the name: "…_floor_01_walls_visual" are walls.
const PartKind* kindOf(const std::string& name) {
  const PartKind* found = nullptr;
  std::size_t last = 0;
  for (const auto& kind : partKinds()) {
    const auto at = name.rfind(kind.word);
    if (at == std::string::npos || (found != nullptr && at < last)) continue;
    found = &kind;
    last = at;
  }
  return found;
}

bool isOf(const Surface& surface, std::string_view className) {
  return surface.classId == classId(className);
}

Surface placed(const geometry::Pose3& T_world_model, Surface surface) {
  return transformed(T_world_model, std::move(surface));
}

/// Of the texture in the middles of the surface's triangles, by their areas: for what is added in its style.
sensors::Rgb meanColor(const Surface& surface, const sensors::Image<sensors::Rgb>& texture) {
  const auto pixel = [](float coordinate, int size) {
    const auto share = static_cast<double>(coordinate - std::floor(coordinate));
    return std::min(static_cast<int>(share * size), size - 1);
  };
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double areas = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto& v = surface.vertices;
    const auto area = static_cast<double>((v[b] - v[a]).cross(v[c] - v[a]).norm());
    const auto& uv = surface.textureCoordinates;
    const Eigen::Vector2f middle = (uv[a] + uv[b] + uv[c]) / 3.0F;
    const auto& color = texture(pixel(middle.x(), texture.width()), pixel(1.0F - middle.y(), texture.height()));
    sum += area * Eigen::Vector3d(color.r, color.g, color.b);
    areas += area;
  }
  const Eigen::Vector3d mean = areas > 0.0 ? Eigen::Vector3d(sum / areas) : Eigen::Vector3d::Constant(200.0);
  return {static_cast<std::uint8_t>(mean.x()), static_cast<std::uint8_t>(mean.y()),
          static_cast<std::uint8_t>(mean.z())};
}

/// Reads each mesh and each texture once, however many storeys show it.
class MeshStore {
 public:
  MeshStore(std::filesystem::path folder, Building& building) : folder_(std::move(folder)), building_(building) {}

  std::filesystem::path meshOf(const std::string& model) const { return folder_ / (model + "_visual.dae"); }
  bool has(const std::string& model) const { return std::filesystem::exists(meshOf(model)); }

  /// With classes and materials, in the model's frame.
  const std::vector<Surface>& surfacesOf(const std::string& model) {
    const auto [entry, isNew] = surfaces_.try_emplace(model);
    if (!isNew) return entry->second;
    for (auto& part : readMesh(meshOf(model))) {
      const PartKind* kind = kindOf(part.name);
      if (kind == nullptr) kind = kindOf(model);
      if (kind == nullptr) {
        building_.remarks.push_back(meshOf(model).string() + ": \"" + part.name +
                                    "\" is no part that is known: left out");
        continue;
      }
      entry->second.push_back(dressed(std::move(part), *kind));
    }
    return entry->second;
  }

 private:
  Surface dressed(MeshPart part, const PartKind& kind) {
    Surface surface = std::move(part.surface);
    surface.classId = classId(kind.className);
    surface.material = kind.fallback;
    const auto texture = textureOf(part.texture);
    if (texture && !surface.textureCoordinates.empty()) {
      surface.material.pattern = Pattern::kImage;
      surface.material.texture = *texture;
      surface.material.color = meanColor(surface, building_.textures[static_cast<std::size_t>(*texture)]);
    } else {
      // Patterns want metres: floors have theirs seen from above, all others are plain.
      surface.textureCoordinates.clear();
      if (kind.fallback.pattern != Pattern::kPlain) {
        for (const auto& vertex : surface.vertices) surface.textureCoordinates.emplace_back(vertex.head<2>());
      }
    }
    return surface;
  }

  std::optional<int> textureOf(const std::filesystem::path& file) {
    if (file.empty()) return std::nullopt;
    const auto [entry, isNew] = textures_.try_emplace(file);
    if (!isNew) return entry->second;
    if (!std::filesystem::exists(file)) {
      building_.remarks.push_back("texture " + file.filename().string() +
                                  " is not there: a plain colour or pattern instead");
      return std::nullopt;
    }
    entry->second = static_cast<int>(building_.textures.size());
    building_.textures.push_back(readPng(file));
    return entry->second;
  }

  std::filesystem::path folder_;
  Building& building_;
  std::map<std::string, std::vector<Surface>> surfaces_;
  std::map<std::filesystem::path, std::optional<int>> textures_;
};

bool isStoreyModel(const std::string& model) {
  return model.ends_with("_floor") || model.ends_with("_walls") || model.ends_with("_ceiling");
}

/// Height of the floor's greatest level, in the model's frame.
double levelOf(const Surface& floor) {
  std::map<long, double> areas;  // by centimetre
  for (const auto& [a, b, c] : floor.triangles) {
    const Eigen::Vector3f doubled =
        (floor.vertices[b] - floor.vertices[a]).cross(floor.vertices[c] - floor.vertices[a]);
    if (std::abs(doubled.z()) < 0.99F * doubled.norm()) continue;
    areas[std::lround(floor.vertices[a].z() * 100.0F)] += static_cast<double>(doubled.norm());
  }
  const auto largest = std::ranges::max_element(areas, {}, [](const auto& entry) { return entry.second; });
  return largest == areas.end() ? 0.0 : static_cast<double>(largest->first) / 100.0;
}

/// Heights of the storeys' floors in the world's file, from below.
std::vector<double> floorLevels(const GazeboWorld& world, MeshStore& store) {
  std::vector<double> levels;
  for (const auto& model : world.models) {
    if (!store.has(model.model) || std::abs(model.T_world_model.translation().z()) > kTallestBuilding) continue;
    for (const auto& surface : store.surfacesOf(model.model)) {
      if (isOf(surface, "floor")) levels.push_back(model.T_world_model.translation().z() + levelOf(surface));
    }
  }
  std::ranges::sort(levels);
  levels.erase(std::unique(levels.begin(), levels.end(), [](double a, double b) { return b - a < kSameLevel; }),
               levels.end());
  return levels;
}

std::size_t storeyAt(const std::vector<double>& levels, double z) {
  const auto above = std::ranges::upper_bound(levels, z + kSameLevel);
  return above == levels.begin() ? 0 : static_cast<std::size_t>(above - levels.begin()) - 1;
}

/// The ceiling's height, or where there is none that of the walls.
void measureHeight(StoreyMesh& mesh, const std::string& place) {
  Eigen::AlignedBox3f walls;
  Eigen::AlignedBox3f ceiling;
  for (const auto& surface : mesh.surfaces) {
    if (isOf(surface, "wall")) walls.extend(boundsOf(surface));
    if (isOf(surface, "ceiling")) ceiling.extend(boundsOf(surface));
  }
  if (walls.isEmpty()) throw base::FileError(base::expectedFound(place, "walls on every storey", "none"));
  const double top = static_cast<double>(ceiling.isEmpty() ? walls.max().z() : ceiling.max().z());
  mesh.storey.ceilingHeight = top - mesh.storey.floor_z - kCeilingGap;
  for (auto& surface : mesh.surfaces) {
    if (!isOf(surface, "ceiling")) continue;
    for (auto& vertex : surface.vertices) vertex.z() -= static_cast<float>(kCeilingGap);
  }
}

}  // namespace

StoreyMeshes readStoreyMeshes(const GazeboWorld& world, const std::filesystem::path& path, Building& building) {
  MeshStore store(path.parent_path(), building);
  const auto levels = floorLevels(world, store);
  if (levels.empty()) {
    for (const auto& model : world.models) {
      if (isStoreyModel(model.model)) store.surfacesOf(model.model);  // throws: there is no such mesh
    }
    throw base::FileError(base::expectedFound(
        path.string(), "a model NAME_floor with NAME_floor_visual.dae beside the world", "no floor"));
  }
  StoreyMeshes meshes{.lowestFloor = levels.front()};
  for (const double level : levels) meshes.storeys.push_back({.storey = {.floor_z = level - levels.front()}});
  for (std::size_t i = 0; i < world.models.size(); ++i) {
    const auto& model = world.models[i];
    if (!store.has(model.model) && !isStoreyModel(model.model)) continue;
    meshes.models.push_back(i);
    auto T_world_model = model.T_world_model;
    auto& mesh = meshes.storeys[storeyAt(levels, T_world_model.translation().z())];
    T_world_model.translation().z() -= levels.front();
    for (const auto& surface : store.surfacesOf(model.model)) mesh.surfaces.push_back(placed(T_world_model, surface));
  }
  for (auto& mesh : meshes.storeys) measureHeight(mesh, path.string());
  return meshes;
}

std::vector<Segment> sliceOf(const StoreyMesh& mesh, std::string_view className, double height) {
  std::vector<Segment> segments;
  for (const auto& surface : mesh.surfaces) {
    if (!isOf(surface, className)) continue;
    const auto slice = sliceAt(surface, mesh.floor() + height);
    segments.insert(segments.end(), slice.begin(), slice.end());
  }
  return segments;
}

bool hasFloorAt(const StoreyMesh& mesh, const Eigen::Vector2d& point) {
  constexpr float kLevel = 0.05F;
  for (const auto& surface : mesh.surfaces) {
    if (!isOf(surface, "floor")) continue;
    for (const auto& triangle : surface.triangles) {
      Polygon corners;
      bool isLevel = true;
      for (const auto index : triangle) {
        const auto& vertex = surface.vertices[index];
        isLevel = isLevel && std::abs(vertex.z() - static_cast<float>(mesh.floor())) < kLevel;
        corners.emplace_back(vertex.head<2>().cast<double>());
      }
      if (isLevel && contains(corners, point)) return true;
    }
  }
  return false;
}

Surface emptySurface(const StoreyMesh& mesh, std::string_view className) {
  const auto like = std::ranges::find(mesh.surfaces, classId(className), &Surface::classId);
  Surface empty{.classId = classId(className)};
  if (like != mesh.surfaces.end()) empty.material = like->material;
  if (empty.material.pattern == Pattern::kImage) empty.material.pattern = Pattern::kPlain;
  return empty;
}

void addFloor(StoreyMesh& mesh, const Eigen::AlignedBox2d& plan) {
  Surface added = emptySurface(mesh, "floor");
  addRectangle(added, {plan.min().x(), plan.min().y(), mesh.floor()}, {plan.sizes().x(), 0.0, 0.0},
               {0.0, plan.sizes().y(), 0.0});
  // As on the rest: metres from the model's origin.
  for (std::size_t i = 0; i < added.vertices.size(); ++i) added.textureCoordinates[i] = added.vertices[i].head<2>();
  mesh.surfaces.push_back(std::move(added));
}

void cutAway(StoreyMesh& mesh, const Eigen::AlignedBox3d& box, std::initializer_list<std::string_view> classNames) {
  for (const auto className : classNames) {
    for (auto& surface : mesh.surfaces) {
      if (isOf(surface, className)) surface = cutAway(surface, box);
    }
  }
}

double distanceTo(const std::vector<Segment>& segments, const Eigen::Vector2d& from, const Eigen::Vector2d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& segment : segments) {
    const Eigen::Vector2d way = segment.b - segment.a;
    const Eigen::Vector2d offset = segment.a - from;
    const double sine = direction.x() * way.y() - direction.y() * way.x();
    if (std::abs(sine) < 1e-9) continue;
    const double t = (offset.x() * way.y() - offset.y() * way.x()) / sine;
    const double s = (offset.x() * direction.y() - offset.y() * direction.x()) / sine;
    if (t >= 0.0 && s >= 0.0 && s <= 1.0) nearest = std::min(nearest, t);
  }
  return nearest;
}

}  // namespace prodomos::simulation
