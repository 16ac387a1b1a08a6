// From the entries of a character file to muscle descriptions: bones looked up, positions taken to their bones'
// frames, levels and tensions filled in, the other side added, lines checked.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/muscle_description.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {

// Names of muscles so far, and where each was written ("file:line").
using MuscleNames = std::map<std::string, std::string>;

// A description and what it was made from.
struct ResolvedMuscle {
  MuscleDescription description;
  const CharacterFile* source = nullptr;
  MeshEntry mesh;          // a mirror image's name is that of its own mesh
  NameEntry mirrored_mesh; // of a mirror image: the original's mesh
  int mirror_axis = -1;    // of the reflection that made it, or -1
  std::array<AreaEntry, 2> areas;      // at origin and insertion; bones' names are this side's
  bool fit = true;
  std::optional<float> max_distance;   // m: the fit chooses |C| and LSS
};

// Appends the muscles of one file, each mirrored one after its original, and all errors. `names` grows.
void resolve_muscles(const CharacterFile& file, const Skeleton& skeleton, const LoadOptions& options,
                     MuscleNames& names, std::vector<ResolvedMuscle>& muscles, Diagnostics& diagnostics);

}  // namespace fascicle::muscle
