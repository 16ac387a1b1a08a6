// The fit's frames are those of the built muscle.
#include "modules/muscle/asset/fit/rest_frames.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

void expect_built_frames(std::span<const MuscleDescription> muscles, std::span<const MuscleFit> fits) {
  const std::vector<glm::mat4> bones = test::rest_bones();
  const auto built = build_muscle_asset(muscles, bones, fits);
  ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
  const MuscleAsset& asset = **built;
  std::vector<SectionFrame> frames;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    std::vector<glm::dvec3> points;
    for (std::uint32_t k = 0; k < asset.muscles[m].section_count; ++k) points.push_back(rest_point(asset, m, k));
    const auto bone = static_cast<std::size_t>(muscles[m].attachments.front().bone);
    EndNormals normals;
    for (std::size_t end = 0; end < 2 && !fits.empty(); ++end) {
      if (fits[m].end_normals[end]) normals[end] = glm::dvec3(*fits[m].end_normals[end]);
    }
    rest_frames(points, glm::dmat3(glm::dmat4(bones[bone])), normals, frames);
    ASSERT_EQ(frames.size(), points.size());
    for (std::uint32_t k = 0; k < points.size(); ++k) {
      const std::uint32_t s = asset.slot(m, k);
      ASSERT_LT(glm::distance(frames[k].u, glm::dvec3(asset.rest_ux[s], asset.rest_uy[s], asset.rest_uz[s])), 1e-5)
          << asset.muscles[m].name << " section " << k;
      ASSERT_LT(glm::distance(frames[k].v, glm::dvec3(asset.rest_vx[s], asset.rest_vy[s], asset.rest_vz[s])), 1e-5);
      ASSERT_NEAR(glm::dot(frames[k].tangent, frames[k].u), 0.0, 1e-12);
      ASSERT_EQ(frames[k].centre, points[k]);
    }
  }
}

TEST(RestFrames, AreThoseOfTheBuiltMuscle) { expect_built_frames(test::synthetic_muscles(8, 2), {}); }

TEST(RestFrames, AreThoseOfTheBuiltMuscleWhenItIsDisplaced) {
  const std::vector<MuscleDescription> muscles = test::synthetic_muscles(8, 2);
  test::Numbers numbers(4);
  std::vector<MuscleFit> fits(muscles.size());
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    for (std::size_t k = 0; k < ((muscles[m].attachments.size() - 1) << 2) + 1; ++k) {
      fits[m].displacements.push_back(numbers.point(-0.01f, 0.01f));
    }
  }
  expect_built_frames(muscles, fits);
}

TEST(RestFrames, AreThoseOfTheBuiltMuscleWhenItsEndsLieOnAreas) {
  const std::vector<MuscleDescription> muscles = test::synthetic_muscles(8, 2);
  test::Numbers numbers(9);
  std::vector<MuscleFit> fits(muscles.size());
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    if (m % 3 != 0) fits[m].end_normals[0] = glm::normalize(numbers.point(-1.0f, 1.0f) + glm::vec3(0.0f, -2.0f, 0.0f));
    if (m % 3 != 1) fits[m].end_normals[1] = glm::normalize(numbers.point(-1.0f, 1.0f) + glm::vec3(0.0f, -2.0f, 0.0f));
  }
  expect_built_frames(muscles, fits);
}

TEST(RestFrames, ZeroLengthAndHairpinsStayFinite) {
  std::vector<SectionFrame> frames;
  for (const std::vector<glm::dvec3>& points :
       {std::vector<glm::dvec3>{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
        std::vector<glm::dvec3>{{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}, std::vector<glm::dvec3>{{0, 0, 0}, {0, 0, 1}}}) {
    rest_frames(points, glm::dmat3(1.0), {}, frames);
    for (const SectionFrame& frame : frames) {
      EXPECT_NEAR(glm::length(frame.u), 1.0, 1e-12);
      EXPECT_NEAR(glm::length(frame.v), 1.0, 1e-12);
    }
  }
}

TEST(RestFrames, TurnWithTheBone) {
  const std::vector<glm::dvec3> points{{0, 0, 0}, {0.1, 0.5, 0.05}, {0.2, 1.0, 0.3}};
  const glm::dmat3 turn(glm::rotate(glm::mat4(1.0f), 1.1f, glm::vec3(0.3f, 0.2f, 0.9f)));
  std::vector<glm::dvec3> turned;
  for (const glm::dvec3& p : points) turned.push_back(turn * p);
  std::vector<SectionFrame> before, after;
  rest_frames(points, glm::dmat3(1.0), {}, before);
  rest_frames(turned, turn, {}, after);
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_LT(glm::distance(turn * before[k].u, after[k].u), 1e-6);
}

}  // namespace
}  // namespace fascicle::muscle
