#include "modules/muscle/measure/surface_depth.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/parallel/worker_arena.hpp"
#include "tests/modules/muscle/measure/measured_shapes.hpp"
#include "tests/support/plain_surface.hpp"

namespace fascicle::muscle {
namespace {

const glm::mat4 kHere(1.0f);

glm::mat4 shifted(float x, float y, float z) { return glm::translate(glm::mat4(1.0f), {x, y, z}); }

SurfaceDepths depths_of(const SurfaceAsset& asset, const std::vector<glm::vec3>& places,
                        const std::vector<BoneMesh>& meshes, const std::vector<glm::mat4>& bones,
                        const glm::mat4& frame = kHere) {
  const SurfaceDepthMeter meter(std::make_shared<const SurfaceAsset>(asset), make_bone_solids(meshes));
  return meter.measure(test::to_points(places), frame, bones);
}

// A cube of 20 mm whose underside is at z = 0.
TriangleMesh cube() { return test::make_box({-0.01f, -0.01f, 0.0f}, {0.01f, 0.01f, 0.02f}); }
// A slab of bone below z = 0.
BoneMesh slab(std::int32_t bone = 0) {
  return test::bone_of(test::make_box({-0.05f, -0.05f, -0.03f}, {0.05f, 0.05f, 0.0f}), bone);
}

TEST(SurfaceDepth, WithoutBonesThereIsNone) {
  const TriangleMesh mesh = cube();
  const SurfaceDepths none = depths_of(test::plain_surface(mesh), mesh.positions, {}, {});
  EXPECT_EQ(none.free.depth, 0.0);
  EXPECT_EQ(none.free.bone, -1);
  EXPECT_EQ(none.points, 0u);
  // A bone that the skeleton lacks.
  EXPECT_EQ(depths_of(test::plain_surface(mesh), mesh.positions, {slab(3)}, {kHere}).points, 0u);
}

TEST(SurfaceDepth, VerticesThatAreNotFiniteAreReported) {
  TriangleMesh mesh = test::moved(cube(), shifted(0, 0, -0.003f));
  const SurfaceAsset asset = test::plain_surface(mesh);
  mesh.positions[7].x = std::numeric_limits<float>::quiet_NaN();
  const SurfaceDepths found = depths_of(asset, mesh.positions, {slab()}, {kHere});
  EXPECT_FALSE(found.finite);
  EXPECT_NEAR(found.free.depth, 0.003, 1e-7);  // of the triangles that are left
}

TEST(SurfaceDepth, ACubePushedIntoABone) {
  const TriangleMesh mesh = cube();
  const SurfaceAsset asset = test::plain_surface(mesh);
  for (const float depth : {0.0001f, 0.0005f, 0.003f, 0.009f}) {
    const SurfaceDepths found =
        depths_of(asset, test::moved(mesh, shifted(0, 0, -depth)).positions, {slab()}, {kHere});
    EXPECT_NEAR(found.free.depth, depth, 1e-7);
    EXPECT_EQ(found.free.bone, 0);
    EXPECT_NEAR(found.free.place.z, -depth, 1e-7);
    EXPECT_TRUE(found.finite);
    EXPECT_EQ(found.beside.depth, 0.0);
  }
  EXPECT_EQ(depths_of(asset, test::moved(mesh, shifted(0, 0, 0.0001f)).positions, {slab()}, {kHere}).free.depth, 0.0);
}

// The muscle in a frame of its own, the bone turned and moved: only where they are to each other counts.
TEST(SurfaceDepth, FramesAndBonesMayStandAnywhere) {
  const TriangleMesh mesh = test::moved(cube(), shifted(0, 0, -0.002f));
  const glm::mat4 frame = glm::rotate(shifted(1, 2, 3), 1.0f, glm::vec3(1, 1, 0));
  const glm::mat4 own = glm::rotate(shifted(0.3f, 0, 0), 2.0f, glm::vec3(0, 1, 0));  // bone frame -> frame
  BoneMesh bone = slab(1);
  bone.transform = glm::inverse(own);
  const SurfaceDepths found = depths_of(test::plain_surface(mesh), mesh.positions, {bone}, {kHere, frame * own}, frame);
  EXPECT_NEAR(found.free.depth, 0.002, 1e-6);
  EXPECT_EQ(found.free.bone, 1);
  const glm::vec3 local(glm::inverse(frame) * glm::vec4(found.free.place, 1.0f));
  EXPECT_NEAR(local.z, -0.002f, 1e-6f);
}

// A knob of bone in the middle of a face, far from all vertices.
TEST(SurfaceDepth, FacesAreSampledBetweenTheirVertices) {
  const TriangleMesh mesh = cube();
  const BoneMesh knob = test::bone_of(test::make_sphere(0.004f, 48, 96, {0.003f, 0.002f, -0.002f}));
  const SurfaceDepths found = depths_of(test::plain_surface(mesh), mesh.positions, {knob}, {kHere});
  // The deepest point of the face lies 2 mm below the knob's top, no sample further than 0.58 mm from it.
  EXPECT_LE(found.free.depth, 0.002 + 1e-6);
  EXPECT_GT(found.free.depth, 0.0018);
  EXPECT_NEAR(glm::distance(found.free.place, {0.003f, 0.002f, 0.0f}), 0.0, 0.00075);
}

TEST(SurfaceDepth, AttachedVerticesAndTheirNeighboursCountApart) {
  // A strip of squares of 10 mm along x, wound into a closed tube: a ring of vertices every 10 mm.
  std::vector<glm::vec2> outline;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 12;
    outline.emplace_back(0.01 * std::cos(angle), 0.01 * std::sin(angle));
  }
  const TriangleMesh tube = test::make_wall(outline, 0.0f, 0.06f, 6);
  SurfaceAsset asset = test::plain_surface(tube);
  std::vector<std::uint32_t> first_ring;
  for (std::uint32_t v = 0; v < 12; ++v) first_ring.push_back(v);
  test::attach(asset, 0, first_ring);
  const auto bone_between = [](float from, float to) {
    return test::bone_of(test::make_box({-0.05f, -0.05f, from}, {0.05f, 0.05f, to}));
  };
  // Attached: the first ring. Triangles that touch it end at z = 10 mm, those that touch neighbours at 20 mm.
  const SurfaceDepths attached = depths_of(asset, tube.positions, {bone_between(-0.05f, 0.009f)}, {kHere});
  EXPECT_EQ(attached.free.depth, 0.0);
  EXPECT_EQ(attached.beside.depth, 0.0);
  const SurfaceDepths beside = depths_of(asset, tube.positions, {bone_between(-0.05f, 0.018f)}, {kHere});
  EXPECT_EQ(beside.free.depth, 0.0);
  EXPECT_NEAR(beside.beside.depth, 0.008, 1e-6);
  const SurfaceDepths beyond = depths_of(asset, tube.positions, {bone_between(-0.05f, 0.023f)}, {kHere});
  EXPECT_NEAR(beyond.free.depth, 0.003, 1e-6);
  EXPECT_NEAR(beyond.beside.depth, 0.013, 1e-6);
}

TEST(SurfaceDepth, TheWorkersChangeNothing) {
  const TriangleMesh mesh = test::make_torus(0.03f, 0.01f, 60, 30);
  const SurfaceDepthMeter meter(std::make_shared<const SurfaceAsset>(test::plain_surface(mesh)),
                                make_bone_solids(std::vector<BoneMesh>{slab()}));
  SurfaceDepths one, four;
  parallel::WorkerArena(1).execute([&] { one = meter.measure(test::to_points(mesh.positions), kHere, {{kHere}}); });
  parallel::WorkerArena(4).execute([&] { four = meter.measure(test::to_points(mesh.positions), kHere, {{kHere}}); });
  EXPECT_GT(one.free.depth, 0.009);
  EXPECT_EQ(one.free.depth, four.free.depth);
  EXPECT_EQ(one.free.triangle, four.free.triangle);
  EXPECT_EQ(one.points, four.points);
}

TEST(AttachmentErrors, AreByAttachmentAndAgainstTheBonesMotion) {
  const TriangleMesh mesh = cube();
  SurfaceAsset asset = test::plain_surface(mesh);
  test::attach(asset, 0, {0, 1});
  test::attach(asset, 1, {4, 5});
  const glm::mat4 rest = shifted(0.1f, 0.2f, 0.0f), turn = glm::rotate(kHere, 0.7f, glm::vec3(1, 0, 0));
  std::vector<glm::vec3> places = mesh.positions;
  for (const std::size_t v : {4u, 5u}) places[v] = glm::vec3(turn * glm::vec4(places[v], 1.0f));
  const auto errors = [&] {
    return attachment_errors(asset, test::to_points(places), kHere, {{kHere, rest}}, {{kHere, turn * rest}});
  };
  ASSERT_EQ(errors().size(), 2u);
  EXPECT_NEAR(errors()[0], 0.0, 1e-7);
  EXPECT_NEAR(errors()[1], 0.0, 1e-7);
  places[1].y += 0.0002f;
  places[5].z -= 0.0005f;
  EXPECT_NEAR(errors()[0], 0.0002, 1e-7);
  EXPECT_NEAR(errors()[1], 0.0005, 1e-7);
  places[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isinf(errors()[0]));
}

}  // namespace
}  // namespace fascicle::muscle
