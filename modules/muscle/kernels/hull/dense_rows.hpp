// A dense matrix as the coarse hull's kernels read it, once per product: panels of 16 rows, in each column after column,
// so that 16 rows are multiplied side by side and every entry is loaded once.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/math/aligned_vector.hpp"

namespace fascicle::muscle {

inline constexpr std::size_t kPanelRows = 16;

struct DenseRows {
  std::uint32_t rows = 0, columns = 0;
  AlignedVector<float> values;  // [panel][column][16]; spare rows are zero

  std::size_t panels() const { return (rows + kPanelRows - 1) / kPanelRows; }
  std::size_t index(std::uint32_t row, std::uint32_t column) const {
    return (row / kPanelRows * columns + column) * kPanelRows + row % kPanelRows;
  }
};

inline DenseRows make_dense_rows(std::uint32_t rows, std::uint32_t columns) {
  DenseRows matrix{rows, columns, {}};
  matrix.values.assign(matrix.panels() * columns * kPanelRows, 0.0f);
  return matrix;
}

}  // namespace fascicle::muscle
