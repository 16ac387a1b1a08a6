// What the generator says about its own output: figures by which a change for the worse shows.
#pragma once

#include <string>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "tools/walker/bone_shapes.hpp"
#include "tools/walker/gait.hpp"

namespace fascicle::walker {

struct MeshFaults {
  std::size_t open_edges = 0;     // edges without exactly one opposite
  std::size_t crowded_edges = 0;  // directed edges used more than once
  bool outward = true;
};
MeshFaults find_faults(const TriangleMesh& mesh);

// Whether p lies inside a closed mesh (winding number above one half).
bool inside(const TriangleMesh& mesh, const glm::vec3& p);

// Tables as text.
std::string report_meshes(const std::vector<MuscleSpec>& muscles, const std::vector<TriangleMesh>& meshes,
                          const std::vector<std::size_t>& sides, const std::vector<BoneShape>& shapes);
std::string report_overlaps(const std::vector<TriangleMesh>& meshes);
// How deep each action line cuts bone, at rest and over the cycle, its ends (8 mm) left out.
std::string report_lines(const std::vector<MuscleSpec>& muscles, const std::vector<BoneShape>& shapes,
                         const Gait& gait);
// Lowest point (m) of the feet in a pose.
float lowest_foot(const Pose& pose, const std::vector<TriangleMesh>& bone_meshes);

}  // namespace fascicle::walker
