// Muscle-like meshes with known answers, and muscles through them, for tests of the fit.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/muscle_description.hpp"

namespace fascicle::test {

// A closed tube along x (s from 0 to 1 is x from 0 to `length`): the outline at s, anticlockwise as seen against the
// x axis, in (y, z); always the same number of points. Its caps are fans round the outline's first triangle's middle,
// so outlines at the ends must be star-shaped from there.
inline TriangleMesh make_tube(const std::function<std::vector<glm::dvec2>(double)>& outline, double length,
                              std::uint32_t layers) {
  TriangleMesh mesh;
  mesh.name = "tube";
  std::uint32_t count = 0;
  std::vector<glm::dvec2> ends[2];
  for (std::uint32_t k = 0; k <= layers; ++k) {
    const double s = static_cast<double>(k) / layers;
    const std::vector<glm::dvec2> points = outline(s);
    count = static_cast<std::uint32_t>(points.size());
    for (const glm::dvec2& p : points) mesh.positions.emplace_back(s * length, p.x, p.y);
    if (k == 0) ends[0] = points;
    if (k == layers) ends[1] = points;
  }
  for (std::uint32_t k = 0; k < layers; ++k) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t a = k * count + i, b = k * count + (i + 1) % count;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + count, b, b + count, a + count});
    }
  }
  // Caps as strips across the outline, from point i to point -i: right for anything symmetric about that.
  for (std::uint32_t end = 0; end < 2; ++end) {
    const std::uint32_t first = end * layers * count;
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (end == 0) std::swap(b, c);
      mesh.indices.insert(mesh.indices.end(), {first + a, first + b, first + c});
    };
    std::uint32_t low = 0, high = count - 1;
    while (low + 1 < high) {
      triangle(low, low + 1, high);
      if (low + 2 < high) triangle(low + 1, high - 1, high);
      ++low;
      --high;
    }
  }
  return mesh;
}

inline std::vector<glm::dvec2> ellipse(const glm::dvec2& centre, double a, double b, std::uint32_t count = 48) {
  std::vector<glm::dvec2> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    // Turned by half a step, so that rays along the axes meet sides and not corners.
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / count;
    points.push_back(centre + glm::dvec2(a * std::cos(angle), b * std::sin(angle)));
  }
  return points;
}

// A C round the point `centre`, open towards +y: an arc of `radius` and half width `half`, over 2 (pi - opening).
inline std::vector<glm::dvec2> c_shape(const glm::dvec2& centre, double radius, double half, double opening,
                                       std::uint32_t steps = 40) {
  std::vector<glm::dvec2> points;
  const auto at = [&](double r, double angle) { return centre + r * glm::dvec2(std::cos(angle), std::sin(angle)); };
  for (std::uint32_t i = 0; i <= steps; ++i) {
    points.push_back(at(radius + half, opening + (2.0 * std::numbers::pi - 2.0 * opening) * i / steps));
  }
  for (std::uint32_t i = 0; i <= steps; ++i) {
    points.push_back(at(radius - half, 2.0 * std::numbers::pi - opening -
                                           (2.0 * std::numbers::pi - 2.0 * opening) * i / steps));
  }
  return points;
}

// From point to point on one bone.
inline muscle::MuscleDescription line_muscle(std::vector<glm::vec3> points, std::uint32_t section_vertices,
                                             std::uint32_t subdivision) {
  muscle::MuscleDescription description;
  description.name = "tested";
  for (const glm::vec3& p : points) description.attachments.push_back({0, p, true});
  description.section_vertices = section_vertices;
  description.longitudinal_subdivision = subdivision;
  return description;
}

}  // namespace fascicle::test
