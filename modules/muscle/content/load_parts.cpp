#include "modules/muscle/content/load_parts.hpp"

#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "engine/animation/gltf_skins.hpp"
#include "engine/content/closest_name.hpp"
#include "engine/content/gltf_reader.hpp"
#include "modules/muscle/content/mirror.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

// The skin on the character's skeleton; null where one of its bones is not there.
std::shared_ptr<const SkinAsset> bind_skin(const GltfFile& file, const GltfMesh& mesh, const Skeleton& skeleton,
                                           const JsonNode& node, Diagnostics& diagnostics) {
  std::shared_ptr<const SkinAsset> skin = make_skin_asset(file, mesh);
  if (&file.skeleton == &skeleton) return skin;
  auto bound = std::make_shared<SkinAsset>(*skin);
  bool sound = true;
  for (std::int32_t& bone : bound->joint_bones) {
    const std::string& name = file.skeleton.names[static_cast<std::size_t>(bone)];
    bone = skeleton.find(name);
    if (bone >= 0) continue;
    node.error(diagnostics, fmt::format("the skin '{}' hangs on bone '{}', which the skeleton doesn't have", mesh.name,
                                        name),
               suggest_name(name, skeleton.names, "bones"));
    sound = false;
  }
  return sound ? std::shared_ptr<const SkinAsset>(std::move(bound)) : nullptr;
}

std::vector<std::string> names_of_meshes(const GltfFile& file) {
  std::vector<std::string> names;
  for (const GltfMesh& mesh : file.meshes) names.push_back(mesh.name);
  return names;
}

std::shared_ptr<const TriangleMesh> reflect(const TriangleMesh& mesh, int axis) {
  auto reflected = std::make_shared<TriangleMesh>(mesh);
  for (glm::vec3& position : reflected->positions) position = mirror_point(position, axis);
  for (glm::vec3& normal : reflected->normals) normal = mirror_point(normal, axis);
  // A reflection turns triangles inside out; exchanging two corners turns them back.
  for (std::size_t i = 0; i + 2 < reflected->indices.size(); i += 3) {
    std::swap(reflected->indices[i + 1], reflected->indices[i + 2]);
  }
  return reflected;
}

void drop_from(std::vector<Diagnostic>& list) {
  std::set<std::tuple<std::string, int, int, std::string, std::string>> known;
  std::erase_if(list, [&](const Diagnostic& one) {
    return !known.emplace(one.file, one.line, one.column, one.path, one.cause).second;
  });
}

}  // namespace

void drop_repetitions(Diagnostics& diagnostics) {
  drop_from(diagnostics.errors);
  drop_from(diagnostics.warnings);
}

void load_skins(const CharacterFile& file, const fs::path& base, ContentSources& sources, CharacterAsset& asset,
                Diagnostics& diagnostics) {
  if (!file.skin.given()) return;
  const std::shared_ptr<const GltfFile> gltf = sources.gltf(file.skin.text, base, file.skin.node, diagnostics);
  if (!gltf) return;
  const auto add = [&](const GltfMesh& mesh, const JsonNode& node) {
    if (!asset.skeleton) return;
    if (auto skin = bind_skin(*gltf, mesh, *asset.skeleton, node, diagnostics)) asset.skins.push_back(std::move(skin));
  };
  if (file.skin_meshes.empty()) {
    bool any = false;
    for (const GltfMesh& mesh : gltf->meshes) {
      if (mesh.skin < 0) continue;
      any = true;
      add(mesh, file.skin.node);
    }
    if (!any) {
      file.skin.node.error(diagnostics, fmt::format("'{}' has no skinned mesh", file.skin.text),
                           "name the meshes to wear in \"meshes\"; those without a skin follow their node");
    }
  }
  for (const NameEntry& name : file.skin_meshes) {
    if (const GltfMesh* mesh = gltf->find_mesh(name.text)) {
      add(*mesh, name.node);
    } else {
      name.node.error(diagnostics, fmt::format("'{}' has no mesh '{}'", file.skin.text, name.text),
                      suggest_name(name.text, names_of_meshes(*gltf), "meshes"));
    }
  }
}

void load_bone_meshes(const CharacterFile& file, const fs::path& base, ContentSources& sources, CharacterAsset& asset,
                      Diagnostics& diagnostics) {
  for (const BoneMeshEntry& entry : file.bone_meshes) {
    BoneMesh part;
    if (entry.bone.given() && asset.skeleton) {
      part.bone = asset.skeleton->find(entry.bone.text);
      if (part.bone < 0) {
        entry.bone.node.error(diagnostics, fmt::format("the skeleton has no bone '{}'", entry.bone.text),
                              suggest_name(entry.bone.text, asset.skeleton->names, "bones"));
      }
    }
    if (entry.file.given()) part.mesh = sources.mesh(entry.file.text, base, entry.file.node, diagnostics);
    if (part.bone < 0 || !part.mesh) continue;
    part.transform = to_matrix(entry.transform);
    if (entry.in_character_space) {
      const glm::mat4& rest = asset.skeleton->rest_world[static_cast<std::size_t>(part.bone)];
      part.transform = glm::mat4(glm::inverse(glm::dmat4(rest))) * part.transform;
    }
    asset.bone_meshes.push_back(std::move(part));
  }
}

void load_muscle_meshes(const CharacterFile& file, const fs::path& base, std::span<const ResolvedMuscle> muscles,
                        ContentSources& sources, CharacterAsset& asset, Diagnostics& diagnostics) {
  std::shared_ptr<const GltfFile> gltf;
  if (file.muscle_meshes.given()) {
    gltf = sources.gltf(file.muscle_meshes.text, base, file.muscle_meshes.node, diagnostics);
    if (!gltf) return;
  }
  for (const MuscleEntry& entry : file.muscles) {
    if (!entry.mesh.given()) continue;
    if (!gltf) {
      entry.mesh.node.error(diagnostics,
                            fmt::format("the mesh '{}' is named, but the file has no muscle_meshes", entry.mesh.text),
                            "add \"muscle_meshes\": {\"file\": \"muscles.glb\"}, or leave out \"mesh\"");
    } else if (gltf->find_mesh(entry.mesh.text) == nullptr) {
      entry.mesh.node.error(diagnostics,
                            fmt::format("'{}' has no mesh '{}'", file.muscle_meshes.text, entry.mesh.text),
                            suggest_name(entry.mesh.text, names_of_meshes(*gltf), "meshes"));
    }
  }
  if (!gltf) return;
  const auto load = [&](std::string_view name) -> std::shared_ptr<const TriangleMesh> {
    const GltfMesh* mesh = gltf->find_mesh(name);
    return mesh == nullptr ? nullptr
                           : rest_space_mesh(*gltf, static_cast<std::size_t>(mesh - gltf->meshes.data()));
  };
  for (const ResolvedMuscle& muscle : muscles) {
    if (muscle.source != &file || !muscle.mesh.given()) continue;
    std::shared_ptr<const TriangleMesh> mesh = load(muscle.mesh.text);
    if (!mesh && muscle.mirror_axis >= 0) {
      if (const auto original = load(muscle.mirrored_mesh.text)) mesh = reflect(*original, muscle.mirror_axis);
    }
    if (mesh) asset.muscle_meshes.emplace(muscle.description.name, std::move(mesh));
  }
}

}  // namespace fascicle::muscle
