// What `fascicle-cook hull` says of coarse hulls: made, measured and checked by other means than they were made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/asset/hull/progressive_hull.hpp"

namespace fascicle::cook {

struct MeasuredHull {
  std::string muscle;
  const TriangleMesh* fine = nullptr;  // m; lives longer
  muscle::HullTarget target;
  muscle::ProgressiveHull hull;
  double milliseconds = 0.0;           // of making it
  double size = 0.0;                   // m, the mesh's diagonal
  double outside = 0.0;                // m: of the fine vertex that is furthest out of the hull
  double furthest = 0.0, mean = 0.0;   // m: of the hull's surface from the mesh
  bool closed = false;                 // every edge has two triangles, in opposite directions
  std::size_t crossings = 0;           // pairs of the hull's triangles that pass through each other
  std::size_t fine_crossings = 0;      // the mesh's own

  // Closed, and nothing of the mesh outside by more than 1e-6 of its size.
  bool sound() const;
};

// Errors and warnings are the hull's.
Result<MeasuredHull> measure_hull(const std::string& muscle, const TriangleMesh& fine, const muscle::HullTarget& target);

std::string to_table(std::span<const MeasuredHull> hulls);

// The hull as an .obj file's text; numbers come back bit for bit.
std::string to_obj(const MeasuredHull& hull);

}  // namespace fascicle::cook
