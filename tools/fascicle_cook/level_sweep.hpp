// How well and how cheaply each level of detail stands for the meshes: |C| = 6..36 by LSS = 0..3.
#pragma once

#include <string>
#include <vector>

#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::cook {

struct SweptLevel {
  std::uint32_t section_vertices = 0, longitudinal_subdivision = 0;
  std::vector<std::size_t> muscles;                // indices of descriptions; fitted ones
  std::vector<muscle::FitComparison> comparisons;  // one each
};

// Fits all muscles with a mesh at every level and compares them with their meshes.
std::vector<SweptLevel> sweep_levels(const muscle::CharacterAsset& character);

// A line a level: vertices, and RMS (over muscles) and largest distance, each way.
std::string to_table(const std::vector<SweptLevel>& levels);
// A line a level and muscle.
std::string to_csv(const std::vector<SweptLevel>& levels, const muscle::CharacterAsset& character);

}  // namespace fascicle::cook
