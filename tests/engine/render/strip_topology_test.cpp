#include "engine/render/strip_topology.hpp"

#include <array>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/render/tube_surface.hpp"

namespace fascicle {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// The triangles that GL makes of strips and fans with primitive restart.
std::vector<Triangle> triangles_of(const StripTopology& topology) {
  std::vector<Triangle> triangles;
  const auto each_primitive = [](const std::vector<std::uint32_t>& indices, auto f) {
    std::vector<std::uint32_t> primitive;
    for (const std::uint32_t index : indices) {
      if (index != kPrimitiveRestart) {
        primitive.push_back(index);
        continue;
      }
      f(primitive);
      primitive.clear();
    }
    EXPECT_TRUE(primitive.empty()) << "the last primitive isn't ended";
  };
  each_primitive(topology.strip_indices, [&](const std::vector<std::uint32_t>& strip) {
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
      const bool odd = i % 2 == 1;
      triangles.push_back({strip[i + (odd ? 1 : 0)], strip[i + (odd ? 0 : 1)], strip[i + 2]});
    }
  });
  each_primitive(topology.fan_indices, [&](const std::vector<std::uint32_t>& fan) {
    for (std::size_t i = 1; i + 1 < fan.size(); ++i) triangles.push_back({fan[0], fan[i], fan[i + 1]});
  });
  return triangles;
}

TEST(StripTopology, CountsFollowFromRowsAndVertices) {
  StripTopology topology;
  append_tube_vertices(5, 8, topology);
  append_tube_indices(0, 5, 8, topology);
  EXPECT_EQ(topology.vertices.size(), 5u * 8u + 2u);
  EXPECT_EQ(topology.strip_indices.size(), 4u * (2u * 9u + 1u));
  EXPECT_EQ(topology.fan_indices.size(), 2u * (8u + 2u + 1u));
  EXPECT_EQ(topology.ring_indices.size(), 5u * (8u + 2u));
  EXPECT_EQ(topology.row_count, 5u);
  EXPECT_EQ(topology.item_count, 1u);
}

TEST(StripTopology, SecondTubeGoesOnWhereTheFirstEnded) {
  StripTopology topology;
  append_tube_vertices(2, 6, topology);
  append_tube_vertices(3, 6, topology);
  EXPECT_EQ(topology.vertices[14].row, 2u);       // the second tube's first row
  EXPECT_EQ(topology.vertices.back().row, 4u);    // its last cap
  EXPECT_EQ(topology.vertices.back().turn, StripVertexInfo::kAxis);
  EXPECT_FLOAT_EQ(topology.vertices[14 + 6 + 3].turn, 0.5f);
  EXPECT_FLOAT_EQ(topology.vertices[14 + 6].along, 0.5f);
  EXPECT_EQ(topology.item_count, 2u);
}

TEST(StripTopology, TubeIsClosedAndFacesOutwards) {
  const TubeSurface tube = make_cylinder(2.0f, 0.5f, 6, 0.0f, 4);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (const Triangle& t : triangles_of(tube.topology)) {
    for (int corner = 0; corner < 3; ++corner) {
      edges[{t[static_cast<std::size_t>(corner)], t[static_cast<std::size_t>((corner + 1) % 3)]}] += 1;
    }
    const glm::vec3 &a = tube.vertices[t[0]].position, &b = tube.vertices[t[1]].position,
                    &c = tube.vertices[t[2]].position;
    volume += static_cast<double>(glm::dot(a, glm::cross(b, c))) / 6.0;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << "no triangle on the other side";
  }
  const double hexagon = 1.5 * std::sqrt(3.0) * 0.25;  // area at radius 0.5
  EXPECT_NEAR(volume, 2.0 * hexagon, 1e-6);
}

}  // namespace
}  // namespace fascicle
