#include "modules/muscle/measure/bone_solids.hpp"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/modules/muscle/measure/measured_shapes.hpp"

namespace fascicle::muscle {
namespace {

// The grid must not change an answer.
void expect_exact(const BoneSolid& solid, int count, std::uint32_t seed = 1) {
  test::Numbers numbers(seed);
  int inside = 0;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 share = numbers.point(-0.1f, 1.1f);
    const glm::vec3 point = solid.box().lower + share * (solid.box().upper - solid.box().lower);
    const double exact = solid.exact_depth(point), found = solid.depth_beyond(point, 0.0);
    ASSERT_EQ(found, exact) << i;
    inside += exact > 0.0 ? 1 : 0;
    const double enough = 0.005, deeper = solid.depth_beyond(point, enough);
    ASSERT_TRUE(exact > enough ? deeper == exact : deeper <= enough) << i;
  }
  EXPECT_GT(inside, count / 20);
}

TEST(BoneSolids, MeshesWithoutTrianglesAreLeftOut) {
  EXPECT_TRUE(make_bone_solids({})->empty());
  TriangleMesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.indices = {0, 1, 2};
  const std::vector<BoneMesh> meshes{{0, glm::mat4(1.0f), nullptr}, test::bone_of({}), test::bone_of(flat),
                                     test::bone_of(test::make_sphere(0.02f, 8, 8), -1)};
  EXPECT_TRUE(make_bone_solids(meshes)->empty());
}

TEST(BoneSolids, DepthIsTheDistanceToTheSurface) {
  const BoneSolid ball(test::bone_of(test::make_sphere(0.03f, 48, 96), 2, glm::translate(glm::mat4(1.0f), {1, 2, 3})));
  EXPECT_EQ(ball.bone(), 2);
  EXPECT_NEAR(ball.depth_beyond({1.0f, 2.01f, 3.0f}, 0.0), 0.02, 1e-4);
  EXPECT_NEAR(ball.depth_beyond({1.029f, 2.0f, 3.0f}, 0.0), 0.001, 1e-4);
  EXPECT_EQ(ball.depth_beyond({1.031f, 2.0f, 3.0f}, 0.0), 0.0);
  EXPECT_EQ(ball.depth_beyond({0.0f, 0.0f, 0.0f}, 0.0), 0.0);
}

TEST(BoneSolids, TheGridChangesNothing) {
  expect_exact(BoneSolid(test::bone_of(test::make_sphere(0.05f, 24, 48))), 20000);
  expect_exact(BoneSolid(test::bone_of(test::make_torus(0.05f, 0.012f, 48, 24))), 20000);
  expect_exact(BoneSolid(test::bone_of(test::inside_out(test::make_sphere(0.05f, 24, 48)))), 5000);
}

// A ball with its north cut off: the winding number closes the hole by a smooth lid.
TEST(BoneSolids, TheGridChangesNothingOfMeshesWithHoles) {
  TriangleMesh cut = test::make_sphere(0.05f, 24, 48);
  TriangleMesh open = cut;
  open.indices.clear();
  for (std::size_t i = 0; i + 2 < cut.indices.size(); i += 3) {
    if (cut.positions[cut.indices[i]].z < 0.035f) {
      open.indices.insert(open.indices.end(), cut.indices.begin() + static_cast<std::ptrdiff_t>(i),
                          cut.indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    }
  }
  ASSERT_LT(open.indices.size(), cut.indices.size());
  const BoneSolid solid(test::bone_of(open));
  expect_exact(solid, 20000);
  EXPECT_NEAR(solid.depth_beyond({0.0f, 0.0f, -0.045f}, 0.0), 0.005, 1e-4);
}

}  // namespace
}  // namespace fascicle::muscle
