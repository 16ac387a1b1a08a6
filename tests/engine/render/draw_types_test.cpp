#include "engine/render/draw_types.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace fascicle {
namespace {

TEST(PackNormal, ZeroAndNonFiniteBecomeUp) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const glm::vec3 bad : {glm::vec3(0.0f), glm::vec3(nan, 0, 0), glm::vec3(0, infinity, 0)}) {
    EXPECT_EQ(unpack_normal(pack_normal(bad)), glm::vec3(0.0f, 1.0f, 0.0f));
  }
}

TEST(PackNormal, RoundTripIsWithinHalfAStepOnTheWholeSphere) {
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j < 80; ++j) {
      const float polar = 3.14159265f * static_cast<float>(i) / 40.0f;
      const float turn = 6.28318531f * static_cast<float>(j) / 80.0f;
      const glm::vec3 n(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
      const glm::vec3 difference = glm::abs(unpack_normal(pack_normal(3.0f * n)) - n);
      EXPECT_LE(std::max({difference.x, difference.y, difference.z}), 0.5f / 511.0f + 1e-6f);
    }
  }
}

TEST(PackNormal, LayoutIsTwoTenTenTen) {
  EXPECT_EQ(pack_normal({1, 0, 0}), 511u);
  EXPECT_EQ(pack_normal({0, 1, 0}), 511u << 10);
  EXPECT_EQ(pack_normal({0, 0, 1}), 511u << 20);
  EXPECT_EQ(pack_normal({-1, 0, 0}), 513u);  // -511 in 10 bits
}

TEST(PackVertices, NormalsDefaultToUp) {
  const glm::vec3 positions[2] = {{1, 2, 3}, {4, 5, 6}};
  DrawVertex vertices[2];
  pack_vertices(positions, {}, vertices);
  EXPECT_EQ(vertices[1].position, positions[1]);
  EXPECT_EQ(vertices[1].normal, pack_normal({0, 1, 0}));
}

TEST(PackColour, BytesAreRgbaFromTheLowestAndClamped) {
  EXPECT_EQ(pack_colour({1.0f, 0.0f, 0.0f, 1.0f}), 0xff0000ffu);
  EXPECT_EQ(pack_colour({-1.0f, 2.0f, 0.5f, 0.0f}), 0x0080ff00u);
}

}  // namespace
}  // namespace fascicle
