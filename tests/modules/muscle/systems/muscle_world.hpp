// A world with synthetic characters and the muscle systems' schedule.
#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {

inline std::shared_ptr<const MuscleAsset> synthetic_asset(std::uint32_t section_vertices = 8,
                                                          std::uint32_t subdivision = 1) {
  const auto result =
      build_muscle_asset(test::synthetic_muscles(section_vertices, subdivision), test::rest_bones());
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return *result;
}

struct MuscleWorld {
  ecs::World world;
  ecs::Schedule schedule;
  parallel::WorkerArena arena;

  explicit MuscleWorld(int workers = 1, const MuscleSettings& settings = {}) : arena(workers) {
    prepare_muscles(world, settings);
    add_muscle_systems(schedule);
  }

  ecs::Entity add_character(std::vector<glm::mat4> bones) {
    const ecs::Entity character = world.create();
    world.add(character, BoneMatrices{std::move(bones), 0});
    return character;
  }
  void pose(ecs::Entity character, const std::vector<glm::mat4>& bones) {
    world.get<BoneMatrices>(character).world = bones;
  }
  void step() { schedule.run(world, arena); }
};

}  // namespace fascicle::muscle
