#include "modules/muscle/kernels/hull/hull_reference.hpp"

#include <array>
#include <cmath>

namespace fascicle::muscle {
namespace {

void multiply(const ProductJob& job) {
  if (job.matrix == nullptr) return;
  const DenseRows& matrix = *job.matrix;
  for (std::uint32_t r = 0; r < matrix.rows; ++r) {
    std::array<double, 3> sum{};
    for (std::uint32_t c = 0; c < matrix.columns; ++c) {
      const double entry = matrix.values[matrix.index(r, c)];
      sum[0] += entry * job.in[c].x;
      sum[1] += entry * job.in[c].y;
      sum[2] += entry * job.in[c].z;
    }
    SurfacePoint& out = job.out[r];
    const std::array<double, 3> old = job.add ? std::array<double, 3>{out.x, out.y, out.z} : std::array<double, 3>{};
    out.x = static_cast<float>(old[0] + sum[0]);
    out.y = static_cast<float>(old[1] + sum[1]);
    out.z = static_cast<float>(old[2] + sum[2]);
  }
}

using Quaternion = std::array<double, 4>;  // w x y z
using Matrix4 = std::array<std::array<double, 4>, 4>;

// The unit eigenvector of a symmetric matrix's greatest eigenvalue, by Jacobi's rotations.
Quaternion find_greatest_eigenvector(Matrix4 n) {
  Matrix4 vectors{};
  for (std::size_t i = 0; i < 4; ++i) vectors[i][i] = 1.0;
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t q = p + 1; q < 4; ++q) {
        if (std::abs(n[p][q]) <= 1.0e-17 * (std::abs(n[p][p]) + std::abs(n[q][q]))) continue;
        const double angle = 0.5 * std::atan2(2.0 * n[p][q], n[q][q] - n[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::size_t k = 0; k < 4; ++k) {
          const double a = n[k][p], b = n[k][q];
          n[k][p] = c * a - s * b;
          n[k][q] = s * a + c * b;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double a = n[p][k], b = n[q][k], v = vectors[k][p], w = vectors[k][q];
          n[p][k] = c * a - s * b;
          n[q][k] = s * a + c * b;
          vectors[k][p] = c * v - s * w;
          vectors[k][q] = s * v + c * w;
        }
      }
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < 4; ++i) best = n[i][i] > n[best][best] ? i : best;
  return {vectors[0][best], vectors[1][best], vectors[2][best], vectors[3][best]};
}

void fit_lane(const MatrixPack& matrix, std::size_t lane, MatrixPack& rotation) {
  std::array<double, 9> s;  // by rows
  double square = 0.0;
  for (std::size_t i = 0; i < 9; ++i) {
    s[i] = matrix.value[i][lane];
    square += s[i] * s[i];
  }
  if (!(square > 1.0e-30) || !(square < 1.0e30)) return;
  const auto [w, x, y, z] = find_greatest_eigenvector(
      {{{s[0] + s[4] + s[8], s[7] - s[5], s[2] - s[6], s[3] - s[1]},
        {s[7] - s[5], s[0] - s[4] - s[8], s[1] + s[3], s[2] + s[6]},
        {s[2] - s[6], s[1] + s[3], s[4] - s[0] - s[8], s[5] + s[7]},
        {s[3] - s[1], s[2] + s[6], s[5] + s[7], s[8] - s[0] - s[4]}}});
  const std::array<double, 9> r = {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
                                   2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
                                   2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)};
  for (std::size_t i = 0; i < 9; ++i) rotation.value[i][lane] = static_cast<float>(r[i]);
}

void fit_rotations(const RotationJob& job) {
  for (std::size_t i = 0; i < job.matrices.size(); ++i) {
    for (std::size_t lane = 0; lane < kPanelRows; ++lane) fit_lane(job.matrices[i], lane, job.rotations[i]);
  }
}

void solve_factor(const FactorJob& job) {
  if (job.factor == nullptr) return;
  const SparseFactor& l = *job.factor;
  std::vector<std::array<double, 8>> x(l.size);
  for (std::size_t j = 0; j < l.size; ++j) {
    for (std::size_t k = 0; k < 8; ++k) x[j][k] = job.x[j].value[k];
  }
  for (std::size_t j = 0; j < l.size; ++j) {
    for (double& value : x[j]) value *= l.value[l.first[j]];
    for (std::size_t e = l.first[j] + 1; e < l.first[j + 1]; ++e) {
      for (std::size_t k = 0; k < 8; ++k) x[l.row[e]][k] -= l.value[e] * x[j][k];
    }
  }
  for (std::size_t j = l.size; j-- > 0;) {
    for (std::size_t e = l.first[j] + 1; e < l.first[j + 1]; ++e) {
      for (std::size_t k = 0; k < 8; ++k) x[j][k] -= l.value[e] * x[l.row[e]][k];
    }
    for (double& value : x[j]) value *= l.value[l.first[j]];
  }
  for (std::size_t j = 0; j < l.size; ++j) {
    for (std::size_t k = 0; k < 8; ++k) job.x[j].value[k] = static_cast<float>(x[j][k]);
  }
}

}  // namespace

const HullKernels& hull_reference_kernels() {
  static const HullKernels kKernels{
      .multiply = multiply, .fit_rotations = fit_rotations, .solve_factor = solve_factor};
  return kKernels;
}

}  // namespace fascicle::muscle
