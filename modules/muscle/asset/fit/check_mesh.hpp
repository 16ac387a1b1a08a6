// What a fit must know of a mesh before it casts into it: whether crossings alone say what is inside, what must be
// mended first, and whether it is of the muscle's size at all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/content/triangle_mesh.hpp"

namespace fascicle::muscle {

// Closed, consistently turned, outward and finite, to a hash: every side of a triangle has its reverse as often as
// itself, so that every line leaves the mesh as often as it enters. Linear and cheap; self-intersections are not looked
// for.
bool is_sound(const TriangleMesh& mesh);

// A mesh ready to be fitted to.
struct CheckedMesh {
  std::optional<TriangleMesh> mended;            // nothing: the mesh as it is
  std::vector<std::uint32_t> source_triangles;   // of the mended one's
  double size = 0.0;                             // m, diagonal of the bounds
  bool sound = false;
  std::string defects;                           // what was wrong, in words; empty: nothing
};
CheckedMesh check_mesh(const TriangleMesh& mesh);

// Of a mesh `factor` times as large as the muscle that it is for: what unit it seems to be in; nothing where no unit
// comes near.
struct UnitGuess {
  const char* unit;
  double factor;  // how much too large a mesh in that unit is
};
std::optional<UnitGuess> guess_unit(double factor);

// m, how far away the furthest vertex is, where it lies out of all proportion to where most are; else nothing.
std::optional<double> find_stray_vertex(const TriangleMesh& mesh);

// Meshes this much larger or smaller than their action lines are in another unit.
inline constexpr double kWrongUnit = 8.0;

}  // namespace fascicle::muscle
