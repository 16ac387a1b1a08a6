// A point against a triangle: how high above its plane, over which place of it, and which place of it is nearest.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {

// A place in the triangle's plane: p_1 + b2 (p_2 - p_1) + b3 (p_3 - p_1).
struct TriangleWeights {
  float b2 = 0.0f, b3 = 0.0f;

  bool inside() const { return b2 >= 0.0f && b3 >= 0.0f && b2 + b3 <= 1.0f; }
};

struct TrianglePlane {
  glm::vec3 corner{0.0f}, second{0.0f}, third{0.0f};  // m: p_1, p_2 - p_1, p_3 - p_1
  glm::vec3 area_normal{0.0f};                        // m^2: their cross product
  glm::vec3 normal{0.0f};                             // unit

  // False where the triangle has no area.
  bool set(const glm::vec3& p1, const glm::vec3& p2, const glm::vec3& p3) {
    corner = p1;
    second = p2 - p1;
    third = p3 - p1;
    area_normal = glm::cross(second, third);
    const float square = glm::dot(area_normal, area_normal);
    if (!(square > std::numeric_limits<float>::min())) return false;
    normal = area_normal / std::sqrt(square);
    return true;
  }

  float height(const glm::vec3& p) const { return glm::dot(normal, p - corner); }

  // Under the point along the normal.
  TriangleWeights under(const glm::vec3& p) const {
    const glm::vec3 to = p - corner;
    const float inverse = 1.0f / glm::dot(area_normal, area_normal);
    return {glm::dot(glm::cross(to, third), area_normal) * inverse,
            glm::dot(glm::cross(second, to), area_normal) * inverse};
  }

  glm::vec3 at(const TriangleWeights& w) const { return corner + w.b2 * second + w.b3 * third; }

  // The triangle's own place that is nearest to the point over `w`.
  TriangleWeights nearest(const TriangleWeights& w) const {
    if (w.inside()) return w;
    const glm::vec3 to = w.b2 * second + w.b3 * third;
    // Nearest on each side; the nearest of these is it.
    TriangleWeights best;
    float least = std::numeric_limits<float>::max();
    const auto consider = [&](const TriangleWeights& place) {
      const glm::vec3 apart = to - place.b2 * second - place.b3 * third;
      const float square = glm::dot(apart, apart);
      if (square < least) {
        least = square;
        best = place;
      }
    };
    const auto along = [](const glm::vec3& side, const glm::vec3& from) {
      return std::clamp(glm::dot(side, from) / std::max(glm::dot(side, side), std::numeric_limits<float>::min()), 0.0f,
                        1.0f);
    };
    consider({along(second, to), 0.0f});
    consider({0.0f, along(third, to)});
    const float s = along(third - second, to - second);
    consider({1.0f - s, s});
    return best;
  }
};

}  // namespace fascicle::muscle
