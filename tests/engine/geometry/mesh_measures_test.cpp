#include "engine/geometry/mesh_measures.hpp"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace fascicle {
namespace {

// A right-angled corner of a cube of side `a`: volume a^3 / 6.
TriangleMesh corner(float a, const glm::vec3& at) {
  TriangleMesh mesh;
  mesh.positions = {at, at + glm::vec3(a, 0, 0), at + glm::vec3(0, a, 0), at + glm::vec3(0, 0, a)};
  mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return mesh;
}

TEST(MeshMeasures, NothingIsZero) {
  EXPECT_EQ(mesh_volume({}), 0.0);
  EXPECT_EQ(mesh_area({}), 0.0);
  EXPECT_EQ(mesh_bounds({}).diagonal(), 0.0f);
}

TEST(MeshMeasures, ACornerOfACube) {
  const TriangleMesh mesh = corner(2.0f, {0, 0, 0});
  EXPECT_DOUBLE_EQ(mesh_volume(mesh), 8.0 / 6.0);
  EXPECT_NEAR(mesh_area(mesh), 3.0 * 2.0 + 2.0 * std::sqrt(3.0), 1e-6);
  EXPECT_FLOAT_EQ(mesh_bounds(mesh).diagonal(), 2.0f * std::sqrt(3.0f));
}

TEST(MeshMeasures, InsideOutIsNegative) {
  TriangleMesh mesh = corner(2.0f, {0, 0, 0});
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  EXPECT_DOUBLE_EQ(mesh_volume(mesh), -8.0 / 6.0);
}

TEST(MeshMeasures, PlaceDoesNotMatterToVolume) {
  EXPECT_NEAR(mesh_volume(corner(0.25f, {64, -32, 16})), 0.25 * 0.25 * 0.25 / 6.0, 1e-12);
}

TEST(MeshMeasures, UnusedVerticesDoNotCount) {
  TriangleMesh mesh = corner(1.0f, {0, 0, 0});
  mesh.positions.push_back({100, 100, 100});
  EXPECT_FLOAT_EQ(mesh_bounds(mesh).diagonal(), std::sqrt(3.0f));
}

}  // namespace
}  // namespace fascicle
