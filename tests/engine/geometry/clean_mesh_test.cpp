#include "engine/geometry/clean_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/content/mesh_reader.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// The triangles by their corners' places, each turned so that the least comes first, in order: equal for meshes that
// differ in nothing but the order of vertices and triangles.
using Corner = std::tuple<float, float, float>;
std::vector<std::array<Corner, 3>> triangles_of(const TriangleMesh& mesh) {
  std::vector<std::array<Corner, 3>> triangles;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<Corner, 3> t;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3& p = mesh.positions[mesh.indices[i + k]];
      t[k] = {p.x, p.y, p.z};
    }
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  std::ranges::sort(triangles);
  return triangles;
}

// Each triangle with its own vertices, in a random order and sense, a fifth of them twice.
TriangleMesh shatter(const TriangleMesh& mesh, std::uint32_t seed) {
  test::Numbers numbers(seed);
  std::vector<std::uint32_t> order(mesh.indices.size() / 3);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(numbers.next() * static_cast<float>(i))]);
  TriangleMesh out;
  for (const std::uint32_t t : order) {
    for (int copies = numbers.next() < 0.2f ? 2 : 1; copies > 0; --copies) {
      const std::uint32_t first = static_cast<std::uint32_t>(out.positions.size());
      const auto start = static_cast<std::uint32_t>(numbers.next() * 3.0f);
      for (std::uint32_t k = 0; k < 3; ++k)
        out.positions.push_back(mesh.positions[mesh.indices[3 * t + (start + k) % 3]]);
      const bool flip = numbers.next() < 0.5f;
      out.indices.insert(out.indices.end(), {first, first + (flip ? 2u : 1u), first + (flip ? 1u : 2u)});
    }
  }
  return out;
}

TriangleMesh without_triangle(TriangleMesh mesh, std::size_t t) {
  mesh.indices.erase(mesh.indices.begin() + 3 * static_cast<std::ptrdiff_t>(t),
                     mesh.indices.begin() + 3 * static_cast<std::ptrdiff_t>(t) + 3);
  return mesh;
}

TriangleMesh flipped(TriangleMesh mesh, std::span<const std::size_t> triangles) {
  for (const std::size_t t : triangles) std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
  return mesh;
}

const TriangleMesh kBox = test::make_box({0, 0, 0}, {1, 2, 3});

TEST(CleanMesh, OfNothingThereIsNothing) {
  const CleanMesh none = clean_mesh({});
  EXPECT_TRUE(none.mesh.indices.empty());
  EXPECT_FALSE(none.defects.sound());
  EXPECT_FALSE(none.defects.closed());
  EXPECT_EQ(none.defects.to_text(), "no triangle with an area");
}

TEST(CleanMesh, TrianglesWithoutAreaLeaveNothing) {
  TriangleMesh line;
  line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}};
  line.indices = {0, 1, 2, 0, 3, 1, 1, 1, 1, 2, 1, 0};
  const CleanMesh clean = clean_mesh(line);
  EXPECT_THAT(clean.mesh.indices, IsEmpty());
  EXPECT_THAT(clean.mesh.positions, IsEmpty());
  EXPECT_EQ(clean.defects.degenerate_triangles, 3u);
  EXPECT_EQ(clean.defects.duplicate_triangles, 1u);
  EXPECT_EQ(clean.defects.to_text(),
            "no triangle with an area, 3 triangles without area (left out), 1 triangle twice (left out), 1 vertex at "
            "the place of another (welded)");
}

TEST(CleanMesh, VerticesThatAreNotFiniteGoWithTheirTriangles) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    TriangleMesh mesh = kBox;
    mesh.positions[7].y = bad;
    const CleanMesh clean = clean_mesh(mesh);
    EXPECT_EQ(clean.defects.non_finite_vertices, 1u);
    EXPECT_EQ(clean.mesh.positions.size(), 7u);
    EXPECT_FALSE(clean.defects.sound());
    EXPECT_EQ(clean.defects.holes, 1u);
    for (const glm::vec3& p : clean.mesh.positions) EXPECT_EQ(p, p);
    for (glm::vec3& p : mesh.positions) p.x = bad;
    EXPECT_THAT(clean_mesh(mesh).mesh.indices, IsEmpty());
  }
}

TEST(CleanMesh, ASoundMeshStaysAsItIs) {
  for (const TriangleMesh& mesh : {kBox, test::make_sphere(2.0f, 12, 17), test::make_torus(3.0f, 1.0f, 20, 11)}) {
    const CleanMesh clean = clean_mesh(mesh);
    EXPECT_EQ(clean.mesh.positions, mesh.positions);
    EXPECT_EQ(clean.mesh.indices, mesh.indices);
    EXPECT_TRUE(clean.defects.sound());
    EXPECT_EQ(clean.defects.to_text(), "");
    EXPECT_EQ(clean.defects.components, 1u);
    for (std::size_t t = 0; t < clean.source_triangles.size(); ++t) EXPECT_EQ(clean.source_triangles[t], t);
  }
}

TEST(CleanMesh, ShatteredMeshesComeBack) {
  const TriangleMesh shapes[] = {kBox, test::make_sphere(0.02f, 9, 14, {5, 0, 0}),
                                 test::make_torus(100.0f, 30.0f, 24, 9)};
  for (const TriangleMesh& whole : shapes) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
      const TriangleMesh soup = shatter(whole, seed);
      const CleanMesh clean = clean_mesh(soup);
      EXPECT_EQ(triangles_of(clean.mesh), triangles_of(whole));
      EXPECT_EQ(clean.mesh.positions.size(), whole.positions.size());
      EXPECT_TRUE(clean.defects.closed());
      EXPECT_EQ(clean.defects.duplicate_triangles, (soup.indices.size() - whole.indices.size()) / 3);
      EXPECT_EQ(clean.defects.welded_vertices, soup.positions.size() - whole.positions.size());
      for (std::size_t t = 0; t < clean.source_triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const glm::vec3& p = clean.mesh.positions[clean.mesh.indices[3 * t + k]];
          bool found = false;
          for (std::size_t j = 0; j < 3; ++j) found |= soup.positions[3 * clean.source_triangles[t] + j] == p;
          EXPECT_TRUE(found);
        }
      }
    }
  }
}

TEST(CleanMesh, VerticesWeldWithinAMillionthOfTheDiagonal) {
  // Two halves of a box whose rims are apart by a given part of the diagonal (5 m).
  const auto halves = [](float part) {
    TriangleMesh box = test::make_box({0, 0, 0}, {0, 3, 4});
    box.positions[7].x = box.positions[5].x = box.positions[3].x = box.positions[1].x = 1e-3f;
    TriangleMesh soup = shatter(box, 3);
    test::Numbers numbers(9);
    for (glm::vec3& p : soup.positions) p.x += 5.0f * part * (numbers.next() - 0.5f);
    return clean_mesh(soup);
  };
  EXPECT_EQ(halves(0.9e-6f).mesh.positions.size(), 8u);
  EXPECT_TRUE(halves(0.9e-6f).defects.closed());
  EXPECT_GT(halves(1e-5f).mesh.positions.size(), 8u);
  EXPECT_FALSE(halves(1e-5f).defects.closed());
}

TEST(CleanMesh, AVertexInAnEdgeIsJoinedToTheTriangleAcross) {
  // The box's lower face is a fan over five corners, of which one lies in an edge: a triangle without area, which keeps
  // its neighbours together.
  TriangleMesh mesh = kBox;
  mesh.positions.push_back({0.5f, 0.0f, 0.0f});
  mesh.indices[0] = 0, mesh.indices[1] = 2, mesh.indices[2] = 1;  // below
  mesh.indices.insert(mesh.indices.end(), {0, 1, 8});             // no area
  const std::array<std::uint32_t, 3> front = {mesh.indices[12], mesh.indices[13], mesh.indices[14]};
  EXPECT_THAT(front, ElementsAre(0, 1, 4));  // the face y = 0, split at the vertex
  mesh.indices[12] = 0, mesh.indices[13] = 8, mesh.indices[14] = 4;
  mesh.indices.insert(mesh.indices.end(), {8, 1, 4});
  const CleanMesh clean = clean_mesh(mesh);
  EXPECT_TRUE(clean.defects.sound()) << clean.defects.to_text();
  EXPECT_EQ(clean.defects.degenerate_triangles, 1u);
  EXPECT_EQ(clean.mesh.indices.size(), mesh.indices.size());
  EXPECT_DOUBLE_EQ(mesh_volume(clean.mesh), 6.0);
  for (std::size_t i = 0; i < clean.mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return clean.mesh.positions[clean.mesh.indices[i + k]]; };
    EXPECT_GT(glm::length(glm::cross(at(1) - at(0), at(2) - at(0))), 0.1f);
  }
}

TEST(CleanMesh, HolesAreCountedAndStay) {
  const TriangleMesh sphere = test::make_sphere(1.0f, 20, 30);
  CleanMesh clean = clean_mesh(without_triangle(sphere, 400));
  EXPECT_EQ(clean.defects.open_edges, 3u);
  EXPECT_EQ(clean.defects.holes, 1u);
  EXPECT_FALSE(clean.defects.closed());
  EXPECT_EQ(clean.defects.to_text(), "3 open edges round 1 hole");
  EXPECT_EQ(clean.mesh.indices.size(), sphere.indices.size() - 3);
  clean = clean_mesh(without_triangle(without_triangle(sphere, 700), 100));
  EXPECT_EQ(clean.defects.to_text(), "6 open edges round 2 holes");
}

TEST(CleanMesh, FlippedPatchesAndWholesAreTurned) {
  const TriangleMesh sphere = test::make_sphere(1.0f, 20, 30);
  const std::size_t patch[] = {3, 4, 5, 600};
  CleanMesh clean = clean_mesh(flipped(sphere, patch));
  EXPECT_EQ(triangles_of(clean.mesh), triangles_of(sphere));
  EXPECT_EQ(clean.defects.to_text(), "4 flipped triangles (turned round)");
  EXPECT_FALSE(clean.defects.inverted);

  clean = clean_mesh(test::inside_out(sphere));
  EXPECT_EQ(triangles_of(clean.mesh), triangles_of(sphere));
  EXPECT_EQ(clean.defects.flipped_triangles, 0u);
  EXPECT_EQ(clean.defects.to_text(), "inside out (turned round)");

  clean = clean_mesh(flipped(test::inside_out(sphere), patch));
  EXPECT_EQ(triangles_of(clean.mesh), triangles_of(sphere));
  EXPECT_EQ(clean.defects.to_text(), "inside out (turned round), 4 flipped triangles (kept)");
}

TEST(CleanMesh, ManySelfIntersectionsAreAtLeastSoMany) {
  MeshDefects defects;
  defects.components = 1;
  defects.self_intersections = 1000;
  EXPECT_EQ(defects.to_text(), "1000 pairs of triangles that cross each other");
  defects.more_self_intersections = true;
  EXPECT_EQ(defects.to_text(), "at least 1000 pairs of triangles that cross each other");
  defects.open_edges = 4;
  defects.holes = 1;
  EXPECT_EQ(defects.to_text(), "4 open edges round 1 hole, at least 1000 pairs of triangles that cross each other");
  defects.self_intersections = 0;  // none was found before the search was cut off
  EXPECT_EQ(defects.to_text(), "4 open edges round 1 hole");
}

TEST(CleanMesh, AnythingCanBeCleaned) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    TriangleMesh soup = test::make_soup(seed, seed);
    test::Numbers numbers(seed);
    // On a coarse grid: many coincidences, flat triangles and crossings through edges.
    for (glm::vec3& p : soup.positions) p = glm::vec3(glm::ivec3(numbers.point(0.0f, 4.0f)));
    const CleanMesh clean = clean_mesh(soup);
    EXPECT_EQ(clean.mesh.indices.size(), 3 * clean.source_triangles.size());
    for (std::size_t i = 0; i < clean.mesh.indices.size(); i += 3) {
      const auto at = [&](std::size_t k) { return clean.mesh.positions[clean.mesh.indices[i + k]]; };
      EXPECT_GT(glm::length(glm::cross(at(1) - at(0), at(2) - at(0))), 0.0f);
    }
    const CleanMesh again = clean_mesh(clean.mesh);
    EXPECT_EQ(again.mesh.positions, clean.mesh.positions);
    EXPECT_EQ(triangles_of(again.mesh).size(), triangles_of(clean.mesh).size());
    EXPECT_EQ(again.defects.degenerate_triangles + again.defects.duplicate_triangles + again.defects.welded_vertices,
              0u);
    EXPECT_EQ(again.defects.open_edges, clean.defects.open_edges);
    EXPECT_EQ(again.defects.self_intersections, clean.defects.self_intersections);
  }
}

CleanMesh clean_data(const std::string& file) {
  const Result<TriangleMesh> mesh = read_mesh((test::data_folder() / file).string());
  EXPECT_TRUE(mesh.ok()) << to_text(mesh.diagnostics());
  return clean_mesh(*mesh);
}

TEST(CleanMeshData, AnatomicalMusclesAreSound) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const CleanMesh gluteus = clean_data("pbd/gluteus_maximus.vtk");
  EXPECT_TRUE(gluteus.defects.sound()) << gluteus.defects.to_text();
  EXPECT_EQ(gluteus.mesh.positions.size(), 9878u);
  EXPECT_EQ(gluteus.mesh.indices.size(), 3u * 19752u);
  EXPECT_NEAR(mesh_volume(gluteus.mesh), 746600.0, 100.0);
  const CleanMesh iliacus = clean_data("pbd/iliacus.vtk");
  EXPECT_TRUE(iliacus.defects.sound()) << iliacus.defects.to_text();
  EXPECT_NEAR(mesh_volume(iliacus.mesh), 102300.0, 100.0);
  const CleanMesh box = clean_data("pbd/box.vtk");
  EXPECT_TRUE(box.defects.sound()) << box.defects.to_text();
  EXPECT_NEAR(mesh_volume(box.mesh), 100.0 * 80.0 * 100.0, 1.0);
}

TEST(CleanMeshData, FlippedFacesAreTurned) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/femur.vtk");
  const CleanMesh femur = clean_data("pbd/femur.vtk");
  EXPECT_EQ(femur.defects.to_text(), "5 flipped triangles (turned round)");
  for (const char* plate : {"pbd/plate_top.vtk", "pbd/plate_bottom.vtk"}) {
    const CleanMesh clean = clean_data(plate);
    EXPECT_EQ(clean.defects.to_text(), "2 flipped triangles (turned round)");
    EXPECT_DOUBLE_EQ(mesh_volume(clean.mesh), 400.0 * 100.0 * 400.0);
  }
}

TEST(CleanMeshData, BonesOfOpenSimHaveDefectsOfAllKinds) {
  FASCICLE_SKIP_WITHOUT_DATA("opensim/Geometry/arm_r_radius.vtp");
  EXPECT_TRUE(clean_data("opensim/Geometry/femur_r.vtp").defects.sound());
  EXPECT_TRUE(clean_data("opensim/Geometry/treadmill.vtp").defects.sound());  // 24 vertices, 16 of them to be welded
  const CleanMesh radius = clean_data("opensim/Geometry/arm_r_radius.vtp");
  EXPECT_EQ(radius.defects.to_text(),
            "55 open edges round 3 holes, 15 edges with more than two triangles, 22 pairs of triangles that cross each "
            "other, 45 flipped triangles (turned round)");
  EXPECT_NEAR(mesh_volume(radius.mesh), 1.71e-5, 1e-7);  // as given, two halves cancel
}

}  // namespace
}  // namespace fascicle
