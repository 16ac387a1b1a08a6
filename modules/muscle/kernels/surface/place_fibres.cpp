#include "modules/muscle/kernels/surface/place_fibres.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <immintrin.h>

namespace fascicle::muscle {
namespace {

constexpr std::size_t kLanes = 4;

// Four places side by side, a lane each. The fourth row of what was transposed is nobody's business.
struct Places {
  __m128 x, y, z;
};

Places side_by_side(__m128 a, __m128 b, __m128 c, __m128 d) {
  _MM_TRANSPOSE4_PS(a, b, c, d);
  return {a, b, c};
}

Places operator-(const Places& a, const Places& b) {
  return {_mm_sub_ps(a.x, b.x), _mm_sub_ps(a.y, b.y), _mm_sub_ps(a.z, b.z)};
}

__m128 difference(__m128 a, __m128 b, __m128 c, __m128 d) { return _mm_sub_ps(_mm_mul_ps(a, b), _mm_mul_ps(c, d)); }

Places cross(const Places& a, const Places& b) {
  return {difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x)};
}

__m128 square(const Places& a) {
  return _mm_add_ps(_mm_add_ps(_mm_mul_ps(a.x, a.x), _mm_mul_ps(a.y, a.y)), _mm_mul_ps(a.z, a.z));
}

// The vertices with number `k` of four bindings.
Places gather(const FibreBinding* bindings, std::size_t k, const SurfacePoint* surface) {
  const auto load = [&](std::size_t i) { return _mm_load_ps(&surface[bindings[i].vertex[k]].x); };
  return side_by_side(load(0), load(1), load(2), load(3));
}

void place(const FibreBinding* bindings, const SurfacePoint* surface, SurfacePoint* points) {
  const Places a = gather(bindings, 0, surface), b = gather(bindings, 1, surface), c = gather(bindings, 2, surface),
               d = gather(bindings, 3, surface);
  const Places normal = cross(b - a, c - a);
  // A triangle without an area has no normal: the least square keeps the answer finite.
  const __m128 length = _mm_sqrt_ps(_mm_max_ps(square(normal), _mm_set1_ps(1.0e-30f)));
  const __m128 rise = _mm_div_ps(
      _mm_setr_ps(bindings[0].rise, bindings[1].rise, bindings[2].rise, bindings[3].rise), length);
  __m128 wa = _mm_loadu_ps(bindings[0].weight.data()), wb = _mm_loadu_ps(bindings[1].weight.data()),
         wc = _mm_loadu_ps(bindings[2].weight.data()), wd = _mm_loadu_ps(bindings[3].weight.data());
  _MM_TRANSPOSE4_PS(wa, wb, wc, wd);  // from a binding each to a vertex each
  const auto sum = [&](__m128 pa, __m128 pb, __m128 pc, __m128 pd, __m128 n) {
    const __m128 ab = _mm_add_ps(_mm_mul_ps(wa, pa), _mm_mul_ps(wb, pb));
    const __m128 cd = _mm_add_ps(_mm_mul_ps(wc, pc), _mm_mul_ps(wd, pd));
    return _mm_add_ps(_mm_add_ps(ab, cd), _mm_mul_ps(rise, n));
  };
  __m128 x = sum(a.x, b.x, c.x, d.x, normal.x), y = sum(a.y, b.y, c.y, d.y, normal.y),
         z = sum(a.z, b.z, c.z, d.z, normal.z), w = _mm_setzero_ps();
  _MM_TRANSPOSE4_PS(x, y, z, w);
  _mm_store_ps(&points[0].x, x);
  _mm_store_ps(&points[1].x, y);
  _mm_store_ps(&points[2].x, z);
  _mm_store_ps(&points[3].x, w);
}

// Along `count` points; four segments at a time, their sums kept apart to the end.
float measure(const SurfacePoint* points, std::size_t count) {
  const auto way = [&](std::size_t i) { return _mm_sub_ps(_mm_load_ps(&points[i + 1].x), _mm_load_ps(&points[i].x)); };
  __m128 sums = _mm_setzero_ps();
  std::size_t i = 0;
  for (; i + kLanes < count; i += kLanes)
    sums = _mm_add_ps(sums, _mm_sqrt_ps(square(side_by_side(way(i), way(i + 1), way(i + 2), way(i + 3)))));
  for (; i + 1 < count; ++i) {
    const __m128 one = way(i);
    sums = _mm_add_ss(sums, _mm_sqrt_ss(_mm_dp_ps(one, one, 0x71)));
  }
  std::array<float, kLanes> part{};
  _mm_storeu_ps(part.data(), sums);
  return (part[0] + part[1]) + (part[2] + part[3]);
}

}  // namespace

void place_fibres(const PlaceFibresJob& job) {
  const std::size_t count = job.lengths.size() * job.points_per_fibre, whole = count - count % kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) place(&job.bindings[i], job.surface.data(), &job.points[i]);
  if (whole < count) {
    std::array<FibreBinding, kLanes> last{};
    std::array<SurfacePoint, kLanes> places{};
    std::copy_n(&job.bindings[whole], count - whole, last.begin());
    place(last.data(), job.surface.data(), places.data());
    std::copy_n(places.begin(), count - whole, &job.points[whole]);
  }
  for (std::size_t f = 0; f < job.lengths.size(); ++f)
    job.lengths[f] = measure(&job.points[f * job.points_per_fibre], job.points_per_fibre);
}

}  // namespace fascicle::muscle
