// Whether a surface muscle has somewhere to go: no solver can bring a muscle out of a bone that holds all of it, because
// every way out is as good as any other. Content is asked, which has the bones' meshes, before anything is built.
#pragma once

#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::muscle {

// An error where one of the bones that the muscle stays out of holds all of its vertices that can move, at
// rest. Quick where a vertex is outside of the bone's box; asset.skeleton and bone_meshes are there.
void check_swallowed(const SurfaceMuscleDescription& muscle, const CharacterAsset& asset, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
