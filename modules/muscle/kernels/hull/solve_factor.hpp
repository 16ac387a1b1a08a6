// L L^T x = b by substitution, forwards and backwards, for eight right-hand sides side by side.
// For the kernels' source files only (see engine/math/wide_float.hpp).
//
// Columns of a Cholesky factor whose next column has the same rows but one are taken four at a time (supernodes, found
// on the way: the first row below column j's diagonal is j + 1, and column j + 1 is shorter by one; with all of its
// fill, column j + 1 then has just the rest of column j's rows). Their common rows' unknowns are loaded and stored once
// and not four times, and the row numbers are read once. Columns are too short for the processor to see them coming:
// each asks for the values of the next ones ahead of time.
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/hull/hull_kernel_data.hpp"
#include "modules/muscle/kernels/hull/repeat_value.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

inline constexpr std::size_t kColumnsAtOnce = 4;

// Whether column j + 1 has column j's rows but the first.
FASCICLE_INLINE bool continues(const FactorColumns& l, std::size_t j) {
  const std::size_t begin = l.first[j], end = l.first[j + 1];
  return j + 1 < l.size && end - begin > 1 && l.row[begin + 1] == j + 1 && l.first[j + 2] - end == end - begin - 1;
}

FASCICLE_INLINE WideFloat<8> load_row(const float* x, std::size_t row) { return load<8>(x + 8 * row); }

// Asks for the value so many places on, or, with a negative number, back; it may lie outside of all values.
FASCICLE_INLINE void fetch(const float* value, std::ptrdiff_t places) {
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(value) + static_cast<std::uintptr_t>(4 * places);
  _mm_prefetch(reinterpret_cast<const char*>(address), _MM_HINT_T0);
}

// kCount columns from j: their entries of the rows that they have in common begin at value[.], with numbers row[.].
template <std::size_t kCount>
struct Common {
  const float* value[kCount];
  const std::uint32_t* row;
  std::size_t count;
};
template <std::size_t kCount>
FASCICLE_INLINE Common<kCount> common_rows(const FactorColumns& l, std::size_t j) {
  Common<kCount> common;
  for (std::size_t k = 0; k < kCount; ++k) common.value[k] = l.value + l.first[j + k] + (kCount - k);
  const std::size_t last = j + kCount - 1;
  common.row = l.row + l.first[last] + 1;
  common.count = l.first[last + 1] - l.first[last] - 1;
  return common;
}

template <std::size_t kCount>
FASCICLE_INLINE void go_forward(const FactorColumns& l, std::size_t j) {
  WideFloat<8> x[kCount];
  for (std::size_t k = 0; k < kCount; ++k) {
    x[k] = load_row(l.x, j + k);
    for (std::size_t i = 0; i < k; ++i) x[k] = x[k] - repeat<8>(l.value + l.first[j + i] + (k - i)) * x[i];
    x[k] = repeat<8>(l.value + l.first[j + k]) * x[k];
    store(x[k], l.x + 8 * (j + k));
  }
  const Common<kCount> common = common_rows<kCount>(l, j);
  const float* const ahead = l.value + l.first[j + kCount];
  for (std::size_t e = 0; e < common.count; ++e) {
    fetch(ahead, static_cast<std::ptrdiff_t>(kCount * e));
    float* const to = l.x + 8 * static_cast<std::size_t>(common.row[e]);
    WideFloat<8> changed = load<8>(to);
    for (std::size_t k = 0; k < kCount; ++k) changed = changed - repeat<8>(common.value[k] + e) * x[k];
    store(changed, to);
  }
}

// Few columns have several sums each, of every other entry: one alone would wait for its additions.
template <std::size_t kCount>
FASCICLE_INLINE void go_back(const FactorColumns& l, std::size_t j) {
  constexpr std::size_t kSums = kColumnsAtOnce / kCount;
  WideFloat<8> sum[kCount][kSums];
  for (std::size_t k = 0; k < kCount; ++k) {
    for (std::size_t s = 0; s < kSums; ++s) sum[k][s] = broadcast<8>(0.0f);
  }
  const Common<kCount> common = common_rows<kCount>(l, j);
  std::size_t e = 0;
  const float* const behind = l.value + l.first[j];
  for (; e + kSums <= common.count; e += kSums) {
    fetch(behind, -static_cast<std::ptrdiff_t>(kCount * (e + kSums)));
    for (std::size_t s = 0; s < kSums; ++s) {
      const WideFloat<8> x = load_row(l.x, common.row[e + s]);
      for (std::size_t k = 0; k < kCount; ++k) sum[k][s] = sum[k][s] + repeat<8>(common.value[k] + e + s) * x;
    }
  }
  for (; e < common.count; ++e) {
    const WideFloat<8> x = load_row(l.x, common.row[e]);
    for (std::size_t k = 0; k < kCount; ++k) sum[k][0] = sum[k][0] + repeat<8>(common.value[k] + e) * x;
  }
  WideFloat<8> x[kCount];
  for (std::size_t k = kCount; k-- > 0;) {
    const std::size_t column = j + k;
    for (std::size_t s = 1; s < kSums; ++s) sum[k][0] = sum[k][0] + sum[k][s];
    x[k] = load_row(l.x, column) - sum[k][0];
    for (std::size_t i = k + 1; i < kCount; ++i) x[k] = x[k] - repeat<8>(l.value + l.first[column] + (i - k)) * x[i];
    x[k] = repeat<8>(l.value + l.first[column]) * x[k];
    store(x[k], l.x + 8 * column);
  }
}

inline void solve_factor(const FactorColumns& l) {
  for (std::size_t j = 0; j < l.size;) {
    std::size_t count = 1;
    while (count < kColumnsAtOnce && continues(l, j + count - 1)) ++count;
    switch (count) {
      case 1: go_forward<1>(l, j); break;
      case 2: go_forward<2>(l, j); break;
      case 3: go_forward<3>(l, j); break;
      default: go_forward<4>(l, j); break;
    }
    j += count;
  }
  for (std::size_t end = l.size; end > 0;) {
    std::size_t count = 1;
    while (count < kColumnsAtOnce && count < end &&
           continues(l, end - count - 1)) {
      ++count;
    }
    const std::size_t j = end - count;
    switch (count) {
      case 1: go_back<1>(l, j); break;
      case 2: go_back<2>(l, j); break;
      case 3: go_back<3>(l, j); break;
      default: go_back<4>(l, j); break;
    }
    end = j;
  }
}

}  // namespace fascicle::muscle::FASCICLE_ISA
