// Bellies become closed meshes. Each section's rim starts as its ellipse and gives way to bones and to neighbouring
// bellies: a point belongs to the belly whose normalised radius is smallest there (a power diagram of swept ellipses),
// which is what presses muscles into the concave slices that anatomy has. Rows of rims make a tube with two caps:
// closed, 2-manifold and outward by construction.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "tools/walker/muscle_sections.hpp"

namespace fascicle::walker {

struct MeshSize {
  std::size_t stations = 0;  // rims
  std::size_t sides = 0;     // vertices a rim
};
// By the muscle's length and girth, so that triangles are of like size on all muscles.
MeshSize plan_mesh(const MuscleSpec& muscle);

// Meshes of the right side in the character's rest space, in the order of `bellies`, which grow until each mesh has its
// muscle's volume or is hemmed in.
std::vector<TriangleMesh> mesh_bellies(std::vector<Belly>& bellies, const std::vector<MeshSize>& sizes,
                                       const std::vector<BoneShape>& bones);

// The mirror image in x = 0, still outward.
TriangleMesh mirrored(const TriangleMesh& mesh);
double mesh_volume(const TriangleMesh& mesh);  // m^3

}  // namespace fascicle::walker
