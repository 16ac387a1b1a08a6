// The sense of each triangle, so that a surface is consistently outward.
//
// A component is what hangs together by edges with two triangles; inside it every triangle follows from the first.
// Which of its two senses is outward:
// - A closed component gets the sense that gives it a positive volume. That holds also for one inside another: muscles
//   of several overlapping shells are common and muscles with cavities are not, so a cavity counts as filled.
// - An open one is closed in thought by a fan from the middle of each hole. Where the fans are smaller than three
//   quarters of the surface, it is treated as closed.
// - What is left are sheets and patches. A single one, and any surface without volume, keeps the sense of most of its
//   triangles. Several are taken to be parts of one surface: each keeps the sense of most of its triangles, and all are
//   turned if seen from their middle they face inward.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace fascicle {

struct TriangleSenses {
  std::vector<std::uint8_t> turned;  // 1: the triangle must be turned round
  std::size_t components = 0;
  std::size_t open_edges = 0, holes = 0, crowded_edges = 0, twisted_edges = 0;  // see MeshDefects
};

// No triangle has a vertex twice. Linear in the number of triangles, but for sorting.
TriangleSenses orient_triangles(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices);

}  // namespace fascicle
