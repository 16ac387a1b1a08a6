// From the entries of a collision file to the description that the solver takes: names looked up, the other side added,
// contradictions told.
#pragma once

#include <span>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/muscle_description.hpp"
#include "modules/muscle/content/collision_file.hpp"
#include "modules/muscle/content/resolve_muscles.hpp"

namespace fascicle::muscle {

// What a collision file's names can mean.
struct CollisionScope {
  const Skeleton& skeleton;
  std::span<const MuscleDescription> muscles;
  const MuscleNames& names;                   // of all muscles, those with errors of their own, too
  std::span<const BoneMeshEntry> bone_meshes;
  const MirrorRule& mirror;
};

// A transversal that mirrors another.
struct MirrorImage {
  std::size_t transversal = 0;  // its index
  SectionTag first, second;     // the original's
};

struct ResolvedCollision {
  CollisionDescription description;
  std::vector<MirrorImage> images;  // place_images gives them their angles
};

// Appends all errors; what is broken is left out of the answer.
//
// An entry without "mirror" stands for both sides where the character has the other side, in its mirror rule and its
// muscles; with "mirror": true it is an error if it has not. Automatic entries that an author's ignored pair overrules
// are left out, with a warning.
ResolvedCollision resolve_collision(const CollisionFile& file, const CollisionScope& scope, Diagnostics& diagnostics);

// The mirror images' angles, from the two muscles' frames at rest.
void place_images(const MuscleAsset& asset, int mirror_axis, ResolvedCollision& collision);

}  // namespace fascicle::muscle
