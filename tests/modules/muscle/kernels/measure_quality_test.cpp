#include "modules/muscle/kernels/surface/measure_quality.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/plain_surface.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

SurfaceQuality quality_of(const SurfaceAsset& asset, const std::vector<glm::vec3>& places,
                          const std::vector<glm::mat4>& bones = {}) {
  SurfaceQuality quality;
  measure_quality(asset, test::to_points(places), bones, quality);
  return quality;
}

// Two triangles with the edge along y between them, the second one bent up by `angle`.
TriangleMesh bent_pair(double angle) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0.5f, 0}};
  mesh.positions.emplace_back(std::cos(angle), 0.5, std::sin(angle));
  mesh.indices = {0, 1, 2, 1, 0, 3};
  return mesh;
}

TEST(MeasureQuality, OfNothingIsFiniteAndUnchanged) {
  const SurfaceQuality quality = quality_of({}, {});
  EXPECT_EQ(quality.volume_ratio, 1.0);
  EXPECT_EQ(quality.edge_ratio_mean, 1.0);
  EXPECT_EQ(quality.dihedral_change_mean, 0.0);
  EXPECT_EQ(quality.rest_distance_max, 0.0);
}

TEST(MeasureQuality, BonesThatAreNotThereDoNotCount) {
  SurfaceAsset asset = test::plain_surface(test::make_sphere(0.05f, 8, 12));
  test::attach(asset, 7, {0});
  test::attach(asset, -1, {1});
  const std::vector<glm::vec3> far(asset.vertex_count, glm::vec3(1.0f));
  EXPECT_EQ(quality_of(asset, far, {glm::mat4(1.0f)}).attachment_error_max, 0.0);
}

TEST(MeasureQuality, AtRestNothingHasChanged) {
  const TriangleMesh mesh = test::make_torus(0.05f, 0.02f, 24, 16);
  const SurfaceAsset asset = test::plain_surface(mesh);
  ASSERT_EQ(asset.hinges.size(), mesh.indices.size() / 2);
  const SurfaceQuality quality = quality_of(asset, mesh.positions);
  EXPECT_NEAR(quality.volume_ratio, 1.0, 1e-12);
  EXPECT_NEAR(quality.edge_ratio_mean, 1.0, 1e-7);
  EXPECT_NEAR(quality.edge_ratio_min, 1.0, 1e-6);
  EXPECT_NEAR(quality.edge_ratio_max, 1.0, 1e-6);
  EXPECT_NEAR(quality.dihedral_change_max, 0.0, 1e-6);
  EXPECT_EQ(quality.rest_distance_max, 0.0);
  EXPECT_EQ(quality.folded, 0u);
  EXPECT_EQ(quality.turned, 0u);
}

TEST(MeasureQuality, ASphereBlownUpByATenth) {
  const TriangleMesh mesh = test::make_sphere(0.05f, 24, 32);
  const SurfaceAsset asset = test::plain_surface(mesh);
  std::vector<glm::vec3> places = mesh.positions;
  for (glm::vec3& p : places) p *= 1.1f;
  const SurfaceQuality quality = quality_of(asset, places);
  EXPECT_NEAR(quality.volume_ratio, 1.331, 1e-5);
  for (const double ratio : {quality.edge_ratio_mean, quality.edge_ratio_min, quality.edge_ratio_max,
                             quality.edge_ratio_p5, quality.edge_ratio_p50, quality.edge_ratio_p95}) {
    EXPECT_NEAR(ratio, 1.1, 1e-4);
  }
  EXPECT_NEAR(quality.edge_ratio_abs_mean, 0.1, 1e-5);
  EXPECT_NEAR(quality.dihedral_change_max, 0.0, 1e-4);
  EXPECT_NEAR(quality.rest_distance_max, 0.005, 1e-7);
}

TEST(MeasureQuality, ARigidMotionChangesThePlacesAlone) {
  const TriangleMesh mesh = test::make_sphere(0.05f, 12, 16);
  const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), {0.02f, 0.0f, 0.0f}), 2.0f, {1.0f, 2.0f, 3.0f});
  SurfaceAsset asset = test::plain_surface(mesh);
  test::attach(asset, 1, {3, 4, 5});
  const SurfaceQuality quality =
      quality_of(asset, test::moved(mesh, motion).positions, {glm::mat4(1.0f), motion});
  EXPECT_NEAR(quality.volume_ratio, 1.0, 1e-5);
  EXPECT_NEAR(quality.edge_ratio_abs_mean, 0.0, 1e-5);
  EXPECT_NEAR(quality.dihedral_change_max, 0.0, 1e-4);
  EXPECT_NEAR(quality.attachment_error_max, 0.0, 1e-7);
  EXPECT_GT(quality.rest_distance_max, 0.05);
}

TEST(MeasureQuality, APercentileIsTheEdgeOfThatRank) {
  SurfaceAsset asset;  // hinges from a point to each of 101 others, all of them 1 long at rest
  asset.vertex_count = 102;
  asset.rest.resize(102);
  std::vector<glm::vec3> places(102);
  for (std::uint32_t i = 0; i <= 100; ++i) {
    asset.hinges.push_back({{0, i + 1, 0, 0}, 1.0f, 0.0f});
    places[i + 1].x = 1.0f + 0.01f * static_cast<float>((37 * i) % 101);
  }
  const SurfaceQuality quality = quality_of(asset, places);
  EXPECT_NEAR(quality.edge_ratio_min, 1.0, 1e-6);
  EXPECT_NEAR(quality.edge_ratio_p5, 1.05, 1e-6);
  EXPECT_NEAR(quality.edge_ratio_p50, 1.5, 1e-6);
  EXPECT_NEAR(quality.edge_ratio_p95, 1.95, 1e-6);
  EXPECT_NEAR(quality.edge_ratio_max, 2.0, 1e-6);
}

TEST(MeasureQuality, AnAngleChangesByWhatItIsBent) {
  const TriangleMesh rest = bent_pair(0.3);
  const SurfaceAsset asset = test::plain_surface(rest);
  ASSERT_EQ(asset.hinges.size(), 1u);
  EXPECT_NEAR(std::abs(asset.hinges[0].angle), 0.3, 1e-6);
  for (const double angle : {-2.5, -0.4, 0.0, 0.3, 1.5, 2.9}) {
    const SurfaceQuality quality = quality_of(asset, bent_pair(angle).positions);
    EXPECT_NEAR(quality.dihedral_change_mean, std::abs(angle - 0.3), 1e-6) << angle;
    EXPECT_NEAR(quality.dihedral_change_max, std::abs(angle - 0.3), 1e-6) << angle;
    EXPECT_NEAR(quality.angle_max, std::abs(angle), 1e-6) << angle;
    EXPECT_EQ(quality.folded, 0u) << angle;
    EXPECT_NEAR(quality.edge_ratio_max, 1.0, 1e-6) << angle;
  }
  // The shorter way round.
  EXPECT_NEAR(quality_of(asset, bent_pair(-3.0).positions).dihedral_change_max, 2.0 * std::numbers::pi - 3.3, 1e-6);
}

// Two triangles fold up until they swing through each other and come out on the other side, and all the way back.
TEST(MeasureQuality, TrianglesThatSwingThroughEachOther) {
  const SurfaceAsset asset = test::plain_surface(bent_pair(0.0));
  SurfaceQuality quality;
  const auto bend = [&](double angle) {
    measure_quality(asset, test::to_points(bent_pair(angle).positions), {}, quality);
  };
  for (double angle = 0.0; angle < 2.9; angle += 0.2) {
    bend(angle);
    ASSERT_EQ(quality.folded + quality.turned, 0u) << angle;
  }
  bend(3.0);
  EXPECT_EQ(quality.folded, 1u);
  EXPECT_EQ(quality.turned, 0u);
  bend(3.3);
  EXPECT_EQ(quality.folded, 1u);
  EXPECT_EQ(quality.turned, 1u);
  bend(4.0);
  EXPECT_EQ(quality.folded, 0u);
  EXPECT_EQ(quality.turned, 1u);
  EXPECT_NEAR(quality.angle_max, 2.0 * std::numbers::pi - 4.0, 1e-6);
  bend(3.0);
  bend(1.0);
  EXPECT_EQ(quality.turned, 0u);
  EXPECT_NEAR(quality.dihedral_change_max, 1.0, 1e-6);
  // And all the way round.
  for (double angle = 1.0; angle < 5.2; angle += 0.6) bend(angle);
  EXPECT_EQ(quality.turned, 1u);
  bend(5.7);
  EXPECT_EQ(quality.turned, 0u);
}

// Sharp at rest is not folded.
TEST(MeasureQuality, WhatIsFoldedAtRestDoesNotCount) {
  const TriangleMesh sharp = bent_pair(3.0);
  EXPECT_EQ(quality_of(test::plain_surface(sharp), sharp.positions).folded, 0u);
}

TEST(MeasureQuality, AttachedVerticesAreComparedWithTheirOwnBones) {
  const TriangleMesh mesh = test::make_sphere(0.05f, 8, 12);
  SurfaceAsset asset = test::plain_surface(mesh);
  test::attach(asset, 0, {2, 3});
  test::attach(asset, 1, {5});
  const glm::mat4 away = glm::translate(glm::mat4(1.0f), {0.0f, 0.01f, 0.0f});
  std::vector<glm::vec3> places = mesh.positions;
  places[5].y += 0.01f;
  EXPECT_NEAR(quality_of(asset, places, {glm::mat4(1.0f), away}).attachment_error_max, 0.0, 1e-8);
  places[3].x += 0.0004f;
  places[5].z += 0.0003f;
  EXPECT_NEAR(quality_of(asset, places, {glm::mat4(1.0f), away}).attachment_error_max, 0.0004, 1e-8);
}

TEST(MeasureQuality, EdgesWithoutALengthKeepFiguresFinite) {
  SurfaceAsset asset = test::plain_surface(test::make_box({0, 0, 0}, {1, 1, 1}));
  asset.hinges[0].length = 0.0f;
  const SurfaceQuality quality = quality_of(asset, std::vector<glm::vec3>(8, glm::vec3(0.5f)));
  EXPECT_EQ(quality.volume_ratio, 0.0);
  EXPECT_TRUE(std::isfinite(quality.edge_ratio_mean));
  EXPECT_TRUE(std::isfinite(quality.dihedral_change_mean));
}

}  // namespace
}  // namespace fascicle::muscle
