// A surface muscle at rest as a plain mesh, for what asks questions of geometry.
#pragma once

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

inline TriangleMesh surface_mesh(const SurfaceAsset& surface) {
  TriangleMesh mesh;
  mesh.name = surface.name;
  mesh.positions.reserve(surface.vertex_count);
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v)
    mesh.positions.emplace_back(surface.rest[v].x, surface.rest[v].y, surface.rest[v].z);
  mesh.indices = surface.triangles;
  return mesh;
}

}  // namespace fascicle::muscle
