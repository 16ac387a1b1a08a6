#include "engine/geometry/mesh_measures.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

TEST(MeshMeasures, NothingIsZero) {
  EXPECT_EQ(mesh_volume({}), 0.0);
  EXPECT_EQ(mesh_area({}), 0.0);
  EXPECT_EQ(mesh_bounds({}).diagonal(), 0.0f);
}

TEST(MeshMeasures, ACornerOfACube) {
  const TriangleMesh mesh = test::make_corner(2.0f, {0, 0, 0});
  EXPECT_DOUBLE_EQ(mesh_volume(mesh), 8.0 / 6.0);
  EXPECT_NEAR(mesh_area(mesh), 3.0 * 2.0 + 2.0 * std::sqrt(3.0), 1e-6);
  EXPECT_FLOAT_EQ(mesh_bounds(mesh).diagonal(), 2.0f * std::sqrt(3.0f));
}

TEST(MeshMeasures, WhatIsNotFiniteDoesNotCount) {
  TriangleMesh mesh = test::make_corner(2.0f);
  const double area = mesh_area(mesh);
  mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  mesh.positions.push_back({0, std::numeric_limits<float>::infinity(), 0});
  mesh.indices.insert(mesh.indices.begin(), {4, 1, 2, 0, 1, 5});
  EXPECT_EQ(mesh_area(mesh), area);
  EXPECT_DOUBLE_EQ(mesh_volume(mesh), 8.0 / 6.0);
  EXPECT_FLOAT_EQ(mesh_bounds(mesh).diagonal(), 2.0f * std::sqrt(3.0f));
  mesh.indices.resize(6);
  EXPECT_EQ(mesh_area(mesh), 0.0);
  EXPECT_EQ(mesh_volume(mesh), 0.0);
  EXPECT_EQ(mesh_bounds(mesh).diagonal(), 0.0f);
}

TEST(MeshMeasures, FiniteWhateverTheSize) {
  const TriangleMesh mesh = test::make_corner(3e38f);
  EXPECT_TRUE(std::isfinite(mesh_area(mesh)) && std::isfinite(mesh_volume(mesh)));
  EXPECT_TRUE(std::isfinite(mesh_bounds(mesh).diagonal()));
}

TEST(MeshMeasures, InsideOutIsNegative) {
  EXPECT_DOUBLE_EQ(mesh_volume(test::inside_out(test::make_corner(2.0f))), -8.0 / 6.0);
}

TEST(MeshMeasures, PlaceDoesNotMatterToVolume) {
  EXPECT_NEAR(mesh_volume(test::make_corner(0.25f, {64, -32, 16})), 0.25 * 0.25 * 0.25 / 6.0, 1e-12);
}

TEST(MeshMeasures, UnusedVerticesDoNotCount) {
  TriangleMesh mesh = test::make_corner(1.0f, {0, 0, 0});
  mesh.positions.push_back({100, 100, 100});
  EXPECT_FLOAT_EQ(mesh_bounds(mesh).diagonal(), std::sqrt(3.0f));
}

}  // namespace
}  // namespace fascicle
