#include "game/collision_stats.hpp"

#include <filesystem>

#include <gmock/gmock.h>

#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

std::shared_ptr<const muscle::SceneAsset> walker() {
  const auto scene =
      muscle::load_scene(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "scenes" / "walker.scene.json");
  EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
  return *scene;
}

TEST(CollisionStats, WithoutCollisionThereIsNothing) {
  Simulation simulation(walker(), {.workers = 1, .collision = false, .skin_meshes = false});
  CollisionStats stats;
  EXPECT_EQ(stats.summary(), "none");
  simulation.step();
  stats.record(simulation, true);
  EXPECT_FALSE(stats.any());
  EXPECT_EQ(stats.summary(), "none");
  EXPECT_EQ(stats.to_table(), "");
}

// The components' own numbers, put in by hand, over two steps and two characters.
TEST(CollisionStats, StepsAddUpAndTheLargestStays) {
  Simulation simulation(walker(), {.workers = 1, .copies = 2, .skin_meshes = false});
  simulation.step();
  CollisionStats stats;
  for (const float depth : {0.004f, 0.001f}) {
    for (std::size_t i = 0; i < 2; ++i) {
      auto& collision = simulation.world().get<muscle::MuscleCollision>(simulation.characters()[i].musculature);
      auto& contacts = simulation.world().get<muscle::MuscleContacts>(simulation.characters()[i].musculature);
      collision.contact_count = 10;
      collision.fallbacks = 1;
      collision.overflows = 2;
      std::fill(collision.depth.begin(), collision.depth.end(), 0.0f);
      std::fill(collision.cost.begin(), collision.cost.end(), 0.0f);
      collision.depth[3] = i == 0 ? depth : 0.0f;
      collision.cost[3] = depth > 0.002f ? 6.0f : 4.0f;
      contacts.now.assign(3, {});
      contacts.began.assign(2, {});
      contacts.ended.assign(1, {});
    }
    stats.record(simulation, true);
  }
  EXPECT_EQ(stats.last().contacts, 20u);
  EXPECT_EQ(stats.last().pairs, 6u);
  EXPECT_FLOAT_EQ(stats.last().left, 0.001f);
  EXPECT_EQ(stats.total().contacts, 40u);
  EXPECT_EQ(stats.total().began, 8u);
  EXPECT_EQ(stats.total().ended, 4u);
  EXPECT_EQ(stats.total().fallbacks, 2u) << "they count from the spawn on already";
  EXPECT_EQ(stats.total().overflows, 4u);
  EXPECT_FLOAT_EQ(stats.total().left, 0.004f);
  EXPECT_EQ(stats.summary(),
            "20.0 contacts a step (most 20), 6.0 pairs touching (most 6), 8 began, 4 ended, deepest left 4.000 mm, 2 "
            "fallbacks, 4 overflows");
  const std::string table = stats.to_table();
  const std::string& name = simulation.characters()[0].asset->muscles->muscles[3].name;
  EXPECT_THAT(table, testing::ContainsRegex("walker 1 +" + name + " +5\\.0 +6 +4\\.000 +2\n"));
  EXPECT_THAT(table, testing::ContainsRegex("walker 2 +" + name + " +5\\.0 +6 +0\\.000 +0\n"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << "muscles without contacts are left out";
}

}  // namespace
}  // namespace fascicle::game
