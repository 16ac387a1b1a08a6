#include "modules/muscle/content/bone_field_store.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <glm/vec4.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid.hpp"
#include "modules/muscle/asset/bone_fields/bone_grid_file.hpp"
#include "modules/muscle/content/fit_store.hpp"

namespace fascicle::muscle {

namespace fs = std::filesystem;

namespace {

TriangleMesh in_bone_frame(const BoneMesh& part) {
  TriangleMesh mesh;
  mesh.indices = part.mesh->indices;
  mesh.positions.reserve(part.mesh->positions.size());
  for (const glm::vec3& position : part.mesh->positions) {
    mesh.positions.push_back(glm::vec3(part.transform * glm::vec4(position, 1.0f)));
  }
  return mesh;
}

// A bone on its way from meshes to a field.
struct Work {
  std::size_t bone = 0;
  std::uint64_t inputs = 0;
  std::optional<BoneGrid> grid;
  Diagnostics faults;
  bool built = false;
};

}  // namespace

fs::path bone_field_store_of(const fs::path& character_file) {
  std::string name = fit_store_of(character_file).filename().string();
  name.resize(name.size() - std::string_view(".fit.json").size());
  return character_file.parent_path() / (name + ".bones.vdb");
}

std::vector<std::vector<TriangleMesh>> bone_surfaces(const CharacterAsset& asset) {
  std::vector<std::vector<TriangleMesh>> meshes(asset.skeleton->names.size());
  for (const BoneMesh& part : asset.bone_meshes) {
    meshes[static_cast<std::size_t>(part.bone)].push_back(in_bone_frame(part));
  }
  return meshes;
}

std::size_t load_bone_fields(const fs::path& character_file, CharacterAsset& asset, Diagnostics& diagnostics,
                             bool rebuild) {
  const std::vector<std::string>& names = asset.skeleton->names;
  asset.bone_fields.assign(names.size(), nullptr);
  const std::vector<std::vector<TriangleMesh>> meshes = bone_surfaces(asset);
  const BoneGridSettings settings{.voxel = asset.collision.settings.bone_voxel};
  const fs::path file = bone_field_store_of(character_file);
  std::vector<StoredBoneGrid> stored;
  std::vector<Work> work;
  for (std::size_t bone = 0; bone < names.size(); ++bone) {
    if (!meshes[bone].empty()) work.emplace_back().bone = bone;
  }
  if (work.empty()) return 0;
  if (!rebuild) stored = read_bone_grids(file);
  const std::size_t known = stored.size();
  parallel::for_range(work.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (Work& each : std::span(work).subspan(begin, end - begin)) {
      each.inputs = hash_bone_inputs(meshes[each.bone], settings);
      // By what went in, not by name: bones may be renamed, and share a shape.
      const auto same = std::find_if(stored.begin(), stored.end(),
                                     [&](const StoredBoneGrid& grid) { return grid.inputs == each.inputs; });
      if (same != stored.end()) {
        each.grid = same->grid;
      } else {
        Result<BoneGrid> grid = build_bone_grid(meshes[each.bone], names[each.bone], settings);
        each.built = grid.ok();
        if (grid) each.grid = std::move(*grid);
        each.faults = std::move(grid.diagnostics());
      }
      if (each.grid) asset.bone_fields[each.bone] = std::make_shared<const BoneField>(flatten(*each.grid));
    }
  });
  std::vector<StoredBoneGrid> kept;
  std::size_t built = 0;
  for (Work& each : work) {
    for (Diagnostic& fault : each.faults.errors) {
      fault.file = character_file.string();
      fault.cause = "the bone '" + names[each.bone] + "' has no field, so muscles pass through it: " + fault.cause;
      diagnostics.warnings.push_back(std::move(fault));
    }
    if (each.built) ++built;
    if (each.grid) kept.push_back({names[each.bone], each.inputs, std::move(*each.grid)});
  }
  // A folder that may not be written is no fault of the content, and nothing is lost but time.
  if (built > 0 || kept.size() != known) write_bone_grids(file, kept);
  return built;
}

}  // namespace fascicle::muscle
