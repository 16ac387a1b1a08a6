// Meshes with known answers, for tests of geometry: closed and outward unless their names say otherwise.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::test {

// A right-angled corner of a cube: volume a^3 / 6.
inline TriangleMesh make_corner(float a, const glm::vec3& at = {}) {
  TriangleMesh mesh;
  mesh.positions = {at, at + glm::vec3(a, 0, 0), at + glm::vec3(0, a, 0), at + glm::vec3(0, 0, a)};
  mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return mesh;
}

// Faces -z, +z, -y, +y, -x, +x in this order, two triangles each.
inline TriangleMesh make_box(const glm::vec3& lower, const glm::vec3& upper) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) ? upper.x : lower.x, (i & 2) ? upper.y : lower.y, (i & 4) ? upper.z : lower.z);
  }
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

// The side of a cylinder without caps over an anticlockwise outline, `layers` layers from z = bottom to z = top: open.
inline TriangleMesh make_wall(std::span<const glm::vec2> outline, float bottom, float top, std::uint32_t layers = 1) {
  TriangleMesh mesh;
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t k = 0; k <= layers; ++k) {
    const float z = bottom + (top - bottom) * static_cast<float>(k) / static_cast<float>(layers);
    for (const glm::vec2& p : outline) mesh.positions.emplace_back(p.x, p.y, z);
  }
  for (std::uint32_t k = 0; k < layers; ++k) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t a = k * count + i, b = k * count + (i + 1) % count;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + count, b, b + count, a + count});
    }
  }
  return mesh;
}

// Poles on the z axis. `rings` rows of triangles from pole to pole; an even number puts vertices on the equator.
inline TriangleMesh make_sphere(float radius, std::uint32_t rings, std::uint32_t segments,
                                const glm::vec3& centre = {}) {
  TriangleMesh mesh;
  mesh.positions.push_back(centre + glm::vec3(0, 0, radius));
  for (std::uint32_t k = 1; k < rings; ++k) {
    const double theta = std::numbers::pi * k / rings;
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / segments;
      const glm::dvec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         2 * k == rings ? 0.0 : std::cos(theta));
      mesh.positions.push_back(centre + glm::vec3(static_cast<double>(radius) * n));
    }
  }
  mesh.positions.push_back(centre - glm::vec3(0, 0, radius));
  const std::uint32_t last = static_cast<std::uint32_t>(mesh.positions.size()) - 1;
  const auto at = [&](std::uint32_t k, std::uint32_t i) { return 1 + (k - 1) * segments + i % segments; };
  for (std::uint32_t i = 0; i < segments; ++i) {
    mesh.indices.insert(mesh.indices.end(), {0, at(1, i), at(1, i + 1)});
    for (std::uint32_t k = 1; k + 1 < rings; ++k) {
      mesh.indices.insert(mesh.indices.end(), {at(k, i), at(k + 1, i), at(k, i + 1)});
      mesh.indices.insert(mesh.indices.end(), {at(k, i + 1), at(k + 1, i), at(k + 1, i + 1)});
    }
    mesh.indices.insert(mesh.indices.end(), {last, at(rings - 1, i + 1), at(rings - 1, i)});
  }
  return mesh;
}

// Round the z axis.
inline TriangleMesh make_torus(float ring_radius, float tube_radius, std::uint32_t segments, std::uint32_t sides) {
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k < segments; ++k) {
    const double phi = 2.0 * std::numbers::pi * k / segments;
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double theta = 2.0 * std::numbers::pi * i / sides;
      const double r = ring_radius + tube_radius * std::cos(theta);
      mesh.positions.emplace_back(r * std::cos(phi), r * std::sin(phi), tube_radius * std::sin(theta));
    }
  }
  const auto at = [&](std::uint32_t k, std::uint32_t i) { return (k % segments) * sides + i % sides; };
  for (std::uint32_t k = 0; k < segments; ++k) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      mesh.indices.insert(mesh.indices.end(), {at(k, i), at(k + 1, i), at(k, i + 1)});
      mesh.indices.insert(mesh.indices.end(), {at(k, i + 1), at(k + 1, i), at(k + 1, i + 1)});
    }
  }
  return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return mesh;
}

inline TriangleMesh join(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const std::uint32_t index : b.indices) a.indices.push_back(first + index);
  return a;
}

inline TriangleMesh moved(TriangleMesh mesh, const glm::mat4& by) {
  for (glm::vec3& p : mesh.positions) p = glm::vec3(by * glm::vec4(p, 1.0f));
  return mesh;
}

// Numbers in [0, 1) that are the same everywhere.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed) {}
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(state_ >> 8) / 16777216.0f;
  }
  glm::vec3 point(float lower, float upper) {
    const float x = next(), y = next(), z = next();
    return glm::vec3(lower) + (upper - lower) * glm::vec3(x, y, z);
  }

 private:
  std::uint32_t state_;
};

// As the text of an .obj file.
inline std::string as_obj(const TriangleMesh& mesh) {
  std::ostringstream text;
  for (const glm::vec3& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    text << "f " << mesh.indices[i] + 1 << ' ' << mesh.indices[i + 1] + 1 << ' ' << mesh.indices[i + 2] + 1 << '\n';
  }
  return text.str();
}

// Triangles anywhere in a cube from -1 to 1 that share vertices at random: no surface at all.
inline TriangleMesh make_soup(std::uint32_t triangles, std::uint32_t seed) {
  TriangleMesh mesh;
  Numbers numbers(seed);
  const std::uint32_t count = triangles / 2 + 3;
  for (std::uint32_t i = 0; i < count; ++i) mesh.positions.push_back(numbers.point(-1.0f, 1.0f));
  for (std::uint32_t i = 0; i < 3 * triangles; ++i) {
    mesh.indices.push_back(static_cast<std::uint32_t>(numbers.next() * static_cast<float>(count)));
  }
  return mesh;
}

}  // namespace fascicle::test
