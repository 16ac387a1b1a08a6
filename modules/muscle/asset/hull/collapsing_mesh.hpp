// A closed manifold mesh whose edges are collapsed one after the other. A collapse replaces the edge's two vertices by a
// new one, with an index of its own, so that whatever is known of an index stays true or dies with it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

class CollapsingMesh {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  // Every edge of `mesh` has two triangles, in opposite directions. Positions are kept relative to `centre`.
  CollapsingMesh(const TriangleMesh& mesh, const glm::dvec3& centre);

  std::uint32_t vertex_count() const { return live_vertices_; }
  std::uint32_t vertex_end() const { return static_cast<std::uint32_t>(positions_.size()); }
  const glm::dvec3& position(std::uint32_t vertex) const { return positions_[vertex]; }
  bool alive(std::uint32_t vertex) const { return !fans_[vertex].empty(); }
  // Grows whenever a triangle at the vertex changes.
  std::uint32_t revision(std::uint32_t vertex) const { return revisions_[vertex]; }

  std::uint32_t triangle_end() const { return static_cast<std::uint32_t>(triangles_.size()); }
  bool triangle_alive(std::uint32_t triangle) const { return triangles_[triangle][0] != triangles_[triangle][1]; }
  const Triangle& triangle(std::uint32_t triangle) const { return triangles_[triangle]; }
  // Half the cross product of two sides: the outward normal times the area (m^2).
  const glm::dvec3& area(std::uint32_t triangle) const { return areas_[triangle]; }
  // The triangles at a vertex.
  std::span<const std::uint32_t> fan(std::uint32_t vertex) const { return fans_[vertex]; }

  // Whether the mesh stays closed and manifold, with no two triangles over the same three vertices, when the edge
  // between `u` and `v` is collapsed (the link condition). False where there is no such edge.
  bool can_collapse(std::uint32_t u, std::uint32_t v);
  // The new vertex. Only where can_collapse.
  std::uint32_t collapse(std::uint32_t u, std::uint32_t v, const glm::dvec3& place);

  // The mesh as it is now: vertices in the order of their making, `centre` added.
  TriangleMesh finish() const;

 private:
  glm::dvec3 centre_;
  std::vector<glm::dvec3> positions_;
  std::vector<Triangle> triangles_;  // a dead one has one vertex three times
  std::vector<glm::dvec3> areas_;
  std::vector<std::vector<std::uint32_t>> fans_;
  std::vector<std::uint32_t> revisions_;
  std::vector<std::uint32_t> marks_;  // by vertex: the last search that met it
  std::uint32_t mark_ = 0;
  std::uint32_t live_vertices_ = 0;

  void measure(std::uint32_t triangle);
};

}  // namespace fascicle::muscle
