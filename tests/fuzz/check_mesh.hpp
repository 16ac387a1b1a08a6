// What must hold of whatever a mesh reader answers; else the program aborts.
#pragma once

#include <cmath>
#include <cstdlib>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle::test {

inline void check_mesh(const Result<TriangleMesh>& result) {
  if (!result) {
    if (result.diagnostics().errors.empty()) std::abort();
    to_text(result.diagnostics());
    return;
  }
  const std::size_t count = result->positions.size();
  if (!result->normals.empty() && result->normals.size() != count) std::abort();
  if (result->indices.empty() || result->indices.size() % 3 != 0) std::abort();
  for (const std::uint32_t index : result->indices) {
    if (index >= count) std::abort();
  }
  for (const glm::vec3& p : result->positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
  }
}

}  // namespace fascicle::test
