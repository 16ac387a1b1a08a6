#include "tools/walker/bone_shapes.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "tools/walker/voxel_mesh.hpp"

namespace fascicle::walker {
namespace {

constexpr float kPadReach = 0.016f;  // m: an attachment further out than this is left hanging
constexpr float kPadGap = 0.0005f;   // m: nearer ones need no pad

// A small boss of bone from the surface to just under an attachment.
void add_pad(BoneShape& shape, const glm::vec3& attachment) {
  glm::vec3 at = attachment;
  if (shape.symmetric) at.x = -std::abs(at.x);
  const float gap = shape.solid.distance(at);
  if (gap < kPadGap || gap > kPadReach) return;
  const glm::vec3 out = shape.solid.outward(at);
  // The wider the gap, the broader the boss.
  const float tip = std::clamp(0.6f * gap, 0.0025f, 0.0065f);
  shape.solid.keep(RoundCone{{at - out * tip, tip}, {at - out * (gap + 0.0015f), 1.8f * tip}});
}

}  // namespace

Knot knot_mm(float x, float y, float z, float radius) { return {from_opensim_mm(x, y, z), 0.001f * radius}; }

float BoneShape::distance(const glm::vec3& local) const {
  return solid.distance(symmetric ? glm::vec3(-std::abs(local.x), local.y, local.z) : local);
}

std::vector<BoneShape> make_bone_shapes(const std::vector<MuscleSpec>& muscles) {
  std::vector<BoneShape> shapes;
  shapes.push_back(make_pelvis());
  shapes.push_back(make_torso());
  shapes.push_back(make_femur());
  shapes.push_back(make_tibia());
  shapes.push_back(make_patella());
  shapes.push_back(make_talus());
  shapes.push_back(make_foot());
  shapes.push_back(make_toes());
  for (const MuscleSpec& muscle : muscles) {
    for (const PathPoint& end : {muscle.path.front(), muscle.path.back()}) {
      const int bone = find_bone(end.bone);
      for (BoneShape& shape : shapes)
        if (shape.bone == bone) add_pad(shape, end.position);
    }
  }
  return shapes;
}

float rest_distance(const std::vector<BoneShape>& shapes, const glm::vec3& p) {
  float d = 1e9f;
  for (const BoneShape& shape : shapes) {
    const glm::vec3 local = p - bones()[static_cast<std::size_t>(shape.bone)].place;
    // A cheap bound first: the box around the solid.
    const glm::vec3 folded = shape.symmetric ? glm::vec3(-std::abs(local.x), local.y, local.z) : local;
    const glm::vec3 beyond =
        glm::max(glm::max(shape.solid.low() - folded, folded - shape.solid.high()), glm::vec3(0.0f));
    if (glm::length(beyond) - 0.003f > d) continue;
    d = std::min(d, shape.solid.distance(folded));
  }
  return d;
}

glm::vec3 rest_outward(const std::vector<BoneShape>& shapes, const glm::vec3& p) {
  constexpr float kStep = 0.001f;
  glm::vec3 gradient(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 offset(0.0f);
    offset[axis] = kStep;
    gradient[axis] = rest_distance(shapes, p + offset) - rest_distance(shapes, p - offset);
  }
  const float length = glm::length(gradient);
  return length > 1e-9f ? gradient / length : glm::vec3(0.0f, 1.0f, 0.0f);
}

std::vector<TriangleMesh> mesh_bones(const std::vector<BoneShape>& shapes) {
  std::vector<TriangleMesh> meshes;
  for (const BoneShape& shape : shapes) {
    const float margin = 4.0f * shape.voxel;
    Box box{shape.solid.low() - margin, shape.solid.high() + margin};
    if (shape.symmetric) box.high.x = -box.low.x;
    TriangleMesh mesh =
        mesh_field([&shape](const glm::vec3& p) { return shape.distance(p); }, box, shape.voxel, shape.adaptivity);
    mesh.name = bones()[static_cast<std::size_t>(shape.bone)].name;
    meshes.push_back(mesh);
    const int other = mirrored_bone(shape.bone);
    if (other == shape.bone) continue;
    for (glm::vec3& p : mesh.positions) p.x = -p.x;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    mesh.name = bones()[static_cast<std::size_t>(other)].name;
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace fascicle::walker
