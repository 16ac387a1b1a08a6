// Any bytes as a mesh: the first says how many vertices there are, then their coordinates, one float or one small step
// of a grid each, then the triangles' corners. What comes out must hold together, and be clean.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <glm/geometric.hpp>

#include "engine/geometry/clean_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::size_t count = data[0];
  const bool on_grid = data[1] % 2 == 0;
  const std::size_t number = on_grid ? 1 : sizeof(float);
  const std::uint8_t *at = data + 2, *const end = data + size;
  fascicle::TriangleMesh mesh;
  for (std::size_t i = 0; i < count && static_cast<std::size_t>(end - at) >= 3 * number; ++i) {
    glm::vec3 p;
    for (int k = 0; k < 3; ++k, at += number) {
      if (on_grid) {
        p[k] = static_cast<float>(*at % 8);
      } else {
        std::memcpy(&p[k], at, number);
      }
    }
    mesh.positions.push_back(p);
  }
  if (mesh.positions.empty()) return 0;
  for (; at != end; ++at) mesh.indices.push_back(static_cast<std::uint32_t>(*at % mesh.positions.size()));

  const fascicle::CleanMesh clean = fascicle::clean_mesh(mesh);
  if (clean.mesh.indices.size() != 3 * clean.source_triangles.size()) std::abort();
  for (const std::uint32_t source : clean.source_triangles) {
    if (source >= mesh.indices.size() / 3) std::abort();
  }
  for (const glm::vec3& p : clean.mesh.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
  }
  for (std::size_t i = 0; i < clean.mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return glm::dvec3(clean.mesh.positions.at(clean.mesh.indices[i + k])); };
    if (!(glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) > 0.0)) std::abort();
  }
  const fascicle::MeshDefects again = fascicle::clean_mesh(clean.mesh).defects;
  if (again.degenerate_triangles + again.duplicate_triangles + again.non_finite_vertices != 0) std::abort();
  return 0;
}
