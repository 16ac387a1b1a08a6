#include "modules/muscle/content/load_parts.hpp"

#include <map>
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

// A reflection turns triangles inside out; exchanging two corners turns them back.
void turn_triangles(TriangleMesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

std::shared_ptr<const TriangleMesh> reflect(const TriangleMesh& mesh, int axis) {
  auto reflected = std::make_shared<TriangleMesh>(mesh);
  for (glm::vec3& position : reflected->positions) position = mirror_point(position, axis);
  for (glm::vec3& normal : reflected->normals) normal = mirror_point(normal, axis);
  turn_triangles(*reflected);
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

namespace {

// The muscles' meshes of one file. Muscles with the same mesh get the same object: they are its heads.
class MuscleMeshes {
 public:
  MuscleMeshes(const CharacterFile& file, const fs::path& base, ContentSources& sources, Diagnostics& diagnostics)
      : file_(file), base_(base), sources_(sources), diagnostics_(diagnostics) {}

  // False where the file of "muscle_meshes" cannot be read.
  bool open() {
    if (!file_.muscle_meshes.given()) return true;
    const NameEntry& entry = file_.muscle_meshes;
    Diagnostics found;
    named_ = sources_.gltf(entry.text, base_, entry.node, found);
    tell(entry.node, std::move(found));
    return named_ != nullptr;
  }

  // Null where there is none, or it is wrong, which has been told then.
  std::shared_ptr<const TriangleMesh> find(const ResolvedMuscle& muscle) {
    if (muscle.mesh.file.given()) {
      const auto mesh = load_file(muscle.mesh);
      return mesh && muscle.mirror_axis >= 0 ? reflected(mesh, muscle.mirror_axis) : mesh;
    }
    if (!muscle.mesh.name.given() || !named_) return nullptr;
    const auto own = load_named(muscle.mesh.name.text);
    if (own || muscle.mirror_axis < 0) return own;
    const auto original = load_named(muscle.mirrored_mesh.text);
    return original ? reflected(original, muscle.mirror_axis) : nullptr;
  }

  void check_name(const NameEntry& name) {
    if (!named_) {
      name.node.error(diagnostics_, fmt::format("the mesh '{}' is named, but the file has no muscle_meshes", name.text),
                      "add \"muscle_meshes\": {\"file\": \"muscles.glb\"}, or leave out \"mesh\"");
    } else if (named_->find_mesh(name.text) == nullptr) {
      name.node.error(diagnostics_, fmt::format("'{}' has no mesh '{}'", file_.muscle_meshes.text, name.text),
                      suggest_name(name.text, names_of_meshes(*named_), "meshes"));
    }
  }

 private:
  using Mesh = std::shared_ptr<const TriangleMesh>;

  // A reference that leads nowhere is an error; a mesh file that is broken inside leaves its muscles unfitted.
  void tell(const JsonNode& node, Diagnostics found) {
    for (Diagnostic& error : found.errors) {
      if (error.file == node.file()) {
        diagnostics_.errors.push_back(std::move(error));
      } else {
        node.warning(diagnostics_, fmt::format("the mesh file cannot be used: {}", to_string(error)),
                     "mend it or name another; the muscles keep their unfitted shapes");
      }
    }
    diagnostics_.append({.errors = {}, .warnings = std::move(found.warnings)});
  }

  Mesh load_named(const std::string& name) {
    const GltfMesh* mesh = named_->find_mesh(name);
    if (mesh == nullptr) return nullptr;
    Mesh& known = by_name_[mesh->name];
    if (!known) {
      known = placed(rest_space_mesh(*named_, static_cast<std::size_t>(mesh - named_->meshes.data())),
                     file_.muscle_mesh_unit, Trs{});
    }
    return known;
  }

  Mesh load_file(const MeshEntry& entry) {
    Diagnostics found;
    Mesh mesh = sources_.mesh(entry.file.text, base_, entry.file.node, found);
    tell(entry.file.node, std::move(found));
    if (!mesh) return nullptr;
    // The same file may be placed in several ways.
    const Trs& t = entry.transform;
    const std::string key = fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", entry.file.text, entry.unit, t.scale.x,
                                        t.scale.y, t.scale.z, t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w,
                                        t.translation.x, t.translation.y, t.translation.z);
    Mesh& known = by_file_[key];
    if (!known) known = placed(std::move(mesh), entry.unit, t);
    return known;
  }

  static Mesh placed(Mesh mesh, float unit, Trs transform) {
    transform.scale *= unit;
    const glm::mat4 matrix = to_matrix(transform);
    if (matrix == glm::mat4(1.0f)) return mesh;
    auto moved = std::make_shared<TriangleMesh>(*mesh);
    for (glm::vec3& position : moved->positions) position = glm::vec3(matrix * glm::vec4(position, 1.0f));
    moved->normals.clear();  // the fit makes no use of them
    const bool mirrors = transform.scale.x * transform.scale.y * transform.scale.z < 0.0f;
    if (mirrors) turn_triangles(*moved);
    return moved;
  }

  Mesh reflected(const Mesh& mesh, int axis) {
    Mesh& known = reflected_[mesh];
    if (!known) known = reflect(*mesh, axis);
    return known;
  }

  const CharacterFile& file_;
  const fs::path& base_;
  ContentSources& sources_;
  Diagnostics& diagnostics_;
  std::shared_ptr<const GltfFile> named_;
  std::map<std::string, Mesh> by_name_, by_file_;
  std::map<Mesh, Mesh> reflected_;  // looked up only, never gone through
};

}  // namespace

void load_muscle_meshes(const CharacterFile& file, const fs::path& base, std::span<const ResolvedMuscle> muscles,
                        ContentSources& sources, CharacterAsset& asset, Diagnostics& diagnostics) {
  MuscleMeshes meshes(file, base, sources, diagnostics);
  if (!meshes.open()) return;
  for (const MuscleEntry& entry : file.muscles) {
    if (entry.mesh.name.given()) meshes.check_name(entry.mesh.name);
  }
  for (const ResolvedMuscle& muscle : muscles) {
    if (muscle.source != &file) continue;
    if (auto mesh = meshes.find(muscle)) asset.muscle_meshes.emplace(muscle.description.name, std::move(mesh));
  }
}

}  // namespace fascicle::muscle
