// Bones' level sets in a file, so that they need not be built at each load: one .vdb file for all bones of a character,
// which OpenVDB's own tools open too. Each grid carries a hash of what it was built from. The file is a cache: one that
// is missing, cut off, of another version or no such file at all is as good as an empty one, and is never an error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "modules/muscle/asset/bone_fields/bone_grid.hpp"

namespace fascicle::muscle {

struct StoredBoneGrid {
  std::string bone;
  std::uint64_t inputs = 0;  // hash_bone_inputs of what it was built from
  BoneGrid grid;
};

// Changes with every bit of the meshes' triangles and of the voxel, and with the way in which grids are built.
std::uint64_t hash_bone_inputs(std::span<const TriangleMesh> meshes, const BoneGridSettings& settings);

// Grids come back bit for bit. Empty where the file cannot be used.
std::vector<StoredBoneGrid> read_bone_grids(const std::filesystem::path& file);
// Written aside and renamed, so that readers and other writers at the same time see a whole file. False where the
// folder cannot be written.
bool write_bone_grids(const std::filesystem::path& file, std::span<const StoredBoneGrid> grids);

}  // namespace fascicle::muscle
