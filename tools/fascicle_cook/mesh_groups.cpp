#include "tools/fascicle_cook/mesh_groups.hpp"

#include <algorithm>

#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::cook {

using namespace fascicle::muscle;

std::vector<MeshGroup> group_by_mesh(const CharacterAsset& character) {
  std::vector<MeshGroup> groups;
  for (std::uint32_t i = 0; i < character.descriptions.size(); ++i) {
    const auto mesh = character.muscle_meshes.find(character.descriptions[i].name);
    if (mesh == character.muscle_meshes.end()) continue;
    auto known = std::ranges::find(groups, mesh->second.get(), &MeshGroup::mesh);
    if (known == groups.end()) {
      groups.push_back({mesh->second.get(), {}, nullptr});
      known = groups.end() - 1;
    }
    known->muscles.push_back(i);
  }
  parallel::for_range(groups.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      groups[g].oracle = std::make_unique<const MeshOracle>(clean_mesh(*groups[g].mesh).mesh);
    }
  });
  return groups;
}

std::vector<FitComparison> compare_groups(const std::vector<MeshGroup>& groups, const MuscleAsset& asset,
                                          const std::vector<bool>& fitted) {
  std::vector<FitComparison> compared(fitted.size());
  parallel::for_range(groups.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      std::vector<std::uint32_t> heads;
      for (const std::uint32_t i : groups[g].muscles) {
        if (fitted[i]) heads.push_back(i);
      }
      if (heads.empty()) continue;
      const std::vector<FitComparison> results = compare_heads(asset, heads, *groups[g].oracle);
      for (std::size_t k = 0; k < heads.size(); ++k) compared[heads[k]] = results[k];
    }
  });
  return compared;
}

}  // namespace fascicle::cook
