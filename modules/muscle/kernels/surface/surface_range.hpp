// Boxes, and ranges of normals, four lanes at once. For source files of one instruction set (wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/surface/surface_boxes.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

using namespace fascicle::FASCICLE_ISA;
using FourLanes = WideFloat<4>;

// A range in registers. The fourth lane is 0 to 0, so that it never decides.
struct WideRange {
  FourLanes lower, upper;
};

inline WideRange load_range(const SurfaceRange& range) {
  return {load<4>(range.lower.data()), load<4>(range.upper.data())};
}

inline void store_range(const WideRange& range, SurfaceRange& to) {
  store(range.lower, to.lower.data());
  store(range.upper, to.upper.data());
}

// No number changes nothing.
inline FourLanes lesser(FourLanes a, FourLanes b) { return select(b < a, b, a); }
inline FourLanes greater(FourLanes a, FourLanes b) { return select(a < b, b, a); }

inline void include(WideRange& range, FourLanes p) {
  range.lower = lesser(range.lower, p);
  range.upper = greater(range.upper, p);
}

inline void include(WideRange& range, const WideRange& other) {
  range.lower = lesser(range.lower, other.lower);
  range.upper = greater(range.upper, other.upper);
}

// Within `reach` of each other along all axes.
inline bool near(const WideRange& a, const WideRange& b, float reach) {
  return !any((b.upper + broadcast<4>(reach) < a.lower) | (a.upper + broadcast<4>(reach) < b.lower));
}

// The least dot product of a vector of one range and one of the other.
inline float least_dot(const WideRange& a, const WideRange& b) {
  const FourLanes least = lesser(lesser(a.lower * b.lower, a.lower * b.upper),
                                 lesser(a.upper * b.lower, a.upper * b.upper));
  float of[4];
  store(least, of);
  return of[0] + of[1] + of[2];
}

}  // namespace fascicle::muscle::FASCICLE_ISA
