#include "engine/geometry/weld_vertices.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include <glm/geometric.hpp>

#include "tests/support/shapes.hpp"

namespace fascicle {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(WeldVertices, OfNothingThereIsNothing) { EXPECT_THAT(weld_vertices({}, 1.0), IsEmpty()); }

TEST(WeldVertices, OnePlaceIsOneVertex) {
  const std::vector<glm::vec3> same(4, glm::vec3(1e30f, -0.0f, 3.0f));
  EXPECT_THAT(weld_vertices(same, 0.0), ElementsAre(0, 0, 0, 0));
  const std::vector<glm::vec3> zeros = {{0.0f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}};
  EXPECT_THAT(weld_vertices(zeros, 0.0), ElementsAre(0, 0, 2));
}

TEST(WeldVertices, TheFirstStandsForThoseNearIt) {
  const std::vector<glm::vec3> row = {{0, 0, 0}, {0.6f, 0, 0}, {1.2f, 0, 0}, {1.8f, 0, 0}, {50, 0, 0}};
  EXPECT_THAT(weld_vertices(row, 1.0), ElementsAre(0, 0, 2, 2, 4));  // the third is near the second only
}

TEST(WeldVertices, AgreesWithLookingAtEveryPair) {
  for (const double tolerance : {0.0, 1e-7, 0.01, 0.2, 5.0}) {
    test::Numbers numbers(5);
    std::vector<glm::vec3> points;
    for (int i = 0; i < 400; ++i) points.push_back(numbers.point(-1.0f, 1.0f));
    for (int i = 0; i < 100; ++i) points.push_back(points[static_cast<std::size_t>(numbers.next() * 400.0f)]);
    std::vector<std::uint32_t> expected(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      expected[i] = i;
      for (std::uint32_t j = i; j-- > 0;) {
        if (expected[j] == j && glm::distance(glm::dvec3(points[i]), glm::dvec3(points[j])) <= tolerance)
          expected[i] = j;
      }
    }
    EXPECT_EQ(weld_vertices(points, tolerance), expected);
  }
}

}  // namespace
}  // namespace fascicle
