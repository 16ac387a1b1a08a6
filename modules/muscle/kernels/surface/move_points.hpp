// What a substep does to every vertex by itself: it goes with its carriers and its velocity, and what the constraints
// have added becomes its velocity. For the kernels' source files only (see engine/math/wide_float.hpp).
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/surface/surface_kernel_data.hpp"
#include "modules/muscle/kernels/surface/vertex_fours.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

// Which carriers move: none, one of them, or more.
struct Movers {
  std::size_t count = 0;  // 2: two or more
  int first = 0;
};

FASCICLE_INLINE Movers find_movers(const PointRows& rows) {
  Movers movers;
  if (rows.carry == nullptr) return movers;
  for (std::size_t c = 0; c < rows.moved_count / 12 && movers.count < 2; ++c) {
    bool moves = false;
    for (std::size_t i = 0; i < 12; ++i) moves = moves || rows.moved[12 * c + i] != 0.0f;
    if (!moves) continue;
    if (movers.count == 0) movers.first = static_cast<int>(c);
    ++movers.count;
  }
  return movers;
}

FASCICLE_INLINE const float* weights_of(const CarryWeights* carry) {
  return reinterpret_cast<const float*>(&carry->weight);
}

// Adds the carriers in one of four vertices' slots, by weight, to the rows of how these vertices move.
template <int kSlot>
FASCICLE_INLINE void add_carriers(const CarryWeights* const (&carry)[4], const float* moved, WideFloat<16> weights,
                                  WideFloat<16> (&row)[3]) {
  const WideFloat<16> weight = reorder<kSlot * 0x55>(weights);
  if (!any(broadcast<16>(0.0f) < weight)) return;  // most vertices have two
  const float* from[4];
  for (int i = 0; i < 4; ++i) {
    from[i] = moved + 12 * static_cast<long>(reinterpret_cast<const std::uint16_t*>(&carry[i]->carrier)[kSlot]);
  }
  for (int r = 0; r < 3; ++r) {
    row[r] = row[r] + weight * join_records(from[0] + 4 * r, from[1] + 4 * r, from[2] + 4 * r, from[3] + 4 * r);
  }
}

// Rows of a matrix for each of four vertices, times (x, y, z, 1); w is zero.
FASCICLE_INLINE WideFloat<16> multiply(const WideFloat<16> (&row)[3], WideFloat<16> p) {
  const WideFloat<16> zero = broadcast<16>(0.0f);
  const WideFloat<16> place = select(load_int<16>(kMassLanes), broadcast<16>(1.0f), p);
  const WideFloat<16> x = row[0] * place, y = row[1] * place, z = row[2] * place;
  // Halves, then quarters of the sums side by side.
  const WideFloat<16> xy = join<kFirstTwo>(x, y) + join<kLastTwo>(x, y);
  const WideFloat<16> z0 = join<kFirstTwo>(z, zero) + join<kLastTwo>(z, zero);
  return join<kEven>(xy, z0) + join<kOdd>(xy, z0);
}

// Four vertices' weight of one carrier, in whatever slot it is.
FASCICLE_INLINE WideFloat<16> weight_of(const CarryWeights* const (&carry)[4], WideFloat<16> weights, int carrier) {
  const WideInt<16> carriers =
      join_shorts(&carry[0]->carrier, &carry[1]->carrier, &carry[2]->carrier, &carry[3]->carrier);
  const WideFloat<16> own = select(carriers == broadcast_int<16>(carrier), weights, broadcast<16>(0.0f));
  const WideFloat<16> pairs = own + reorder<kYxwz>(own);
  return pairs + reorder<kZwxy>(pairs);
}

// How far their carriers take four vertices; w is zero. Muscles between two bones have one that moves: the other is
// what places are counted from.
FASCICLE_INLINE WideFloat<16> carry_four(const PointRows& rows, Movers movers, std::size_t four, WideFloat<16> p) {
  const CarryWeights* carry[4];
  for (std::size_t i = 0; i < 4; ++i) {
    carry[i] = rows.carry + (4 * four + i < rows.vertex_count ? 4 * four + i : rows.vertex_count - 1);
  }
  const WideFloat<16> zero = broadcast<16>(0.0f);
  const WideFloat<16> weights = join_records(weights_of(carry[0]), weights_of(carry[1]), weights_of(carry[2]),
                                             weights_of(carry[3]));
  if (movers.count == 1) {
    const float* from = rows.moved + 12 * static_cast<long>(movers.first);
    const WideFloat<16> row[3] = {repeat_record<16>(from), repeat_record<16>(from + 4), repeat_record<16>(from + 8)};
    return weight_of(carry, weights, movers.first) * multiply(row, p);
  }
  WideFloat<16> row[3] = {zero, zero, zero};
  add_carriers<0>(carry, rows.moved, weights, row);
  add_carriers<1>(carry, rows.moved, weights, row);
  add_carriers<2>(carry, rows.moved, weights, row);
  add_carriers<3>(carry, rows.moved, weights, row);
  return multiply(row, p);
}

inline void carry(const PointRows& rows) {
  const float* rest = reinterpret_cast<const float*>(rows.rest);
  float* points = reinterpret_cast<float*>(rows.points);
  const Movers movers = find_movers(rows);
  for (std::size_t four = 0; 4 * four < rows.vertex_count; ++four) {
    WideFloat<16> p = load_vertices(rest, four, rows.vertex_count);
    if (movers.count > 0) p = p + carry_four(rows, movers, four, p);
    store_vertices(p, points, four, rows.vertex_count);
  }
}

inline void predict(const PointRows& rows) {
  float* points = reinterpret_cast<float*>(rows.points);
  float* before = reinterpret_cast<float*>(rows.before);
  const float* velocity = reinterpret_cast<const float*>(rows.velocity);
  const WideFloat<16> zero = broadcast<16>(0.0f), time = broadcast<16>(rows.h * rows.keep);
  const WideFloat<16> pull = broadcast<16>(rows.pull);
  const float* anchors = reinterpret_cast<const float*>(rows.anchors);
  const Movers movers = find_movers(rows);
  for (std::size_t four = 0; 4 * four < rows.vertex_count; ++four) {
    WideFloat<16> p = load_vertices(points, four, rows.vertex_count);
    const WideInt<16> free = zero < reorder<kAllW>(p);
    if (movers.count > 0) p = p + select(free, carry_four(rows, movers, four, p), zero);
    store_vertices(p, before, four, rows.vertex_count);
    const WideFloat<16> v = select(load_int<16>(kMassLanes), zero, load_vertices(velocity, four, rows.vertex_count));
    WideFloat<16> moved = p + time * v;
    if (anchors != nullptr) {
      const WideFloat<16> away = load_vertices(anchors, four, rows.vertex_count) - moved;
      moved = moved + select(load_int<16>(kMassLanes), zero, pull * away);
    }
    store_vertices(select(free, moved, p), points, four, rows.vertex_count);
  }
}

inline void take_velocities(const PointRows& rows) {
  const float* points = reinterpret_cast<const float*>(rows.points);
  const float* before = reinterpret_cast<const float*>(rows.before);
  float* velocity = reinterpret_cast<float*>(rows.velocity);
  const WideFloat<16> zero = broadcast<16>(0.0f), rate = broadcast<16>(1.0f / rows.h);
  for (std::size_t four = 0; 4 * four < rows.vertex_count; ++four) {
    const WideFloat<16> p = load_vertices(points, four, rows.vertex_count);
    const WideFloat<16> moved = p - load_vertices(before, four, rows.vertex_count);
    const WideInt<16> held = reorder<kAllW>(p) <= zero;
    const WideFloat<16> v = select(held | load_int<16>(kMassLanes), zero, moved * rate);
    store_vertices(v, velocity, four, rows.vertex_count);
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
