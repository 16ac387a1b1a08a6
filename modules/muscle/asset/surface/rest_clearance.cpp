#include "modules/muscle/asset/surface/rest_clearance.hpp"

#include <cstddef>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/winding_number.hpp"

namespace fascicle::muscle {
namespace {

TriangleMesh rest_mesh(const SurfaceAsset& asset) {
  TriangleMesh mesh;
  mesh.positions.reserve(asset.vertex_count);
  for (std::size_t v = 0; v < asset.vertex_count; ++v) {
    mesh.positions.emplace_back(asset.rest[v].x, asset.rest[v].y, asset.rest[v].z);
  }
  mesh.indices = asset.triangles;
  return mesh;
}

bool within(const Bounds& box, const glm::vec3& p, float reach) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < box.lower[axis] - reach || p[axis] > box.upper[axis] + reach) return false;
  }
  return true;
}

}  // namespace

std::vector<float> find_rest_clearance(const SurfaceAsset& muscle, const SurfaceAsset& other, float reach) {
  std::vector<float> clearance(muscle.vertex_count, reach);
  const TriangleMesh mesh = rest_mesh(other);
  const Bounds box = mesh_bounds(mesh);
  const ClosestPoints closest(mesh);
  const WindingField winding(mesh);
  for (std::size_t v = 0; v < clearance.size(); ++v) {
    const glm::vec3 p(muscle.rest[v].x, muscle.rest[v].y, muscle.rest[v].z);
    if (!within(box, p, reach)) continue;
    if (winding.inside(p)) {
      clearance[v] = -closest.at(p).distance;
    } else if (const ClosestPoint found = closest.within(p, reach); found.distance < reach) {
      clearance[v] = found.distance;
    }
  }
  return clearance;
}

}  // namespace fascicle::muscle
