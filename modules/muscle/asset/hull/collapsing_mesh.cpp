#include "modules/muscle/asset/hull/collapsing_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/hull/progressive_hull.hpp"

namespace fascicle::muscle {
namespace {

bool has(const CollapsingMesh::Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

}  // namespace

CollapsingMesh::CollapsingMesh(const TriangleMesh& mesh, const glm::dvec3& centre) : centre_(centre) {
  const std::size_t vertices = mesh.positions.size(), triangles = mesh.indices.size() / 3;
  positions_.reserve(2 * vertices);
  for (const glm::vec3& position : mesh.positions) positions_.push_back(glm::dvec3(position) - centre);
  fans_.reserve(2 * vertices);
  fans_.resize(vertices);
  revisions_.resize(vertices, 0);
  marks_.resize(vertices, 0);
  areas_.resize(triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    triangles_.push_back({mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]});
    for (const std::uint32_t vertex : triangles_[t]) fans_[vertex].push_back(t);
    measure(t);
  }
  for (const auto& fan : fans_) live_vertices_ += fan.empty() ? 0 : 1;
}

void CollapsingMesh::measure(std::uint32_t triangle) {
  const auto& [a, b, c] = triangles_[triangle];
  areas_[triangle] = 0.5 * glm::cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
}

bool CollapsingMesh::can_collapse(std::uint32_t u, std::uint32_t v) {
  if (live_vertices_ <= kFewestHullVertices) return false;
  std::uint32_t shared = 0;
  ++mark_;
  for (const std::uint32_t t : fans_[u]) {
    const Triangle& triangle = triangles_[t];
    const bool both = has(triangle, v);
    shared += both ? 1 : 0;
    for (const std::uint32_t vertex : triangle) {
      marks_[vertex] = mark_;
      // A vertex beside the edge loses a triangle, and three are the fewest.
      if (both && vertex != u && vertex != v && fans_[vertex].size() <= 3) return false;
    }
  }
  if (shared != 2) return false;
  marks_[u] = 0;
  marks_[v] = 0;
  // Beside the edge's own two triangles nothing may join its ends.
  std::uint32_t common = 0;
  for (const std::uint32_t t : fans_[v]) {
    for (const std::uint32_t vertex : triangles_[t]) {
      if (marks_[vertex] != mark_) continue;
      marks_[vertex] = 0;
      ++common;
    }
  }
  return common == 2;
}

std::uint32_t CollapsingMesh::collapse(std::uint32_t u, std::uint32_t v, const glm::dvec3& place) {
  assert(can_collapse(u, v));
  const std::uint32_t merged = vertex_end();
  positions_.push_back(place);
  revisions_.push_back(0);
  marks_.push_back(0);
  std::vector<std::uint32_t> fan;
  fan.reserve(fans_[u].size() + fans_[v].size() - 4);
  for (const std::uint32_t from : {u, v}) {
    for (const std::uint32_t t : fans_[from]) {
      Triangle& triangle = triangles_[t];
      if (!has(triangle, from)) continue;  // died as a triangle of `u`
      if (from == u && has(triangle, v)) {
        for (const std::uint32_t vertex : triangle) {
          if (vertex != u && vertex != v) std::erase(fans_[vertex], t);
        }
        triangle.fill(std::numeric_limits<std::uint32_t>::max());
        continue;
      }
      std::ranges::replace(triangle, from, merged);
      fan.push_back(t);
    }
  }
  fans_[u] = {};
  fans_[v] = {};
  fans_.push_back(std::move(fan));
  for (const std::uint32_t t : fans_[merged]) {
    measure(t);
    for (const std::uint32_t vertex : triangles_[t]) ++revisions_[vertex];
  }
  --live_vertices_;
  return merged;
}

TriangleMesh CollapsingMesh::finish() const {
  TriangleMesh mesh;
  std::vector<std::uint32_t> renamed(positions_.size(), 0);
  for (std::uint32_t v = 0; v < vertex_end(); ++v) {
    if (!alive(v)) continue;
    renamed[v] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(positions_[v] + centre_);
  }
  for (std::uint32_t t = 0; t < triangle_end(); ++t) {
    if (!triangle_alive(t)) continue;
    for (const std::uint32_t vertex : triangles_[t]) mesh.indices.push_back(renamed[vertex]);
  }
  return mesh;
}

}  // namespace fascicle::muscle
