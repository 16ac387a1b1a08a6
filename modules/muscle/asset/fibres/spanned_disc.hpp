// A loop in space, spanned by a surface and mapped to the unit disc: how a contour takes what a template of fibres has
// at a point of the disc (4.4). Contours are neither planar nor convex, so the surface is the triangulation of the
// loop with the least area (it bridges no dent), refined, and the map is harmonic with positive weights. Its border
// runs round the circle by the loop's length, so it is one to one whatever the loop is like (Tutte, Floater).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fascicle::muscle {

// Triangles of the loop's points, two fewer than points: the least sum of areas (m^2) and, to a small share, of the
// edges' squares. The third power of the number of points.
std::vector<std::array<std::uint32_t, 3>> triangulate_loop(std::span<const glm::dvec3> loop);

class SpannedDisc {
 public:
  // `loop`: evenly spaced points. Nothing for fewer than 3, or where the map cannot be solved.
  static std::optional<SpannedDisc> span(std::span<const glm::dvec3> loop);

  // The place (m) of a point of the unit disc. (1, 0) is the loop's first point, (0, 1) a quarter of its length on. A
  // point outside of the disc counts as the nearest in it.
  glm::dvec3 at(const glm::dvec2& point) const;

 private:
  static constexpr int kCells = 24;  // a side of the grid over the disc's square

  std::vector<glm::dvec3> places_;
  std::vector<glm::dvec2> disc_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> first_in_cell_, in_cell_;  // triangles by the cells that their boxes touch

  void fill_cells();
};

}  // namespace fascicle::muscle
