// A flat closed sheet with a thickness: what two sides of a muscle are that lie near to each other.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::test {

// From the origin along x and z, `cells` squares each way on the upper side (y = thickness / 2) and on the lower one,
// and one row of triangles between them. Vertex (i, k) of the upper side is i + k (cells_x + 1), below it stands the
// one with as many more as the side has.
inline TriangleMesh make_sheet(const glm::vec3& size, std::uint32_t cells_x, std::uint32_t cells_z) {
  TriangleMesh mesh;
  const std::uint32_t row = cells_x + 1, side = row * (cells_z + 1);
  for (const float y : {0.5f * size.y, -0.5f * size.y}) {
    for (std::uint32_t k = 0; k <= cells_z; ++k) {
      for (std::uint32_t i = 0; i <= cells_x; ++i) {
        mesh.positions.emplace_back(size.x * static_cast<float>(i) / static_cast<float>(cells_x), y,
                                    size.z * static_cast<float>(k) / static_cast<float>(cells_z));
      }
    }
  }
  for (std::uint32_t k = 0; k < cells_z; ++k) {
    for (std::uint32_t i = 0; i < cells_x; ++i) {
      const std::uint32_t a = i + k * row, b = a + 1, c = a + row, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
      mesh.indices.insert(mesh.indices.end(), {side + a, side + b, side + c, side + b, side + d, side + c});
    }
  }
  // Round the rim, as it is seen from above, the other way round than y turns x to z.
  std::vector<std::uint32_t> rim;
  for (std::uint32_t k = 0; k < cells_z; ++k) rim.push_back(k * row);
  for (std::uint32_t i = 0; i < cells_x; ++i) rim.push_back(cells_z * row + i);
  for (std::uint32_t k = cells_z; k > 0; --k) rim.push_back(k * row + cells_x);
  for (std::uint32_t i = cells_x; i > 0; --i) rim.push_back(i);
  for (std::size_t j = 0; j < rim.size(); ++j) {
    const std::uint32_t a = rim[j], b = rim[(j + 1) % rim.size()];
    mesh.indices.insert(mesh.indices.end(), {a, side + a, b, b, side + a, side + b});
  }
  return mesh;
}

}  // namespace fascicle::test
