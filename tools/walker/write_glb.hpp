// Meshes, skeleton, skin and clip as binary glTF 2.0 files, by tinygltf; the same input gives the same bytes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "tools/walker/gait.hpp"
#include "tools/walker/skin.hpp"

namespace fascicle::walker {

// One node and one mesh of the same name for each of `meshes`, without normals. False where the file cannot be written.
bool write_meshes(const std::filesystem::path& file, const std::vector<TriangleMesh>& meshes);
// Skeleton, skinned mesh "skin" and animation "walk".
bool write_walker(const std::filesystem::path& file, const Skin& skin, const Gait& gait);

}  // namespace fascicle::walker
