// The rings of triangles about a mesh's vertices, for the volume's gradient: that of vertex a is the sum of p_b x p_c
// over its triangles (a, b, c), and since they close a ring b, c, d ... b, one walk round it with a product a step does.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

// Of four consecutive vertices side by side. A row has the next neighbour of each; vertex v is lane v % 4 of the rows
// first[v / 4] .. first[v / 4 + 1]. Shorter rings repeat their last neighbour, whose product with itself is zero. A
// vertex that several rings touch has them one after the other, with vertex 0 between: places are counted from it.
struct VertexRings {
  std::vector<std::uint32_t> first;  // by four vertices, and one more
  AlignedVector<std::array<std::int32_t, 4>> rows;
};

// `triangles`: three vertices each, all below vertex_count.
VertexRings build_vertex_rings(std::span<const std::uint32_t> triangles, std::uint32_t vertex_count);

}  // namespace fascicle::muscle
