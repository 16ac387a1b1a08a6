#include "modules/muscle/kernels/surface/surface_normals.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>

#include "engine/math/wide_float.hpp"

namespace fascicle::muscle {
namespace {

using namespace FASCICLE_ISA;
using Four = WideFloat<4>;
using Vector = WideVector<4>;

// Squared length (m^4) below which a normal has no direction.
constexpr float kSmallestNormalSquared = 1.0e-34f;
// Length of a normal before its components are rounded to 10 bits.
constexpr float kPackedLength = 511.0f;

static_assert(sizeof(SurfacePoint) == 4 * sizeof(float) && sizeof(SurfaceVertex) == 4 * sizeof(float));

// The first three lanes of the cross product; the last is zero.
Four cross_product(Four a, Four b) {
  const auto turn = [](Four v) { return Four{_mm_shuffle_ps(v.v, v.v, _MM_SHUFFLE(3, 0, 2, 1))}; };  // y z x w
  return turn(a * turn(b) - turn(a) * b);
}

void sum_normals(std::span<const std::uint32_t> triangles, const float* points, float* sums) {
  const auto add = [sums](std::size_t vertex, Four normal) {
    store(load<4>(sums + 4 * vertex) + normal, sums + 4 * vertex);
  };
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const std::size_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    const Four corner = load<4>(points + 4 * a);
    const Four normal = cross_product(load<4>(points + 4 * b) - corner, load<4>(points + 4 * c) - corner);
    add(a, normal);
    add(b, normal);
    add(c, normal);
  }
}

// Four records of x y z w as vectors; w is left out.
Vector load_four(const float* from) {
  __m128 a = _mm_loadu_ps(from), b = _mm_loadu_ps(from + 4), c = _mm_loadu_ps(from + 8), d = _mm_loadu_ps(from + 12);
  _MM_TRANSPOSE4_PS(a, b, c, d);
  return {{a}, {b}, {c}};
}

Vector transform(const glm::mat3& matrix, const Vector& v) {
  return {matrix[0].x * v.x + matrix[1].x * v.y + matrix[2].x * v.z,
          matrix[0].y * v.x + matrix[1].y * v.y + matrix[2].y * v.z,
          matrix[0].z * v.x + matrix[1].z * v.y + matrix[2].z * v.z};
}

// 10:10:10:2 signed, from components of length 511: added up with a bias that keeps each field positive, so that no
// sign spills into the next, and which is then taken off by flipping each field's highest bit.
Four pack(const Vector& n) {
  const WideInt<4> bias = broadcast_int<4>(512 | 512 << 10 | 512 << 20);
  const WideInt<4> sum =
      round_to_int(n.x) + shift_left(round_to_int(n.y), 10) + shift_left(round_to_int(n.z), 20) + bias;
  return from_bits(sum ^ bias);
}

struct Frame {
  glm::mat3 axes, cofactors;  // cofactors turn normals rightly under scale and mirroring
  glm::vec3 origin;
};

// Four points and sums to four vertices; `sums` and `to` may be the same.
void finish_four(const Frame& frame, const float* points, const float* sums, float* to) {
  const Vector place = transform(frame.axes, load_four(points));
  Vector normal = load_four(sums);
  const WideInt<4> vanished = dot(normal, normal) < broadcast<4>(kSmallestNormalSquared);
  normal = select(vanished, {broadcast<4>(0.0f), broadcast<4>(1.0f), broadcast<4>(0.0f)}, normal);
  normal = transform(frame.cofactors, normal);
  normal = inverse_root(dot(normal, normal), kPackedLength) * normal;
  store_records<false>(place.x + frame.origin.x, place.y + frame.origin.y, place.z + frame.origin.z, pack(normal), to);
}

}  // namespace

void write_surface_vertices(std::span<const std::uint32_t> triangles, std::span<const SurfacePoint> points,
                            const glm::mat4& frame, std::span<SurfaceVertex> vertices) {
  assert(points.size() >= vertices.size());
  if (vertices.empty()) return;
  const float* from = &points.data()->x;
  float* to = reinterpret_cast<float*>(vertices.data());
  std::memset(static_cast<void*>(to), 0, vertices.size_bytes());
  sum_normals(triangles, from, to);

  const glm::mat3 m(frame);
  const Frame made{m, {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])}, glm::vec3(frame[3])};
  const std::size_t whole = vertices.size() / 4 * 4;
  for (std::size_t v = 0; v < whole; v += 4) finish_four(made, from + 4 * v, to + 4 * v, to + 4 * v);
  if (whole == vertices.size()) return;
  // The rest, filled up with zeros.
  float rest_points[16] = {}, rest[16] = {};
  const std::size_t bytes = 4 * sizeof(float) * (vertices.size() - whole);
  std::memcpy(rest_points, from + 4 * whole, bytes);
  std::memcpy(rest, to + 4 * whole, bytes);
  finish_four(made, rest_points, rest, rest);
  std::memcpy(to + 4 * whole, rest, bytes);
}

}  // namespace fascicle::muscle
