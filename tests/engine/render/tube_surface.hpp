// Test shapes: capped tubes along a path, with a tendon coordinate, written the way a simulation writes them.
#pragma once

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/render/draw_types.hpp"
#include "engine/render/strip_topology.hpp"

namespace fascicle {

struct TubeSurface {
  StripTopology topology;
  std::vector<DrawVertex> vertices;
  std::vector<StripRow> rows;
};

// Appends a tube with a row at each point of `path`; radii and tendon coordinates one a row, m.
inline void append_tube(const std::vector<glm::vec3>& path, const std::vector<float>& radii,
                        const std::vector<float>& tendon, std::uint32_t row_vertices, TubeSurface& surface) {
  const auto rows = static_cast<std::uint32_t>(path.size());
  const auto first_vertex = static_cast<std::uint32_t>(surface.vertices.size());
  const std::uint32_t item = surface.topology.item_count;
  append_tube_vertices(rows, row_vertices, surface.topology);
  append_tube_indices(first_vertex, rows, row_vertices, surface.topology);
  const glm::vec3 first_axis = glm::normalize(path[1] - path[0]);
  const glm::vec3 helper = std::abs(first_axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  glm::vec3 u = glm::normalize(glm::cross(helper, first_axis));
  for (std::uint32_t k = 0; k < rows; ++k) {
    const glm::vec3 ahead = path[k + 1 < rows ? k + 1 : k], behind = path[k > 0 ? k - 1 : k];
    const glm::vec3 t = glm::normalize(ahead - behind);
    u = glm::normalize(u - glm::dot(u, t) * t);
    const glm::vec3 v = glm::cross(t, u);
    const float slope = (radii[k + 1 < rows ? k + 1 : k] - radii[k > 0 ? k - 1 : k]) / glm::length(ahead - behind);
    for (std::uint32_t i = 0; i < row_vertices; ++i) {
      const float angle = 6.28318531f * static_cast<float>(i) / static_cast<float>(row_vertices);
      const glm::vec3 outward = std::cos(angle) * u + std::sin(angle) * v;
      surface.vertices.push_back({path[k] + radii[k] * outward, pack_normal(outward - slope * t)});
    }
    surface.rows.push_back({tendon[k], item});
  }
  surface.vertices.push_back({path.front(), pack_normal(path[0] - path[1])});
  surface.vertices.push_back({path.back(), pack_normal(path[rows - 1] - path[rows - 2])});
}

// A straight cylinder along x, from -length/2 to length/2; everything right of x = border is tendon.
inline TubeSurface make_cylinder(float length, float radius, std::uint32_t row_vertices, float border,
                                 int rows = 9) {
  std::vector<glm::vec3> path;
  std::vector<float> radii, tendon;
  for (int k = 0; k < rows; ++k) {
    const float x = length * (static_cast<float>(k) / static_cast<float>(rows - 1) - 0.5f);
    path.emplace_back(x, 0.0f, 0.0f);
    radii.push_back(radius);
    tendon.push_back(border - x);
  }
  TubeSurface surface;
  append_tube(path, radii, tendon, row_vertices, surface);
  return surface;
}

}  // namespace fascicle
