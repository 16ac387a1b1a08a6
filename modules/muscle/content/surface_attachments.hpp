// Which vertices of a surface muscle's mesh an attachment holds, by what its author wrote.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/surface_mesh.hpp"

namespace fascicle::muscle {

// Vertices of `mesh.rest`, rising. `bone` is the attachment's; `in_rest_space`: the space of the file's attachment
// positions. Empty with an error where there are none: a bone without meshes, an area that no vertex lies in, numbers
// of vertices that the muscle doesn't have.
std::vector<std::uint32_t> choose_attached_vertices(const SurfaceAttachmentEntry& entry, const SurfaceMesh& mesh,
                                                    const CharacterAsset& asset, std::int32_t bone, bool in_rest_space,
                                                    Diagnostics& diagnostics);

}  // namespace fascicle::muscle
