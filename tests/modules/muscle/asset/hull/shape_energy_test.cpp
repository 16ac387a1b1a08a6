// The full mesh's energy: matrices against the sums that they stand for.
#include "modules/muscle/asset/hull/shape_energy.hpp"

#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/plain_surface.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

SurfaceAsset make_ball() {
  SurfaceAsset asset = test::plain_surface(test::make_sphere(0.05f, 12, 14));
  asset.size = 0.17f;
  return asset;
}

TEST(ShapeEnergy, TheLaplacianOfAFlatOrConstantFunctionIsNothing) {
  const SurfaceAsset box = [] {
    SurfaceAsset asset = test::plain_surface(test::make_box({0, 0, 0}, {1, 1, 1}));
    asset.size = 1.7f;
    return asset;
  }();
  const ShapeEnergy energy = build_shape_energy(box, 1.0);
  EXPECT_LT((energy.laplacian * Eigen::VectorXd::Ones(energy.rest.rows())).norm(), 1e-12);
  EXPECT_NEAR(energy.mass.sum(), 6.0, 1e-6);
}

TEST(ShapeEnergy, MassesAreTheAreaAndCurvatureIsTheBalls) {
  const SurfaceAsset ball = make_ball();
  const ShapeEnergy energy = build_shape_energy(ball, 1.0);
  EXPECT_NEAR(energy.mass.sum(), 4.0 * 3.14159265 * 0.05 * 0.05, 0.05 * energy.mass.sum());
  // (L V) / m is twice the mean curvature's vector: 2 / r outwards.
  double mean = 0.0;
  for (Eigen::Index v = 0; v < energy.rest.rows(); ++v) mean += energy.curvature.row(v).dot(energy.rest.row(v).normalized());
  EXPECT_NEAR(mean / static_cast<double>(energy.rest.rows()), 2.0 / 0.05, 0.15 * 2.0 / 0.05);
}

TEST(ShapeEnergy, MatrixAndLoadsAreTheSumOverEdgesAndVertices) {
  const SurfaceAsset ball = make_ball();
  const ShapeEnergy energy = build_shape_energy(ball, 0.7);
  std::vector<std::uint32_t> own(ball.vertex_count);
  std::iota(own.begin(), own.end(), 0u);
  // Any places, and any rotation a vertex.
  Places places = energy.rest;
  std::vector<Eigen::Matrix3d> turned;
  for (Eigen::Index v = 0; v < places.rows(); ++v) {
    const double a = static_cast<double>(v);
    places.row(v) += 0.01 * Eigen::RowVector3d(std::sin(a), std::cos(3.0 * a), std::sin(2.0 * a));
    turned.push_back(Eigen::AngleAxisd(0.3 * std::sin(a), Eigen::Vector3d(1.0, 0.5, -1.0).normalized()).toRotationMatrix());
  }
  double sum = 0.0;
  for (const ShapeEnergy::Edge& edge : energy.edges) {
    const Eigen::Vector3d e = (places.row(edge.first) - places.row(edge.second)).transpose();
    const Eigen::Vector3d rest = (energy.rest.row(edge.first) - energy.rest.row(edge.second)).transpose();
    sum += 0.5 * edge.weight * ((e - turned[edge.first] * rest).squaredNorm() + (e - turned[edge.second] * rest).squaredNorm());
  }
  const Places bent = energy.mass.cwiseInverse().asDiagonal() * Places(energy.laplacian * places);
  for (Eigen::Index v = 0; v < places.rows(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    sum += energy.beta * energy.mass[v] *
           (bent.row(v).transpose() - turned[i] * energy.curvature.row(v).transpose()).squaredNorm();
  }
  // <V, E V> - 2 sum <R, S> + <V_0, E V_0>, S = V' B.
  const Places shape = energy.loads(own, ball.vertex_count).transpose() * places;
  double matrix = places.cwiseProduct(Places(energy.matrix() * places)).sum() +
                  energy.rest.cwiseProduct(Places(energy.matrix() * energy.rest)).sum();
  for (std::size_t v = 0; v < turned.size(); ++v) {
    const Eigen::Matrix3d s = shape.middleRows<3>(3 * static_cast<Eigen::Index>(v)).transpose();
    matrix -= 2.0 * turned[v].cwiseProduct(s).sum();
  }
  EXPECT_NEAR(matrix, sum, 1e-9 * sum);
}

TEST(ShapeEnergy, BendingIsItsWeightAndNoneIsEdgesAlone) {
  const SurfaceAsset ball = make_ball();
  EXPECT_EQ(build_shape_energy(ball, 0.0).beta, 0.0);
  EXPECT_NEAR(build_shape_energy(ball, 2.0).beta, 2.0 * build_shape_energy(ball, 1.0).beta, 1e-12);
}

}  // namespace
}  // namespace fascicle::muscle
