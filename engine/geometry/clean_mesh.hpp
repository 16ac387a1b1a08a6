// Meshes as authors bring them made into meshes that can be fitted, drawn and measured: welded, without triangles that
// have no area or stand twice, consistently turned and outward. What was wrong is counted, so that an author can be
// told; holes, edges with more than two triangles and self-intersections are told of but stay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

// How many of each were found.
struct MeshDefects {
  // Mended. Welding is no defect, only needed for some formats: an .stl knows no shared vertices.
  std::size_t non_finite_vertices = 0;   // left out with their triangles
  std::size_t unused_vertices = 0;       // left out
  std::size_t welded_vertices = 0;       // made one with an earlier vertex
  std::size_t degenerate_triangles = 0;  // without area: left out, or replaced by splitting the neighbour
  std::size_t duplicate_triangles = 0;   // same corners as an earlier one, in whatever order: left out
  std::size_t flipped_triangles = 0;     // turned round; if `inverted`, those that were right
  bool inverted = false;                 // most were inside out

  // Still there.
  std::size_t open_edges = 0;            // with one triangle
  std::size_t holes = 0;                 // connected sets of open edges
  std::size_t crowded_edges = 0;         // with more than two triangles
  std::size_t twisted_edges = 0;         // where a one-sided surface (a Moebius strip) contradicts itself
  std::size_t self_intersections = 0;    // pairs of triangles that cross, or overlap in a plane
  bool more_self_intersections = false;  // the search was cut off: there are at least that many

  std::size_t components = 0;  // parts that hang together by edges with two triangles

  // Every edge has two triangles that agree, and there are some.
  bool closed() const;
  // Closed, and nothing was found that changes what is inside. Welded and unused vertices do not, nor do triangles
  // without area: anatomical meshes are full of them.
  bool sound() const;
  // "12 open edges round 1 hole, 3 flipped triangles (turned round)"; empty when sound.
  std::string to_text() const;
};

struct CleanMesh {
  TriangleMesh mesh;                            // without normals: welded vertices would have several
  std::vector<std::uint32_t> source_triangles;  // for each triangle, the one of the input that it comes from
  MeshDefects defects;
};

// Vertices weld that are equal or within 1e-6 of the bounding diagonal of each other. Vertices and triangles keep their
// order. Every triangle that is left has corners and an area; none may be left. For the sense of the triangles see
// orient_triangles.hpp. The mesh's indices must be in range (readers see to that). About a second for 10^6 triangles.
CleanMesh clean_mesh(const TriangleMesh& mesh);

}  // namespace fascicle
