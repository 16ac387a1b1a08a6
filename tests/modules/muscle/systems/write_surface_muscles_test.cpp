// Vertices and normals of surface muscles as they are drawn.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/kernels/surface/surface_normals.hpp"
#include "modules/muscle/systems/5_present/write_surface_muscles.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0f;

std::vector<SurfacePoint> points_of(const TriangleMesh& mesh) {
  std::vector<SurfacePoint> points;
  for (const glm::vec3& p : mesh.positions) points.push_back({p.x, p.y, p.z, 7.0f});
  return points;
}

std::vector<SurfaceVertex> write(const TriangleMesh& mesh, const glm::mat4& frame = glm::mat4(1.0f)) {
  // What is left over from the step before must not matter.
  std::vector<SurfaceVertex> vertices(mesh.positions.size(), {glm::vec3(NAN), 0xffffffffu});
  write_surface_vertices(mesh.indices, points_of(mesh), frame, vertices);
  return vertices;
}

float angle_between(const glm::vec3& a, const glm::vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST(SurfaceNormals, OfNothingAreNone) {
  write_surface_vertices({}, {}, glm::mat4(1.0f), {});
  const auto vertices = write({});
  EXPECT_TRUE(vertices.empty());
}

TEST(SurfaceNormals, WhereTrianglesHaveNoAreaTheNormalIsStillAUnitVector) {
  TriangleMesh mesh;
  mesh.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {5, 6, 7}, {5, 6, 8}};
  mesh.indices = {0, 1, 2, 0, 3, 4, 0, 4, 3};  // a point, and two that cancel each other out
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 90.0f * kDegree, glm::vec3(1, 0, 0));
  for (const SurfaceVertex& vertex : write(mesh, turned)) {
    EXPECT_LT(glm::distance(unpack_surface_normal(vertex.normal), glm::vec3(0, 0, 1)), 0.003f);
    EXPECT_TRUE(std::isfinite(vertex.position.x));
  }
}

TEST(SurfaceNormals, OfASpherePointOutwardsWithinADegree) {
  const glm::vec3 centre(0.3f, -1.2f, 0.8f);
  const TriangleMesh sphere = test::make_sphere(0.05f, 48, 64, centre);
  const auto vertices = write(sphere);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    EXPECT_EQ(vertices[v].position, sphere.positions[v]) << v;
    const glm::vec3 normal = unpack_surface_normal(vertices[v].normal);
    EXPECT_NEAR(glm::length(normal), 1.0f, 0.004f) << v;
    EXPECT_LT(angle_between(normal, sphere.positions[v] - centre), kDegree) << v;
  }
}

// Of a box' corner the three faces count by the area of their triangles there: two triangles of one face and one of
// another differ from their plain mean.
TEST(SurfaceNormals, TrianglesCountByTheirArea) {
  const TriangleMesh box = test::make_box({0, 0, 0}, {1, 2, 3});
  std::vector<glm::dvec3> expected(8, glm::dvec3(0.0));
  for (std::size_t i = 0; i < box.indices.size(); i += 3) {
    const glm::dvec3 a(box.positions[box.indices[i]]), b(box.positions[box.indices[i + 1]]),
        c(box.positions[box.indices[i + 2]]);
    for (std::size_t k = 0; k < 3; ++k) expected[box.indices[i + k]] += glm::cross(b - a, c - a);
  }
  const auto vertices = write(box);
  for (std::size_t v = 0; v < 8; ++v) {
    const glm::vec3 normal = unpack_surface_normal(vertices[v].normal);
    EXPECT_LT(angle_between(normal, glm::vec3(expected[v])), 0.2f * kDegree) << v;
  }
}

TEST(SurfaceNormals, AFrameMovesPlacesAndTurnsNormals) {
  const TriangleMesh torus = test::make_torus(0.08f, 0.03f, 31, 17);  // 527 vertices: three beyond the last four
  const auto at_rest = write(torus);
  const glm::mat4 frame = glm::translate(glm::mat4(1.0f), {2.0f, 0.5f, -3.0f}) *
                          glm::rotate(glm::mat4(1.0f), 2.1f, glm::normalize(glm::vec3(1, 2, -3)));
  const auto moved = write(torus, frame);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const glm::vec3 place(frame * glm::vec4(torus.positions[v], 1.0f));
    EXPECT_LT(glm::distance(moved[v].position, place), 1.0e-6f) << v;
    const glm::vec3 turned = glm::mat3(frame) * unpack_surface_normal(at_rest[v].normal);
    EXPECT_LT(angle_between(unpack_surface_normal(moved[v].normal), turned), 0.3f * kDegree) << v;
  }
}

TEST(SurfaceNormals, AFrameThatSqueezesGivesTheSqueezedSurfacesNormals) {
  const TriangleMesh sphere = test::make_sphere(1.0f, 24, 32);
  const glm::mat4 squeeze = glm::scale(glm::mat4(1.0f), {1.0f, 0.25f, 1.0f});
  const auto vertices = write(sphere, squeeze);
  const auto expected = write(test::moved(sphere, squeeze));
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const glm::vec3 normal = unpack_surface_normal(vertices[v].normal);
    EXPECT_LT(angle_between(normal, unpack_surface_normal(expected[v].normal)), 0.3f * kDegree) << v;
  }
}

class WriteSurfaceMuscles : public testing::Test {
 protected:
  WriteSurfaceMuscles() {
    world_.set_resource(CostLedger{});
    world_.resource<CostLedger>().add_system("write_surface_muscles");
    schedule_.add("write_surface_muscles", write_surface_muscles);
  }
  ecs::Entity spawn(const TriangleMesh& mesh) {
    auto asset = std::make_shared<SurfaceAsset>();
    asset->vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    asset->triangles = mesh.indices;
    SurfaceState state;
    for (const SurfacePoint& point : points_of(mesh)) state.points.push_back(point);
    state.points.resize(state.points.size() + kPaddingPoints);
    DrawnSurface drawn;
    drawn.vertices.resize(asset->vertex_count);
    SurfaceMuscle muscle;
    muscle.asset = std::move(asset);
    const ecs::Entity entity = world_.create();
    world_.add(entity, std::move(muscle));
    world_.add(entity, std::move(state));
    world_.add(entity, std::move(drawn));
    return entity;
  }
  void run(int workers) {
    parallel::WorkerArena arena(workers);
    schedule_.run(world_, arena);
  }

  ecs::World world_;
  ecs::Schedule schedule_;
};

TEST_F(WriteSurfaceMuscles, WithoutAMuscleNothingHappens) {
  run(1);
  spawn({});
  run(2);
}

TEST_F(WriteSurfaceMuscles, EachMuscleGetsItsOwnSurfaceWhateverTheWorkers) {
  const TriangleMesh sphere = test::make_sphere(0.05f, 12, 16);
  const TriangleMesh torus = test::make_torus(0.08f, 0.03f, 30, 15);
  const ecs::Entity first = spawn(sphere), second = spawn(torus);
  const glm::mat4 frame = glm::translate(glm::mat4(1.0f), {1.0f, 2.0f, 3.0f});
  world_.get<SurfaceState>(second).frame = frame;
  for (const int workers : {1, 3}) {
    run(workers);
    const auto expect_same = [&](ecs::Entity entity, const std::vector<SurfaceVertex>& expected) {
      const auto& vertices = world_.get<DrawnSurface>(entity).vertices;
      ASSERT_EQ(vertices.size(), expected.size());
      EXPECT_EQ(std::memcmp(vertices.data(), expected.data(), expected.size() * sizeof(SurfaceVertex)), 0);
    };
    expect_same(first, write(sphere));
    expect_same(second, write(torus, frame));
  }
}

TEST_F(WriteSurfaceMuscles, ASurfaceOfAnotherSizeIsPassedOver) {
  const ecs::Entity entity = spawn(test::make_sphere(0.05f, 12, 16));
  world_.get<DrawnSurface>(entity).vertices.assign(5, {glm::vec3(4.0f), 3u});
  run(1);
  EXPECT_EQ(world_.get<DrawnSurface>(entity).vertices[4].position, glm::vec3(4.0f));
}

TEST_F(WriteSurfaceMuscles, ItsTimeIsInTheLedgerAndNothingIsAllocated) {
  const ecs::Entity entity = spawn(test::make_sphere(0.05f, 24, 32));
  CostLedger& ledger = world_.resource<CostLedger>();
  ledger.add_owner(entity, "somebody's sphere", {});
  ledger.set_enabled(true);
  parallel::WorkerArena arena(1);
  schedule_.run(world_, arena);
  schedule_.run(world_, arena);
  {
    const test::AllocationScope scope;
    schedule_.run(world_, arena);
    EXPECT_EQ(scope.allocations(), 0u);
  }
  ledger.end_frame();
  const auto rows = ledger.statistics();
  const bool listed = std::any_of(rows.begin(), rows.end(), [](const ItemCost& row) {
    return row.system == "write_surface_muscles" && row.owner == "somebody's sphere";
  });
  EXPECT_TRUE(listed);
}

}  // namespace
}  // namespace fascicle::muscle
