// Substitution by a sparse factor: a known one, Eigen's of a grid; all instruction sets give the same bits.
#include <cmath>
#include <random>

#include <Eigen/Sparse>
#include <gtest/gtest.h>

#include "modules/muscle/kernels/hull/hull_reference.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::levels;
using test::same_bits;

using Columns = std::vector<EightColumns>;
using SparseMatrix = Eigen::SparseMatrix<double>;

SparseFactor make_factor(const Eigen::SimplicialLLT<SparseMatrix>& llt) {
  const SparseMatrix l = llt.matrixL();
  SparseFactor factor;
  factor.size = static_cast<std::uint32_t>(l.rows());
  factor.order.resize(factor.size);
  for (int i = 0; i < l.rows(); ++i) {
    factor.order[static_cast<std::size_t>(llt.permutationP().indices()[i])] = static_cast<std::uint32_t>(i);
  }
  for (int j = 0; j < l.cols(); ++j) {
    factor.first.push_back(static_cast<std::uint32_t>(factor.row.size()));
    for (SparseMatrix::InnerIterator entry(l, j); entry; ++entry) {
      factor.row.push_back(static_cast<std::uint32_t>(entry.row()));
      factor.value.push_back(static_cast<float>(entry.row() == j ? 1.0 / entry.value() : entry.value()));
    }
  }
  factor.first.push_back(static_cast<std::uint32_t>(factor.row.size()));
  return factor;
}

// Neighbours of a grid's points and of their neighbours, coupled at random: like a Laplacian times itself.
SparseMatrix make_grid(int side) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> weight(0.5, 1.5);
  std::vector<Eigen::Triplet<double>> entries;
  const int count = side * side;
  std::vector<double> sums(static_cast<std::size_t>(count), 0.0);
  const auto couple = [&](int a, int b) {
    const double w = -weight(random);
    entries.insert(entries.end(), {{a, b, w}, {b, a, w}});
    sums[static_cast<std::size_t>(a)] -= w;
    sums[static_cast<std::size_t>(b)] -= w;
  };
  for (int i = 0; i < count; ++i) {
    if (i % side + 1 < side) couple(i, i + 1);
    if (i % side + 2 < side) couple(i, i + 2);
    if (i + side < count) couple(i, i + side);
    if (i + 2 * side < count) couple(i, i + 2 * side);
  }
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 0.1 + sums[static_cast<std::size_t>(i)]);
  SparseMatrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Columns solve(const HullKernels& kernels, const SparseFactor& factor, Columns x) {
  kernels.solve_factor({.factor = &factor, .x = x});
  return x;
}

TEST(HullFactor, OfNothingChangesNothing) {
  for (const SimdLevel level : levels()) {
    hull_kernels(level).solve_factor({.x = {}});
    EXPECT_TRUE(solve(hull_kernels(level), {.size = 0, .first = {0}, .row = {}, .value = {}, .order = {}}, {}).empty());
  }
}

TEST(HullFactor, SolvesAKnownMatrix) {
  // L = (2 0 0; 1 4 0; 3 5 8), so that A (1, 2, 3) = L L^T (1, 2, 3) = L (13, 23, 24).
  const SparseFactor factor{3, {0, 3, 5, 6}, {0, 1, 2, 1, 2, 2}, {0.5f, 1, 3, 0.25f, 5, 0.125f}, {0, 1, 2}};
  for (const SimdLevel level : levels()) {
    Columns x(3);
    for (std::size_t k = 0; k < 8; ++k) {
      const float scale = std::exp2(static_cast<float>(k));
      x[0].value[k] = scale * 26;
      x[1].value[k] = scale * 105;
      x[2].value[k] = scale * 346;
    }
    x = solve(hull_kernels(level), factor, x);
    for (std::size_t k = 0; k < 8; ++k) {
      const float scale = std::exp2(static_cast<float>(k));
      for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(x[i].value[k], scale * static_cast<float>(i + 1));
    }
  }
}

// Columns that continue each other, and columns that only seem to: the next column is shorter by one, but not next.
TEST(HullFactor, TellsColumnsThatContinueEachOtherFromOthers) {
  const SparseFactor apart{5, {0, 3, 5, 7, 9, 10}, {0, 2, 3, 1, 3, 2, 3, 3, 4, 4},
                           {1, 2, 3, 1, 4, 1, 5, 1, 6, 1}, {0, 1, 2, 3, 4}};
  Columns b(5);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t k = 0; k < 8; ++k) b[i].value[k] = static_cast<float>(i * k + 1);
  }
  const Columns plain = solve(hull_reference_kernels(), apart, b);
  for (const SimdLevel level : levels()) EXPECT_TRUE(same_bits(solve(hull_kernels(level), apart, b), plain));
}

TEST(HullFactor, AgreesWithEigenAndHasTheSameBitsOnAllInstructionSets) {
  for (const int side : {1, 2, 3, 10, 33}) {
    const SparseMatrix a = make_grid(side);
    const Eigen::SimplicialLLT<SparseMatrix> llt(a);
    ASSERT_EQ(llt.info(), Eigen::Success);
    const SparseFactor factor = make_factor(llt);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const Eigen::MatrixXd expected = Eigen::MatrixXd::NullaryExpr(a.rows(), 8, [&] { return any(random); });
    const Eigen::MatrixXd right = a * expected;
    Columns b(factor.size);
    for (std::size_t i = 0; i < factor.size; ++i) {
      for (std::size_t k = 0; k < 8; ++k) {
        b[i].value[k] = static_cast<float>(right(factor.order[i], static_cast<int>(k)));
      }
    }
    const Columns x = solve(hull_kernels(SimdLevel::kPortable), factor, b);
    const Columns plain = solve(hull_reference_kernels(), factor, b);
    for (std::size_t i = 0; i < factor.size; ++i) {
      for (std::size_t k = 0; k < 8; ++k) {
        ASSERT_NEAR(x[i].value[k], expected(factor.order[i], static_cast<int>(k)), 2.0e-4) << side << " " << i;
        ASSERT_NEAR(x[i].value[k], plain[i].value[k], 2.0e-4) << side << " " << i;
      }
    }
    for (const SimdLevel level : levels()) EXPECT_TRUE(same_bits(solve(hull_kernels(level), factor, b), x)) << side;
  }
}

}  // namespace
}  // namespace fascicle::muscle
