#include "engine/geometry/orient_triangles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

using testing::Each;
using testing::ElementsAre;

TriangleSenses senses_of(const TriangleMesh& mesh) { return orient_triangles(mesh.positions, mesh.indices); }

// Flips each triangle that `flips` says, then tells whether the found senses turn just these back.
void expect_turned_back(TriangleMesh mesh, const std::vector<std::uint8_t>& flips) {
  for (std::size_t t = 0; t < flips.size(); ++t) {
    if (flips[t] != 0) std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
  }
  EXPECT_EQ(senses_of(mesh).turned, flips);
}

std::vector<std::uint8_t> random_flips(const TriangleMesh& mesh, std::uint32_t seed, float part) {
  test::Numbers numbers(seed);
  std::vector<std::uint8_t> flips(mesh.indices.size() / 3);
  for (std::uint8_t& flip : flips) flip = numbers.next() < part;
  return flips;
}

// A sphere without the rows nearest to its lower pole.
TriangleMesh make_bowl(std::uint32_t rings, std::uint32_t rows) {
  TriangleMesh mesh = test::make_sphere(1.0f, rings, 24);
  const float below = static_cast<float>(std::cos(std::numbers::pi * rows / rings)) - 1e-4f;
  TriangleMesh out{{}, mesh.positions, {}, {}};
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corners = std::span(mesh.indices).subspan(i, 3);
    if (std::ranges::all_of(corners, [&](std::uint32_t v) { return mesh.positions[v].z > below; }))
      out.indices.insert(out.indices.end(), corners.begin(), corners.end());
  }
  return out;
}

TEST(OrientTriangles, OfNothingThereIsNothing) {
  const TriangleSenses senses = orient_triangles({}, {});
  EXPECT_TRUE(senses.turned.empty());
  EXPECT_EQ(senses.components, 0u);
}

TEST(OrientTriangles, AMoebiusStripHasAnEdgeThatContradicts) {
  TriangleMesh strip;
  const std::uint32_t count = 20;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turn = std::numbers::pi * i / count, around = 2.0 * turn;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1.0 + side * std::cos(turn);
      strip.positions.emplace_back(r * std::cos(around), r * std::sin(around), side * std::sin(turn));
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool last = i + 1 == count;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;  // joined with a half turn
    strip.indices.insert(strip.indices.end(), {a, b, c, c, b, d});
  }
  const TriangleSenses senses = senses_of(strip);
  EXPECT_EQ(senses.components, 1u);
  EXPECT_EQ(senses.twisted_edges, 1u);
  EXPECT_EQ(senses.holes, 1u);  // its rim is one
  EXPECT_EQ(senses.open_edges, 2 * count);
  EXPECT_EQ(senses.crowded_edges, 0u);
}

TEST(OrientTriangles, ClosedMeshesEndOutwardWhateverTheyWere) {
  for (const TriangleMesh& mesh : {test::make_box({9, 9, 9}, {10, 11, 12}), test::make_sphere(1e-3f, 8, 12, {1, 0, 0}),
                                   test::make_torus(50.0f, 20.0f, 16, 8)}) {
    for (const float part : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) expect_turned_back(mesh, random_flips(mesh, 7, part));
  }
}

TEST(OrientTriangles, ShellsInsideShellsAndApartAreAllOutward) {
  const TriangleMesh shells = test::join(test::join(test::make_sphere(1.0f, 10, 12), test::make_sphere(0.5f, 8, 10)),
                                         test::make_box({3, 3, 3}, {4, 4, 4}));
  expect_turned_back(shells, random_flips(shells, 3, 0.5f));
  const TriangleSenses senses = senses_of(shells);
  EXPECT_EQ(senses.components, 3u);
  EXPECT_EQ(senses.open_edges, 0u);
}

TEST(OrientTriangles, BowlsAreTreatedAsClosed) {
  for (const std::uint32_t rows : {19u, 15u, 12u, 10u}) {  // of 20: nearly whole to a half
    const TriangleMesh bowl = make_bowl(20, rows);
    const TriangleSenses senses = senses_of(bowl);
    EXPECT_EQ(senses.holes, 1u);
    EXPECT_EQ(senses.open_edges, 24u);
    EXPECT_THAT(senses.turned, Each(0));
    expect_turned_back(bowl, random_flips(bowl, rows, 0.7f));
  }
}

TEST(OrientTriangles, ASheetKeepsTheSenseOfMostOfIt) {
  TriangleMesh sheet = make_bowl(40, 4);
  EXPECT_THAT(senses_of(sheet).turned, Each(0));
  EXPECT_THAT(senses_of(test::inside_out(sheet)).turned, Each(0));
  sheet.indices = {sheet.indices.begin(), sheet.indices.begin() + 30};
  std::swap(sheet.indices[0], sheet.indices[1]);
  EXPECT_THAT(senses_of(sheet).turned, ElementsAre(1, 0, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(OrientTriangles, PatchesAroundAMiddleAreTurnedTogether) {
  // The six faces of a box, apart from each other.
  TriangleMesh box = test::make_box({-2, -1, -1}, {2, 1, 1});
  TriangleMesh faces;
  for (std::size_t f = 0; f < 6; ++f) {
    for (std::size_t k = 0; k < 6; ++k) {
      faces.indices.push_back(static_cast<std::uint32_t>(6 * f + k));
      faces.positions.push_back(box.positions[box.indices[6 * f + k]]);
    }
    // The second triangle's corners that it shares with the first.
    for (std::size_t k = 3; k < 6; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (box.indices[6 * f + k] == box.indices[6 * f + j])
          faces.indices[6 * f + k] = static_cast<std::uint32_t>(6 * f + j);
      }
    }
  }
  EXPECT_THAT(senses_of(faces).turned, Each(0));
  EXPECT_EQ(senses_of(faces).components, 6u);
  EXPECT_EQ(senses_of(faces).holes, 6u);
  EXPECT_THAT(senses_of(test::inside_out(faces)).turned, Each(1));
}

TEST(OrientTriangles, AMembraneInsideMakesItsRimCrowded) {
  // Two boxes on top of each other with the face between them.
  TriangleMesh mesh = test::make_box({0, 0, 0}, {1, 1, 1});
  for (std::uint32_t i = 4; i < 8; ++i) mesh.positions.push_back(mesh.positions[i] + glm::vec3(0, 0, 1));
  const TriangleMesh box = mesh;
  for (std::size_t i = 0; i < 36; ++i) {
    if (i / 6 != 0) mesh.indices.push_back(box.indices[i] + 4);  // its lower face is the other's upper one
  }
  const TriangleSenses senses = senses_of(mesh);
  EXPECT_EQ(senses.crowded_edges, 4u);
  EXPECT_EQ(senses.open_edges, 0u);
  EXPECT_EQ(senses.components, 3u);
  EXPECT_THAT(senses.turned, Each(0));
}

}  // namespace
}  // namespace fascicle
