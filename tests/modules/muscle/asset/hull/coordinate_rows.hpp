// Rows of mean value coordinates as tests look at them: what they miss, and the weights by a slow way of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/hull/mean_value_coordinates.hpp"

namespace fascicle::test {

inline std::vector<float> coordinates(const TriangleMesh& hull, std::span<const glm::vec3> points) {
  std::vector<float> weights(points.size() * hull.positions.size(), -99.0f);
  muscle::find_mean_value_coordinates(hull, points, weights);
  return weights;
}
inline std::vector<float> coordinates(const TriangleMesh& hull, const glm::vec3& point) {
  return coordinates(hull, std::span(&point, 1));
}

inline double sum_of(std::span<const float> row) {
  double sum = 0.0;
  for (const float weight : row) sum += static_cast<double>(weight);
  return sum;
}

inline glm::dvec3 blend(std::span<const float> row, std::span<const glm::vec3> positions) {
  glm::dvec3 place(0.0);
  for (std::size_t v = 0; v < row.size(); ++v) place += static_cast<double>(row[v]) * glm::dvec3(positions[v]);
  return place;
}

inline double largest_difference(std::span<const float> a, std::span<const double> b) {
  double most = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const double difference = std::abs(static_cast<double>(a[v]) - b[v]);
    if (!(difference <= most)) most = difference;  // no number is never least
  }
  return most;
}

// What the definition says: the integral of (vertex's hat function) / distance over all directions, its sign that of
// the surface's side, as a sum over small pieces of the triangles. Nothing for points on the hull or next to it.
inline std::vector<double> integrated_coordinates(const TriangleMesh& hull, const glm::vec3& point, int pieces = 160) {
  std::vector<double> weights(hull.positions.size(), 0.0);
  const glm::dvec3 x(point);
  for (std::size_t i = 0; i + 2 < hull.indices.size(); i += 3) {
    const glm::dvec3 a(hull.positions[hull.indices[i]]), b(hull.positions[hull.indices[i + 1]]),
        c(hull.positions[hull.indices[i + 2]]);
    const glm::dvec3 area = 0.5 * glm::cross(b - a, c - a) / static_cast<double>(pieces * pieces);
    const auto add = [&](double s, double t) {  // the middle of a piece, from a along b and c
      const glm::dvec3 way = a + s * (b - a) + t * (c - a) - x;
      const double square = glm::dot(way, way), density = glm::dot(area, way) / (square * square);
      weights[hull.indices[i]] += (1.0 - s - t) * density;
      weights[hull.indices[i + 1]] += s * density;
      weights[hull.indices[i + 2]] += t * density;
    };
    const double h = 1.0 / pieces;
    for (int j = 0; j < pieces; ++j) {
      for (int k = 0; j + k < pieces; ++k) {
        add((j + 1.0 / 3.0) * h, (k + 1.0 / 3.0) * h);
        if (j + k + 1 < pieces) add((j + 2.0 / 3.0) * h, (k + 2.0 / 3.0) * h);
      }
    }
  }
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight /= sum;
  return weights;
}

// What rows miss at most, of points and of a hull that moves: by how much the blended hull misses the moved points.
inline double missed(const std::vector<float>& rows, const TriangleMesh& hull, std::span<const glm::vec3> points,
                     const glm::dmat4& motion = glm::dmat4(1.0)) {
  const std::size_t count = hull.positions.size();
  std::vector<glm::vec3> moved;
  for (const glm::vec3& p : hull.positions) moved.emplace_back(motion * glm::dvec4(glm::dvec3(p), 1.0));
  double most = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::span row(rows.data() + i * count, count);
    const glm::dvec3 target(motion * glm::dvec4(glm::dvec3(points[i]), 1.0));
    const double distance = glm::distance(blend(row, moved), target);
    if (!(distance <= most)) most = distance;
  }
  return most;
}

}  // namespace fascicle::test
