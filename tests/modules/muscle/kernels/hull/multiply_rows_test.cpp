// Dense products: all instruction sets give the same bits, the plain code agrees, whole numbers are exact.
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "modules/muscle/kernels/hull/hull_reference.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::levels;
using test::same_bits;

struct Product {
  DenseRows matrix;
  AlignedVector<SurfacePoint> in, out;
};

Product make_product(std::uint32_t rows, std::uint32_t columns) {
  std::mt19937 random(rows + 1000 * columns);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  Product product{make_dense_rows(rows, columns), AlignedVector<SurfacePoint>(columns),
                  AlignedVector<SurfacePoint>(rows)};
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) product.matrix.values[product.matrix.index(r, c)] = any(random);
  }
  for (SurfacePoint& p : product.in) p = {any(random), any(random), any(random), any(random)};
  for (SurfacePoint& p : product.out) p = {any(random), any(random), any(random), any(random)};
  return product;
}

AlignedVector<SurfacePoint> multiply(const HullKernels& kernels, const Product& product, bool add) {
  AlignedVector<SurfacePoint> out = product.out;
  kernels.multiply({.matrix = &product.matrix, .in = product.in, .out = out, .add = add});
  return out;
}

TEST(HullProducts, OfNothingChangeNothing) {
  for (const SimdLevel level : levels()) {
    hull_kernels(level).multiply({.in = {}, .out = {}});
    EXPECT_TRUE(multiply(hull_kernels(level), make_product(0, 5), false).empty());
    const Product product = make_product(21, 0);
    EXPECT_TRUE(same_bits(multiply(hull_kernels(level), product, true), product.out));
    for (const SurfacePoint& p : multiply(hull_kernels(level), product, false)) {
      EXPECT_EQ(p.x, 0.0f);
      EXPECT_EQ(p.z, 0.0f);
    }
  }
}

TEST(HullProducts, AgreeWithThePlainCodeAndHaveTheSameBitsOnAllInstructionSets) {
  for (const auto& [rows, columns] : {std::pair{1u, 1u}, {5u, 2u}, {16u, 7u}, {17u, 33u}, {47u, 1u}, {48u, 64u},
                                      {64u, 3u}, {79u, 20u}, {81u, 5u}, {130u, 301u}, {300u, 90u}}) {
    const Product product = make_product(rows, columns);
    for (const bool add : {false, true}) {
      const auto first = multiply(hull_kernels(SimdLevel::kPortable), product, add);
      const auto plain = multiply(hull_reference_kernels(), product, add);
      for (const SimdLevel level : levels()) {
        EXPECT_TRUE(same_bits(multiply(hull_kernels(level), product, add), first)) << rows << " " << to_string(level);
      }
      for (std::uint32_t r = 0; r < rows; ++r) {
        const float bound = 2.0e-7f * static_cast<float>(columns + 1);
        ASSERT_NEAR(first[r].x, plain[r].x, bound) << rows << " " << columns << " " << r;
        ASSERT_NEAR(first[r].y, plain[r].y, bound) << rows << " " << columns << " " << r;
        ASSERT_NEAR(first[r].z, plain[r].z, bound) << rows << " " << columns << " " << r;
        ASSERT_EQ(first[r].inverse_mass, product.out[r].inverse_mass);
      }
    }
  }
}

TEST(HullProducts, OfWholeNumbersAreExact) {
  DenseRows matrix = make_dense_rows(18, 3);
  for (std::uint32_t r = 0; r < 18; ++r) {
    for (std::uint32_t c = 0; c < 3; ++c) matrix.values[matrix.index(r, c)] = static_cast<float>(10 * r + c);
  }
  const AlignedVector<SurfacePoint> in = {{1, 0, -1, 9}, {2, 1, 0, 9}, {3, 0, 1, 9}};
  for (const SimdLevel level : levels()) {
    AlignedVector<SurfacePoint> out(18, {1, 2, 3, 4});
    hull_kernels(level).multiply({.matrix = &matrix, .in = in, .out = out, .add = true});
    for (std::uint32_t r = 0; r < 18; ++r) {
      const float row = static_cast<float>(10 * r);
      EXPECT_EQ(out[r].x, 1 + 6 * row + 8);
      EXPECT_EQ(out[r].y, 2 + row + 1);
      EXPECT_EQ(out[r].z, 3 + 2);
      EXPECT_EQ(out[r].inverse_mass, 4.0f);
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
