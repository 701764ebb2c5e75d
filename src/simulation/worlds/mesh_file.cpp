// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/worlds/mesh_file.hpp"

#include "prodomos/base/error.hpp"

#include "simulation/surface_tools.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>

namespace prodomos::simulation {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& expected, std::string found) {
  std::ranges::replace(found, '\n', ' ');
  throw base::FileError(base::expectedFound(path.string(), expected, found));
}

/// The file's text, which Assimp can read: it takes offence at a blank before the first number of a <color>.
std::string tidiedText(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) fail(path, "a COLLADA mesh", "no such file");
  pugi::xml_document document;
  const auto parsed = document.load_file(path.c_str(), pugi::parse_default | pugi::parse_trim_pcdata);
  if (!parsed) {
    fail(path, "a COLLADA mesh",
         std::string(parsed.description()) + " at byte " + std::to_string(std::max<std::ptrdiff_t>(parsed.offset, 0)));
  }
  const auto root = document.child("COLLADA");
  if (!root) fail(path, "a COLLADA mesh", "<" + std::string(document.document_element().name()) + ">");
  const auto unit = root.child("asset").child("unit").attribute("meter");
  if (!(unit.as_double() > 0.0)) {
    fail(path, "the mesh's unit (<unit meter=\"0.01\"/> in <asset>)",
         unit ? "meter=\"" + std::string(unit.as_string()) + "\"" : "none");
  }
  std::ostringstream text;
  document.save(text, "", pugi::format_raw);
  return std::move(text).str();
}

Eigen::Affine3d toEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return transform;
}

Surface surfaceOf(const aiMesh& mesh, const Eigen::Affine3d& T_file_node) {
  Surface surface;
  for (unsigned int i = 0; i < mesh.mNumVertices; ++i) {
    const auto& v = mesh.mVertices[i];
    surface.vertices.push_back((T_file_node * Eigen::Vector3d(v.x, v.y, v.z)).cast<float>());
    if (!mesh.HasTextureCoords(0)) continue;
    const auto& t = mesh.mTextureCoords[0][i];
    surface.textureCoordinates.emplace_back(t.x, t.y);
  }
  const bool mirrors = T_file_node.linear().determinant() < 0.0;
  for (unsigned int i = 0; i < mesh.mNumFaces; ++i) {
    const auto& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines show nothing
    std::array<std::uint32_t, 3> triangle{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (mirrors) std::swap(triangle[1], triangle[2]);
    surface.triangles.push_back(triangle);
  }
  return surface;
}

std::filesystem::path textureOf(const aiMaterial& material, const std::filesystem::path& folder) {
  aiString name;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS) return {};
  return folder / std::filesystem::path(name.C_Str()).filename();
}

void collect(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& T_file_parent,
             const std::filesystem::path& folder, std::vector<MeshPart>& parts) {
  const Eigen::Affine3d T_file_node = T_file_parent * toEigen(node.mTransformation);
  for (unsigned int i = 0; i < node.mNumMeshes; ++i) {
    const auto& mesh = *scene.mMeshes[node.mMeshes[i]];
    parts.push_back({.name = node.mName.C_Str(),
                     .surface = surfaceOf(mesh, T_file_node),
                     .texture = textureOf(*scene.mMaterials[mesh.mMaterialIndex], folder)});
  }
  for (unsigned int i = 0; i < node.mNumChildren; ++i) {
    collect(scene, *node.mChildren[i], T_file_node, folder, parts);
  }
}

void checkSize(const std::filesystem::path& path, const std::vector<MeshPart>& parts) {
  constexpr double kSmallest = 2.0;
  constexpr double kLargest = 500.0;
  Eigen::AlignedBox3f bounds;
  for (const auto& part : parts) bounds.extend(boundsOf(part.surface));
  if (bounds.isEmpty()) fail(path, "a mesh", "no triangles");
  const double size = bounds.sizes().maxCoeff();
  if (size >= kSmallest && size <= kLargest) return;
  std::array<char, 64> found{};
  std::snprintf(found.data(), found.size(), "%.3g m: is its <unit> right?", size);
  fail(path, "a part of a building, 2 to 500 m long", found.data());
}

}  // namespace

std::vector<MeshPart> readMesh(const std::filesystem::path& path) {
  const std::string text = tidiedText(path);
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(),
                                                     aiProcess_Triangulate | aiProcess_JoinIdenticalVertices, "dae");
  if (scene == nullptr) fail(path, "a COLLADA mesh", importer.GetErrorString());
  std::vector<MeshPart> parts;
  collect(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), path.parent_path(), parts);
  checkSize(path, parts);
  return parts;
}

}  // namespace prodomos::simulation
