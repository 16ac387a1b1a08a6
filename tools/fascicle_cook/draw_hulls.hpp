// A picture of coarse hulls for an author's eyes: each hull's edges over the mesh that it encloses, side by side. Needs
// no display.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle::cook {

struct PicturedHull {
  const TriangleMesh* fine = nullptr;
  const TriangleMesh* hull = nullptr;
  std::string caption;
};

// In reading order, `columns` a row; all of a row at the same scale. A mesh's longest direction is upright, its shortest
// towards the eye. `height`: pixels of each, 64..4096.
// Errors: nothing to draw, no OpenGL here, a path that cannot be written.
Diagnostics draw_hulls(std::span<const PicturedHull> hulls, std::size_t columns, int height,
                       const std::filesystem::path& png);

}  // namespace fascicle::cook
