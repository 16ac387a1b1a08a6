// Rays onto a muscle's drawn surface, each near one of its sections' vertices: from just above one of the drawn
// triangles, so that nothing else is in between, at a place whose nearest vertex of that triangle is the one meant.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/render/pick.hpp"
#include "modules/muscle/muscle.hpp"
#include "modules/muscle/systems/5_present/draw_collision.hpp"

namespace fascicle::test {

inline constexpr float kRayHeight = 1e-4f;  // m

struct SurfaceRay {
  Ray ray;
  std::uint32_t section = 0, vertex = 0;
};

// At most one a vertex; of vertices of inner sections that are no closer than `apart` (m) to another of their muscle.
inline std::vector<SurfaceRay> surface_rays(const muscle::MuscleAsset& asset, const muscle::MuscleSurfaces& surfaces,
                                            const muscle::ActionLines& lines, const muscle::CrossSections& sections,
                                            std::uint32_t m, float apart = 1e-3f) {
  const muscle::MuscleSurfaceView surface = surface_of(asset, surfaces, m);
  const std::uint32_t count = surface.section_vertices;
  const auto vertices = static_cast<std::uint32_t>(surface.vertices.size()) - 2;  // without the caps' centres
  std::vector<SurfaceRay> rays;
  for (std::uint32_t k = 1; k + 1 < asset.muscles[m].section_count; ++k) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec3 place = section_vertex(asset, lines, sections, m, k, i);
      // The drawn vertex: in column i, where the section's is to rounding.
      std::uint32_t drawn = vertices, close = 0;
      for (std::uint32_t v = 0; v < vertices; ++v) {
        const float distance = glm::distance(surface.vertices[v].position, place);
        if (v % count == i && distance < 2e-6f) drawn = v;
        if (distance < apart) ++close;
      }
      if (drawn == vertices || close != 1) continue;
      for (std::size_t s = 2; s < surface.strips.size(); ++s) {
        const std::array<std::uint32_t, 3> corners = {surface.strips[s - 2], surface.strips[s - 1], surface.strips[s]};
        bool whole = true, has = false;
        glm::vec3 middle(0.0f), at[3];
        for (std::size_t c = 0; c < 3 && whole; ++c) {
          whole = corners[c] != muscle::kRestartIndex;
          if (!whole) break;
          has = has || corners[c] - surface.first_vertex == drawn;
          at[c] = surface.vertices[corners[c] - surface.first_vertex].position;
          middle += at[c] / 3.0f;
        }
        const glm::vec3 normal = whole ? glm::cross(at[1] - at[0], at[2] - at[0]) : glm::vec3(0.0f);
        if (!whole || !has || glm::length(normal) < 1e-6f) continue;
        const float way = std::min(0.05f, 0.3f * apart / glm::distance(middle, place));
        const glm::vec3 target = place + way * (middle - place);
        const glm::vec3 up = glm::normalize(normal);
        rays.push_back({{target + kRayHeight * up, -up}, k, i});
        break;
      }
    }
  }
  return rays;
}

}  // namespace fascicle::test
