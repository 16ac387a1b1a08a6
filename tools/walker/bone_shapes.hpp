// The walker's bones as solids in their bones' frames, right side and middle only: the left side is the mirror image.
#pragma once

#include <string>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "tools/walker/muscle_table.hpp"
#include "tools/walker/shapes.hpp"
#include "tools/walker/skeleton.hpp"

namespace fascicle::walker {

struct BoneShape {
  int bone = -1;
  Solid solid{0.004f};
  bool symmetric = false;  // the solid is the right half (x <= 0) of a bone that crosses the middle
  float voxel = 0.0032f;   // m, for meshing
  float adaptivity = 0.02f;

  // Signed distance (m) of a point in the bone's frame.
  float distance(const glm::vec3& local) const;
};

// Landmarks in millimetres, OpenSim axes, in the bone's frame; see the sources for where they come from.
Knot knot_mm(float x, float y, float z, float radius);

BoneShape make_pelvis();
BoneShape make_torso();
BoneShape make_femur();
BoneShape make_tibia();
BoneShape make_patella();
BoneShape make_talus();
BoneShape make_foot();
BoneShape make_toes();

// All of them, with small pads of bone under attachments that would otherwise hang in the air.
std::vector<BoneShape> make_bone_shapes(const std::vector<MuscleSpec>& muscles);

// Distance (m) in the character's rest space to the nearest bone of the right side and the middle.
float rest_distance(const std::vector<BoneShape>& shapes, const glm::vec3& p);
glm::vec3 rest_outward(const std::vector<BoneShape>& shapes, const glm::vec3& p);

// Every bone's mesh, both sides, named by bone, in the bone's frame.
std::vector<TriangleMesh> mesh_bones(const std::vector<BoneShape>& shapes);

}  // namespace fascicle::walker
