#include "engine/animation/skinning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/gltf_skins.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

// A strip along x from 0 to 2; bone 0 stands at the origin, bone 1 at x = 1. Weights go over around x = 1.
SkinAsset make_strip() {
  SkinAsset asset;
  for (int i = 0; i <= 20; ++i) {
    const float x = 0.1f * static_cast<float>(i);
    const float second = std::clamp((x - 0.8f) / 0.4f, 0.0f, 1.0f);
    asset.positions.push_back({x, 0, 0.1f});
    asset.normals.push_back({0, 0, 1});
    asset.joints.push_back({0, 1, 0, 0});
    asset.weights.push_back({1.0f - second, second, 0, 0});
  }
  asset.joint_bones = {0, 1};
  asset.inverse_binds = {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(-1, 0, 0))};
  return asset;
}

SkinnedSurface skin(const SkinAsset& asset, const std::vector<glm::mat4>& world) {
  SkinnedSurface surface = make_skinned_surface(asset);
  compute_joint_matrices(asset, world, surface.joint_matrices);
  skin_vertices(asset, surface.joint_matrices, 0, asset.size(), surface.positions, surface.normals);
  return surface;
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-6f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

const glm::mat4 kOne(1.0f);
const glm::mat4 kRestOfSecond = glm::translate(kOne, glm::vec3(1, 0, 0));

TEST(Skinning, AtRestNothingMoves) {
  const SkinAsset asset = make_strip();
  const SkinnedSurface surface = skin(asset, {kOne, kRestOfSecond});
  EXPECT_EQ(surface.positions, asset.positions);
  EXPECT_EQ(surface.normals, asset.normals);
}

TEST(Skinning, RigidMotionMovesRigidly) {
  const SkinAsset asset = make_strip();
  const glm::mat4 motion =
      glm::rotate(glm::translate(kOne, glm::vec3(3, -2, 5)), 1.2f, glm::normalize(glm::vec3(1, 2, 3)));
  const SkinnedSurface surface = skin(asset, {motion, motion * kRestOfSecond});
  for (std::size_t i = 0; i < asset.size(); ++i) {
    expect_near(surface.positions[i], glm::vec3(motion * glm::vec4(asset.positions[i], 1.0f)), 1e-5f);
    expect_near(surface.normals[i], glm::mat3(motion) * asset.normals[i]);
  }
}

TEST(Skinning, TwoBonesBend) {
  const SkinAsset asset = make_strip();
  // The second bone turns by 90 degrees about y at x = 1: x goes to -z.
  const glm::mat4 bent = glm::rotate(kRestOfSecond, std::numbers::pi_v<float> / 2.0f, glm::vec3(0, 1, 0));
  const SkinnedSurface surface = skin(asset, {kOne, bent});
  EXPECT_EQ(surface.positions[0], asset.positions[0]);  // all on the first bone
  expect_near(surface.positions[20], {1.1f, 0, -1});    // all on the second: (1, 0, 0.1) turned, from x = 1
  expect_near(surface.normals[20], {1, 0, 0});
  expect_near(surface.positions[10], {1.05f, 0, 0.05f});  // half and half: the mean of (1, 0, 0.1), (1.1, 0, 0)
  const float half = std::numbers::sqrt2_v<float> / 2.0f;
  expect_near(surface.normals[10], {half, 0, half});
}

TEST(Skinning, VanishingNormalsStayUnit) {
  SkinAsset asset = make_strip();
  // The two bones turn a vertex's normal to opposite sides with equal weights.
  const glm::mat4 over = glm::rotate(kRestOfSecond, std::numbers::pi_v<float>, glm::vec3(1, 0, 0));
  for (glm::vec4& weight : asset.weights) weight = {0.5f, 0.5f, 0, 0};
  for (const glm::vec3& normal : skin(asset, {kOne, over}).normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
  for (const glm::vec3& normal : skin(asset, {glm::mat4(0.0f), glm::mat4(0.0f)}).normals)
    EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
}

TEST(Skinning, OnlyTheRangeIsWritten) {
  const SkinAsset asset = make_strip();
  const std::vector<glm::mat4> joints(2, glm::translate(kOne, glm::vec3(0, 7, 0)));
  SkinnedSurface surface = make_skinned_surface(asset);
  skin_vertices(asset, joints, 5, 8, surface.positions, surface.normals);
  for (std::size_t i = 0; i < asset.size(); ++i) EXPECT_EQ(surface.positions[i].y, i >= 5 && i < 8 ? 7.0f : 0.0f);
}

TEST(Skinning, AMeshWithoutSkinFollowsItsNode) {
  GltfFile file;
  GltfMesh mesh;
  mesh.bone = 3;
  mesh.geometry.positions = {{1, 0, 0}, {0, 1, 0}};
  mesh.geometry.normals = {{0, 0, 1}, {0, 0, 1}};
  const auto asset = make_skin_asset(file, mesh);
  const std::vector<glm::mat4> world(4, glm::translate(kOne, glm::vec3(0, 0, 2)));
  const SkinnedSurface surface = skin(*asset, world);
  EXPECT_EQ(surface.positions[1], glm::vec3(0, 1, 2));
}

TEST(SkinningData, CesiumManAgreesWithTheReferenceAndRestsInPlace) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const Result<GltfFile> file = read_gltf(test::data_folder() / "gltf/CesiumMan.glb");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  const auto asset = make_skin_asset(*file, file->meshes.at(0));
  const SkinnedSurface rest = skin(*asset, file->skeleton.rest_world);
  glm::vec3 low(1e9f), high(-1e9f);
  for (const glm::vec3& p : rest.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_NEAR(high.y - low.y, 1.5f, 0.1f);  // a man's height in this model, m

  std::vector<Trs> pose = file->skeleton.rest_local;
  sample_clip(file->clips.at(0), 0.7f, pose);
  std::vector<glm::mat4> world(pose.size());
  compose(file->skeleton, pose, glm::mat4(1.0f), world);
  const SkinnedSurface fast = skin(*asset, world);
  SkinnedSurface reference = make_skinned_surface(*asset);
  compute_joint_matrices(*asset, world, reference.joint_matrices);
  skin_vertices_reference(*asset, reference.joint_matrices, 0, asset->size(), reference.positions, reference.normals);
  for (std::size_t i = 0; i < asset->size(); ++i) {
    expect_near(fast.positions[i], reference.positions[i], 1e-5f);
    expect_near(fast.normals[i], reference.normals[i], 1e-4f);
  }
}

}  // namespace
}  // namespace fascicle
