// Lines through meshes: Embree against the plain loop, against the method's rays taken literally, and along edges.
#include "engine/geometry/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/ray_reference.hpp"
#include "engine/parallel/for_range.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

std::vector<Line> random_lines(const TriangleMesh& mesh, std::size_t count, std::uint32_t seed) {
  const Bounds bounds = mesh_bounds(mesh);
  test::Numbers numbers(seed);
  std::vector<Line> lines;
  while (lines.size() < count) {
    const glm::vec3 direction = numbers.point(-1.0f, 1.0f);
    if (glm::length(direction) < 0.1f) continue;
    const glm::vec3 at = bounds.lower + (bounds.upper - bounds.lower) * numbers.point(0.0f, 1.0f);
    lines.push_back({at, glm::normalize(direction)});
  }
  return lines;
}

std::vector<LineExtremes> cast(const RayScene& scene, std::span<const Line> lines) {
  std::vector<LineExtremes> extremes(lines.size());
  scene.cast(lines, extremes);
  return extremes;
}

// The method's ray P from the vertex at `radius` along the line, else its ray N; nothing where both miss.
std::optional<float> radius_by_rules(const std::vector<LineCrossing>& crossings, float radius) {
  std::optional<float> p, n;
  for (const LineCrossing& crossing : crossings) {
    const float along_p = crossing.t - radius, along_n = radius - crossing.t;
    const bool back_face_of_p = crossing.exit;   // e . n > 0
    const bool front_face_of_n = crossing.exit;  // (-e) . n < 0
    if (along_p >= 0.0f && back_face_of_p && (!p || along_p > *p)) p = along_p;
    if (along_n >= 0.0f && front_face_of_n && (!n || along_n < *n)) n = along_n;
  }
  if (p) return radius + *p;
  if (!n) return std::nullopt;
  const float distance = std::abs(radius - *n);
  return *n > radius ? -distance : distance;  // past the centre
}

TriangleMesh hard_mesh() {  // a ring and two balls that overlap it
  const TriangleMesh ring = test::make_torus(0.5f, 0.15f, 40, 24);
  return test::join(test::join(ring, test::make_sphere(0.3f, 12, 20, {0.5f, 0.1f, 0.0f})),
                    test::make_sphere(0.2f, 10, 16, {-0.4f, 0.2f, 0.3f}));
}

TEST(RayScene, AMeshWithoutTrianglesGivesNoHits) {
  const RayDevice device;
  TriangleMesh mesh = test::make_box({0, 0, 0}, {1, 1, 1});
  mesh.indices.clear();
  for (const TriangleMesh& empty : {TriangleMesh{}, mesh}) {
    const RayScene scene(device, empty);
    const Line line{{0.5f, 0.5f, 0.5f}, {0.0f, 0.0f, 1.0f}};
    const LineExtremes found = cast(scene, std::span(&line, 1))[0];
    EXPECT_TRUE(std::isinf(found.first_entry) && found.first_entry > 0.0f);
    EXPECT_TRUE(std::isinf(found.last_exit) && found.last_exit < 0.0f);
    std::vector<std::uint32_t> starts;
    std::vector<LineCrossing> crossings;
    scene.cast_all(std::span(&line, 1), starts, crossings);
    EXPECT_EQ(starts, (std::vector<std::uint32_t>{0, 0}));
  }
}

TEST(RayScene, NoLinesAreNoLines) {
  const RayScene scene(RayDevice{}, test::make_box({0, 0, 0}, {1, 1, 1}));
  scene.cast({}, {});
}

TEST(RayScene, ABoxIsEnteredAndLeftWhereItsFacesAre) {
  const RayDevice device;
  const RayScene scene(device, test::make_box({-1, -2, -3}, {1, 2, 5}));
  const std::vector<Line> lines = {{{0.3f, 0.2f, 0.1f}, {0, 0, 1}}, {{0.3f, 0.2f, 40.0f}, {0, 0, 1}},
                                   {{0.3f, 0.2f, 0.1f}, {-1, 0, 0}}, {{3.0f, 0.2f, 0.1f}, {0, 0, 1}}};
  const std::vector<LineExtremes> found = cast(scene, lines);
  EXPECT_NEAR(found[0].first_entry, -3.1f, 1e-5f);
  EXPECT_NEAR(found[0].last_exit, 4.9f, 1e-5f);
  EXPECT_NEAR(found[1].first_entry, -43.0f, 1e-4f);
  EXPECT_NEAR(found[1].last_exit, -35.0f, 1e-4f);
  EXPECT_NEAR(found[2].first_entry, -0.7f, 1e-5f);
  EXPECT_NEAR(found[2].last_exit, 1.3f, 1e-5f);
  EXPECT_TRUE(std::isinf(found[3].last_exit));
}

TEST(RayScene, OneLineAnswersTheFourRaysOfAnOppositePair) {
  const RayDevice device;
  const TriangleMesh mesh = hard_mesh();
  const RayScene scene(device, mesh);
  const std::vector<Line> lines = random_lines(mesh, 3000, 5);
  const std::vector<LineExtremes> found = cast(scene, lines);
  test::Numbers numbers(8);
  std::size_t negative = 0, missed = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<LineCrossing> here;
    cross_line_reference(mesh, lines[i], here);
    // The opposite vertex sees the line the other way round.
    std::vector<LineCrossing> opposite = here;
    for (LineCrossing& crossing : opposite) crossing = {-crossing.t, crossing.triangle, !crossing.exit};
    for (const float radius : {0.001f, 0.9f * numbers.next() + 0.01f, 3.0f}) {
      const std::optional<float> wanted = radius_by_rules(here, radius);
      const std::optional<float> wanted_opposite = radius_by_rules(opposite, radius);
      ASSERT_EQ(wanted.has_value(), std::isfinite(found[i].last_exit)) << i;
      ASSERT_EQ(wanted_opposite.has_value(), std::isfinite(found[i].first_entry)) << i;
      if (!wanted || !wanted_opposite) {
        ++missed;
        continue;
      }
      ASSERT_NEAR(*wanted, found[i].last_exit, 2e-5f) << "line " << i << " from radius " << radius;
      ASSERT_NEAR(*wanted_opposite, -found[i].first_entry, 2e-5f);
      negative += *wanted < 0.0f || *wanted_opposite < 0.0f ? 1 : 0;
    }
  }
  EXPECT_GT(negative, 1000u);  // the hard case did occur
  EXPECT_GT(missed, 100u);
}

TEST(RayScene, AgreesWithThePlainLoop) {
  const RayDevice device;
  for (const TriangleMesh& mesh : {hard_mesh(), test::make_torus(1.0f, 0.02f, 200, 6), test::make_corner(0.7f)}) {
    const RayScene scene(device, mesh), plain(mesh);
    const std::vector<Line> lines = random_lines(mesh, 4000, 3);
    const std::vector<LineExtremes> fast = cast(scene, lines), slow = cast(plain, lines);
    std::vector<std::uint32_t> starts, plain_starts;
    std::vector<LineCrossing> all, plain_all;
    scene.cast_all(lines, starts, all);
    plain.cast_all(lines, plain_starts, plain_all);
    std::size_t different = 0, hits = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::size_t count = starts[i + 1] - starts[i];
      // The plain loop is not watertight, and a line along a facet is hit or not by rounding.
      if (count != plain_starts[i + 1] - plain_starts[i]) {
        ++different;
        continue;
      }
      for (std::size_t j = 0; j < count; ++j) {
        const LineCrossing &a = all[starts[i] + j], &b = plain_all[plain_starts[i] + j];
        ASSERT_NEAR(a.t, b.t, 1e-4f) << i;
        ASSERT_EQ(a.exit, b.exit) << i;
      }
      hits += count;
      if (count == 0) continue;
      ASSERT_NEAR(fast[i].first_entry, slow[i].first_entry, 1e-4f);
      ASSERT_NEAR(fast[i].last_exit, slow[i].last_exit, 1e-4f);
      ASSERT_EQ(fast[i].first_entry, all[starts[i]].t);
      ASSERT_EQ(fast[i].last_exit, all[starts[i + 1] - 1].t);
    }
    EXPECT_LE(different, 4u);
    EXPECT_GT(hits, 1000u);
  }
}

// Lines through every vertex and every edge's middle of closed meshes: none slips through.
TEST(RayScene, NothingLeaksAtEdgesAndVertices) {
  const RayDevice device;
  test::Numbers numbers(1);
  for (const TriangleMesh& mesh : {test::make_sphere(1.0f, 24, 40, {3, 2, 1}), test::make_torus(2.0f, 0.5f, 60, 30),
                                   test::make_box({0, 0, 0}, {1, 2, 3})}) {
    const RayScene scene(device, mesh);
    std::vector<Line> lines;
    const auto add = [&](const glm::vec3& through) {
      for (int i = 0; i < 4; ++i) lines.push_back({through, glm::normalize(numbers.point(-1.0f, 1.0f) + 1e-3f)});
    };
    for (const glm::vec3& p : mesh.positions) add(p);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::size_t j = i % 3 == 2 ? i - 2 : i + 1;
      add(0.5f * (mesh.positions[mesh.indices[i]] + mesh.positions[mesh.indices[j]]));
    }
    const std::vector<LineExtremes> found = cast(scene, lines);
    std::vector<std::uint32_t> starts;
    std::vector<LineCrossing> crossings;
    scene.cast_all(lines, starts, crossings);
    std::size_t grazing = 0, unbalanced = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      int elsewhere = 0, here = 0;  // entries less exits
      for (std::size_t j = starts[i]; j < starts[i + 1]; ++j) {
        (std::abs(crossings[j].t) < 1e-3f ? here : elsewhere) += crossings[j].exit ? -1 : 1;
      }
      if (elsewhere == 0) {  // the line only touches the mesh here: either side may be seen, both or none
        ++grazing;
        continue;
      }
      unbalanced += here == -elsewhere ? 0 : 1;
      ASSERT_TRUE(std::isfinite(found[i].first_entry) && std::isfinite(found[i].last_exit)) << i;
      ASSERT_LT(found[i].first_entry, found[i].last_exit) << i;
    }
    EXPECT_LT(grazing, lines.size() / 2);  // many, at the corners of a box
    EXPECT_LE(unbalanced, 1u);  // a line in the plane of two triangles
  }
}

TEST(RayScene, LinesIntoTheInsideAlwaysHitTwice) {
  const RayDevice device;
  const TriangleMesh mesh = test::make_sphere(1.0f, 24, 40);
  const RayScene scene(device, mesh);
  std::vector<Line> lines;
  for (const glm::vec3& p : mesh.positions) lines.push_back({p, glm::normalize(glm::vec3(0.1f, -0.2f, 0.15f) - p)});
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::size_t j = i % 3 == 2 ? i - 2 : i + 1;
    const glm::vec3 p = 0.5f * (mesh.positions[mesh.indices[i]] + mesh.positions[mesh.indices[j]]);
    lines.push_back({p, glm::normalize(glm::vec3(-0.2f, 0.1f, 0.05f) - p)});
  }
  std::vector<std::uint32_t> starts;
  std::vector<LineCrossing> crossings;
  scene.cast_all(lines, starts, crossings);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    ASSERT_EQ(starts[i + 1] - starts[i], 2u) << i;
    EXPECT_NEAR(crossings[starts[i]].t, 0.0f, 1e-5f);
    EXPECT_FALSE(crossings[starts[i]].exit);
    EXPECT_TRUE(crossings[starts[i] + 1].exit);
  }
}

TEST(RayScene, TheSharedDiagonalOfAFaceIsCrossedOnce) {
  const RayScene scene(RayDevice{}, test::make_box({0, 0, 0}, {1, 1, 1}));
  const Line line{{0.5f, 0.5f, 0.25f}, {0, 0, 1}};
  std::vector<std::uint32_t> starts;
  std::vector<LineCrossing> crossings;
  scene.cast_all(std::span(&line, 1), starts, crossings);
  ASSERT_EQ(crossings.size(), 2u);
  EXPECT_FLOAT_EQ(crossings[0].t, -0.25f);
  EXPECT_FLOAT_EQ(crossings[1].t, 0.75f);
}

TEST(RayScene, ScenesAreBuiltAndCastByManyThreadsAtOnce) {
  const RayDevice device;
  const TriangleMesh mesh = hard_mesh();
  const std::vector<Line> lines = random_lines(mesh, 500, 9);
  const std::vector<LineExtremes> wanted = cast(RayScene(device, mesh), lines);
  std::vector<std::vector<LineExtremes>> found(32);
  parallel::for_range(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = cast(RayScene(device, mesh), lines);
  });
  for (const std::vector<LineExtremes>& one : found) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      ASSERT_EQ(one[i].first_entry, wanted[i].first_entry);
      ASSERT_EQ(one[i].last_exit, wanted[i].last_exit);
    }
  }
}

TEST(RayScene, RealMeshesGiveWhatThePlainLoopGives) {
  for (const char* name : {"pbd/gluteus_maximus.vtk", "pbd/iliacus.vtk"}) {
    FASCICLE_SKIP_WITHOUT_DATA(name);
    const auto mesh = read_mesh((test::data_folder() / name).string());
    ASSERT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
    const float size = mesh_bounds(*mesh).diagonal();
    const RayScene scene(RayDevice{}, *mesh), plain(*mesh);
    const std::vector<Line> lines = random_lines(*mesh, 1500, 21);
    const std::vector<LineExtremes> fast = cast(scene, lines), slow = cast(plain, lines);
    std::size_t different = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      ASSERT_EQ(std::isfinite(fast[i].first_entry), std::isfinite(fast[i].last_exit)) << i;
      const bool same = fast[i].last_exit == slow[i].last_exit ||
                        (std::abs(fast[i].first_entry - slow[i].first_entry) < 1e-4f * size &&
                         std::abs(fast[i].last_exit - slow[i].last_exit) < 1e-4f * size);
      different += same ? 0 : 1;
    }
    EXPECT_LE(different, 2u);  // grazing lines, and leaks of the plain loop
  }
}

}  // namespace
}  // namespace fascicle
