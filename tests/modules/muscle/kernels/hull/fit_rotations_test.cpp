// Nearest rotations: analytic cases, matrices of all kinds against a singular value decomposition from near and far,
// lanes without an answer; all instruction sets give the same bits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "modules/muscle/kernels/hull/hull_reference.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::levels;
using test::same_bits;

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

}  // namespace
}  // namespace fascicle::muscle
