#include "modules/muscle/measure/sample_surface.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

// Far more than any muscle needs: a surface torn apart by a mistake must not take all memory.
constexpr float kMostSteps = 256.0f;

int steps_over(float length, float spacing) {
  return static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0f, kMostSteps));
}

}  // namespace

void find_row_places(const MuscleAsset& asset, const Tendons& tendons, std::uint32_t muscle,
                     std::vector<float>& places) {
  const MuscleLayout& layout = asset.muscles[muscle];
  places.clear();
  for (std::uint32_t k = 0; k < layout.section_count; ++k) {
    places.push_back(static_cast<float>(k));
    for (std::size_t end = 0; end < 2; ++end) {
      if (!layout.tendon_drawn[end]) continue;
      const std::int32_t segment = tendons.segment[end][layout.lane_index];
      if (segment != static_cast<std::int32_t>(k)) continue;
      places.push_back(static_cast<float>(k) + tendons.fraction[end][layout.lane_index]);
    }
  }
  places.resize(layout.row_count, static_cast<float>(layout.section_count - 1));
}

SurfacePatch patch_of(const MuscleSurfaceView& surface, std::span<const float> row_places, std::uint32_t row,
                      std::uint32_t side) {
  const std::uint32_t count = surface.section_vertices, next = (side + 1) % count;
  const SurfaceVertex* here = surface.vertices.data() + std::size_t{row} * count;
  const SurfaceVertex* after = here + count;
  return {{here[side].position, here[next].position, after[side].position, after[next].position},
          row_places[row],
          row_places[row + 1]};
}

void sample_patch(const SurfacePatch& patch, float spacing, float first, float last,
                  std::vector<SampledPoint>& points) {
  points.clear();
  if (patch.to < first || patch.from > last) return;
  const auto& [a, b, c, d] = patch.corners;
  const int around = steps_over(std::max(glm::distance(a, b), glm::distance(c, d)), spacing);
  const int along = steps_over(std::max(glm::distance(a, c), glm::distance(b, d)), spacing);
  for (int j = 0; j < along; ++j) {
    const float t = static_cast<float>(j) / static_cast<float>(along);
    const float place = patch.from + t * (patch.to - patch.from);
    if (place < first || place > last) continue;
    for (int i = 0; i < around; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(around);
      // The diagonal runs from a to d.
      points.push_back({s >= t ? a + s * (b - a) + t * (d - b) : a + t * (c - a) + s * (d - c), place});
    }
  }
}

std::vector<std::uint32_t> surface_triangles(const MuscleAsset& asset, std::uint32_t muscle) {
  const MuscleLayout& layout = asset.muscles[muscle];
  const std::uint32_t first = layout.first_vertex;
  std::vector<std::uint32_t> triangles;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.insert(triangles.end(), {a - first, b - first, c - first});
  };
  const std::span<const std::uint32_t> strips(asset.strip_indices.data() + layout.first_strip_index,
                                              layout.strip_index_count);
  for (std::size_t i = 0, start = 0; i < strips.size(); ++i) {
    if (strips[i] == kRestartIndex) start = i + 1;
    if (i < start + 2) continue;
    if ((i - start) % 2 == 0) {
      add(strips[i - 2], strips[i - 1], strips[i]);
    } else {
      add(strips[i - 1], strips[i - 2], strips[i]);
    }
  }
  const std::span<const std::uint32_t> fans(asset.fan_indices.data() + layout.first_fan_index, layout.fan_index_count);
  for (std::size_t i = 0, start = 0; i < fans.size(); ++i) {
    if (fans[i] == kRestartIndex) start = i + 1;
    if (i >= start + 2) add(fans[start], fans[i - 1], fans[i]);
  }
  return triangles;
}

}  // namespace fascicle::muscle
