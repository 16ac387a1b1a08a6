#include "modules/muscle/kernels/surface/place_fibres.hpp"

#include <cmath>
#include <cstddef>

namespace fascicle::muscle {
namespace {

SurfacePoint place(const FibreBinding& binding, const SurfacePoint* surface) {
  SurfacePoint sum;
  for (std::size_t k = 0; k < 4; ++k) {
    const SurfacePoint& p = surface[binding.vertex[k]];
    sum.x += binding.weight[k] * p.x;
    sum.y += binding.weight[k] * p.y;
    sum.z += binding.weight[k] * p.z;
  }
  return sum;
}

}  // namespace

void place_fibres(const PlaceFibresJob& job) {
  std::size_t i = 0;
  for (float& length : job.lengths) {
    SurfacePoint before = place(job.bindings[i], job.surface.data());
    job.points[i++] = before;
    float sum = 0.0f;
    for (std::uint32_t k = 1; k < job.points_per_fibre; ++k, ++i) {
      const SurfacePoint here = place(job.bindings[i], job.surface.data());
      const float x = here.x - before.x, y = here.y - before.y, z = here.z - before.z;
      sum += std::sqrt(x * x + y * y + z * z);
      job.points[i] = here;
      before = here;
    }
    length = sum;
  }
}

}  // namespace fascicle::muscle
