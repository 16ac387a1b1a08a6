#include "engine/geometry/principal_axes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/geometry/for_each_triangle.hpp"

namespace fascicle {
namespace {

double area_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

// Eigenvectors of a symmetric matrix as columns, by Jacobi rotations; `matrix` becomes diagonal.
glm::dmat3 diagonalise(glm::dmat3& matrix) {
  glm::dmat3 vectors(1.0);
  constexpr int kSweeps = 32;  // converges quadratically: 6 do
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const double rest = std::abs(matrix[0][1]) + std::abs(matrix[0][2]) + std::abs(matrix[1][2]);
    if (rest == 0.0) break;
    for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      if (matrix[p][q] == 0.0) continue;
      const double theta = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
      const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
      const double cosine = 1.0 / std::sqrt(t * t + 1.0), sine = t * cosine;
      glm::dmat3 turn(1.0);
      turn[p][p] = turn[q][q] = cosine;
      turn[q][p] = sine;
      turn[p][q] = -sine;
      matrix = glm::transpose(turn) * matrix * turn;
      matrix[p][q] = matrix[q][p] = 0.0;
      vectors = vectors * turn;
    }
  }
  return vectors;
}

// The integral of s^3 over the surface, s along `axis` from `centre`; and of |s|^3 at its corners, for scale.
std::pair<double, double> third_moment(const TriangleMesh& mesh, const glm::dvec3& centre, const glm::dvec3& axis) {
  double moment = 0.0, scale = 0.0;
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double area = area_of(a, b, c);
    const double x = glm::dot(a - centre, axis), y = glm::dot(b - centre, axis), z = glm::dot(c - centre, axis);
    moment += area / 10.0 * (x * x * x + y * y * y + z * z * z + x * x * (y + z) + y * y * (x + z) +
                             z * z * (x + y) + x * y * z);
    scale += area / 3.0 * (std::abs(x * x * x) + std::abs(y * y * y) + std::abs(z * z * z));
  });
  return {moment, scale};
}

glm::dvec3 choose_sign(const TriangleMesh& mesh, const glm::dvec3& centre, const glm::dvec3& axis) {
  constexpr double kSymmetric = 1e-4;  // of the scale: below it the mesh's rounding would choose
  const auto [moment, scale] = third_moment(mesh, centre, axis);
  if (std::abs(moment) > kSymmetric * scale) return moment > 0.0 ? axis : -axis;
  int greatest = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(axis[i]) > std::abs(axis[greatest]) + 1e-9) greatest = i;
  }
  return axis[greatest] > 0.0 ? axis : -axis;
}

}  // namespace

PrincipalAxes principal_axes(const TriangleMesh& mesh) {
  PrincipalAxes result;
  double area = 0.0, count = 0.0;
  glm::dvec3 weighted(0.0), mean(0.0);
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double size = area_of(a, b, c);
    area += size;
    weighted += size / 3.0 * (a + b + c);
    mean += (a + b + c) / 3.0;
    count += 1.0;
  });
  if (count == 0.0) return result;
  result.centre = area > 0.0 ? weighted / area : mean / count;

  if (area > 0.0) {
    glm::dmat3 covariance(0.0);
    for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
      const glm::dvec3 x = a - result.centre, y = b - result.centre, z = c - result.centre, sum = x + y + z;
      const double weight = area_of(a, b, c) / (12.0 * area);
      covariance += weight * (glm::outerProduct(x, x) + glm::outerProduct(y, y) + glm::outerProduct(z, z) +
                              glm::outerProduct(sum, sum));
    });
    const glm::dmat3 vectors = diagonalise(covariance);
    std::array<int, 3> order = {0, 1, 2};
    std::ranges::stable_sort(order, [&](int a, int b) { return covariance[a][a] > covariance[b][b]; });
    for (std::size_t i = 0; i < 3; ++i) {
      result.deviations[i] = std::sqrt(std::max(covariance[order[i]][order[i]], 0.0));
      result.axes[i] = glm::normalize(vectors[order[i]]);
    }
    result.axes[0] = choose_sign(mesh, result.centre, result.axes[0]);
    result.axes[1] = choose_sign(mesh, result.centre, result.axes[1]);
    result.axes[2] = glm::cross(result.axes[0], result.axes[1]);
  }

  constexpr double kMost = std::numeric_limits<double>::max();
  result.ranges.fill({kMost, -kMost});
  for_each_triangle(mesh, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const glm::dvec3& corner : {a, b, c}) {
        const double along = glm::dot(corner - result.centre, result.axes[i]);
        result.ranges[i] = {std::min(result.ranges[i].x, along), std::max(result.ranges[i].y, along)};
      }
    }
  });
  return result;
}

}  // namespace fascicle
