#include "modules/muscle/measure/rest_surfaces.hpp"

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/loop/frame_time.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/muscle_systems.hpp"
#include "modules/muscle/spawn_muscles.hpp"

namespace fascicle::muscle {

RestSurfaces make_rest_surfaces(std::shared_ptr<const MuscleAsset> asset, std::span<const glm::mat4> bones) {
  ecs::World world;
  world.set_resource(FrameTime{});
  prepare_muscles(world);
  const ecs::Entity character = world.create();
  world.add(character, BoneMatrices{{bones.begin(), bones.end()}});
  const ecs::Entity musculature = spawn_musculature(world, character, std::move(asset));
  ecs::Schedule schedule;
  add_muscle_systems(schedule);
  parallel::WorkerArena one(1);
  schedule.run(world, one);
  return {world.get<MuscleSurfaces>(musculature), world.get<Tendons>(musculature)};
}

}  // namespace fascicle::muscle
