// The coarse-hull solver's inner loops, one instruction set a file. All instruction sets give the same bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/simd_level.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/kernels/hull/dense_rows.hpp"

namespace fascicle::muscle {

// out = matrix * in, or out += matrix * in, for x, y and z at once; inverse_mass is not read, and not written. Each
// row's sum runs over its columns in order. `in` and `out` do not overlap.
struct ProductJob {
  const DenseRows* matrix = nullptr;
  std::span<const SurfacePoint> in;  // columns
  std::span<SurfacePoint> out;       // rows
  bool add = false;
};

// 16 matrices of 3 x 3 side by side: value[3 * row + column][lane].
struct alignas(64) MatrixPack {
  std::array<std::array<float, kPanelRows>, 9> value;
};

// The rotations that come nearest to matrices S: those that maximise sum R_ij S_ij (Mueller et al. 2016, but to the
// second order, see fit_rotations.hpp: from a start within 20 degrees two iterations reach the accuracy of floats, from
// anywhere half a dozen). Flat and mirrored S give rotations, too; S that is zero (below 10^-15), or no number, leaves
// its R alone. A start that is no rotation counts as the identity. A lane stops when it has arrived.
struct RotationJob {
  std::span<const MatrixPack> matrices;  // S
  std::span<MatrixPack> rotations;       // in: where to start, a rotation; out: the nearest
  std::uint32_t iterations = 4;
};

// A sparse matrix L with L L^T = A, its rows and columns permuted, for the full mesh: columns with their diagonal
// first, and all of their fill (none dropped: columns in a row that share their rows are told by their lengths).
struct SparseFactor {
  std::uint32_t size = 0;
  std::vector<std::uint32_t> first;     // by column, and one more
  std::vector<std::uint32_t> row;       // rising in a column
  std::vector<float> value;             // the diagonal's are inverse
  std::vector<std::uint32_t> order;     // the unknown that each row of L belongs to
};
// A x = b for eight right-hand sides at once, in place, in L's order.
struct alignas(32) EightColumns {
  std::array<float, 8> value{};
};
struct FactorJob {
  const SparseFactor* factor = nullptr;
  std::span<EightColumns> x;            // in: b; out: x
};

struct HullKernels {
  void (*multiply)(const ProductJob& job);
  void (*fit_rotations)(const RotationJob& job);
  void (*solve_factor)(const FactorJob& job);
};

// Of the level or the best below it that the processor has.
const HullKernels& hull_kernels(SimdLevel level);

}  // namespace fascicle::muscle
