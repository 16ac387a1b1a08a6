#include "modules/muscle/asset/fit/fit_surface.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

// Boxes 10 mm wide, 20 mm from each other along x from 0. The first has a small hole in a side.
TriangleMesh row_of_boxes(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const float x = 0.02f * static_cast<float>(i);
    mesh = test::join(std::move(mesh), test::make_box({x, -0.1f, -0.1f}, {x + 0.01f, 0.1f, 0.1f}));
  }
  mesh.indices.erase(mesh.indices.begin(), mesh.indices.begin() + 3);
  return mesh;
}

std::vector<InsideInterval> stretches_along_x(const TriangleMesh& mesh) {
  const FitSurface surface(mesh, RayScene(mesh), false);
  const Line line{{-0.5f, 0.013f, 0.007f}, {1, 0, 0}};
  std::vector<std::uint32_t> starts;
  std::vector<InsideInterval> intervals;
  surface.find_inside({&line, 1}, starts, intervals);
  return intervals;
}

// With few crossings the winding number decides; with many the crossings do, and say the same.
TEST(FitSurface, DefectiveMeshesAreToldApartHoweverManyTheirCrossings) {
  for (const int count : {30, 40}) {
    const std::vector<InsideInterval> stretches = stretches_along_x(row_of_boxes(count));
    ASSERT_EQ(stretches.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      EXPECT_NEAR(stretches[static_cast<std::size_t>(i)].from, 0.5 + 0.02 * i, 1e-6);
      EXPECT_NEAR(stretches[static_cast<std::size_t>(i)].to, 0.51 + 0.02 * i, 1e-6);
    }
  }
}

TEST(FitSurface, ManyCrossingsThroughAHoleAreCountedFromBothEnds) {
  TriangleMesh mesh = row_of_boxes(40);
  mesh = test::join(std::move(mesh), test::make_box({0.9f, -0.1f, -0.1f}, {0.91f, 0.1f, 0.1f}));
  mesh.indices.resize(mesh.indices.size() - 6);  // without its far side
  const std::vector<InsideInterval> stretches = stretches_along_x(mesh);
  ASSERT_FALSE(stretches.empty());
  EXPECT_NEAR(stretches.front().from, 0.5, 1e-6);
  for (const InsideInterval& stretch : stretches) EXPECT_LE(stretch.to, 0.5 + 0.91);
}

TEST(FitSurface, WhereManyCrossingsEncloseNothingNothingIsInside) {
  EXPECT_TRUE(stretches_along_x(test::inside_out(row_of_boxes(40))).empty());
}

TEST(FitSurface, TrianglesWithoutOrderGiveFiniteNumbers) {
  TriangleMesh mesh = test::make_soup(6000, 5);
  for (glm::vec3& position : mesh.positions) position *= glm::vec3(0.1f, 0.02f, 0.02f);
  const MuscleDescription description = test::line_muscle({{-0.09f, 0, 0}, {0.09f, 0, 0}}, 12, 2);
  const FitInput input{&description, &mesh, {}};
  const glm::mat4 bone(1.0f);
  const FittedMuscle fitted = fit_muscles({&input, 1}, {&bone, 1})[0];
  EXPECT_FALSE(fitted.diagnostics.warnings.empty());
  for (const float radius : fitted.fit.radii) EXPECT_TRUE(std::isfinite(radius) && std::abs(radius) < 0.3f) << radius;
}

}  // namespace
}  // namespace fascicle::muscle
