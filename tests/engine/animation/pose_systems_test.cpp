#include "engine/animation/pose_systems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/animation/gltf_skins.hpp"
#include "engine/animation/skinning_systems.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle {
namespace {

ecs::Schedule make_schedule() {
  ecs::Schedule schedule;
  schedule.add("advance_clips", advance_clips);
  schedule.add("sample_clips", sample_clips);
  schedule.add("compose_bones", compose_bones);
  schedule.add("skin_meshes", skin_meshes);
  return schedule;
}

// A bone that moves from x = 0 to x = 2 in 2 s.
std::shared_ptr<const Clip> make_clip() {
  auto clip = std::make_shared<Clip>();
  clip->start = 1.0f;
  clip->end = 3.0f;
  clip->channels = {{0, ClipTarget::kTranslation, ClipInterpolation::kLinear, 0, 2, 0}};
  clip->times = {1.0f, 3.0f};
  clip->values = {glm::vec4(0), glm::vec4(2, 0, 0, 0)};
  return clip;
}

std::shared_ptr<const Skeleton> make_skeleton() {
  auto skeleton = std::make_shared<Skeleton>();
  skeleton->names = {"root", "tip"};
  skeleton->parents = {-1, 0};
  skeleton->rest_local = {{}, {{0, 1, 0}}};
  skeleton->rest_world.resize(2);
  compose(*skeleton, skeleton->rest_local, glm::mat4(1.0f), skeleton->rest_world);
  return skeleton;
}

std::shared_ptr<const SkinAsset> make_point() {
  auto asset = std::make_shared<SkinAsset>();
  asset->positions = {{0, 1, 0}};
  asset->normals = {{0, 0, 1}};
  asset->joints = {glm::u16vec4(0)};
  asset->weights = {{1, 0, 0, 0}};
  asset->joint_bones = {1};
  asset->inverse_binds = {glm::inverse(make_skeleton()->rest_world[1])};
  return asset;
}

class PoseSystems : public testing::Test {
 protected:
  PoseSystems() {
    FrameTime time;
    time.step = 0.5f;
    world_.set_resource(time);
  }
  ecs::Entity spawn(std::shared_ptr<const Clip> clip) {
    const ecs::Entity entity = world_.create();
    world_.add(entity, make_rest_pose(make_skeleton()));
    world_.add(entity, Placement{{0, 0, 10}, glm::quat(1, 0, 0, 0), 4});
    world_.add(entity, BoneMatrices{});
    world_.add(entity, ClipPlayer{std::move(clip), 0.0f, 1.0f, true});
    return entity;
  }

  ecs::World world_;
  ecs::Schedule schedule_ = make_schedule();
  parallel::WorkerArena arena_{2};
};

TEST_F(PoseSystems, WithoutAClipThePoseRests) {
  const ecs::Entity entity = spawn(nullptr);
  schedule_.run(world_, arena_);
  EXPECT_EQ(glm::vec3(world_.get<BoneMatrices>(entity).world[1][3]), glm::vec3(0, 1, 10));
  EXPECT_EQ(world_.get<BoneMatrices>(entity).teleport_count, 4u);
}

TEST_F(PoseSystems, ClipsPlayAndLoop) {
  const ecs::Entity entity = spawn(make_clip());
  const float expected[] = {0.5f, 1.0f, 1.5f, 0.0f, 0.5f};
  for (const float x : expected) {
    schedule_.run(world_, arena_);
    EXPECT_EQ(world_.get<BoneMatrices>(entity).world[1][3].x, x);
  }
}

TEST_F(PoseSystems, BackwardsAndOnce) {
  const ecs::Entity entity = spawn(make_clip());
  world_.get<ClipPlayer>(entity).speed = -1.0f;
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<BoneMatrices>(entity).world[0][3].x, 1.5f);
  world_.get<ClipPlayer>(entity).loop = false;
  world_.get<ClipPlayer>(entity).speed = 10.0f;
  schedule_.run(world_, arena_);
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<BoneMatrices>(entity).world[0][3].x, 2.0f);
}

TEST_F(PoseSystems, SkinsFollowTheirCharacter) {
  const ecs::Entity character = spawn(make_clip());
  const ecs::Entity skin = world_.create();
  const auto asset = make_point();
  world_.add(skin, SkinInstance{asset, character});
  world_.add(skin, make_skinned_surface(*asset));
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<SkinnedSurface>(skin).positions[0], glm::vec3(0.5f, 1, 10));
  world_.destroy(character);
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<SkinnedSurface>(skin).positions[0], glm::vec3(0.5f, 1, 10));  // stays as it was
}

TEST_F(PoseSystems, ASkinForMoreBonesKeepsItsSurface) {
  const ecs::Entity character = spawn(nullptr);
  auto asset = std::make_shared<SkinAsset>(*make_point());
  asset->joint_bones = {7};
  const ecs::Entity skin = world_.create();
  world_.add(skin, SkinInstance{asset, character});
  world_.add(skin, make_skinned_surface(*asset));
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<SkinnedSurface>(skin).positions[0], glm::vec3(0, 1, 0));
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST_F(PoseSystems, ANanPlacementHoldsTheLastGoodBonesAndSkin) {
  const ecs::Entity character = spawn(make_clip());
  const auto asset = make_point();
  world_.add(character, SkinInstance{asset, character});
  world_.add(character, make_skinned_surface(*asset));
  schedule_.run(world_, arena_);
  const std::vector<glm::mat4> good = world_.get<BoneMatrices>(character).world;
  const glm::vec3 skin = world_.get<SkinnedSurface>(character).positions[0];
  for (const float wrong : {kNan, std::numeric_limits<float>::infinity(), 1e30f}) {
    world_.get<Placement>(character).position.y = wrong;
    world_.get<Placement>(character).teleport_count = 5;
    schedule_.run(world_, arena_);
    EXPECT_EQ(world_.get<BoneMatrices>(character).world, good);
    EXPECT_EQ(world_.get<BoneMatrices>(character).teleport_count, 4u);  // the jump comes with the next good pose
    EXPECT_EQ(world_.get<SkinnedSurface>(character).positions[0], skin);
  }
  EXPECT_EQ(world_.get<BoneMatrices>(character).held_steps, 3u);
  world_.get<Placement>(character).position.y = 0.0f;
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<BoneMatrices>(character).world[1][3], glm::vec4(0.5f, 1.0f, 10.0f, 1.0f));
  EXPECT_EQ(world_.get<BoneMatrices>(character).teleport_count, 5u);
  EXPECT_EQ(world_.get<BoneMatrices>(character).held_steps, 3u);
}

TEST_F(PoseSystems, ANanInOneBonesPoseHoldsThemAllAndOthersGoOn) {
  const ecs::Entity broken = spawn(nullptr);
  const ecs::Entity sound = spawn(make_clip());
  schedule_.run(world_, arena_);
  const std::vector<glm::mat4> good = world_.get<BoneMatrices>(broken).world;
  world_.get<LocalPose>(broken).bones[0].translation.x = 3.0f;
  world_.get<LocalPose>(broken).bones[1].rotation.w = kNan;
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<BoneMatrices>(broken).world, good);
  EXPECT_EQ(world_.get<BoneMatrices>(broken).held_steps, 1u);
  EXPECT_EQ(world_.get<BoneMatrices>(sound).world[0][3].x, 1.0f);
  EXPECT_EQ(world_.get<BoneMatrices>(sound).held_steps, 0u);
}

TEST_F(PoseSystems, ANanInTheFirstStepGivesTheRestPose) {
  const ecs::Entity entity = spawn(nullptr);
  world_.get<Placement>(entity).rotation.x = kNan;
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<BoneMatrices>(entity).world, make_skeleton()->rest_world);
  EXPECT_EQ(world_.get<BoneMatrices>(entity).held_steps, 1u);
}

TEST_F(PoseSystems, SkinsHoldWhereAHostsBonesAreNotFinite) {
  const ecs::Entity character = world_.create();  // without a pose: the host writes the matrices
  const auto asset = make_point();
  world_.add(character, BoneMatrices{make_skeleton()->rest_world, 0});
  world_.add(character, SkinInstance{asset, character});
  world_.add(character, make_skinned_surface(*asset));
  world_.get<BoneMatrices>(character).world[1][3].x = 7.0f;
  schedule_.run(world_, arena_);
  world_.get<BoneMatrices>(character).world[1][0].x = kNan;
  schedule_.run(world_, arena_);
  EXPECT_EQ(world_.get<SkinnedSurface>(character).positions[0], glm::vec3(7, 1, 0));
}

TEST_F(PoseSystems, HeldStepsAllocateNothing) {
  const ecs::Entity entity = spawn(make_clip());
  const auto compose_all = [&] { compose_bones(world_.view<const LocalPose, const Placement, BoneMatrices>()); };
  compose_all();
  compose_all();
  world_.get<Placement>(entity).position.x = kNan;
  const test::AllocationScope scope;
  for (int step = 0; step < 10; ++step) compose_all();
  EXPECT_EQ(scope.allocations(), 0u);
  EXPECT_EQ(world_.get<BoneMatrices>(entity).held_steps, 10u);
}

TEST_F(PoseSystems, SteadyFramesAllocateNothing) {
  for (int i = 0; i < 100; ++i) {
    const ecs::Entity character = spawn(make_clip());
    const auto asset = make_point();
    world_.add(character, SkinInstance{asset, character});
    world_.add(character, make_skinned_surface(*asset));
  }
  const auto run_all = [&] {
    advance_clips(world_.view<ClipPlayer>(), ecs::Resource<const FrameTime>(world_.resource<FrameTime>()));
    sample_clips(world_.view<const ClipPlayer, LocalPose>());
    compose_bones(world_.view<const LocalPose, const Placement, BoneMatrices>());
    skin_meshes(world_.view<const SkinInstance, SkinnedSurface>(), world_.view<const BoneMatrices>());
  };
  parallel::WorkerArena one(1);  // what oneTBB allocates for its own threads is not ours
  one.execute([&] {
    run_all();
    const test::AllocationScope scope;
    for (int frame = 0; frame < 10; ++frame) run_all();
    EXPECT_EQ(scope.allocations(), 0u);
  });
}

TEST_F(PoseSystems, AnyNumberOfWorkersGivesTheSameBits) {
  FASCICLE_SKIP_WITHOUT_DATA("gltf/CesiumMan.glb");
  const Result<GltfFile> file = read_gltf(test::data_folder() / "gltf/CesiumMan.glb");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  const auto skeleton = std::make_shared<const Skeleton>(file->skeleton);
  const auto clip = std::make_shared<const Clip>(file->clips.at(0));
  const auto asset = make_skin_asset(*file, file->meshes.at(0));
  std::vector<std::vector<glm::vec3>> results;
  for (const int workers : {1, 2, 5}) {
    ecs::World world;
    world.set_resource(FrameTime{});
    std::vector<ecs::Entity> characters;
    for (int i = 0; i < 20; ++i) {
      const ecs::Entity entity = world.create();
      world.add(entity, make_rest_pose(skeleton));
      world.add(entity, Placement{});
      world.add(entity, BoneMatrices{});
      world.add(entity, ClipPlayer{clip, 0.1f * static_cast<float>(i), 1.0f, true});
      world.add(entity, SkinInstance{asset, entity});
      world.add(entity, make_skinned_surface(*asset));
      characters.push_back(entity);
    }
    ecs::Schedule schedule = make_schedule();
    parallel::WorkerArena arena(workers);
    for (int frame = 0; frame < 30; ++frame) schedule.run(world, arena);
    std::vector<glm::vec3> all;
    for (const ecs::Entity entity : characters) {
      const SkinnedSurface& surface = world.get<SkinnedSurface>(entity);
      all.insert(all.end(), surface.positions.begin(), surface.positions.end());
      all.insert(all.end(), surface.normals.begin(), surface.normals.end());
    }
    for (const glm::vec3& v : all) ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
    results.push_back(std::move(all));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace fascicle
