#include "modules/muscle/kernels/sweep_rays.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/triangle_tree.hpp"

namespace fascicle::muscle {
namespace {

// By the axes along which an edge and a box could be apart. No division, so edges along an axis need no care; grown by
// what rounding could take away. False for an edge that is not finite.
bool meets_box(const SweepEdge& edge, const glm::vec3& lower, const glm::vec3& upper) {
  const glm::vec3 half_box = 0.5f * (upper - lower), half_edge = 0.5f * (edge.to - edge.from);
  const glm::vec3 apart = 0.5f * (edge.from + edge.to) - 0.5f * (lower + upper);
  const glm::vec3 reach = glm::abs(half_edge) + 1.0e-6f * (glm::abs(lower) + glm::abs(upper)) + 1.0e-9f;
  const glm::vec3 box = half_box + reach;
  if (!(std::abs(apart.x) <= box.x && std::abs(apart.y) <= box.y && std::abs(apart.z) <= box.z)) return false;
  const glm::vec3 size = half_box + (reach - glm::abs(half_edge));
  const glm::vec3 across = glm::abs(glm::cross(apart, half_edge)), along = glm::abs(half_edge) + 1.0e-6f * size;
  return across.x <= size.y * along.z + size.z * along.y && across.y <= size.x * along.z + size.z * along.x &&
         across.z <= size.x * along.y + size.y * along.x;
}

bool crosses_tree(const SweepEdge& edge, const TriangleTree& tree) {
  std::array<std::uint32_t, kTreeStackSize> stack;
  std::size_t depth = 0;
  if (!tree.nodes.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t number = stack[--depth];
    const TriangleTree::Node& node = tree.nodes[number];
    if (!meets_box(edge, node.lower, node.upper)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = number + 1;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      if (crosses(edge, tree.triangles[t])) return true;
    }
  }
  return false;
}

}  // namespace

void sweep_edges(std::span<const glm::vec3> section, std::span<const glm::vec3> neighbour,
                 std::span<SweepEdge> latitudinal, std::span<SweepEdge> diagonal) {
  const std::size_t count = section.size();
  assert(neighbour.size() == count && latitudinal.size() == count && diagonal.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = i + 1 < count ? i + 1 : 0;
    latitudinal[i] = {section[i], section[next]};
    diagonal[i] = {section[i], neighbour[next]};
  }
}

void segment_triangles(std::span<const glm::vec3> section, std::span<const glm::vec3> next,
                       std::span<SweepTriangle> triangles) {
  const std::size_t count = section.size();
  assert(next.size() == count && triangles.size() == 2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = i + 1 < count ? i + 1 : 0;
    triangles[2 * i] = {section[i], section[j], next[j]};
    triangles[2 * i + 1] = {section[i], next[j], next[i]};
  }
}

bool crosses(const SweepEdge& edge, const SweepTriangle& triangle) {
  const glm::vec3 direction = edge.to - edge.from;
  const glm::vec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const glm::vec3 p = glm::cross(direction, ac);
  const float determinant = glm::dot(ab, p);
  if (determinant == 0.0f) return false;
  const float inverse = 1.0f / determinant;
  const glm::vec3 s = edge.from - triangle[0];
  const float u = inverse * glm::dot(s, p);
  if (!(u >= 0.0f && u <= 1.0f)) return false;
  const glm::vec3 q = glm::cross(s, ab);
  const float v = inverse * glm::dot(direction, q);
  if (!(v >= 0.0f && u + v <= 1.0f)) return false;
  const float t = inverse * glm::dot(ac, q);  // of the edge's length
  return t >= 0.0f && t <= 1.0f;
}

void mark_crossings(std::span<const SweepEdge> edges, std::span<const SweepTriangle> triangles,
                    std::span<std::uint8_t> hits) {
  assert(edges.size() == hits.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t t = 0; t < triangles.size() && hits[i] == 0; ++t) {
      if (crosses(edges[i], triangles[t])) hits[i] = 1;
    }
  }
}

void mark_crossings(std::span<const SweepEdge> edges, const TriangleTree& tree, const glm::mat4& to_tree,
                    std::span<std::uint8_t> hits) {
  assert(edges.size() == hits.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (hits[i] != 0) continue;
    const SweepEdge edge{glm::vec3(to_tree * glm::vec4(edges[i].from, 1.0f)),
                         glm::vec3(to_tree * glm::vec4(edges[i].to, 1.0f))};
    if (crosses_tree(edge, tree)) hits[i] = 1;
  }
}

void mark_vertices(std::span<const std::uint8_t> latitudinal_hits, std::span<std::uint8_t> surrounded) {
  assert(latitudinal_hits.size() == surrounded.size());
  for (std::size_t i = 0; i < surrounded.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : surrounded.size() - 1;
    surrounded[i] = latitudinal_hits[before] != 0 || latitudinal_hits[i] != 0 ? 1 : 0;
  }
}

}  // namespace fascicle::muscle
