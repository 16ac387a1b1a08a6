// Which part of a muscle's mesh its attachment area is, as the content file describes it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/resolve_muscles.hpp"

namespace fascicle::muscle {

// All meshes of a bone as one, in the rest space.
TriangleMesh bone_mesh_at_rest(const CharacterAsset& asset, std::int32_t bone);

// Triangles of `mesh` (rest space, m) with all corners in the area, at origin and insertion; empty where no area is
// given. Warnings: an area that holds none, a bone without meshes.
std::array<std::vector<std::uint32_t>, 2> find_attachment_areas(const ResolvedMuscle& muscle, const TriangleMesh& mesh,
                                                                const CharacterAsset& asset, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
