// Skins made from what the glTF reader returns.
#pragma once

#include <memory>

#include "engine/animation/skinning.hpp"
#include "engine/content/gltf_reader.hpp"

namespace fascicle {

// A mesh without a skin of its own becomes one whose vertices all follow the node that carries it.
std::shared_ptr<const SkinAsset> make_skin_asset(const GltfFile& file, const GltfMesh& mesh);

}  // namespace fascicle
