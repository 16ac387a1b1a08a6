// Wide attachments: the end sections lie on the areas, and the attachment points stay.
#include "modules/muscle/asset/fit/end_area.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

// A square of side 2 r in the plane through the origin with this normal (in the x-y plane), as two triangles.
TriangleMesh square(double degrees, float r) {
  const double angle = degrees * 3.14159265358979 / 180.0;
  const glm::vec3 side(-std::sin(angle), std::cos(angle), 0.0f), z(0, 0, 1);
  TriangleMesh mesh;
  mesh.positions = {-r * side - r * z, r * side - r * z, r * side + r * z, -r * side + r * z};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TEST(AreaNormal, IsTheAreasAlongTheLine) {
  for (const double degrees : {0.0, 20.0, -45.0, 59.0}) {
    const double angle = degrees * 3.14159265358979 / 180.0;
    const glm::dvec3 wanted(std::cos(angle), std::sin(angle), 0);
    EXPECT_LT(glm::distance(*area_normal(square(degrees, 0.02f), {1, 0, 0}), wanted), 1e-5) << degrees;
    EXPECT_LT(glm::distance(*area_normal(square(degrees, 0.02f), {-1, 0, 0}), -wanted), 1e-5) << degrees;
  }
}

TEST(AreaNormal, StaysWithinSixtyDegreesOfTheLine) {
  for (const double degrees : {61.0, 75.0, 89.0, -80.0}) {
    const glm::dvec3 normal = *area_normal(square(degrees, 0.02f), {1, 0, 0});
    EXPECT_NEAR(glm::dot(normal, {1, 0, 0}), 0.5, 1e-6);
    EXPECT_NEAR(glm::length(normal), 1.0, 1e-9);
    EXPECT_GT(normal.y * degrees, 0.0);
  }
}

TEST(AreaNormal, NothingHasNone) {
  EXPECT_FALSE(area_normal({}, {1, 0, 0}));
  TriangleMesh line = square(0.0, 0.02f);
  for (glm::vec3& p : line.positions) p.z = 0.0f;
  EXPECT_FALSE(area_normal(line, {1, 0, 0}));
}

TEST(CastArea, ReachesTheOutlineFromInsideAndOutside) {
  const TriangleMesh area = square(0.0, 0.02f);  // in the y-z plane
  const std::vector<glm::dvec2> directions = ray_directions(8);
  SectionRays rays{.count = 8, .radii = std::vector<double>(8), .hits = {}, .most_crossings = {}};
  rays.hits.resize(8);
  SectionFrame frame{{0.001, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cast_area(area, frame, 0, directions, rays);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(rays.hits[i], 1);
    EXPECT_NEAR(rays.radii[i], i % 2 == 0 ? 0.02 : 0.02 * std::sqrt(2.0), 1e-8);
  }
  frame.centre.y = -0.05;
  cast_area(area, frame, 0, directions, rays);
  EXPECT_NEAR(rays.radii[0], 0.07, 1e-8);
  EXPECT_NEAR(rays.radii[4], -0.03, 1e-8);
  EXPECT_EQ(rays.hits[1], 0);
  EXPECT_EQ(rays.hits[2], 0);
}

// A tube whose ends are cut obliquely, by 40 degrees, with those cuts as attachment areas.
struct ObliqueTube {
  TriangleMesh mesh = test::make_tube([](double) { return test::ellipse({0.0, 0.0}, 0.025, 0.02); }, 0.3, 30);
  MuscleDescription muscle = test::line_muscle({{0, 0.002f, 0}, {0.3f, 0, 0.001f}}, 36, 3);
  FitInput input;
  double slope = std::tan(40.0 * 3.14159265358979 / 180.0);

  ObliqueTube() {
    for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const auto at = [&](float x) {
        for (std::uint32_t i = 0; i < 3; ++i) {
          if (mesh.positions[mesh.indices[3 * t + i]].x != x) return false;
        }
        return true;
      };
      if (at(0.0f)) input.areas[0].push_back(t);
      if (at(mesh.positions.back().x)) input.areas[1].push_back(t);
    }
    for (glm::vec3& p : mesh.positions) {  // sheared by more the nearer to an end
      const double s = p.x / 0.3;
      p.x += static_cast<float>(slope * p.y * std::pow(2.0 * s - 1.0, 4.0));
    }
    input.mesh = &mesh;
    input.description = &muscle;
  }
};

TEST(WideAttachment, EndSectionsLieOnTheAreas) {
  ObliqueTube tube;
  ASSERT_GT(tube.input.areas[0].size(), 20u);
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  const FittedMuscle fitted = fit_muscles(std::span(&tube.input, 1), bones)[0];
  ASSERT_FALSE(fitted.fit.radii.empty()) << to_text(fitted.diagnostics);
  const glm::dvec3 wanted = glm::normalize(glm::dvec3(1.0, -tube.slope, 0.0));
  for (std::size_t end = 0; end < 2; ++end) {
    ASSERT_TRUE(fitted.fit.end_normals[end]);
    EXPECT_LT(glm::distance(glm::dvec3(*fitted.fit.end_normals[end]), wanted), 1e-3);
  }
  EXPECT_EQ(fitted.fit.displacements.front(), glm::vec3(0.0f));
  const auto built = build_muscle_asset(std::span(&tube.muscle, 1), bones, std::span(&fitted.fit, 1));
  ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
  const TriangleMesh rest = rest_surface(**built, 0);
  const ClosestPoints first(take_triangles(tube.mesh, tube.input.areas[0]));
  const ClosestPoints second(take_triangles(tube.mesh, tube.input.areas[1]));
  for (std::uint32_t i = 0; i < 36; ++i) {
    // The plane goes through the attachment point, up to 2 mm beside the area's own.
    EXPECT_LT(first.at(rest.positions[i]).distance, 0.0025f);
    EXPECT_LT(second.at(rest.positions[8 * 36 + i]).distance, 0.0025f);
  }
  // With the areas the fit is nearer to the mesh than without.
  const MeshOracle oracle(tube.mesh);
  FitInput plain = tube.input;
  plain.areas = {};
  const FittedMuscle without = fit_muscles(std::span(&plain, 1), bones)[0];
  EXPECT_FALSE(without.fit.end_normals[0]);
  const auto built_without = build_muscle_asset(std::span(&tube.muscle, 1), bones, std::span(&without.fit, 1));
  const FitComparison near = compare_fit(**built, 0, oracle), far = compare_fit(**built_without, 0, oracle);
  EXPECT_LT(near.max(), 0.1 * far.max());
  EXPECT_LT(near.rms(), 0.3 * far.rms());
}

TEST(WideAttachment, TrianglesThatAreNotThereAreLeftOut) {
  ObliqueTube tube;
  tube.input.areas[0] = {4'000'000'000u, 999'999u};
  tube.input.areas[1].push_back(1'000'000u);
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  const FittedMuscle fitted = fit_muscles(std::span(&tube.input, 1), bones)[0];
  EXPECT_FALSE(fitted.fit.end_normals[0]);
  EXPECT_TRUE(fitted.fit.end_normals[1]);
}

TEST(WideAttachment, AreasSurviveMending) {
  ObliqueTube tube;
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  const FittedMuscle whole = fit_muscles(std::span(&tube.input, 1), bones)[0];
  // A triangle without area in front moves all numbers by one.
  tube.mesh.indices.insert(tube.mesh.indices.begin(), {0, 0, 1});
  for (auto& area : tube.input.areas) {
    for (std::uint32_t& triangle : area) ++triangle;
  }
  tube.mesh.indices.insert(tube.mesh.indices.end(), {5, 6, 7});
  const FittedMuscle mended = fit_muscles(std::span(&tube.input, 1), bones)[0];
  ASSERT_TRUE(mended.fit.end_normals[0] && mended.fit.end_normals[1]);
  for (std::size_t end = 0; end < 2; ++end) {
    EXPECT_LT(glm::distance(*mended.fit.end_normals[end], *whole.fit.end_normals[end]), 1e-5f);
  }
}

}  // namespace
}  // namespace fascicle::muscle
