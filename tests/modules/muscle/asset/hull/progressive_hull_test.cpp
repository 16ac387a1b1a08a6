#include "modules/muscle/asset/hull/progressive_hull.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/geometry/self_intersections.hpp"
#include "tests/modules/muscle/asset/hull/hull_checks.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using testing::HasSubstr;

constexpr double kEnclosed = 1.0e-6;  // of the mesh's size

std::string error_of(const TriangleMesh& mesh, const HullTarget& target = {}) {
  const auto hull = build_progressive_hull(mesh, target);
  return hull ? "no error" : to_text(hull.diagnostics());
}

ProgressiveHull hull_of(const TriangleMesh& mesh, const HullTarget& target) {
  auto hull = build_progressive_hull(mesh, target);
  EXPECT_TRUE(hull.ok()) << to_text(hull.diagnostics());
  return hull ? *hull : ProgressiveHull{};
}

// Everything that holds for any hull.
void expect_hull(const TriangleMesh& fine, const ProgressiveHull& hull, const std::string& what) {
  EXPECT_EQ(test::manifold_fault(hull.mesh), "") << what;
  EXPECT_LE(test::outside(fine, hull.mesh), kEnclosed) << what;
  EXPECT_GE(hull.overhead(), -1.0e-6) << what;
  EXPECT_NEAR(hull.volume, mesh_volume(hull.mesh), 1e-12 * hull.volume) << what;
  EXPECT_NEAR(hull.fine_volume, mesh_volume(fine), 1e-12 * hull.fine_volume) << what;
}

TriangleMesh split(const TriangleMesh& mesh, int times) {
  TriangleMesh fine = mesh;
  for (int i = 0; i < times; ++i) {
    const MeshEdges edges = find_edges(fine.indices, fine.positions.size());
    const auto first = static_cast<std::uint32_t>(fine.positions.size());
    std::vector<std::uint32_t> middle(fine.indices.size());
    for (std::uint32_t e = 0; e < edges.count(); ++e) {
      for (const std::uint32_t side : edges.sides_of(e)) middle[side] = first + e;
      const std::uint32_t side = edges.sides_of(e)[0];
      fine.positions.push_back(0.5f * (fine.positions[fine.indices[side]] + fine.positions[fine.indices[next_side(side)]]));
    }
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t = 0; t < fine.indices.size(); t += 3) {
      const std::uint32_t a = middle[t], b = middle[t + 1], c = middle[t + 2];
      indices.insert(indices.end(), {fine.indices[t], a, c, a, fine.indices[t + 1], b, c, b, fine.indices[t + 2], a, b, c});
    }
    fine.indices = std::move(indices);
  }
  return fine;
}

TEST(ProgressiveHull, RefusesWhatIsNoSolid) {
  const TriangleMesh box = test::make_box(glm::vec3(-1.0f), glm::vec3(1.0f));
  EXPECT_THAT(error_of({}), HasSubstr("the mesh has no triangles"));
  TriangleMesh broken = box;
  broken.indices.pop_back();
  EXPECT_THAT(error_of(broken), HasSubstr("the mesh has no triangles"));
  broken = box;
  broken.indices[5] = 8;
  EXPECT_THAT(error_of(broken), HasSubstr("a triangle has corner 8 of 8"));
  broken = box;
  broken.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error_of(broken), HasSubstr("vertex 3 is no finite place"));
  broken.positions[3].y = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error_of(broken), HasSubstr("vertex 3 is no finite place"));
  broken = box;
  broken.indices[1] = broken.indices[0];
  EXPECT_THAT(error_of(broken), HasSubstr("triangle 0 has a corner twice"));
  broken = box;
  broken.indices.resize(33);
  EXPECT_THAT(error_of(broken), HasSubstr("an edge has 1 triangles"));
  broken = box;
  std::swap(broken.indices[0], broken.indices[1]);
  EXPECT_THAT(error_of(broken), HasSubstr("an edge runs the same way in both"));
  EXPECT_THAT(error_of(test::inside_out(box)), HasSubstr("the mesh encloses -8 m^3"));
  EXPECT_THAT(error_of(test::moved(box, glm::mat4(glm::mat3(1, 0, 0, 0, 1, 0, 0, 0, 0)))), HasSubstr("encloses"));
  EXPECT_THAT(error_of(test::make_soup(50, 1)), HasSubstr("error"));
}

TEST(ProgressiveHull, RefusesDistancesThatAreNone) {
  const TriangleMesh box = test::make_box(glm::vec3(-1.0f), glm::vec3(1.0f));
  EXPECT_THAT(error_of(box, {.vertices = 8, .error = -0.1f}), HasSubstr("-0.1 m away"));
  EXPECT_THAT(error_of(box, {.error = std::numeric_limits<float>::quiet_NaN()}), HasSubstr("give 0 or more"));
  EXPECT_THAT(error_of(box, {.error = std::numeric_limits<float>::infinity()}), HasSubstr("give 0 or more"));
}

TEST(ProgressiveHull, FewVerticesAreTheirOwnHull) {
  const TriangleMesh corner = test::make_corner(1.0f);
  for (const std::uint32_t vertices : {300u, 4u}) {
    const auto hull = build_progressive_hull(corner, {.vertices = vertices});
    ASSERT_TRUE(hull.ok());
    EXPECT_TRUE(hull.diagnostics().warnings.empty());
    EXPECT_EQ(hull->mesh.positions, corner.positions);
    EXPECT_EQ(hull->mesh.indices, corner.indices);
    EXPECT_EQ(hull->distance, 0.0f);
    EXPECT_EQ(hull->overhead(), 0.0);
  }
}

TEST(ProgressiveHull, SaysHowManyItNeeds) {
  const auto corner = build_progressive_hull(test::make_corner(1.0f), {.vertices = 0});
  ASSERT_TRUE(corner.ok());
  ASSERT_EQ(corner.diagnostics().warnings.size(), 1u);
  EXPECT_THAT(corner.diagnostics().warnings[0].cause, HasSubstr("the hull needs 4 vertices, more than the 0 asked for"));
  EXPECT_EQ(corner.diagnostics().warnings[0].remedy, "ask for 4 or more");
  // A genus takes seven; how many it comes to here is told.
  const TriangleMesh torus = test::make_torus(1.0f, 0.4f, 24, 12);
  const auto ring = build_progressive_hull(torus, {.vertices = 4});
  ASSERT_TRUE(ring.ok());
  expect_hull(torus, *ring, "torus");
  ASSERT_EQ(ring.diagnostics().warnings.size(), 1u);
  EXPECT_THAT(ring.diagnostics().warnings[0].cause,
              HasSubstr(fmt::format("needs {} vertices", ring->mesh.positions.size())));
  EXPECT_GE(ring->mesh.positions.size(), 7u);
  EXPECT_LE(ring->mesh.positions.size(), 30u);
  EXPECT_EQ(ring->mesh.indices.size() / 3, 2 * ring->mesh.positions.size()) << "it is a torus still";
}

TEST(ProgressiveHull, FlatFacesAndSharpEdgesCostNothing) {
  const TriangleMesh box = split(test::make_box(glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(0.6f, 0.5f, 0.4f)), 3);
  ASSERT_EQ(box.positions.size(), 386u);
  for (const std::uint32_t vertices : {200u, 50u, 8u}) {
    const ProgressiveHull hull = hull_of(box, {.vertices = vertices});
    EXPECT_EQ(hull.mesh.positions.size(), vertices);
    expect_hull(box, hull, fmt::format("{} vertices", vertices));
    EXPECT_NEAR(hull.overhead(), 0.0, 1e-6);
    EXPECT_LT(hull.distance, 1e-7f);
    EXPECT_GT(test::least_shape(hull.mesh), 0.1);
  }
}

TEST(ProgressiveHull, EveryMeshOnTheWayEnclosesTheOneBefore) {
  const TriangleMesh sphere = test::make_sphere(0.1f, 24, 32, glm::vec3(0.3f, -0.2f, 0.9f));
  TriangleMesh before = sphere;
  double volume = mesh_volume(sphere);
  for (const std::uint32_t vertices : {500u, 300u, 200u, 100u, 60u, 40u, 30u, 20u, 15u, 12u}) {
    const ProgressiveHull hull = hull_of(sphere, {.vertices = vertices});
    EXPECT_EQ(hull.mesh.positions.size(), vertices);
    expect_hull(sphere, hull, fmt::format("{} vertices", vertices));
    EXPECT_LE(test::outside(before, hull.mesh), kEnclosed) << vertices;
    EXPECT_GT(hull.volume, volume) << vertices;
    EXPECT_GE(test::least_shape(hull.mesh), 0.049) << vertices;
    before = hull.mesh;
    volume = hull.volume;
  }
  // The least that 100 vertices can enclose a ball with: the best polyhedra of 196 triangles come to 3 %.
  const ProgressiveHull hull = hull_of(sphere, {.vertices = 100});
  EXPECT_LT(hull.volume / (4.0 / 3.0 * std::numbers::pi * 1e-3), 1.09);
}

TEST(ProgressiveHull, KeepsTheDistance) {
  const TriangleMesh sphere = test::make_sphere(0.1f, 24, 32);
  std::size_t before = sphere.positions.size();
  for (const float error : {0.0005f, 0.002f, 0.01f}) {
    const auto hull = build_progressive_hull(sphere, {.vertices = 4, .error = error});
    ASSERT_TRUE(hull.ok());
    expect_hull(sphere, *hull, fmt::format("{} m", error));
    EXPECT_LE(hull->distance, error * 1.0001f);
    EXPECT_GT(hull->distance, 0.5f * error);
    EXPECT_LT(hull->mesh.positions.size(), before);
    before = hull->mesh.positions.size();
    ASSERT_EQ(hull.diagnostics().warnings.size(), 1u);
    EXPECT_THAT(hull.diagnostics().warnings[0].cause,
                HasSubstr(fmt::format("a hull no further than {:.4g} mm away needs {} vertices, more than the 4",
                                      1000.0f * error, before)));
  }
  const auto enough = build_progressive_hull(sphere, {.vertices = 300, .error = 0.01f});
  ASSERT_TRUE(enough.ok());
  EXPECT_TRUE(enough.diagnostics().warnings.empty());
  EXPECT_EQ(enough->mesh.positions.size(), 300u);
}

TEST(ProgressiveHull, KeepsTheDistanceAcrossHollows) {
  const TriangleMesh torus = test::make_torus(0.1f, 0.03f, 40, 20);
  const float error = 0.004f;
  const auto hull = build_progressive_hull(torus, {.vertices = 4, .error = error});
  ASSERT_TRUE(hull.ok());
  expect_hull(torus, *hull, "torus");
  const ClosestPoints fine(torus);
  const TriangleMesh& mesh = hull->mesh;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                    c = mesh.positions[mesh.indices[t + 2]];
    for (const glm::vec3& middle : {(a + b + c) / 3.0f, 0.5f * (a + b), 0.5f * (b + c), 0.5f * (c + a)}) {
      EXPECT_LE(fine.at(middle).distance, error * 1.0001f);
    }
  }
}

TEST(ProgressiveHull, ThinSheetsStayClosed) {
  const TriangleMesh sheet = split(test::make_box(glm::vec3(0.0f), glm::vec3(0.2f, 0.1f, 0.0005f)), 4);
  const ProgressiveHull flat = hull_of(sheet, {.vertices = 20});
  expect_hull(sheet, flat, "flat");
  EXPECT_NEAR(flat.overhead(), 0.0, 1e-5);
  TriangleMesh bent = sheet;
  for (glm::vec3& position : bent.positions) position.z += 0.02f * std::sin(30.0f * position.x) * std::cos(25.0f * position.y);
  const ProgressiveHull hull = hull_of(bent, {.vertices = 300});
  expect_hull(bent, hull, "bent");
}

TEST(ProgressiveHull, TheSameMeshGivesTheSameHullWhereverItIs) {
  const TriangleMesh mesh = test::make_torus(0.3f, 0.1f, 40, 20);
  const ProgressiveHull once = hull_of(mesh, {.vertices = 90}), again = hull_of(mesh, {.vertices = 90});
  EXPECT_EQ(once.mesh.positions, again.mesh.positions);
  EXPECT_EQ(once.mesh.indices, again.mesh.indices);
  EXPECT_EQ(once.volume, again.volume);
  // Small, large, far from the origin.
  for (const float scale : {1e-4f, 1e3f}) {
    TriangleMesh other = mesh;
    for (glm::vec3& position : other.positions) position *= scale;
    const ProgressiveHull scaled = hull_of(other, {.vertices = 90});
    expect_hull(other, scaled, fmt::format("scale {}", scale));
    EXPECT_NEAR(scaled.overhead(), once.overhead(), 0.2 * once.overhead());
  }
  TriangleMesh far = mesh;
  for (glm::vec3& position : far.positions) position += glm::vec3(2.0f, -1.0f, 3.0f);
  expect_hull(far, hull_of(far, {.vertices = 90}), "far");
}

// Any closed surface will do: balls with every vertex at a height of its own, flattened, with slivers and spikes.
TEST(ProgressiveHull, RandomSurfacesAreEnclosed) {
  test::Numbers numbers(7);
  int crossed = 0;
  for (int round = 0; round < 40; ++round) {
    const auto rings = 3 + static_cast<std::uint32_t>(12.0f * numbers.next());
    const auto segments = 3 + static_cast<std::uint32_t>(20.0f * numbers.next());
    TriangleMesh mesh = round % 3 == 0 ? test::make_torus(1.0f, 0.4f, rings, segments)
                                       : test::make_sphere(1.0f, rings, segments);
    const float noise = 0.6f * numbers.next(), flat = 0.02f + numbers.next();
    for (glm::vec3& position : mesh.positions) {
      position *= 1.0f + noise * (numbers.next() - 0.5f);
      position.z *= flat;
    }
    if (mesh_volume(mesh) <= 0.0) continue;
    const auto vertices = 4 + static_cast<std::uint32_t>(numbers.next() * 0.5f * static_cast<float>(mesh.positions.size()));
    const auto hull = build_progressive_hull(mesh, {.vertices = vertices});
    ASSERT_TRUE(hull.ok()) << round << ": " << to_text(hull.diagnostics());
    const std::string what = fmt::format("round {}: {} of {}", round, vertices, mesh.positions.size());
    EXPECT_EQ(test::manifold_fault(hull->mesh), "") << what;
    // Where a mesh passes through itself, parts of it may be inside out: then there is nothing to enclose.
    if (find_self_intersections(mesh.positions, mesh.indices).pairs > 0) {
      ++crossed;
    } else {
      expect_hull(mesh, *hull, what);
    }
    EXPECT_EQ(hull.diagnostics().warnings.size(), hull->mesh.positions.size() > vertices ? 1u : 0u);
  }
  EXPECT_LT(crossed, 20);
}

}  // namespace
}  // namespace fascicle::muscle
