// The volume constraint on meshes with known volumes, on every instruction set.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/surface/pack_hinges.hpp"
#include "modules/muscle/kernels/surface/surface_reference.hpp"
#include "tests/modules/muscle/kernels/surface/kernel_levels.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using fascicle::test::make_box;
using fascicle::test::make_corner;
using fascicle::test::make_sphere;
using test::place;

struct Body {
  explicit Body(const TriangleMesh& mesh) : triangles(mesh.indices), vertex_count(mesh.positions.size()) {
    for (const glm::vec3& p : mesh.positions) points.push_back({p.x, p.y, p.z, 1.0e3f});
    add_padding(points);
    gradient.resize(vertex_count);
    rings = build_vertex_rings(triangles, static_cast<std::uint32_t>(vertex_count));
  }

  VolumeJob job() {
    return {.triangles = triangles,
            .vertex_count = static_cast<std::uint32_t>(vertex_count),
            .points = points,
            .gradient = gradient,
            .rest = rest,
            .compliance = compliance,
            .rings = &rings};
  }

  std::vector<std::uint32_t> triangles;
  std::size_t vertex_count;
  AlignedVector<SurfacePoint> points, gradient;
  VertexRings rings;
  double rest = 0.0;
  float compliance = 0.0f;
};

TEST(SurfaceVolume, IsThatOfKnownBodies) {
  for (const SimdLevel level : test::levels()) {
    Body corner(make_corner(0.1f, {1.0f, 2.0f, 3.0f})), box(make_box({-0.1f, 0.0f, 0.2f}, {0.3f, 0.5f, 0.4f}));
    EXPECT_NEAR(surface_kernels(level).measure_volume(corner.job()), 1.0e-3, 2.0e-9);
    EXPECT_NEAR(surface_kernels(level).measure_volume(box.job()), 6.0 * 0.04, 1.0e-7);
    for (const std::uint32_t segments : {7u, 8u, 9u, 10u}) {  // vertices with and without a whole last four
      const TriangleMesh mesh = make_sphere(0.05f, 12, segments, {0.3f, -0.2f, 0.1f});
      Body sphere(mesh);
      EXPECT_NEAR(surface_kernels(level).measure_volume(sphere.job()) / (6.0 * mesh_volume(mesh)), 1.0, 2.0e-6);
    }
  }
}

// Two bodies that share one vertex: it has two rings.
TEST(SurfaceVolume, KnowsVerticesWithTwoRings) {
  TriangleMesh mesh = make_corner(0.1f);
  const TriangleMesh other = make_corner(-0.2f);  // turned inside out by the mirror
  for (std::size_t v = 1; v < 4; ++v) mesh.positions.push_back(other.positions[v]);
  for (std::size_t i = 0; i < other.indices.size(); i += 3) {
    for (const std::size_t corner : {0u, 2u, 1u}) {
      const std::uint32_t v = other.indices[i + corner];
      mesh.indices.push_back(v == 0 ? 0 : v + 3);
    }
  }
  // So that vertex 0, from which places are counted, is not the shared one.
  for (std::uint32_t& v : mesh.indices) v = v == 0 ? 4 : v == 4 ? 0 : v;
  std::swap(mesh.positions[0], mesh.positions[4]);
  for (const SimdLevel level : test::levels()) {
    Body body(mesh);
    EXPECT_NEAR(surface_kernels(level).measure_volume(body.job()), 1.0e-3 + 8.0e-3, 1.0e-8);
    surface_kernels(level).project_volume(body.job());
    Body plain(mesh);
    surface_reference_kernels().project_volume(plain.job());
    for (std::size_t v = 0; v < body.vertex_count; ++v) {
      EXPECT_LT(glm::distance(place(body.gradient[v]), place(plain.gradient[v])), 1.0e-8);
    }
  }
}

TEST(SurfaceVolume, OneStepBringsASphereBack) {
  for (const SimdLevel level : test::levels()) {
    const SurfaceKernels& kernels = surface_kernels(level);
    Body sphere(make_sphere(0.05f, 24, 37));
    sphere.rest = kernels.measure_volume(sphere.job());
    for (SurfacePoint& p : sphere.points) p = {1.01f * p.x, 1.01f * p.y, 1.01f * p.z, p.inverse_mass};
    const double blown = kernels.project_volume(sphere.job());
    EXPECT_NEAR(blown / sphere.rest, std::pow(1.01, 3), 1.0e-5);
    EXPECT_NEAR(kernels.measure_volume(sphere.job()) / sphere.rest, 1.0, 4.0e-4);  // what is left is of second order
    kernels.project_volume(sphere.job());
    EXPECT_NEAR(kernels.measure_volume(sphere.job()) / sphere.rest, 1.0, 1.0e-6);
  }
}

TEST(SurfaceVolume, GradientIsThatOfDifferences) {
  const TriangleMesh mesh = make_sphere(0.05f, 6, 7, {0.02f, 0.0f, 0.0f});
  for (const SimdLevel level : test::levels()) {
    Body body(mesh);
    surface_kernels(level).project_volume(body.job());
    for (std::size_t v = 0; v < body.vertex_count; ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        constexpr float kStep = 0.01f;  // the volume is linear in one coordinate
        TriangleMesh up = mesh, down = mesh;
        up.positions[v][axis] += kStep;
        down.positions[v][axis] -= kStep;
        const double expected = 6.0 * (mesh_volume(up) - mesh_volume(down)) / (2.0 * kStep);
        EXPECT_NEAR(place(body.gradient[v])[axis], expected, 2.0e-7) << v << " " << axis;
      }
    }
  }
}

// lambda = -C / (sum w g^2 + alpha): as much compliance as the masses have halves the step; held vertices stay.
TEST(SurfaceVolume, GivesWayByItsCompliance) {
  for (const SimdLevel level : test::levels()) {
    const SurfaceKernels& kernels = surface_kernels(level);
    Body rigid(make_sphere(0.05f, 12, 15)), soft = rigid;
    const Body before = rigid;
    rigid.points[5].inverse_mass = soft.points[5].inverse_mass = 0.0f;
    rigid.rest = soft.rest = 1.02 * kernels.measure_volume(rigid.job());
    kernels.project_volume(rigid.job());
    double sum = 0.0;
    for (std::size_t v = 0; v < rigid.vertex_count; ++v) {
      const glm::dvec3 g = place(rigid.gradient[v]);
      sum += static_cast<double>(rigid.points[v].inverse_mass) * glm::dot(g, g);
    }
    soft.compliance = static_cast<float>(sum);
    kernels.project_volume(soft.job());
    EXPECT_EQ(place(rigid.points[5]), place(before.points[5]));
    for (std::size_t v = 0; v < rigid.vertex_count; ++v) {
      const glm::dvec3 whole = place(rigid.points[v]) - place(before.points[v]);
      const glm::dvec3 half = place(soft.points[v]) - place(before.points[v]);
      EXPECT_LT(glm::distance(0.5 * whole, half), 1.0e-8);
    }
  }
}

TEST(SurfaceVolume, BodiesWithoutVolumeOrMassAreLeftAlone) {
  for (const SimdLevel level : test::levels()) {
    Body point(make_sphere(0.0f, 6, 7)), held(make_sphere(0.05f, 6, 7));
    for (SurfacePoint& p : held.points) p.inverse_mass = 0.0f;
    point.rest = held.rest = 1.0;
    for (Body* body : {&point, &held}) {
      const AlignedVector<SurfacePoint> before = body->points;
      surface_kernels(level).project_volume(body->job());
      EXPECT_TRUE(test::same_bits(body->points, before));
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
