// What becomes of meshes as they come: turned, open, overlapping, of the wrong size.
#include "modules/muscle/asset/bone_fields/bone_grid.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/parallel/worker_arena.hpp"
#include "tests/modules/muscle/asset/bone_fields/field_points.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

std::string fault_of(const TriangleMesh& mesh, const BoneGridSettings& settings = {}) {
  const auto grid = build_bone_grid({&mesh, 1}, "femur", settings);
  if (grid) return "none";
  EXPECT_EQ(grid.diagnostics().errors.front().file, "femur");
  EXPECT_FALSE(grid.diagnostics().errors.front().remedy.empty());
  return grid.diagnostics().errors.front().cause;
}

BoneField make_field(std::span<const TriangleMesh> meshes, float voxel = 0.002f) {
  const auto field = build_bone_field(meshes, "bone", {.voxel = voxel});
  EXPECT_TRUE(field.ok()) << to_text(field.diagnostics());
  return field ? **field : BoneField();
}

void expect_sphere(const BoneField& field, float radius, float tolerance) {
  for (const glm::vec3& point : test::points_in_box(glm::vec3(-1.4f * radius), glm::vec3(1.4f * radius), 5'000)) {
    const float wanted = glm::length(point) - radius;
    if (wanted > field.band()) continue;
    ASSERT_NEAR(field.distance(point), wanted, tolerance) << point.x << ' ' << point.y << ' ' << point.z;
  }
}

TEST(BoneGrid, SaysWhatCannotBe) {
  const TriangleMesh box = test::make_box(glm::vec3(-0.01f), glm::vec3(0.01f));
  EXPECT_NE(fault_of({}).find("no triangles"), std::string::npos);
  TriangleMesh flat = box;
  for (glm::vec3& p : flat.positions) p = glm::vec3(p.x, 0.0f, 0.0f);
  EXPECT_NE(fault_of(flat).find("no triangles"), std::string::npos);
  TriangleMesh nowhere = box;
  for (glm::vec3& p : nowhere.positions) p.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(fault_of(nowhere).find("no triangles"), std::string::npos);
  for (const float voxel : {0.0f, -1.0f, std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_NE(fault_of(box, {.voxel = voxel}).find("voxel"), std::string::npos);
  }
  EXPECT_NE(fault_of(box, {.voxel = 1e-6f}).find("GB"), std::string::npos);
  TriangleMesh millimetres = box;
  for (glm::vec3& p : millimetres.positions) p *= 1000.0f * 100.0f;
  EXPECT_NE(fault_of(millimetres).find("GB"), std::string::npos);
  TriangleMesh huge = box;
  for (glm::vec3& p : huge.positions) p *= 1e36f;
  EXPECT_NE(fault_of(huge).find("GB"), std::string::npos);
}

TEST(BoneGrid, TurnedTrianglesChangeNothing) {
  const TriangleMesh sound = test::make_sphere(0.02f, 32, 64);
  TriangleMesh turned = sound;
  for (std::size_t i = 0; i < turned.indices.size(); i += 15) std::swap(turned.indices[i], turned.indices[i + 1]);
  TriangleMesh inverted = sound;
  for (std::size_t i = 0; i < inverted.indices.size(); i += 3) std::swap(inverted.indices[i], inverted.indices[i + 1]);
  const BoneField right = make_field({&sound, 1});
  for (const TriangleMesh& mesh : {turned, inverted}) {
    const BoneField field = make_field({&mesh, 1});
    for (const glm::vec3& point : test::points_in_box(glm::vec3(-0.04f), glm::vec3(0.04f), 5'000)) {
      ASSERT_NEAR(field.distance(point), right.distance(point), 1e-7f);
    }
  }
}

TEST(BoneGrid, HolesAreCapped) {
  TriangleMesh open = test::make_sphere(0.02f, 32, 64);
  open.indices.erase(open.indices.begin(), open.indices.begin() + 3 * 8);        // a slit from a pole
  open.indices.erase(open.indices.begin() + 3000, open.indices.begin() + 3012);  // and a hole elsewhere
  const BoneField field = make_field({&open, 1});
  EXPECT_LT(field.distance({0, 0, 0}), -0.017f);
  expect_sphere(field, 0.02f, 0.0016f);
}

TEST(BoneGrid, ATubeOpenAtBothEndsIsSolid) {
  std::vector<glm::vec2> outline;
  for (int i = 0; i < 48; ++i) {
    const float angle = 0.1308997f * static_cast<float>(i);
    outline.emplace_back(0.012f * std::cos(angle), 0.012f * std::sin(angle));
  }
  const TriangleMesh tube = test::make_wall(outline, -0.04f, 0.04f, 8);
  const BoneField field = make_field({&tube, 1});
  EXPECT_NEAR(field.distance({0.0007f, 0, 0}), -0.0113f, 0.001f);
  EXPECT_NEAR(field.distance({0.014f, 0, 0.01f}), 0.002f, 0.0002f);
  EXPECT_NEAR(field.distance({0.0f, 0.001f, 0.039f}), -0.001f, 0.0002f);  // the cap
  EXPECT_NEAR(field.distance({0.0f, 0.001f, 0.045f}), 0.005f, 0.0002f);
}

TEST(BoneGrid, WallsInsideAreNoSurface) {
  // Two overlapping boxes, and a shell within: the middle is as deep as it is in the box that they make up.
  const std::vector<TriangleMesh> parts = {test::make_box({-0.04f, -0.02f, -0.02f}, {0.01f, 0.02f, 0.02f}),
                                           test::make_box({-0.01f, -0.02f, -0.02f}, {0.04f, 0.02f, 0.02f}),
                                           test::make_sphere(0.008f, 16, 32)};
  const BoneField field = make_field(parts);
  EXPECT_NEAR(field.distance({0.0f, 0.0f, 0.0f}), -0.02f, 0.001f);
  EXPECT_NEAR(field.distance({-0.01f, 0.003f, 0.0f}), -0.017f, 0.001f);
  EXPECT_NEAR(field.distance({0.01f, -0.01f, 0.002f}), -0.01f, 0.001f);
  EXPECT_NEAR(field.distance({0.0f, 0.023f, 0.0f}), 0.003f, 0.0001f);
}

TEST(BoneGrid, PartsApartAreOneField) {
  const std::vector<TriangleMesh> parts = {test::make_sphere(0.01f, 24, 48, {-0.05f, 0, 0}),
                                           test::make_sphere(0.01f, 24, 48, {0.05f, 0, 0})};
  const BoneField field = make_field(parts);
  EXPECT_LT(field.distance({-0.05f, 0, 0}), -0.008f);
  EXPECT_LT(field.distance({0.05f, 0, 0}), -0.008f);
  EXPECT_GT(field.distance({0, 0, 0}), 0.009f);
  EXPECT_LE(field.distance({0, 0, 0}), 0.04f);
}

TEST(BoneGrid, TheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = test::make_sphere(0.03f, 24, 48);
  const BoneField many = make_field({&mesh, 1});
  BoneField one;
  parallel::WorkerArena arena(1);
  arena.execute([&] { one = make_field({&mesh, 1}); });
  for (const glm::vec3& point : test::points_in_box(glm::vec3(-0.05f), glm::vec3(0.05f), 20'000)) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(many.distance(point)), std::bit_cast<std::uint32_t>(one.distance(point)));
  }
}

}  // namespace
}  // namespace fascicle::muscle
