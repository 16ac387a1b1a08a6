#include "modules/muscle/measure/section_areas.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "modules/muscle/measure/sample_surface.hpp"

namespace fascicle::muscle {

void measure_section_areas(const MuscleAsset& asset, const MuscleSurfaces& surfaces, const Tendons& tendons,
                           std::vector<float>& areas) {
  areas.clear();
  std::vector<float> places;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const MuscleLayout& layout = asset.muscles[m];
    const std::uint32_t count = layout.section_vertices;
    find_row_places(asset, tendons, m, places);
    std::uint32_t row = 0;
    for (std::uint32_t k = 0; k < layout.section_count; ++k, ++row) {
      const SurfaceVertex* corners = surfaces.vertices.data() + layout.first_vertex + std::size_t{row} * count;
      glm::dvec3 area(0.0);
      const glm::dvec3 from(corners[0].position);
      for (std::uint32_t i = 1; i + 1 < count; ++i) {
        area += glm::cross(glm::dvec3(corners[i].position) - from, glm::dvec3(corners[i + 1].position) - from);
      }
      areas.push_back(static_cast<float>(0.5 * glm::length(area)));
      // Tendon sections stand after the section that their segment begins with.
      for (std::size_t end = 0; end < 2; ++end) {
        if (layout.tendon_drawn[end] &&
            tendons.segment[end][layout.lane_index] == static_cast<std::int32_t>(k)) {
          ++row;
        }
      }
    }
  }
}

AreaError worst_area_error(const MuscleAsset& asset, std::span<const float> areas, std::span<const float> targets) {
  AreaError worst;
  std::size_t i = 0;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const std::uint32_t count = asset.muscles[m].section_count;
    for (std::uint32_t k = 0; k < count; ++k, ++i) {
      if (i >= areas.size() || i >= targets.size() || k == 0 || k + 1 == count || !(targets[i] > 0.0f)) continue;
      float relative = std::abs(areas[i] - targets[i]) / targets[i];
      if (!std::isfinite(relative)) relative = std::numeric_limits<float>::infinity();
      if (relative > worst.relative) worst = {relative, m, k};
    }
  }
  return worst;
}

}  // namespace fascicle::muscle
