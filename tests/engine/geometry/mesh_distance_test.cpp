#include "engine/geometry/mesh_distance.hpp"

#include <cmath>
#include <limits>

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/geometry/mesh_measures.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

// The square 0 <= x, y <= 1 in the plane z = a + b x.
TriangleMesh plate(float a, float b) {
  return {"", {{0, 0, a}, {1, 0, a + b}, {1, 1, a + b}, {0, 1, a}}, {}, {0, 1, 2, 0, 2, 3}};
}

TriangleMesh floor_mesh() { return {"", {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {}, {0, 1, 2, 0, 2, 3}}; }

TEST(MeshDistance, OfNothingIsZero) {
  const ClosestPoints floor(floor_mesh());
  EXPECT_EQ(measure_distance({}, floor, 0.1).samples, 0u);
  EXPECT_EQ(measure_distance(plate(1, 0), ClosestPoints{TriangleMesh{}}, 0.1).max, 0.0);
  const TriangleMesh flat{"", {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, {}, {0, 1, 2}};
  EXPECT_EQ(measure_distance(flat, floor, 0.1).rms, 0.0);
}

TEST(MeshDistance, ASpacingThatIsNoneIsTheLeast) {
  const ClosestPoints floor(floor_mesh());
  TriangleMesh small = plate(1, 0);
  for (const double spacing : {1e-9, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto few = [](const glm::vec3& p) { return p.x < 1e-5f; };
    const SurfaceDistance found = measure_distance(small, floor, spacing, few);
    EXPECT_GT(found.samples, 0u) << spacing;
    EXPECT_LT(found.samples, kMostSamples / 1000);
  }
  EXPECT_EQ(measure_distance(small, floor, 1e9).samples, 1u);
  EXPECT_EQ(measure_distance(small, floor, std::numeric_limits<double>::infinity()).samples, 1u);
}

TEST(MeshDistance, CornersThatAreNotFiniteDoNotCount) {
  TriangleMesh mesh = plate(1, 0);
  mesh.positions.push_back({0, std::numeric_limits<float>::quiet_NaN(), 0});
  mesh.indices.insert(mesh.indices.end(), {0, 1, 4});
  const SurfaceDistance found = measure_distance(mesh, ClosestPoints(floor_mesh()), 0.05);
  EXPECT_EQ(found.rms, 1.0);
  EXPECT_EQ(found.samples, 400u);
}

TEST(MeshDistance, ParallelPlatesAreOneDistanceApart) {
  const SurfaceDistance found = measure_distance(plate(0.25f, 0), ClosestPoints(floor_mesh()), 0.01);
  EXPECT_DOUBLE_EQ(found.rms, 0.25);
  EXPECT_DOUBLE_EQ(found.mean, 0.25);
  EXPECT_DOUBLE_EQ(found.max, 0.25);
  EXPECT_EQ(found.samples, 10000u);
}

TEST(MeshDistance, ARampRisesEvenly) {
  const SurfaceDistance found = measure_distance(plate(0, 1), ClosestPoints(floor_mesh()), 0.01);
  EXPECT_NEAR(found.mean, 0.5, 1e-3);
  EXPECT_NEAR(found.rms, 1.0 / std::sqrt(3.0), 1e-3);
  EXPECT_EQ(found.max, 1.0);  // at a vertex, which no sample is
}

TEST(MeshDistance, LargeTrianglesWeighByTheirArea) {
  // A square at height 1, and many triangles more in a speck at height 0.5, which hardly count.
  TriangleMesh mesh = plate(1, 0);
  for (int i = 0; i < 50; ++i) {
    mesh = test::join(mesh, test::moved(plate(0.5f, 0), glm::scale(glm::mat4(1.0f), {1e-3f, 1e-3f, 1.0f})));
  }
  const SurfaceDistance found = measure_distance(mesh, ClosestPoints(floor_mesh()), 0.02);
  EXPECT_NEAR(found.mean, 1.0, 1e-3);
}

TEST(MeshDistance, ConcentricSpheres) {
  const TriangleMesh inner = test::make_sphere(1.0f, 60, 90), outer = test::make_sphere(1.5f, 60, 90);
  const SurfaceDistance out = measure_distance(inner, ClosestPoints(outer), 0.02);
  const SurfaceDistance in = measure_distance(outer, ClosestPoints(inner), 0.02);
  EXPECT_NEAR(out.rms, 0.5, 2e-3);
  EXPECT_NEAR(in.rms, 0.5, 2e-3);
  EXPECT_NEAR(out.max, 0.5, 3e-3);
  EXPECT_NEAR(static_cast<double>(in.samples), mesh_area(outer) / 0.0004, 1.0);
}

TEST(MeshDistance, OnlyWhatCounts) {
  const auto low = [](const glm::vec3& p) { return p.z < 0.5f; };
  const SurfaceDistance found = measure_distance(plate(0, 1), ClosestPoints(floor_mesh()), 0.01, low);
  EXPECT_NEAR(found.mean, 0.25, 1e-3);
  EXPECT_LT(found.max, 0.5);
  EXPECT_NEAR(static_cast<double>(found.samples), 0.5 * std::sqrt(2.0) * 10000, 100);
}

TEST(MeshDistance, TheSameForAnyNumberOfThreads) {
  const TriangleMesh from = test::make_torus(1.0f, 0.3f, 60, 40);
  const ClosestPoints to(test::make_torus(1.02f, 0.29f, 50, 30));
  std::vector<SurfaceDistance> found;
  for (const int workers : {1, 2, 5}) {
    parallel::WorkerArena arena(workers);
    arena.execute([&] { found.push_back(measure_distance(from, to, 0.01)); });
  }
  for (const SurfaceDistance& other : found) {
    EXPECT_EQ(found[0].rms, other.rms);
    EXPECT_EQ(found[0].mean, other.mean);
    EXPECT_EQ(found[0].max, other.max);
  }
}

}  // namespace
}  // namespace fascicle
