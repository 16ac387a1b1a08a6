// One muscle and one pose: what the coarse hull's iterations read.
#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/kernels/hull/hull_kernels.hpp"
#include "modules/muscle/kernels/hull/hull_scratch.hpp"
#include "modules/muscle/kernels/surface/step_surface.hpp"

namespace fascicle::muscle {

struct HullProblem {
  const SurfaceStep& step;
  const HullAsset& hull;
  const HullKernels& kernels;
  std::span<const glm::vec3> line;
  bool keeps_volume = true;
};

// Vectors by hull vertex; sums are in double precision.
using HullVector = std::span<SurfacePoint>;
using HullRow = std::span<const SurfacePoint>;

inline double dot(const SurfacePoint& a, const SurfacePoint& b) {
  return static_cast<double>(a.x) * static_cast<double>(b.x) + static_cast<double>(a.y) * static_cast<double>(b.y) +
         static_cast<double>(a.z) * static_cast<double>(b.z);
}

inline double dot(HullRow a, HullRow b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

// out += factor * row
inline void add(double factor, HullRow row, HullVector out) {
  const auto f = static_cast<float>(factor);
  for (std::size_t i = 0; i < row.size(); ++i) {
    out[i].x += f * row[i].x;
    out[i].y += f * row[i].y;
    out[i].z += f * row[i].z;
  }
}

inline glm::vec3 place(const SurfacePoint& p) { return {p.x, p.y, p.z}; }

inline void set(SurfacePoint& p, const glm::vec3& to) {
  p.x = to.x;
  p.y = to.y;
  p.z = to.z;
}

}  // namespace fascicle::muscle
