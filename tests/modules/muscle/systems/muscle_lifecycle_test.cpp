// Spawning, detaching, despawning, access by entity.
#include "engine/ecs/world.hpp"
#include "modules/muscle/components/muscle_measures.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"

namespace fascicle::muscle {
namespace {

TEST(MuscleLifecycle, StaleAndForeignEntitiesAreHarmless) {
  MuscleWorld w;
  const ecs::Entity stranger = w.world.create();
  detach_muscle(w.world, stranger);
  detach_muscle(w.world, ecs::kNoEntity);
  despawn_musculature(w.world, stranger);
  EXPECT_TRUE(w.world.alive(stranger));
  EXPECT_TRUE(surface_of(w.world, stranger).vertices.empty());
  EXPECT_EQ(length_of(w.world, ecs::kNoEntity), 0.0f);
  EXPECT_EQ(muscle_entity(w.world, stranger, "left_0"), ecs::kNoEntity);
  w.step();
}

TEST(MuscleLifecycle, SpawnLeavesACompleteRestShape) {
  MuscleWorld w;
  const auto asset = synthetic_asset();
  const ecs::Entity character = w.add_character(test::rest_bones());
  const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
  const MuscleSurfaces at_spawn = w.world.get<MuscleSurfaces>(muscles);
  w.step();
  const MuscleSurfaces& stepped = w.world.get<MuscleSurfaces>(muscles);
  for (std::size_t v = 0; v < at_spawn.vertices.size(); ++v) {
    ASSERT_LT(glm::distance(at_spawn.vertices[v].position, stepped.vertices[v].position), 1.0e-6f);
  }
}

TEST(MuscleLifecycle, MusclesAreEntities) {
  MuscleWorld w;
  const ecs::Entity character = w.add_character(test::rest_bones());
  const ecs::Entity muscles = spawn_musculature(w.world, character, synthetic_asset());
  EXPECT_EQ(w.world.entity_count(), 2u + 48u);
  const ecs::Entity muscle = muscle_entity(w.world, muscles, "right_3");
  ASSERT_TRUE(w.world.alive(muscle));
  EXPECT_EQ(w.world.get<Muscle>(muscle).index, 27u);
  EXPECT_EQ(muscle, muscle_entity(w.world, muscles, 27u));
  EXPECT_EQ(muscle_entity(w.world, muscles, "nobody"), ecs::kNoEntity);
  EXPECT_EQ(muscle_entity(w.world, muscles, 48u), ecs::kNoEntity);
  const MuscleSurfaceView view = surface_of(w.world, muscle);
  EXPECT_EQ(view.section_vertices, 8u);
  for (const std::uint32_t index : view.strips) {
    if (index != kRestartIndex) {
      EXPECT_LT(index - view.first_vertex, view.vertices.size());
    }
  }
}

TEST(MuscleLifecycle, DetachedMuscleDrawsNothingAndOthersGoOn) {
  MuscleWorld w;
  const auto asset = synthetic_asset();
  const ecs::Entity character = w.add_character(test::rest_bones());
  const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
  w.step();
  const ecs::Entity muscle = muscle_entity(w.world, muscles, 5u);
  detach_muscle(w.world, muscle);
  EXPECT_FALSE(w.world.alive(muscle));
  EXPECT_EQ(muscle_entity(w.world, muscles, 5u), ecs::kNoEntity);
  for (int round = 0; round < 2; ++round) {  // at once, and after a step
    const MuscleSurfaces& surfaces = w.world.get<MuscleSurfaces>(muscles);
    const glm::vec3 place = line_point(*asset, w.world.get<ActionLines>(muscles), 5, 0);
    for (const SurfaceVertex& vertex : surface_of(*asset, surfaces, 5).vertices) EXPECT_EQ(vertex.position, place);
    EXPECT_EQ(w.world.get<MuscleMeasures>(muscles).volume[5], 0.0f);
    EXPECT_EQ(w.world.get<MuscleMeasures>(muscles).length[5], 0.0f);
    EXPECT_EQ(w.world.get<MuscleMeasures>(muscles).tendon_point[5], glm::vec3(0.0f));
    EXPECT_GT(w.world.get<MuscleMeasures>(muscles).volume[6], 0.0f);
    EXPECT_NE(surface_of(*asset, surfaces, 6).vertices[0].position, surface_of(*asset, surfaces, 6).vertices[1].position);
    w.pose(character, test::walk_bones(0.2f));
    w.step();
  }
}

TEST(MuscleLifecycle, DespawnRemovesMusclesAndKeepsTheCharacter) {
  MuscleWorld w;
  const ecs::Entity character = w.add_character(test::rest_bones());
  const auto asset = synthetic_asset();
  for (int round = 0; round < 3; ++round) {
    const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
    list_costs(w.world, muscles, "walker");
    detach_muscle(w.world, muscle_entity(w.world, muscles, 7u));
    w.step();
    despawn_musculature(w.world, muscles);
    EXPECT_FALSE(w.world.alive(muscles));
    EXPECT_TRUE(w.world.alive(character));
    EXPECT_EQ(w.world.entity_count(), 1u);
    despawn_musculature(w.world, muscles);  // again: nothing
    w.step();
  }
  EXPECT_EQ(asset.use_count(), 1);
}

TEST(MuscleLifecycle, MemoryIsReported) {
  MuscleWorld w;
  const auto asset = synthetic_asset();
  spawn_musculature(w.world, w.add_character(test::rest_bones()), asset);
  std::size_t surfaces = 0;
  for (const ecs::ComponentMemory& row : w.world.memory_by_component()) {
    if (row.name.find("MuscleSurfaces") != std::string::npos) surfaces = row.bytes;
  }
  EXPECT_GE(surfaces, asset->vertex_count * sizeof(SurfaceVertex));
  EXPECT_GT(heap_bytes(*asset), asset->strip_indices.size() * sizeof(std::uint32_t));
}

}  // namespace
}  // namespace fascicle::muscle
