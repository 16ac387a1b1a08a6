// Keeps a section's area while something presses part of it in (thesis 4.2.1): the vertices that are held in place are
// *fixed*, the others *free*. Free radii grow or shrink together, so their ratios stay as they are, until the section's
// polygon has its area again.
//
// The thesis finds their common scale by growing it a little at a time. There is nothing to search for (ours, 3.3): a
// triangle (a_k, c_i, c_{i+1}) with algebraic radii has the area sin(2 pi / |C|) / 2 r_i r_{i+1}, so with a common
// scale s of the free radii the section's is
//
//   area(s) = sin(2 pi / |C|) / 2 (free_free s^2 + mixed s + fixed_fixed),
//
// one quadratic. Sums run in double: negative radii let them cancel, and area is to hold to 1e-4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fascicle::muscle {

// sin(2 pi / |C|) / 2; 0 for fewer than three vertices. Needs |C| <= kMaxSectionVertices.
double section_area_factor(std::size_t section_vertices);

// m^2, of the section's polygon with these algebraic radii (m), the triangle that closes it included.
float section_area(std::span<const float> radii);

enum class Inflation {
  kReached,   // the area is the target
  kCapped,    // the scale that reaches it lies beyond the cap; the radii went as far as that
  kAllFixed,  // no radius is free: nothing changed
  kNoRoot,    // no scale reaches it, or a figure is not finite: nothing changed
};

struct InflateOutcome {
  Inflation kind = Inflation::kNoRoot;
  float scale = 1.0f;  // what the free radii were multiplied by
};

// Scales the radii (m) that are not `fixed` (one flag a radius, not 0: fixed) together so that the section's area is
// `target_area` (m^2): by the positive scale nearest to 1 that does, within 1 / largest_scale .. largest_scale. Where
// the fixed radii alone take up more than the target, the free ones shrink as far as that cap.
// Allocates nothing; spans of one length.
InflateOutcome inflate_section(std::span<float> radii, std::span<const std::uint8_t> fixed, float target_area,
                               float largest_scale);

// The thesis's own iteration (4.5 to 4.10), for comparison and for the legacy response: the free radii keep their
// factors to one of them, which grows by `kIterativeGrowth` of itself an iteration while the area that is missing is
// more than the tolerance, and by half of it and half again where it would grow beyond. It measures the triangles by
// base and height, so it takes radii to be positive, and it only ever grows.
inline constexpr float kIterativeGrowth = 0.01f;

struct IterativeInflation {
  std::uint32_t iterations = 0;
  bool converged = false;  // the missing area is within the tolerance; false too where all are fixed
};

// `tolerance`: of the target (the thesis has 1e-6 m^2 instead, a tenth of its smallest section).
IterativeInflation inflate_iteratively(std::span<float> radii, std::span<const std::uint8_t> fixed, float target_area,
                                       float tolerance, std::uint32_t most_iterations);

}  // namespace fascicle::muscle
