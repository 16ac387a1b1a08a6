#include "modules/muscle/asset/surface_topology.hpp"

namespace fascicle::muscle {

void append_strips(const SectionLayout& layout, std::vector<std::uint32_t>& indices) {
  const std::uint32_t count = layout.section_vertices;
  for (std::uint32_t row = 0; row + 1 < layout.row_count; ++row) {
    const std::uint32_t here = layout.first_vertex + row * count, next = here + count;
    for (std::uint32_t i = 0; i <= count; ++i) {
      indices.push_back(next + i % count);
      indices.push_back(here + i % count);
    }
    indices.push_back(kRestartIndex);
  }
}

void append_fans(const SectionLayout& layout, std::vector<std::uint32_t>& indices) {
  const std::uint32_t count = layout.section_vertices;
  const std::uint32_t origin = layout.first_vertex + layout.row_count * count, insertion = origin + 1;
  const std::uint32_t last_row = layout.first_vertex + (layout.row_count - 1) * count;
  indices.push_back(origin);
  for (std::uint32_t i = 0; i <= count; ++i) indices.push_back(layout.first_vertex + (count - i) % count);
  indices.push_back(kRestartIndex);
  indices.push_back(insertion);
  for (std::uint32_t i = 0; i <= count; ++i) indices.push_back(last_row + i % count);
  indices.push_back(kRestartIndex);
}

std::vector<std::array<std::uint32_t, 4>> tetrahedra_of(const MuscleAsset& asset, std::uint32_t muscle) {
  const SectionLayout& layout = asset.muscles[muscle];
  const std::uint32_t count = layout.section_vertices;
  const std::uint32_t first_centre = layout.section_count * count;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  tetrahedra.reserve(std::size_t{3} * count * (layout.section_count - 1));
  for (std::uint32_t k = 0; k + 1 < layout.section_count; ++k) {
    const std::uint32_t a = first_centre + k, a_next = a + 1;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t j = (i + 1) % count;
      const std::uint32_t p = k * count + i, q = k * count + j, p_next = p + count, q_next = q + count;
      tetrahedra.push_back({a, a_next, p_next, q_next});
      tetrahedra.push_back({a, p, q, q_next});
      tetrahedra.push_back({a, p, q_next, p_next});
    }
  }
  return tetrahedra;
}

}  // namespace fascicle::muscle
