// Cross-section frames in the cases that break naive ones: straight and bent lines, twist through half a turn, hairpins,
// steps of no length, end directions along the line.
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/muscle_state.hpp"

namespace fascicle::muscle {
namespace {

using test::MuscleState;

// A muscle from bone 0 to bone 1 by points in the rest space, half of them on each bone.
std::shared_ptr<const MuscleAsset> build(const std::vector<glm::vec3>& points, std::uint32_t subdivision = 2,
                                         const MuscleFit& fit = {}) {
  MuscleDescription muscle;
  muscle.name = "m";
  for (std::size_t i = 0; i < points.size(); ++i) {
    muscle.attachments.push_back({2 * i < points.size() ? 0 : 1, points[i], true});
  }
  muscle.volume = 1.0e-4f;
  muscle.longitudinal_subdivision = subdivision;
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector(2, glm::mat4(1.0f)), std::vector{fit});
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return *result;
}

void expect_orthonormal(const MuscleState& state) {
  for (std::uint32_t k = 0; k < state.asset().muscles[0].section_count; ++k) {
    const glm::vec3 u = state.u(0, k), v = state.v(0, k);
    EXPECT_NEAR(glm::length(u), 1.0f, 1.0e-5f) << k;
    EXPECT_NEAR(glm::length(v), 1.0f, 1.0e-5f) << k;
    EXPECT_NEAR(glm::dot(u, v), 0.0f, 1.0e-5f) << k;
  }
}

const MtuKernels& best() { return mtu_kernels(detect_simd()); }

TEST(Frames, StraightLineKeepsOneDirection) {
  const auto asset = build({{0.0f, 0.0f, 0.0f}, {0.0f, -0.3f, 0.0f}});
  MuscleState state(asset);
  state.step(best(), std::vector(2, glm::mat4(1.0f)), true);
  for (std::uint32_t k = 0; k < 5; ++k) {
    EXPECT_LT(glm::distance(glm::cross(state.u(0, k), state.v(0, k)), glm::vec3(0.0f, -1.0f, 0.0f)), 1.0e-6f);
    EXPECT_LT(glm::distance(state.u(0, k), state.u(0, 0)), 1.0e-6f);
    EXPECT_NEAR(state.sections.arc[asset->slot(0, k)], 0.075f * static_cast<float>(k), 1.0e-6f);
  }
  EXPECT_NEAR(state.twist(0), 0.0f, 1.0e-6f);
}

TEST(Frames, TangentsFollowTheNeighbours) {
  const std::vector<glm::vec3> points = {{0.0f, 0.0f, 0.0f}, {0.0f, -0.1f, 0.0f}, {0.0f, -0.15f, 0.08f}, {0.0f, -0.15f, 0.2f}};
  MuscleState state(build(points, 1));
  state.step(best(), std::vector(2, glm::mat4(1.0f)), true);
  expect_orthonormal(state);
  for (std::uint32_t k = 0; k < 7; ++k) {
    const glm::vec3 expected =
        glm::normalize(state.point(0, std::min(k + 1, 6u)) - state.point(0, k > 0 ? k - 1 : 0));
    EXPECT_LT(glm::distance(glm::cross(state.u(0, k), state.v(0, k)), expected), 1.0e-5f) << k;
  }
}

TEST(Frames, PlanarBendDoesNotTurnAboutTheLine) {
  // In a plane the direction square to the plane is carried unchanged.
  std::vector<glm::vec3> points;
  for (int i = 0; i < 8; ++i) {
    const float angle = 0.35f * static_cast<float>(i);
    points.push_back({0.0f, -0.1f * std::sin(angle), 0.1f * std::cos(angle)});
  }
  MuscleState state(build(points, 1));
  state.step(best(), std::vector(2, glm::mat4(1.0f)), true);
  const float along = glm::dot(state.u(0, 0), glm::vec3(1.0f, 0.0f, 0.0f));
  for (std::uint32_t k = 0; k < 15; ++k) EXPECT_NEAR(glm::dot(state.u(0, k), glm::vec3(1.0f, 0.0f, 0.0f)), along, 1.0e-5f);
}

TEST(Frames, TwistIsSpreadAlongTheLineAndPassesHalfATurn) {
  const auto asset = build({{0.0f, 0.0f, 0.0f}, {0.0f, -0.3f, 0.0f}});
  MuscleState state(asset);
  std::vector<glm::mat4> bones(2, glm::mat4(1.0f));
  state.step(best(), bones, true);
  glm::vec3 last_middle = state.u(0, 2);
  for (int degrees = 0; degrees <= 300; degrees += 5) {  // beyond half a turn
    const float angle = glm::radians(static_cast<float>(degrees));
    bones[1] = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.0f, -1.0f, 0.0f));
    state.step(best(), bones);
    EXPECT_NEAR(state.twist(0), angle, 1.0e-4f);
    const glm::vec3 u0 = state.u(0, 0);
    for (std::uint32_t k = 0; k < 5; ++k) {
      const glm::vec3 expected = glm::vec3(
          glm::rotate(glm::mat4(1.0f), 0.25f * static_cast<float>(k) * angle, glm::vec3(0.0f, -1.0f, 0.0f)) *
          glm::vec4(u0, 0.0f));
      EXPECT_LT(glm::distance(state.u(0, k), expected), 1.0e-4f) << degrees << " " << k;
    }
    EXPECT_LT(glm::distance(state.u(0, 2), last_middle), 0.1f) << "a jump at " << degrees;
    last_middle = state.u(0, 2);
  }
}

// Wide attachments: the end sections turn with their bones, whatever the line does between.
TEST(Frames, EndsOnAreasTurnWithTheirBones) {
  MuscleFit fit;
  fit.end_normals = {glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f)), glm::normalize(glm::vec3(-0.5f, -1.0f, 0.4f))};
  const std::vector<glm::vec3> points = {
      {0.0f, 0.0f, 0.0f}, {0.0f, -0.1f, 0.02f}, {0.0f, -0.2f, 0.0f}, {0.0f, -0.3f, 0.01f}};
  const auto asset = build(points, 2, fit), plain = build(points, 2);
  MuscleState state(asset), without(plain);
  for (const float angle : {0.0f, 0.4f, -0.9f}) {
    const std::vector<glm::mat4> bones = {glm::rotate(glm::mat4(1.0f), 0.5f * angle, {0.0f, 0.6f, 0.8f}),
                                          glm::rotate(glm::mat4(1.0f), angle, {1.0f, 0.0f, 0.0f})};
    state.step(best(), bones, true);
    without.step(best(), bones, true);
    expect_orthonormal(state);
    const std::uint32_t last = asset->muscles[0].section_count - 1;
    for (const std::uint32_t k : {0u, last}) {
      const glm::vec3 expected(bones[k == 0 ? 0 : 1] * glm::vec4(*fit.end_normals[k == 0 ? 0 : 1], 0.0f));
      EXPECT_LT(glm::distance(glm::cross(state.u(0, k), state.v(0, k)), expected), 2.0e-6f) << angle << " " << k;
    }
    for (std::uint32_t k = 1; k < last; ++k) {  // the others stand square to the line as ever
      EXPECT_LT(glm::distance(glm::cross(state.u(0, k), state.v(0, k)), glm::cross(without.u(0, k), without.v(0, k))),
                2.0e-6f);
    }
    if (angle == 0.0f) {
      EXPECT_NEAR(state.twist(0), 0.0f, 1.0e-5f);
    }
  }
}

TEST(Frames, JumpEndsTheUnwrapping) {
  MuscleState state(build({{0.0f, 0.0f, 0.0f}, {0.0f, -0.3f, 0.0f}}));
  std::vector<glm::mat4> bones(2, glm::mat4(1.0f));
  for (int degrees = 0; degrees <= 300; degrees += 30) {
    bones[1] = glm::rotate(glm::mat4(1.0f), glm::radians(static_cast<float>(degrees)), glm::vec3(0.0f, -1.0f, 0.0f));
    state.step(best(), bones, degrees == 0);
  }
  EXPECT_NEAR(state.twist(0), glm::radians(300.0f), 1.0e-4f);
  state.step(best(), bones, true);
  EXPECT_NEAR(state.twist(0), glm::radians(-60.0f), 1.0e-4f);
}

TEST(Frames, QuarterTurnOfTheLineIsSteady) {
  // The line swings against the origin's bone, through the direction that the bone's reference points in.
  MuscleState state(build({{0.0f, 0.0f, 0.0f}, {0.0f, -0.3f, 0.0f}}));
  glm::vec3 last(0.0f);
  for (int degrees = 0; degrees <= 170; degrees += 2) {
    const glm::mat4 swing = glm::rotate(glm::mat4(1.0f), glm::radians(static_cast<float>(degrees)), {1.0f, 0.0f, 0.0f});
    state.step(best(), {glm::mat4(1.0f), swing}, degrees == 0);
    expect_orthonormal(state);
    if (degrees > 0) {
      EXPECT_LT(glm::distance(state.u(0, 2), last), 0.1f) << degrees;
    }
    last = state.u(0, 2);
  }
}

// Lines that have no direction somewhere. Bone 1 is moved so that points meet or the line doubles back.
TEST(Frames, DegenerateLinesStayFinite) {
  const std::vector<glm::vec3> points = {{0.0f, 0.0f, 0.0f}, {0.0f, -0.1f, 0.0f}, {0.0f, -0.2f, 0.0f}, {0.0f, -0.3f, 0.0f}};
  for (const SimdLevel level : test::available_levels()) {
    for (const std::uint32_t subdivision : {0u, 1u, 2u}) {
      MuscleState state(build(points, subdivision));
      state.step(mtu_kernels(level), std::vector(2, glm::mat4(1.0f)), true);
      const auto shift = [](float y) { return glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, y, 0.0f)); };
      const auto turn = [](float angle) {
        glm::mat4 about = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, -0.1f, 0.0f));
        about = glm::rotate(about, angle, glm::vec3(1.0f, 0.0f, 0.0f));
        return glm::translate(about, glm::vec3(0.0f, 0.2f, 0.0f));
      };
      const glm::mat4 collapsed(0.0f);
      const std::vector<glm::mat4> cases = {shift(0.1f),                  // a step of no length
                                            shift(0.2f),                  // a hairpin onto the via point's neighbour
                                            turn(3.14159265f),            // doubled back on itself
                                            turn(3.0f), collapsed};       // all of bone 1 in one point
      for (const glm::mat4& bone : cases) {
        state.step(mtu_kernels(level), {glm::mat4(1.0f), bone});
        expect_orthonormal(state);
        for (const SurfaceVertex& vertex : state.vertices(0)) {
          EXPECT_TRUE(std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z));
          EXPECT_NEAR(glm::length(unpack_surface_normal(vertex.normal)), 1.0f, 5.0e-3f);
        }
        EXPECT_TRUE(std::isfinite(state.volumes[0]));
      }
      // Everything in one point, both bones.
      state.step(mtu_kernels(level), {collapsed, collapsed});
      for (const SurfaceVertex& vertex : state.vertices(0)) EXPECT_TRUE(std::isfinite(vertex.position.x));
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
