// The coarse hull's kernels: all instruction sets give the same bits; products, nearest rotations and substitution
// agree with the plain code, with cases whose answer is known and with Eigen.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <gtest/gtest.h>

#include "modules/muscle/kernels/hull/hull_reference.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::levels;
using test::same_bits;

// --- Products.

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

// --- Rotations.

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d get(const std::vector<MatrixPack>& packs, std::size_t i) {
  Matrix3d m;
  for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = packs[i / 16].value[static_cast<std::size_t>(k)][i % 16];
  return m;
}
void set(std::vector<MatrixPack>& packs, std::size_t i, const Matrix3d& m) {
  if (packs.size() <= i / 16) packs.resize(i / 16 + 1);
  for (int k = 0; k < 9; ++k) {
    packs[i / 16].value[static_cast<std::size_t>(k)][i % 16] = static_cast<float>(m(k / 3, k % 3));
  }
}

struct RandomTurns {
  std::mt19937 random{7};
  std::normal_distribution<double> normal;
  Matrix3d any() {
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  }
  Matrix3d by(double angle) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Eigen::AngleAxisd(angle, Vector3d(x, y, z).normalized()).toRotationMatrix();
  }
};

// The greatest sum R_ij S_ij of all rotations, and where it is.
struct Nearest {
  Matrix3d rotation;
  double value;
};
Nearest find_nearest(const Matrix3d& s) {
  const Eigen::JacobiSVD<Matrix3d> svd(s, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  return {svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), svd.singularValues().dot(signs)};
}

double away_from_rotation(const Matrix3d& r) {
  return std::max((r * r.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff(), std::abs(r.determinant() - 1.0));
}

std::vector<MatrixPack> fit(const HullKernels& kernels, const std::vector<MatrixPack>& matrices,
                            std::vector<MatrixPack> rotations, std::uint32_t iterations) {
  kernels.fit_rotations({.matrices = matrices, .rotations = rotations, .iterations = iterations});
  return rotations;
}
const HullKernels& best() { return hull_kernels(detect_simd()); }

constexpr std::size_t kCount = 640;

// Matrices with about these singular values (the last negative: mirrored), and rotations that far from the nearest.
struct Fits {
  std::vector<MatrixPack> matrices, starts;
  std::vector<Nearest> nearest;
};
Fits make_fits(const Vector3d& values, double angle, double scale = 1.0) {
  RandomTurns turns;
  Fits fits;
  for (std::size_t i = 0; i < kCount; ++i) {
    Vector3d sigma = scale * values;
    for (double& value : sigma) value *= std::exp(0.1 * turns.normal(turns.random));
    set(fits.matrices, i, turns.any() * sigma.asDiagonal() * turns.any());
    fits.nearest.push_back(find_nearest(get(fits.matrices, i)));
    set(fits.starts, i, turns.by(angle) * fits.nearest.back().rotation);
  }
  return fits;
}
double furthest(const Fits& fits, const std::vector<MatrixPack>& rotations) {
  double result = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    result = std::max(result, (get(rotations, i) - fits.nearest[i].rotation).norm());
    EXPECT_LT(away_from_rotation(get(rotations, i)), 7.0e-7);
  }
  return result;
}
// How much less than the greatest sum R_ij S_ij is, as a part of |S|.
double greatest_loss(const Fits& fits, const std::vector<MatrixPack>& rotations) {
  double result = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Matrix3d r = get(rotations, i), s = get(fits.matrices, i);
    result = std::max(result, (fits.nearest[i].value - r.cwiseProduct(s).sum()) / s.norm());
    EXPECT_LT(away_from_rotation(r), 7.0e-7);
  }
  return result;
}

const Vector3d kRound(1.0, 0.9, 0.8), kFlat(1.0, 0.8, 0.0), kThin(1.0, 0.2, 0.01), kMirrored(1.0, 0.8, -0.1);

TEST(HullRotations, OfNothingChangeNothing) {
  for (const SimdLevel level : levels()) hull_kernels(level).fit_rotations({.matrices = {}, .rotations = {}});
  const Fits fits = make_fits(kRound, 0.1);
  EXPECT_LT(greatest_loss(fits, fit(best(), fits.matrices, fits.starts, 0)), 0.05);
}

// Lanes without a direction keep theirs, to the bit, and their neighbours do not notice.
TEST(HullRotations, LeaveLanesAloneWhoseMatrixIsZeroOrNoNumber) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::nan("");
  Fits fits = make_fits(kRound, 0.3);
  const std::vector<MatrixPack> sound = fit(best(), fits.matrices, fits.starts, 4);
  for (std::size_t i = 0; i < kCount; i += 5) {
    Matrix3d broken = get(fits.matrices, i);
    if (i % 3 == 0) broken.setZero();
    else broken(static_cast<int>(i / 5) % 3, 1) = i % 2 == 0 ? kNan : kInfinity;
    set(fits.matrices, i, broken);
  }
  for (const SimdLevel level : levels()) {
    const std::vector<MatrixPack> fitted = fit(hull_kernels(level), fits.matrices, fits.starts, 4);
    for (std::size_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(get(fitted, i), get(i % 5 == 0 ? fits.starts : sound, i)) << i << " " << to_string(level);
    }
  }
}

TEST(HullRotations, StartFromTheIdentityWhereTheStartIsNone) {
  Fits fits = make_fits(kRound, 0.3);
  for (std::size_t i = 0; i < kCount; ++i) set(fits.starts, i, Matrix3d::Constant(i % 2 == 0 ? 0.0 : std::nan("")));
  EXPECT_LT(furthest(fits, fit(best(), fits.matrices, fits.starts, 8)), 2.0e-6);
}

TEST(HullRotations, OfARotationTimesAnEvenMatrixIsTheRotation) {
  std::vector<MatrixPack> matrices, starts;
  RandomTurns turns;
  std::vector<Matrix3d> expected;
  for (std::size_t i = 0; i < 16; ++i) {
    expected.push_back(turns.by(0.1 * static_cast<double>(i)));
    const Matrix3d axes = turns.any();
    set(matrices, i, expected.back() * axes * Vector3d(3.0, 2.0, 1.0).asDiagonal() * axes.transpose());
    set(starts, i, Matrix3d::Identity());
  }
  const std::vector<MatrixPack> fitted = fit(best(), matrices, starts, 4);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_LT((get(fitted, i) - expected[i]).norm(), 1.0e-6) << i;
}

TEST(HullRotations, TakeTwoTurnsToTheAccuracyOfFloatsFromNearby) {
  for (const Vector3d& values : {kRound, kFlat, kMirrored}) {
    const Fits fits = make_fits(values, 0.3);
    EXPECT_LT(furthest(fits, fit(best(), fits.matrices, fits.starts, 1)), 2.0e-2);
    EXPECT_LT(furthest(fits, fit(best(), fits.matrices, fits.starts, 2)), 2.0e-6);
  }
  const Fits fits = make_fits(kThin, 0.05);
  EXPECT_LT(furthest(fits, fit(best(), fits.matrices, fits.starts, 2)), 2.0e-6);
}

TEST(HullRotations, FindTheGreatestSumFromAnywhere) {
  for (const Vector3d& values : {kRound, kFlat, kThin, kMirrored, Vector3d(1.0, 0.0, 0.0)}) {
    for (const double angle : {0.5 * std::numbers::pi, 2.0, 3.0, std::numbers::pi}) {
      const Fits fits = make_fits(values, angle);
      EXPECT_LT(greatest_loss(fits, fit(best(), fits.matrices, fits.starts, 10)), 2.0e-6)
          << values.transpose() << " from " << angle;
    }
  }
}

// Turned by 180 degrees about one of its own axes, a matrix has no slope.
TEST(HullRotations, LeaveSaddlesAtOnce) {
  for (const Vector3d& values : {kRound, kFlat, kThin, kMirrored}) {
    Fits fits = make_fits(values, 0.0);
    for (std::size_t i = 0; i < kCount; ++i) {
      const Eigen::JacobiSVD<Matrix3d> svd(get(fits.matrices, i), Eigen::ComputeFullU);
      const Vector3d axis = svd.matrixU().col(static_cast<int>(i % 3));
      set(fits.starts, i, Eigen::AngleAxisd(std::numbers::pi, axis).toRotationMatrix() * fits.nearest[i].rotation);
    }
    EXPECT_LT(greatest_loss(fits, fit(best(), fits.matrices, fits.starts, 6)), 2.0e-6) << values.transpose();
  }
  std::vector<MatrixPack> matrices, starts;
  for (std::size_t i = 0; i < 16; ++i) {
    const Vector3d sides(i % 3 == 0 ? 1.0 : -1.0, i % 3 == 1 ? 1.0 : -1.0, i % 3 == 2 ? 1.0 : -1.0);
    set(matrices, i, Vector3d(3.0, 2.0, i % 2 == 0 ? 1.0 : 0.0).asDiagonal());
    set(starts, i, sides.asDiagonal());
  }
  const std::vector<MatrixPack> fitted = fit(best(), matrices, starts, 6);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_LT((get(fitted, i) - Matrix3d::Identity()).norm(), 1.0e-6) << i;
}

TEST(HullRotations, DoNotDependOnTheMatrixsScale) {
  for (const double scale : {1.0e-12, 1.0e-6, 1.0e6, 1.0e12}) {
    const Fits fits = make_fits(kRound, 0.3, scale);
    EXPECT_LT(furthest(fits, fit(best(), fits.matrices, fits.starts, 3)), 2.0e-6) << scale;
  }
}

TEST(HullRotations, StayRotationsOverThousandsOfFrames) {
  RandomTurns turns;
  std::vector<MatrixPack> matrices, rotations;
  for (std::size_t i = 0; i < 16; ++i) set(rotations, i, Matrix3d::Identity());
  const Matrix3d turn = Eigen::AngleAxisd(0.05, Vector3d(0.36, 0.48, 0.8)).toRotationMatrix();
  Matrix3d now = Matrix3d::Identity();
  for (int frame = 0; frame < 5000; ++frame) {
    now = turn * now;
    for (std::size_t i = 0; i < 16; ++i) set(matrices, i, now * Vector3d(1.0, 0.7, 0.1).asDiagonal());
    rotations = fit(best(), matrices, rotations, 2);
  }
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_LT(away_from_rotation(get(rotations, i)), 7.0e-7);
    EXPECT_LT((get(rotations, i) - now).norm(), 2.0e-6);
  }
}

TEST(HullRotations, AgreeWithThePlainCodeAndHaveTheSameBitsOnAllInstructionSets) {
  for (const Vector3d& values : {kRound, kThin, kMirrored}) {
    for (const double angle : {0.1, 3.0}) {
      const Fits fits = make_fits(values, angle);
      const auto plain = fit(hull_reference_kernels(), fits.matrices, fits.starts, 1);
      EXPECT_LT(furthest(fits, plain), 2.0e-6);
      for (const std::uint32_t iterations : {1u, 3u, 10u}) {
        const auto first = fit(hull_kernels(SimdLevel::kPortable), fits.matrices, fits.starts, iterations);
        for (const SimdLevel level : levels()) {
          EXPECT_TRUE(same_bits(fit(hull_kernels(level), fits.matrices, fits.starts, iterations), first))
              << to_string(level) << " " << iterations;
        }
        if (iterations < 10) continue;
        for (std::size_t i = 0; i < kCount; ++i) ASSERT_LT((get(first, i) - get(plain, i)).norm(), 4.0e-6) << i;
      }
    }
  }
}

// --- Substitution.

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
