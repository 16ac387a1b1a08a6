#include "modules/muscle/asset/fit/compare_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

// A straight muscle of constant radius along z from z = 0, on the only bone.
MuscleDescription rod(const char* name, float x, float length, float radius, std::uint32_t around = 12) {
  MuscleDescription description;
  description.name = name;
  description.attachments = {{0, {x, 0.0f, 0.0f}}, {0, {x, 0.0f, length}}};
  description.hill = {.max_isometric_force = 100.0f, .optimal_fibre_length = 0.05f, .tendon_slack_length = 0.02f};
  description.profile = {{0.0f, 1.0f}, {radius, radius}, true};
  description.section_vertices = around;
  description.longitudinal_subdivision = 2;
  return description;
}

std::shared_ptr<const MuscleAsset> build(const std::vector<MuscleDescription>& descriptions) {
  const std::array<glm::mat4, 1> bones = {glm::mat4(1.0f)};
  auto asset = build_muscle_asset(descriptions, bones);
  EXPECT_TRUE(asset.ok()) << to_text(asset.diagnostics());
  return *asset;
}

TriangleMesh shifted(const TriangleMesh& mesh, const glm::vec3& by) {
  return test::moved(mesh, glm::translate(glm::mat4(1.0f), by));
}

double polygon_area(double radius, double corners) {
  return 0.5 * corners * radius * radius * std::sin(2.0 * std::numbers::pi / corners);
}

TEST(RestSurface, IsTheDrawnPrism) {
  const auto asset = build({rod("rod", 0.1f, 0.3f, 0.02f)});
  const TriangleMesh surface = rest_surface(*asset, 0);
  EXPECT_EQ(surface.positions.size(), 5u * 12u + 2u);
  EXPECT_NEAR(mesh_volume(surface), 0.3 * polygon_area(0.02, 12), 1e-9);
  // Closed: every edge is used once each way.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, back;
  for (std::size_t i = 0; i < surface.indices.size(); ++i) {
    const std::uint32_t a = surface.indices[i], b = surface.indices[i % 3 == 2 ? i - 2 : i + 1];
    edges.emplace_back(a, b);
    back.emplace_back(b, a);
  }
  std::ranges::sort(edges);
  std::ranges::sort(back);
  EXPECT_EQ(edges, back);
  EXPECT_EQ(std::ranges::adjacent_find(edges), edges.end());
  EXPECT_NEAR(winding_number(surface, {0.1, 0.0, 0.15}), 1.0, 1e-9);
}

TEST(CompareFit, WithNothingIsAllOutsideAndFinite) {
  const auto asset = build({rod("rod", 0.0f, 0.3f, 0.02f)});
  const FitComparison found = compare_fit(*asset, 0, MeshOracle(TriangleMesh{}));
  EXPECT_EQ(found.sections, 5u);
  EXPECT_EQ(found.sections_outside, 5u);
  EXPECT_EQ(found.rms(), 0.0);
  EXPECT_EQ(found.mesh_vertices, 0u);
  EXPECT_EQ(found.mesh_volume, 0.0);
}

TEST(CompareFit, WithAMeshThatIsNotFiniteIsFinite) {
  const auto asset = build({rod("rod", 0.0f, 0.3f, 0.02f)});
  TriangleMesh mesh = rest_surface(*asset, 0);
  mesh.positions[5] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  const FitComparison found = compare_fit(*asset, 0, MeshOracle(mesh));
  EXPECT_TRUE(std::isfinite(found.rms()) && std::isfinite(found.max()) && std::isfinite(found.mesh_volume));
  EXPECT_LT(found.mesh_to_fit.max, 1e-7);
  EXPECT_NEAR(static_cast<double>(found.mesh_to_fit.samples), 2000.0, 1.0);
}

TEST(CompareFit, WithItselfIsNoDistance) {
  const auto asset = build({rod("rod", 0.0f, 0.3f, 0.02f)});
  const FitComparison found = compare_fit(*asset, 0, MeshOracle(rest_surface(*asset, 0)));
  EXPECT_LT(found.max(), 1e-7);
  EXPECT_EQ(found.fit_vertices, found.mesh_vertices);
  EXPECT_EQ(found.fit_volume, found.mesh_volume);
  EXPECT_NEAR(static_cast<double>(found.fit_to_mesh.samples), 2000.0, 1.0);
  EXPECT_EQ(compare_fit(*asset, 0, MeshOracle(rest_surface(*asset, 0)), 0.001).mesh_to_fit.samples,
            static_cast<std::size_t>(std::ceil(mesh_area(rest_surface(*asset, 0)) / 1e-6)));
}

TEST(CompareFit, ThinnerRodsAreTheDifferenceAway) {
  const auto thin = build({rod("thin", 0.0f, 0.3f, 0.02f, 36)}), thick = build({rod("thick", 0.0f, 0.3f, 0.03f, 36)});
  const FitComparison found = compare_fit(*thin, 0, MeshOracle(rest_surface(*thick, 0)));
  // The sides are 10 mm apart, the ends meet; towards the thick one its ends' rims are 10 mm away too.
  EXPECT_NEAR(found.fit_to_mesh.max, 0.01, 1e-4);
  EXPECT_NEAR(found.mesh_to_fit.max, 0.01, 1e-4);
  EXPECT_GT(found.fit_to_mesh.rms, 0.009);
  EXPECT_LT(found.fit_to_mesh.rms, 0.01);
  EXPECT_EQ(found.sections_outside, 5u - 3u);  // the ends' centres lie in the caps: no more than half inside
  EXPECT_NEAR(found.fit_volume / found.mesh_volume, 4.0 / 9.0, 1e-4);
  EXPECT_NEAR(found.rms(), std::sqrt(0.5 * (found.fit_to_mesh.rms * found.fit_to_mesh.rms +
                                            found.mesh_to_fit.rms * found.mesh_to_fit.rms)), 1e-12);
}

TEST(CompareFit, CentresOutsideAreCounted) {
  const auto asset = build({rod("rod", 0.0f, 0.4f, 0.02f)});
  const TriangleMesh own = rest_surface(*asset, 0);
  EXPECT_EQ(compare_fit(*asset, 0, MeshOracle(shifted(own, {0.05f, 0, 0}))).sections_outside, 5u);
  // Up by a quarter and a bit: the lower two of five are left out.
  EXPECT_EQ(compare_fit(*asset, 0, MeshOracle(shifted(own, {0.001f, 0, 0.15f}))).sections_outside, 2u);
}

TEST(CompareFit, DoesNotDependOnAMotion) {
  const auto asset = build({rod("rod", 0.0f, 0.4f, 0.02f)});
  const TriangleMesh mesh = test::make_sphere(0.05f, 20, 30, {0.0f, 0.0f, 0.2f});
  const FitComparison plain = compare_fit(*asset, 0, MeshOracle(mesh), 0.001);
  const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), {0.5f, -1.0f, 0.25f}), 1.1f,
                                       glm::normalize(glm::vec3(1, 2, 3)));
  const std::array<glm::mat4, 1> bones = {motion};
  const auto turned = build_muscle_asset(std::vector{rod("rod", 0.0f, 0.4f, 0.02f)}, bones);
  ASSERT_TRUE(turned.ok());
  const FitComparison moved = compare_fit(**turned, 0, MeshOracle(test::moved(mesh, motion)), 0.001);
  EXPECT_NEAR(moved.rms(), plain.rms(), 1e-5);
  EXPECT_NEAR(moved.max(), plain.max(), 1e-5);
  EXPECT_EQ(moved.sections_outside, plain.sections_outside);
}

TEST(CompareHeads, OfOneIsPlain) {
  const auto asset = build({rod("rod", 0.0f, 0.3f, 0.02f)});
  const MeshOracle oracle(shifted(rest_surface(*asset, 0), {0.01f, 0, 0}));
  const std::array<std::uint32_t, 1> heads = {0};
  const auto found = compare_heads(*asset, heads, oracle);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].rms(), compare_fit(*asset, 0, oracle).rms());
}

TEST(CompareHeads, EachAnswersForItsPartOfTheMesh) {
  const auto asset = build({rod("left", -0.05f, 0.3f, 0.02f), rod("right", 0.05f, 0.3f, 0.03f)});
  const MeshOracle oracle(test::join(rest_surface(*asset, 0), rest_surface(*asset, 1)));
  EXPECT_GT(compare_fit(*asset, 0, oracle).max(), 0.05);  // the other rod is not its own
  const std::array<std::uint32_t, 2> heads = {0, 1};
  for (const FitComparison& head : compare_heads(*asset, heads, oracle)) {
    EXPECT_LT(head.max(), 1e-7);
    EXPECT_GT(head.mesh_to_fit.samples, 500u);
  }
}

TEST(CompareHeads, WhatLiesInsideTheOtherHeadDoesNotCount) {
  // Two rods that overlap, inside a box: the deepest part of each is the farthest from the box, and is in the other.
  const auto asset = build({rod("left", -0.015f, 0.3f, 0.02f, 36), rod("right", 0.015f, 0.3f, 0.02f, 36)});
  const MeshOracle oracle(test::make_box({-0.035f, -0.02f, 0.0f}, {0.035f, 0.02f, 0.3f}));
  const std::array<std::uint32_t, 2> heads = {0, 1};
  const auto found = compare_heads(*asset, heads, oracle, 0.001);
  ASSERT_EQ(found.size(), 2u);
  for (std::uint32_t h = 0; h < 2; ++h) {
    const FitComparison alone = compare_fit(*asset, h, oracle, 0.001);
    EXPECT_GT(alone.fit_to_mesh.max, 0.0199);
    EXPECT_LT(found[h].fit_to_mesh.samples, alone.fit_to_mesh.samples);
    // Where the circles meet, 13.2 mm from the middle plane.
    EXPECT_NEAR(found[h].fit_to_mesh.max, 0.02 - std::sqrt(0.02 * 0.02 - 0.015 * 0.015), 3e-4);
  }
}

}  // namespace
}  // namespace fascicle::muscle
