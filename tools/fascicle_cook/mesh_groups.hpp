// A character's muscles by the mesh that they are fitted to: the heads of one mesh are compared with it together.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::cook {

struct MeshGroup {
  const TriangleMesh* mesh = nullptr;
  std::vector<std::uint32_t> muscles;  // indices of descriptions
  std::unique_ptr<const muscle::MeshOracle> oracle;
};

// In the order of the first muscle of each.
std::vector<MeshGroup> group_by_mesh(const muscle::CharacterAsset& character);

// Each muscle of `asset` with its mesh, by description; those that `fitted` says were not, and those without a mesh, are
// left as they are made.
std::vector<muscle::FitComparison> compare_groups(const std::vector<MeshGroup>& groups, const muscle::MuscleAsset& asset,
                                                  const std::vector<bool>& fitted);

}  // namespace fascicle::cook
