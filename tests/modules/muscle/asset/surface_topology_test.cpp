// Strips, fans and tetrahedra: closed, outward, each triangle once, faces matching.
#include "modules/muscle/asset/surface_topology.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// The triangles that GL draws from a strip or fan buffer, with their winding.
std::vector<Triangle> triangles_of(std::span<const std::uint32_t> indices, bool fan) {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> primitive;
  for (const std::uint32_t index : indices) {
    if (index != kRestartIndex) {
      primitive.push_back(index);
      continue;
    }
    for (std::size_t i = 2; i < primitive.size(); ++i) {
      if (fan) triangles.push_back({primitive[0], primitive[i - 1], primitive[i]});
      else if (i % 2 == 0) triangles.push_back({primitive[i - 2], primitive[i - 1], primitive[i]});
      else triangles.push_back({primitive[i - 1], primitive[i - 2], primitive[i]});
    }
    primitive.clear();
  }
  EXPECT_TRUE(primitive.empty());
  return triangles;
}

std::shared_ptr<const MuscleAsset> build(std::uint32_t count, std::uint32_t subdivision) {
  const auto result = build_muscle_asset(test::synthetic_muscles(count, subdivision), test::rest_bones());
  EXPECT_TRUE(result.ok());
  return *result;
}

TEST(SurfaceTopology, IndexCountsAreTheMethods) {
  const auto asset = build(8, 1);
  for (const MuscleLayout& muscle : asset->muscles) {
    EXPECT_EQ(muscle.strip_index_count, (muscle.row_count - 1) * (2 * (8 + 1) + 1));
    EXPECT_EQ(muscle.fan_index_count, 2 * (8 + 2 + 1));
  }
}

TEST(SurfaceTopology, EveryMuscleIsAClosedManifold) {
  const auto asset = build(6, 1);
  for (const MuscleLayout& muscle : asset->muscles) {
    const std::span strips = std::span(asset->strip_indices).subspan(muscle.first_strip_index, muscle.strip_index_count);
    const std::span fans = std::span(asset->fan_indices).subspan(muscle.first_fan_index, muscle.fan_index_count);
    std::vector<Triangle> triangles = triangles_of(strips, false);
    const std::vector<Triangle> caps = triangles_of(fans, true);
    triangles.insert(triangles.end(), caps.begin(), caps.end());
    EXPECT_EQ(triangles.size(), 2u * 6 * (muscle.row_count - 1) + 2 * 6);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::set<std::uint32_t> used;
    for (const Triangle& t : triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        ++edges[{t[i], t[(i + 1) % 3]}];
        used.insert(t[i]);
      }
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    EXPECT_EQ(used.size(), muscle.vertex_count);
    EXPECT_EQ(*used.begin(), muscle.first_vertex);
    // Euler: V - E + F = 2.
    EXPECT_EQ(used.size() - edges.size() / 2 + triangles.size(), 2u);
  }
}

TEST(SurfaceTopology, VerticesKnowTheirRows) {
  const auto asset = build(8, 1);
  ASSERT_EQ(asset->vertex_rows.size(), asset->vertex_count);
  ASSERT_EQ(asset->row_muscles.size(), asset->row_count);
  for (std::uint32_t m = 0; m < asset->size(); ++m) {
    const MuscleLayout& muscle = asset->muscles[m];
    for (std::uint32_t v = 0; v < muscle.vertex_count; ++v) {
      const std::uint32_t row = asset->vertex_rows[muscle.first_vertex + v];
      EXPECT_EQ(asset->row_muscles[row], m);
      if (v < muscle.row_count * 8) {
        EXPECT_EQ(row, muscle.first_row + v / 8);
      }
    }
  }
}

TEST(SurfaceTopology, SixByFourSegmentsAreSeventyTwoTetrahedra) {
  MuscleDescription muscle;
  muscle.name = "m";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  muscle.volume = 1.0e-4f;
  muscle.section_vertices = 6;
  muscle.longitudinal_subdivision = 2;
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)});
  ASSERT_TRUE(result.ok());
  const auto tetrahedra = tetrahedra_of(**result, 0);
  EXPECT_EQ(tetrahedra.size(), 72u);
  // Each inner face belongs to two tetrahedra, each outer to one: the sides' and the caps' triangles.
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (const auto& tetrahedron : tetrahedra) {
    for (std::size_t skip = 0; skip < 4; ++skip) {
      std::array<std::uint32_t, 3> face{};
      std::size_t n = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i != skip) face[n++] = tetrahedron[i];
      }
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  std::size_t outer = 0;
  for (const auto& [face, count] : faces) {
    EXPECT_LE(count, 2);
    outer += count == 1 ? 1 : 0;
  }
  EXPECT_EQ(outer, 2u * 6 * 4 + 2 * 6);
}

}  // namespace
}  // namespace fascicle::muscle
