#include "modules/muscle/systems/5_present/pick_muscle.hpp"

#include <gtest/gtest.h>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/content/edit_collision.hpp"
#include "modules/muscle/content/tag_place.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"
#include "tests/support/surface_rays.hpp"

namespace fascicle::muscle {
namespace {

class PickMuscle : public testing::Test {
 protected:
  void spawn(std::uint32_t section_vertices, std::uint32_t subdivision) {
    asset_ = synthetic_asset(section_vertices, subdivision);
    character_ = world_.add_character(test::rest_bones());
    musculature_ = spawn_musculature(world_.world, character_, asset_);
    world_.step();
  }
  template <class T>
  const T& get() {
    return world_.world.get<T>(musculature_);
  }
  std::optional<MusclePick> pick(const Ray& ray, std::span<const std::uint8_t> hidden = {}) {
    return pick_muscle(*asset_, get<MuscleSurfaces>(), get<Tendons>(), hidden, ray);
  }

  MuscleWorld world_;
  std::shared_ptr<const MuscleAsset> asset_;
  ecs::Entity character_, musculature_;
};

TEST_F(PickMuscle, NothingIsMetBesideBehindOrHidden) {
  const MuscleAsset none;
  EXPECT_FALSE(pick_muscle(none, MuscleSurfaces{}, Tendons{}, {}, Ray{}).has_value());
  spawn(8, 1);
  EXPECT_FALSE(pick({{10, 10, 10}, {0, 1, 0}}).has_value());
  const test::SurfaceRay ray = test::surface_rays(*asset_, get<MuscleSurfaces>(), get<ActionLines>(),
                                                  get<CrossSections>(), 0)
                                   .at(0);
  EXPECT_TRUE(pick(ray.ray).has_value());
  const std::vector<std::uint8_t> all(asset_->size(), 1);
  EXPECT_FALSE(pick(ray.ray, all).has_value());
}

// From just above every inner vertex, whatever the pose: the vertex, and a tag that leads back to it.
TEST_F(PickMuscle, EveryInnerVertexIsFoundAndItsTagLeadsBackToIt) {
  for (const auto& [vertices, subdivision] : {std::pair{6u, 0u}, {8u, 1u}, {16u, 2u}}) {
    spawn(vertices, subdivision);
    world_.pose(character_, test::walk_bones(0.4f));
    world_.step();
    std::size_t found = 0, asked = 0;
    for (std::uint32_t m = 0; m < asset_->size(); ++m) {
      std::vector<std::uint8_t> others(asset_->size(), 1);
      others[m] = 0;
      for (const test::SurfaceRay& ray :
           test::surface_rays(*asset_, get<MuscleSurfaces>(), get<ActionLines>(), get<CrossSections>(), m)) {
        const auto hit = pick(ray.ray, others);
        ++asked;
        if (!hit || hit->distance < 0.9f * test::kRayHeight) continue;  // a fold of the surface lies above it
        ++found;
        ASSERT_EQ(hit->muscle, m);
        EXPECT_EQ(hit->section, ray.section) << asset_->muscles[m].name << " vertex " << ray.vertex;
        EXPECT_EQ(hit->vertex, ray.vertex) << asset_->muscles[m].name << " section " << ray.section;
        EXPECT_NEAR(hit->distance, test::kRayHeight, 1e-5f);
        const TaggedVertex tagged =
            find_tagged_vertex(*asset_, as_written(tag_of(*asset_, m, hit->section, hit->vertex)));
        EXPECT_EQ(tagged.section, hit->section);
        EXPECT_EQ(tagged.vertex, hit->vertex);
      }
    }
    EXPECT_GT(asked, vertices * asset_->size() / 2);
    EXPECT_GT(found, asked - asked / 100);
  }
}

TEST_F(PickMuscle, TheNearestMuscleThatIsNotHiddenIsMet) {
  spawn(8, 1);
  // Across the right leg, from the side: several muscles lie one behind the other.
  const Ray ray{{-2.0f, 0.6f, 0.0f}, {1, 0, 0}};
  std::vector<std::uint8_t> hidden(asset_->size(), 0);
  float last = 0.0f;
  std::size_t met = 0;
  while (const auto hit = pick(ray, hidden)) {
    EXPECT_GE(hit->distance, last);
    EXPECT_EQ(hidden[hit->muscle], 0);
    EXPECT_GE(hit->section, 1u);
    EXPECT_LT(hit->section + 1, asset_->muscles[hit->muscle].section_count);
    last = hit->distance;
    hidden[hit->muscle] = 1;
    ++met;
  }
  EXPECT_GT(met, 3u);
}

TEST_F(PickMuscle, DetachedMusclesAreNotMet) {
  spawn(8, 1);
  const test::SurfaceRay ray = test::surface_rays(*asset_, get<MuscleSurfaces>(), get<ActionLines>(),
                                                  get<CrossSections>(), 3)
                                   .at(5);
  std::vector<std::uint8_t> others(asset_->size(), 1);
  others[3] = 0;
  ASSERT_TRUE(pick(ray.ray, others).has_value());
  detach_muscle(world_.world, get<Musculature>().muscles[3]);
  world_.step();
  EXPECT_FALSE(pick(ray.ray, others).has_value());
}

}  // namespace
}  // namespace fascicle::muscle
