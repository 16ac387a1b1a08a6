// What the coarse hull's kernels read and write, as bare pointers: their source files call no inline function of
// another library, not even a span's (see engine/math/wide_float.hpp). hull_kernels.cpp fills these in.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fascicle::muscle {

struct ProductRows {
  const float* values = nullptr;  // [panel][column][16]
  std::size_t rows = 0, columns = 0;
  const float* in = nullptr;      // four floats a column, the last not read
  float* out = nullptr;           // four floats a row, the last not written
  bool add = false;
};

struct RotationPacks {
  const float* matrices = nullptr;  // [pack][3 * row + column][16]
  float* rotations = nullptr;       // likewise
  std::size_t pack_count = 0;
  std::size_t iterations = 0;
};

struct FactorColumns {
  std::size_t size = 0;
  const std::uint32_t* first = nullptr;
  const std::uint32_t* row = nullptr;
  const float* value = nullptr;
  float* x = nullptr;  // eight floats a row
};

struct HullKernelTable {
  void (*multiply)(const ProductRows& rows);
  void (*fit_rotations)(const RotationPacks& packs);
  void (*solve_factor)(const FactorColumns& columns);
};

}  // namespace fascicle::muscle
