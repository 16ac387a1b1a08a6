#include "engine/animation/pose_systems.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
