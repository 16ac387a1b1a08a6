#include "modules/muscle/kernels/surface/place_fibres.hpp"

#include <cstddef>

#include <immintrin.h>

namespace fascicle::muscle {
namespace {

// One point in the lanes x, y, z; what its fourth lane holds is nobody's business.
__m128 load(const SurfacePoint& p) { return _mm_load_ps(&p.x); }

__m128 turn_left(__m128 v) { return _mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1)); }  // y, z, x

__m128 cross(__m128 a, __m128 b) {
  return turn_left(_mm_sub_ps(_mm_mul_ps(a, turn_left(b)), _mm_mul_ps(turn_left(a), b)));
}

// Of x, y and z, in all lanes.
__m128 dot(__m128 a, __m128 b) { return _mm_dp_ps(a, b, 0x7f); }

__m128 place(const FibreBinding& binding, const SurfacePoint* surface) {
  const __m128 a = load(surface[binding.vertex[0]]), b = load(surface[binding.vertex[1]]),
               c = load(surface[binding.vertex[2]]), d = load(surface[binding.vertex[3]]);
  const __m128 normal = cross(_mm_sub_ps(b, a), _mm_sub_ps(c, a));
  // A triangle without an area has no normal: the least square keeps the answer finite.
  const __m128 square = _mm_max_ps(dot(normal, normal), _mm_set1_ps(1.0e-30f));
  const __m128 rise = _mm_div_ps(_mm_set1_ps(binding.rise), _mm_sqrt_ps(square));
  const __m128 weights = _mm_loadu_ps(binding.weight.data());
  const __m128 ab = _mm_add_ps(_mm_mul_ps(_mm_shuffle_ps(weights, weights, 0x00), a),
                               _mm_mul_ps(_mm_shuffle_ps(weights, weights, 0x55), b));
  const __m128 cd = _mm_add_ps(_mm_mul_ps(_mm_shuffle_ps(weights, weights, 0xaa), c),
                               _mm_mul_ps(_mm_shuffle_ps(weights, weights, 0xff), d));
  return _mm_blend_ps(_mm_add_ps(_mm_add_ps(ab, cd), _mm_mul_ps(rise, normal)), _mm_setzero_ps(), 0x8);
}

}  // namespace

void place_fibres(const PlaceFibresJob& job) {
  std::size_t i = 0;
  for (float& length : job.lengths) {
    __m128 before = _mm_setzero_ps(), sum = _mm_setzero_ps();
    for (std::uint32_t k = 0; k < job.points_per_fibre; ++k, ++i) {
      const __m128 here = place(job.bindings[i], job.surface.data());
      _mm_store_ps(&job.points[i].x, here);
      const __m128 way = _mm_sub_ps(here, before);
      if (k > 0) sum = _mm_add_ss(sum, _mm_sqrt_ss(dot(way, way)));
      before = here;
    }
    length = _mm_cvtss_f32(sum);
  }
}

}  // namespace fascicle::muscle
