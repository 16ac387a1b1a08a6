#include "modules/muscle/kernels/hull/line_place.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

TEST(PlaceAlong, LinesThatAreNoneHaveAPlaceAllTheSame) {
  EXPECT_EQ(place_along({}, 0.5f), glm::vec3(0.0f));
  const std::vector<glm::vec3> point{{1, 2, 3}}, nowhere{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(place_along(point, 0.5f), point[0]);
  EXPECT_EQ(place_along(nowhere, 0.5f), nowhere[0]);
}

TEST(PlaceAlong, GoesByLengthNotBySegment) {
  const std::vector<glm::vec3> line{{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 1, 0}};
  EXPECT_EQ(place_along(line, 0.0f), line.front());
  EXPECT_EQ(place_along(line, 1.0f), line.back());
  EXPECT_LT(glm::distance(place_along(line, 0.5f), glm::vec3(2, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(place_along(line, 0.75f), glm::vec3(3, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(place_along(line, 0.875f), glm::vec3(3, 0.5f, 0)), 1e-6f);
}

TEST(PlaceAlong, BeyondItsEndsIsAtThem) {
  const std::vector<glm::vec3> line{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(place_along(line, -1.0f), line.front());
  EXPECT_EQ(place_along(line, 2.0f), line.back());
}

}  // namespace
}  // namespace fascicle::muscle
