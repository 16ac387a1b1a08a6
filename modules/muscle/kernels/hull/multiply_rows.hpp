// A dense matrix times three columns: every entry is loaded once, for x, y and z.
// For the kernels' source files only (see engine/math/wide_float.hpp).
//
// A panel's 16 rows have three running sums, each of which waits for its last addition; several panels side by side
// hide that, as many as there are registers for. Then it is the caches that decide.
#pragma once

#include "engine/math/wide_float.hpp"
#include "modules/muscle/kernels/hull/dense_rows.hpp"
#include "modules/muscle/kernels/hull/hull_kernel_data.hpp"
#include "modules/muscle/kernels/hull/repeat_value.hpp"

namespace fascicle::muscle::FASCICLE_ISA {

inline constexpr int kPanelsAtOnce = kNativeLanes == 16 ? 8 : 1;
inline constexpr int kNextRows[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// Sums of up to 16 rows, written or added.
FASCICLE_INLINE void write_rows(WideVector<16> sum, std::size_t row_count, bool add, float* out) {
  if (row_count == kPanelRows) {
    const WideRecord<16> old = load_records<16>(out, kNextRows);
    if (add) sum = WideVector<16>{old.x, old.y, old.z} + sum;
    store_records<false>(sum.x, sum.y, sum.z, old.w, out);
    return;
  }
  float last[3][kPanelRows];
  store(sum.x, last[0]);
  store(sum.y, last[1]);
  store(sum.z, last[2]);
  for (std::size_t i = 0; i < row_count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[4 * i + k] = add ? out[4 * i + k] + last[k][i] : last[k][i];
  }
}

template <int kCount>
FASCICLE_INLINE void multiply_panels(const ProductRows& rows, std::size_t panel) {
  WideVector<16> sum[kCount];
  for (int p = 0; p < kCount; ++p) sum[p] = {broadcast<16>(0.0f), broadcast<16>(0.0f), broadcast<16>(0.0f)};
  const float* const values = rows.values + panel * rows.columns * kPanelRows;
  const std::size_t stride = rows.columns * kPanelRows;
  for (std::size_t c = 0; c < rows.columns; ++c) {
    const float* const in = rows.in + 4 * c;
    const WideVector<16> place{repeat<16>(in), repeat<16>(in + 1), repeat<16>(in + 2)};
    for (int p = 0; p < kCount; ++p) {
      sum[p] = sum[p] + load<16>(values + static_cast<std::size_t>(p) * stride + c * kPanelRows) * place;
    }
  }
  for (int p = 0; p < kCount; ++p) {
    const std::size_t first = (panel + static_cast<std::size_t>(p)) * kPanelRows;
    const std::size_t left = rows.rows - first;
    write_rows(sum[p], left < kPanelRows ? left : kPanelRows, rows.add, rows.out + 4 * first);
  }
}

// All panels from `panel`, kCount at a time, the rest by fewer.
template <int kCount>
FASCICLE_INLINE void multiply_from(const ProductRows& rows, std::size_t panel) {
  const std::size_t panels = (rows.rows + kPanelRows - 1) / kPanelRows;
  for (; panel + kCount <= panels; panel += kCount) multiply_panels<kCount>(rows, panel);
  if constexpr (kCount > 1) multiply_from<kCount / 2>(rows, panel);
}

inline void multiply_rows(const ProductRows& rows) { multiply_from<kPanelsAtOnce>(rows, 0); }

}  // namespace fascicle::muscle::FASCICLE_ISA
