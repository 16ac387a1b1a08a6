// Volumes against the sum over the explicit tetrahedra (1.6), and against the enclosed volume of the drawn surface.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/muscle_state.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

using test::MuscleState;

std::shared_ptr<const MuscleAsset> build_without_tendons(std::uint32_t count) {
  std::vector<MuscleDescription> muscles = test::synthetic_muscles(count, 1);
  for (MuscleDescription& muscle : muscles) muscle.tendon_at_insertion = 0.0f;
  const auto result = build_muscle_asset(muscles, test::rest_bones());
  EXPECT_TRUE(result.ok());
  return *result;
}

// The nodes of tetrahedra_of: the sections' vertices, then the centres.
std::vector<glm::dvec3> nodes_of(const MuscleState& state, std::uint32_t m) {
  const MuscleLayout& layout = state.asset().muscles[m];
  std::vector<glm::dvec3> nodes;
  for (std::uint32_t i = 0; i < layout.section_count * layout.section_vertices; ++i) {
    nodes.push_back(glm::dvec3(state.vertices(m)[i].position));
  }
  for (std::uint32_t k = 0; k < layout.section_count; ++k) nodes.push_back(glm::dvec3(state.point(m, k)));
  return nodes;
}

// The method's |(w - z) . ((x - z) x (y - z))| / 6, with its sign or without.
double sum_volumes(const MuscleState& state, std::uint32_t m, bool absolute) {
  const std::vector<glm::dvec3> nodes = nodes_of(state, m);
  double sum = 0.0;
  for (const auto& t : tetrahedra_of(state.asset(), m)) {
    const double six = glm::dot(nodes[t[3]] - nodes[t[2]], glm::cross(nodes[t[0]] - nodes[t[2]], nodes[t[1]] - nodes[t[2]]));
    sum += (absolute ? std::abs(six) : -six) / 6.0;
  }
  return std::abs(sum);
}

TEST(Volume, IsTheSumOverTheTetrahedra) {
  for (const std::uint32_t count : {6u, 8u, 14u, 36u}) {
    MuscleState state(build_without_tendons(count));
    for (int frame = 0; frame < 6; ++frame) {
      state.step(mtu_kernels(detect_simd()), test::walk_bones(static_cast<float>(frame) / 6.0f), frame == 0);
      for (std::uint32_t m = 0; m < 48; ++m) {
        const double expected = sum_volumes(state, m, false);
        ASSERT_NEAR(double{state.volumes[m]}, expected, 1.0e-5 * expected) << m;
      }
    }
  }
}

TEST(Volume, IsTheSumOfAbsoluteValuesWhereNothingFolds) {
  MuscleState state(build_without_tendons(8));
  state.step(mtu_kernels(detect_simd()), test::rest_bones(), true);
  int straight = 0;
  for (std::uint32_t m = 0; m < 9; ++m) {  // those without via points
    const double expected = sum_volumes(state, m, true);
    EXPECT_NEAR(double{state.volumes[m]}, expected, 1.0e-5 * expected) << m;
    ++straight;
  }
  EXPECT_EQ(straight, 9);
}

TEST(Volume, SignedRadiiGiveTheSlicesArea) {
  // A round slice of radius 1 cm whose centre lies 2 cm off the line: the line is outside, half of the radii negative.
  MuscleDescription muscle;
  muscle.name = "off_centre";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  muscle.section_vertices = 36;
  muscle.longitudinal_subdivision = 1;
  std::vector<MuscleFit> fits(1);
  // An ellipse-like contour around the line, then shifted: r(theta) of a circle seen from outside has no star shape, so
  // use the signed radius of the line through the centre at theta: d cos(theta) + sqrt(R^2 - d^2 sin^2), where it hits.
  const double R = 0.01, d = 0.02;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 36; ++i) {
      const double theta = 2.0 * 3.14159265358979 * i / 36.0;
      const double under = R * R - d * d * std::sin(theta) * std::sin(theta);
      // Opposite vertices lie on the same ray's two hits: one positive, one negative radius.
      const double r = under > 0.0 ? d * std::cos(theta) + std::sqrt(under) : 0.0;
      fits[0].radii.push_back(static_cast<float>(r));
    }
  }
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)}, fits);
  ASSERT_TRUE(result.ok()) << to_text(result.diagnostics());
  const double area = double{(*result)->muscles[0].rest_volume} / 0.3;
  // The polygon's own area by the shoelace formula.
  double shoelace = 0.0;
  for (std::size_t i = 0; i < 36; ++i) {
    const std::size_t j = (i + 1) % 36;
    shoelace += 0.5 * std::sin(2.0 * 3.14159265358979 / 36.0) * double{fits[0].radii[i]} * double{fits[0].radii[j]};
  }
  EXPECT_NEAR(area, shoelace, 1.0e-4 * std::abs(shoelace));
}

TEST(Volume, BellyLeavesTheTendonOut) {
  MuscleDescription muscle;
  muscle.name = "cylinder";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  muscle.profile = {{0.0f, 1.0f}, {0.02f, 0.02f}, true};
  muscle.section_vertices = 36;
  muscle.longitudinal_subdivision = 2;
  muscle.hill.tendon_slack_length = 0.2f;
  muscle.tendon_at_origin = 0.2f;  // .04 and .1 of .3: the belly is .16
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)});
  ASSERT_TRUE(result.ok());
  const double area = 18.0 * std::sin(2.0 * 3.14159265358979 / 36.0) * 0.02 * 0.02;
  EXPECT_NEAR((*result)->muscles[0].rest_volume, 0.16 * area, 1.0e-4 * 0.16 * area);
}

TEST(Volume, BordersInOneSegment) {
  MuscleDescription muscle;
  muscle.name = "cylinder";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  muscle.profile = {{0.0f, 1.0f}, {0.02f, 0.02f}, true};
  muscle.longitudinal_subdivision = 0;
  muscle.hill.tendon_slack_length = 0.2f;
  muscle.tendon_at_origin = 0.2f;
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)});
  ASSERT_TRUE(result.ok());
  const double area = 4.0 * std::sin(2.0 * 3.14159265358979 / 8.0) * 0.02 * 0.02;
  EXPECT_NEAR((*result)->muscles[0].rest_volume, 0.16 * area, 1.0e-4 * 0.16 * area);
}

}  // namespace
}  // namespace fascicle::muscle
