// The line of a surface muscle, from the mesh file's coordinates or the character's to the rest space.
#pragma once

#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/surface_mesh.hpp"

namespace fascicle::muscle {

// Fills in the positions of muscle.action_line, whose bones are there, one point for each of the entry's. Errors: a line
// of no length, one that is nowhere near the muscle.
void place_action_line(const SurfaceMuscleEntry& entry, const SurfaceMesh& mesh, SurfaceMuscleDescription& muscle,
                       Diagnostics& diagnostics);

}  // namespace fascicle::muscle
