// Positions, normals, tendon sections: against the method's formulas, worked out here in double precision.
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/muscle_state.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

using test::MuscleState;

const MtuKernels& best() { return mtu_kernels(detect_simd()); }

std::shared_ptr<const MuscleAsset> build(const std::vector<MuscleDescription>& muscles,
                                         const std::vector<glm::mat4>& bones) {
  const auto result = build_muscle_asset(muscles, bones);
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return *result;
}

MuscleDescription cylinder(float tendon_slack) {
  MuscleDescription muscle;
  muscle.name = "cylinder";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  muscle.hill.tendon_slack_length = tendon_slack;
  muscle.profile = {{0.0f, 1.0f}, {0.02f, 0.02f}, true};
  muscle.longitudinal_subdivision = 2;
  return muscle;
}

TEST(Surface, CylinderHasRadialNormalsAndItsRadius) {
  MuscleState state(build({cylinder(0.0f)}, {glm::mat4(1.0f)}));
  state.step(best(), {glm::mat4(1.0f)}, true);
  ASSERT_EQ(state.vertices(0).size(), 5u * 8 + 2);
  for (std::size_t i = 0; i < 40; ++i) {
    const glm::vec3 p = state.vertices(0)[i].position, n = unpack_surface_normal(state.vertices(0)[i].normal);
    EXPECT_NEAR(std::hypot(p.x, p.z), 0.02f, 1.0e-6f);
    EXPECT_LT(glm::distance(n, glm::normalize(glm::vec3(p.x, 0.0f, p.z))), 3.0e-3f);
  }
  // The caps' centres close the ends.
  EXPECT_LT(glm::distance(state.vertices(0)[40].position, glm::vec3(0.0f)), 1.0e-6f);
  EXPECT_LT(glm::distance(unpack_surface_normal(state.vertices(0)[40].normal), glm::vec3(0.0f, 1.0f, 0.0f)), 3.0e-3f);
  EXPECT_LT(glm::distance(state.vertices(0)[41].position, glm::vec3(0.0f, -0.3f, 0.0f)), 1.0e-6f);
  EXPECT_LT(glm::distance(unpack_surface_normal(state.vertices(0)[41].normal), glm::vec3(0.0f, -1.0f, 0.0f)), 3.0e-3f);
}

TEST(Surface, VerticesAreCentrePlusRadius) {
  MuscleState state(build(test::synthetic_muscles(10, 1), test::rest_bones()));
  state.step(best(), test::walk_bones(0.3f), true);
  for (std::uint32_t m = 0; m < 48; ++m) {
    std::size_t vertex = 0;
    const LinePlace border = tendon_border(state.asset(), state.tendons, m, MuscleEnd::kInsertion);
    for (std::uint32_t k = 0; k < state.asset().muscles[m].section_count; ++k) {
      for (std::uint32_t i = 0; i < 10; ++i, ++vertex) {
        const double theta = 2.0 * 3.14159265358979 * i / 10.0;
        const double r = double{state.sections.radii[state.asset().radius(m, k) + i]};
        const glm::dvec3 expected = glm::dvec3(state.point(m, k)) +
                                    r * (std::cos(theta) * glm::dvec3(state.u(m, k)) +
                                         std::sin(theta) * glm::dvec3(state.v(m, k)));
        ASSERT_LT(glm::distance(glm::dvec3(state.vertices(m)[vertex].position), expected), 1.0e-6) << m;
      }
      if (border.segment == static_cast<std::int32_t>(k)) vertex += 10;
    }
  }
}

TEST(Surface, ZeroRadiiKeepUnitNormals) {
  MuscleDescription muscle = cylinder(0.0f);
  muscle.profile = {{0.0f, 0.5f, 1.0f}, {0.0f, 0.02f, 0.0f}, true};
  MuscleState state(build({muscle}, {glm::mat4(1.0f)}));
  state.step(best(), {glm::mat4(1.0f)}, true);
  for (const SurfaceVertex& vertex : state.vertices(0)) {
    EXPECT_NEAR(glm::length(unpack_surface_normal(vertex.normal)), 1.0f, 4.0e-3f);
  }
}

TEST(Tendon, BorderIsWalkedFromTheInsertionAcrossSegments) {
  MuscleState state(build({cylinder(0.36f)}, {glm::mat4(1.0f)}));  // half of it: .18 of .3, over two of four segments
  state.step(best(), {glm::mat4(1.0f)}, true);
  const LinePlace border = tendon_border(state.asset(), state.tendons, 0, MuscleEnd::kInsertion);
  EXPECT_EQ(border.segment, 1);
  EXPECT_NEAR(border.arc, 0.12f, 1.0e-6f);
  EXPECT_NEAR(border.fraction, 0.6f, 1.0e-5f);
}

TEST(Tendon, IsClampedWhereItIsLongerThanTheLine) {
  const auto asset = build({cylinder(0.4f)}, {glm::mat4(1.0f)});
  MuscleState state(asset);
  const glm::mat4 half = glm::scale(glm::mat4(1.0f), glm::vec3(0.5f));  // the line is .15, the tendon .2
  state.step(best(), {half}, true);
  const LinePlace border = tendon_border(*asset, state.tendons, 0, MuscleEnd::kInsertion);
  EXPECT_EQ(border.segment, 0);
  EXPECT_EQ(border.fraction, 0.0f);
  EXPECT_EQ(border.arc, 0.0f);
  EXPECT_NEAR(state.volumes[0] / asset->muscles[0].rest_volume, 1.0f, 1.0f);
  for (const SurfaceVertex& vertex : state.vertices(0)) EXPECT_TRUE(std::isfinite(vertex.position.y));
}

TEST(Tendon, TwoTendonsKeepTheirOrder) {
  MuscleDescription muscle = cylinder(0.3f);
  muscle.tendon_at_origin = 0.3f;
  muscle.tendon_at_insertion = 0.5f;
  const auto asset = build({muscle}, {glm::mat4(1.0f)});
  EXPECT_EQ(asset->muscles[0].row_count, 7u);
  MuscleState state(asset);
  for (const float scale : {1.0f, 0.9f, 0.7f, 0.4f, 0.1f}) {
    state.step(best(), {glm::scale(glm::mat4(1.0f), glm::vec3(scale))}, true);
    const LinePlace first = tendon_border(*asset, state.tendons, 0, MuscleEnd::kOrigin);
    const LinePlace second = tendon_border(*asset, state.tendons, 0, MuscleEnd::kInsertion);
    EXPECT_LE(first.arc, second.arc);
    // Rows go down the line, borders among them.
    for (std::uint32_t row = 1; row < 7; ++row) {
      EXPECT_LE(state.vertices(0)[8 * row].position.y, state.vertices(0)[8 * (row - 1)].position.y + 1.0e-6f);
    }
  }
}

TEST(Tendon, SectionLiesOnTheSurfaceWithoutIt) {
  // Each vertex of C_t lies on the edge between its neighbours of the sections beside it.
  MuscleState state(build(test::synthetic_muscles(12, 1), test::rest_bones()));
  for (int frame = 0; frame < 8; ++frame) {
    state.step(best(), test::walk_bones(static_cast<float>(frame) / 8.0f), frame == 0);
    for (std::uint32_t m = 0; m < 48; ++m) {
      const LinePlace border = tendon_border(state.asset(), state.tendons, m, MuscleEnd::kInsertion);
      const std::size_t row = static_cast<std::size_t>(border.segment) + 1;  // drawn between segment and segment + 1
      for (std::size_t i = 0; i < 12; ++i) {
        const glm::vec3 a = state.vertices(m)[12 * (row - 1) + i].position, c = state.vertices(m)[12 * row + i].position;
        const glm::vec3 b = state.vertices(m)[12 * (row + 1) + i].position;
        ASSERT_LT(glm::distance(c, glm::mix(a, b, border.fraction)), 1.0e-6f) << m << " " << i;
      }
    }
  }
}

TEST(Surface, NormalsPointOutwards) {
  MuscleState state(build(test::synthetic_muscles(8, 1), test::rest_bones()));
  state.step(best(), test::rest_bones(), true);
  for (std::uint32_t m = 0; m < 48; ++m) {
    const LinePlace border = tendon_border(state.asset(), state.tendons, m, MuscleEnd::kInsertion);
    std::size_t vertex = 0;
    for (std::uint32_t k = 0; k < state.asset().muscles[m].section_count; ++k) {
      for (std::uint32_t i = 0; i < 8; ++i, ++vertex) {
        const SurfaceVertex& at = state.vertices(m)[vertex];
        EXPECT_GT(glm::dot(unpack_surface_normal(at.normal), at.position - state.point(m, k)), 0.0f) << m;
      }
      if (border.segment == static_cast<std::int32_t>(k)) vertex += 8;
    }
  }
}

TEST(Surface, DetachedMuscleCollapses) {
  MuscleState state(build(test::synthetic_muscles(8, 1), test::rest_bones()));
  state.musculature.attached[4] = 0;
  state.step(best(), test::walk_bones(0.2f), true);
  for (const SurfaceVertex& vertex : state.vertices(4)) EXPECT_EQ(vertex.position, state.point(4, 0));
  EXPECT_EQ(state.volumes[4], 0.0f);
  EXPECT_GT(state.volumes[5], 0.0f);
}

}  // namespace
}  // namespace fascicle::muscle
