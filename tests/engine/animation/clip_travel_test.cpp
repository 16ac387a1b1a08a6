#include "engine/animation/clip_travel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/animation/pose_systems.hpp"
#include "engine/content/gltf_reader.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

constexpr float kHalf = std::numbers::sqrt2_v<float> / 2.0f;

// A stand, turned so that its z is the character's y (as exporters of z-up files write it), hips on it, a hand.
std::shared_ptr<Skeleton> make_skeleton() {
  auto skeleton = std::make_shared<Skeleton>();
  skeleton->names = {"stand", "hips", "hand"};
  skeleton->parents = {-1, 0, 1};
  skeleton->rest_local = {{{0, 0, 0}, glm::quat(kHalf, -kHalf, 0, 0), {2, 2, 2}}, {{0, 0, 0.5f}}, {{0.2f, 0, 0}}};
  skeleton->rest_world.resize(3);
  compose(*skeleton, skeleton->rest_local, glm::mat4(1.0f), skeleton->rest_world);
  return skeleton;
}

void add_channel(Clip& clip, std::int32_t bone, ClipInterpolation interpolation, const std::vector<float>& times,
                 const std::vector<glm::vec4>& values) {
  clip.channels.push_back({bone, ClipTarget::kTranslation, interpolation, static_cast<std::uint32_t>(clip.times.size()),
                           static_cast<std::uint32_t>(times.size()), static_cast<std::uint32_t>(clip.values.size())});
  clip.times.insert(clip.times.end(), times.begin(), times.end());
  clip.values.insert(clip.values.end(), values.begin(), values.end());
}

// Two seconds from second 1: the hips go `way` (character's space: x, y, z) and sway to the side and up in between. The
// hand moves too, and the stand has keys that do not.
std::shared_ptr<const Clip> make_walk(glm::vec3 way) {
  auto clip = std::make_shared<Clip>();
  clip->start = 1.0f;
  clip->end = 3.0f;
  const auto stand = [](glm::vec3 v) { return glm::vec4(v.x / 2, -v.z / 2, v.y / 2, 0); };
  add_channel(*clip, 2, ClipInterpolation::kLinear, {1, 3}, {{0.2f, 0, 0, 0}, {0.9f, 0, 0, 0}});
  add_channel(*clip, 0, ClipInterpolation::kLinear, {1, 3}, {glm::vec4(0), glm::vec4(0)});
  const glm::vec3 first(0.25f, 1, 0.5f);
  add_channel(*clip, 1, ClipInterpolation::kLinear, {1, 2, 3},
              {stand(first), stand(first + 0.5f * way + glm::vec3(0.125f, 0.25f, 0)), stand(first + way)});
  return clip;
}

glm::vec3 hips_at(const Clip& clip, const Skeleton& skeleton, float time, bool in_place) {
  std::vector<Trs> pose = skeleton.rest_local;
  sample_clip(clip, time, pose);
  if (in_place) hold_in_place(clip, skeleton, time, pose);
  std::vector<glm::mat4> world(pose.size());
  compose(skeleton, pose, glm::mat4(1.0f), world);
  return glm::vec3(world[1][3]);
}

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-6f);
  EXPECT_NEAR(a.y, b.y, 1e-6f);
  EXPECT_NEAR(a.z, b.z, 1e-6f);
}

TEST(ClipTravel, WithoutAMovingRootNothingIsDone) {
  const auto skeleton = make_skeleton();
  Clip clip;
  clip.end = 1.0f;
  EXPECT_EQ(find_travelling_root(clip, *skeleton), nullptr);
  add_channel(clip, 0, ClipInterpolation::kLinear, {0, 1}, {glm::vec4(1), glm::vec4(1)});
  for (const std::int32_t bone : {-1, 3, 1000000}) {
    add_channel(clip, bone, ClipInterpolation::kLinear, {0, 1}, {glm::vec4(0), glm::vec4(1)});
  }
  EXPECT_EQ(find_travelling_root(clip, *skeleton), nullptr);
  std::vector<Trs> pose = skeleton->rest_local;
  hold_in_place(clip, *skeleton, 0.5f, pose);
  EXPECT_EQ(pose[1].translation, skeleton->rest_local[1].translation);
}

TEST(ClipTravel, APoseOfAnotherSkeletonIsLeftAlone) {
  std::vector<Trs> pose(2);
  hold_in_place(*make_walk({0, 0, 2}), *make_skeleton(), 3.0f, pose);
  EXPECT_EQ(pose[1].translation, glm::vec3(0));
}

TEST(ClipTravel, AStandThatIsFlatLeavesThePoseFinite) {
  const auto skeleton = make_skeleton();
  skeleton->rest_local[0].scale = glm::vec3(0.0f);
  EXPECT_TRUE(std::isfinite(hips_at(*make_walk({1, 0, 2}), *skeleton, 3.0f, true).z));
}

TEST(ClipTravel, TheTopmostBoneThatMovesIsTheRoot) {
  const auto clip = make_walk({0, 0, 2});
  const ClipChannel* root = find_travelling_root(*clip, *make_skeleton());
  ASSERT_NE(root, nullptr);
  EXPECT_EQ(root->bone, 1);
}

TEST(ClipTravel, TheDriftGoesAndTheSwayStays) {
  const auto skeleton = make_skeleton();
  const auto clip = make_walk({1, 0.5f, 2});
  expect_near(hips_at(*clip, *skeleton, 3.0f, false), {1.25f, 1.5f, 2.5f});
  expect_near(hips_at(*clip, *skeleton, 1.0f, true), {0.25f, 1, 0.5f});
  expect_near(hips_at(*clip, *skeleton, 2.0f, true), {0.375f, 1.5f, 0.5f});
  expect_near(hips_at(*clip, *skeleton, 3.0f, true), {0.25f, 1.5f, 0.5f});  // its height is the clip's
  expect_near(hips_at(*clip, *skeleton, 9.0f, true), {0.25f, 1.5f, 0.5f});
  expect_near(hips_at(*clip, *skeleton, std::numeric_limits<float>::quiet_NaN(), true), {0.25f, 1, 0.5f});
}

TEST(ClipTravel, SplinesCountByTheirValues) {
  const auto skeleton = make_skeleton();
  Clip clip;
  clip.end = 1.0f;
  const glm::vec4 tangent(0, -3, 0, 0);  // 6 m/s ahead in the character's space: one way, at an even pace
  add_channel(clip, 1, ClipInterpolation::kCubicSpline, {0, 1},
              {tangent, {0, 0, 0, 0}, tangent, tangent, {0, -3, 0, 0}, tangent});
  EXPECT_NEAR(hips_at(clip, *skeleton, 0.25f, false).z, 1.5f, 1e-6f);
  for (const float time : {0.0f, 0.25f, 0.75f, 1.0f}) EXPECT_NEAR(hips_at(clip, *skeleton, time, true).z, 0.0f, 1e-6f);
}

TEST(ClipTravel, AClipWithoutLevelDriftIsUnchangedBitForBit) {
  const auto skeleton = make_skeleton();
  const auto clip = make_walk({0, 0, 0});
  for (float time = 1.0f; time <= 3.0f; time += 0.07f) {
    EXPECT_EQ(hips_at(*clip, *skeleton, time, true), hips_at(*clip, *skeleton, time, false));
  }
}

class InPlace : public testing::Test {
 protected:
  ecs::Entity spawn(std::shared_ptr<const Skeleton> skeleton, std::shared_ptr<const Clip> clip, bool in_place) {
    const ecs::Entity entity = world_.create();
    world_.add(entity, make_rest_pose(std::move(skeleton)));
    world_.add(entity, Placement{});
    world_.add(entity, BoneMatrices{});
    world_.add(entity, ClipPlayer{.clip = std::move(clip), .in_place = in_place});
    return entity;
  }
  void step() {
    advance_clips(world_.view<ClipPlayer>(), ecs::Resource<const FrameTime>(world_.resource<FrameTime>()));
    sample_clips(world_.view<const ClipPlayer, LocalPose>());
    compose_bones(world_.view<const LocalPose, const Placement, BoneMatrices>());
  }
  void set_step(float seconds) {
    FrameTime time;
    time.step = seconds;
    world_.set_resource(time);
  }
  glm::vec3 hips(ecs::Entity entity) { return glm::vec3(world_.get<BoneMatrices>(entity).world[1][3]); }

  ecs::World world_;
};

TEST_F(InPlace, ALoopedWalkStaysOnTheSpotWithoutAJump) {
  set_step(1.0f / 64);
  const auto skeleton = make_skeleton();
  const auto walk = make_walk({0, 0, 4});
  const ecs::Entity held = spawn(skeleton, walk, true), free = spawn(skeleton, walk, false);
  float largest_step = 0.0f, largest_free_step = 0.0f;
  step();
  for (int i = 0; i < 5 * 128; ++i) {
    const glm::vec3 before = hips(held), before_free = hips(free);
    step();
    largest_step = std::max(largest_step, glm::length(hips(held) - before));
    largest_free_step = std::max(largest_free_step, glm::length(hips(free) - before_free));
    EXPECT_NEAR(hips(held).z, 0.5f, 1e-5f);
  }
  EXPECT_LT(largest_step, 0.01f);  // the sway: 0.28 m in a second
  EXPECT_GT(largest_free_step, 3.9f);  // the jump back that `in_place` spares
}

TEST_F(InPlace, AllocatesNothing) {
  set_step(0.25f);
  spawn(make_skeleton(), make_walk({1, 0, 4}), true);
  parallel::WorkerArena one(1);
  one.execute([&] {
    step();
    const test::AllocationScope scope;
    for (int i = 0; i < 10; ++i) step();
    EXPECT_EQ(scope.allocations(), 0u);
  });
}

TEST_F(InPlace, CesiumMansWalkEndsWhereItBegins) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const Result<GltfFile> file = read_gltf(test::data_folder() / "gltf/CesiumMan.glb");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  const Clip& clip = file->clips.at(0);
  const ClipChannel* root = find_travelling_root(clip, file->skeleton);
  ASSERT_NE(root, nullptr);
  const auto root_at = [&](float time) {
    std::vector<Trs> pose = file->skeleton.rest_local;
    sample_clip(clip, time, pose);
    hold_in_place(clip, file->skeleton, time, pose);
    std::vector<glm::mat4> world(pose.size());
    compose(file->skeleton, pose, glm::mat4(1.0f), world);
    return glm::vec3(world[static_cast<std::size_t>(root->bone)][3]);
  };
  EXPECT_NEAR(root_at(clip.start).x, root_at(clip.end).x, 1e-5f);
  EXPECT_NEAR(root_at(clip.start).z, root_at(clip.end).z, 1e-5f);
}

}  // namespace
}  // namespace fascicle
