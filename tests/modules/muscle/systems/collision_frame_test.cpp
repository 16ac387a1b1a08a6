// What must hold of every frame with collision: the same state for any number of workers, no allocation, levels of
// detail that carry the deformation, and the legacy mode in its place.
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/math/state_hash.hpp"
#include "modules/muscle/components/collision_scratch.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"
#include "modules/muscle/systems/4_solve/solve_as_legacy.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/analytic_bones.hpp"
#include "tests/support/collision_rods.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

test::BoneFields body_bones() {
  test::BoneFields fields(test::kSyntheticBones);
  for (const std::size_t bone : {test::kFemurLeft, test::kTibiaLeft, test::kFemurRight, test::kTibiaRight}) {
    fields[bone] = test::box_bone({-0.012f, -0.39f, -0.012f}, {0.012f, -0.02f, 0.012f});
  }
  return fields;
}

std::shared_ptr<const CollisionAsset> body_collision(std::shared_ptr<const MuscleAsset> muscles) {
  return build_collision_asset(std::move(muscles), {}, body_bones(), test::rest_bones());
}

std::uint64_t hash_collision(const ecs::World& world, ecs::Entity musculature) {
  StateHash hash;
  const MuscleCollision& collision = world.get<MuscleCollision>(musculature);
  for (const AlignedVector<float>* values :
       {&collision.offset_x, &collision.offset_y, &collision.offset_z, &collision.radii}) {
    hash.add(std::span<const float>(*values));
  }
  hash.add(std::span<const float>(collision.depth));
  for (const MuscleContact& contact : world.get<MuscleContacts>(musculature).now) {
    const std::uint32_t ids[] = {contact.muscle, static_cast<std::uint32_t>(contact.bone), contact.other,
                                 contact.points};
    const float values[] = {contact.depth, contact.left, contact.place.x, contact.normal.y};
    hash.add(std::span<const std::uint32_t>(ids));
    hash.add(std::span<const float>(values));
  }
  return hash.value();
}

struct Walkers : MuscleWorld {
  std::shared_ptr<const MuscleAsset> muscles = synthetic_asset(8, 2);
  std::shared_ptr<const CollisionAsset> collision = body_collision(muscles);
  std::vector<ecs::Entity> characters, musculatures;

  Walkers(int workers, int count) : MuscleWorld(workers) {
    for (int i = 0; i < count; ++i) {
      characters.push_back(add_character(test::rest_bones()));
      musculatures.push_back(spawn_musculature(world, characters.back(), muscles));
      add_collision(world, musculatures.back(), std::vector{collision}, CollisionSettings{});
    }
  }
  void walk(int frame) {
    for (std::size_t i = 0; i < characters.size(); ++i) {
      pose(characters[i], test::walk_bones(0.03f * static_cast<float>(frame) + 0.17f * static_cast<float>(i)));
    }
  }
};

TEST(CollisionFrame, StateIsTheSameForAnyWorkers) {
  std::vector<std::uint64_t> expected;
  for (const int workers : {1, 2, 3, 8}) {
    Walkers w(workers, 3);
    std::vector<std::uint64_t> hashes;
    std::uint32_t contacts = 0;
    for (int frame = 0; frame < 5; ++frame) {
      w.walk(frame);
      w.step();
      hashes.push_back(hash_state(w.world));
      for (const ecs::Entity musculature : w.musculatures) {
        hashes.push_back(hash_collision(w.world, musculature));
        contacts += w.world.get<MuscleCollision>(musculature).contact_count;
      }
    }
    EXPECT_GT(contacts, 1000u);
    if (expected.empty()) expected = hashes;
    EXPECT_EQ(hashes, expected) << workers;
  }
}

TEST(CollisionFrame, CharactersDoNotDependOnEachOther) {
  // The second walker alone has the state that it has among others: scratch carries nothing over.
  Walkers many(1, 3), alone(1, 1);
  for (int frame = 0; frame < 5; ++frame) {
    many.walk(frame);
    alone.pose(alone.characters[0], test::walk_bones(0.03f * static_cast<float>(frame) + 0.17f));
    many.step();
    alone.step();
    EXPECT_EQ(hash_collision(many.world, many.musculatures[1]), hash_collision(alone.world, alone.musculatures[0]));
  }
}

TEST(CollisionFrame, NothingIsAllocated) {
  for (const int workers : {1, 2}) {
    Walkers w(workers, 3);
    for (int frame = 0; frame < 18; ++frame) {
      w.walk(frame);
      if (frame == 11) w.world.get<BoneMatrices>(w.characters[0]).world[2][3].x = kNaN;
      if (frame == 13) w.world.get<MuscleCollision>(w.musculatures[1]).radii[40] = kNaN;
      if (frame == 14 || frame == 16) {
        bool& enabled = w.world.get<MuscleCollision>(w.musculatures[2]).settings.enabled;
        enabled = !enabled;
      }
      const test::AllocationScope scope;
      w.step();
      if (frame >= 10) {
        EXPECT_EQ(scope.allocations(), 0u) << "frame " << frame << ", " << workers << " workers";
      }
    }
  }
}

TEST(CollisionFrame, WalkStaysSound) {
  Walkers w(2, 1);
  MuscleSurfaces last;
  for (int frame = 0; frame < 60; ++frame) {
    w.pose(w.characters[0], test::walk_bones(static_cast<float>(frame) / 50.0f, {0.0f, 0.95f, 0.0f}));
    w.step();
    for (const SurfaceVertex& vertex : w.world.get<MuscleSurfaces>(w.musculatures[0]).vertices) {
      ASSERT_TRUE(std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z));
    }
  }
  const MuscleCollision& collision = w.world.get<MuscleCollision>(w.musculatures[0]);
  EXPECT_EQ(collision.fallbacks, 0u);
  EXPECT_EQ(collision.overflows, 0u);
}

// Levels of some rods: half the vertices and half the sections each.
std::shared_ptr<const MuscleLevels> rod_levels(std::vector<test::Rod> rods) {
  std::vector<std::shared_ptr<const MuscleAsset>> assets;
  for (const auto& [section_vertices, subdivision] : {std::pair(32u, 4u), std::pair(16u, 3u), std::pair(8u, 2u)}) {
    for (test::Rod& rod : rods) {
      rod.section_vertices = section_vertices;
      rod.subdivision = subdivision;
    }
    assets.push_back(test::build_rods(rods, 2));
  }
  const auto levels = make_muscle_levels(assets);
  EXPECT_TRUE(levels.ok()) << to_text(levels.diagnostics());
  return levels.ok() ? *levels : nullptr;
}

struct Leveled : MuscleWorld {
  std::shared_ptr<const MuscleLevels> levels;
  ecs::Entity character, musculature;

  Leveled(std::shared_ptr<const MuscleLevels> chain, const test::BoneFields& fields, const std::vector<glm::mat4>& rest)
      : levels(std::move(chain)) {
    character = add_character(rest);
    musculature = spawn_musculature(world, character, levels);
    std::vector<std::shared_ptr<const CollisionAsset>> collisions;
    for (const auto& asset : levels->assets) collisions.push_back(build_collision_asset(asset, {}, fields, rest));
    add_collision(world, musculature, collisions, CollisionSettings{});
  }
  void look(std::uint32_t level) {
    world.set_resource(Viewer{.enabled = true, .eye = {0, 1, 3}, .pixels_per_radian = 1000.0f, .level = level});
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  const MuscleAsset& asset() { return *world.get<Musculature>(musculature).asset; }
  const MuscleCollision& collision() { return world.get<MuscleCollision>(musculature); }
  std::uint32_t middle(std::uint32_t m) { return (asset().muscles[m].section_count - 1) / 2; }
  glm::vec3 centre(std::uint32_t m) {
    return line_point(asset(), world.get<ActionLines>(musculature), m, middle(m));
  }
  // How much wider than at rest the middle section is in each quarter, from its u on.
  std::array<float, 4> stretch(std::uint32_t m) {
    std::array<float, 4> quarters{};
    const std::uint32_t first = asset().radius(m, middle(m)), count = asset().muscles[m].section_vertices;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t at = first + i * count / 4;
      quarters[i] = world.get<CrossSections>(musculature).radii[at] / collision().rest_radii[at];
    }
    return quarters;
  }
};

// Two rods pressed crosswise by 6 mm, and one that nothing touches.
struct LeveledRods : Leveled {
  LeveledRods()
      : Leveled(rod_levels({{.from = {0, 0, -0.1f}, .to = {0, 0, 0.1f}},
                            {.from = {-0.1f, 0.05f, 0}, .to = {0.1f, 0.05f, 0}, .from_bone = 1, .to_bone = 1},
                            {.from = {0.3f, 0, -0.1f}, .to = {0.3f, 0, 0.1f}}}),
                {nullptr, nullptr}, std::vector<glm::mat4>(2, glm::mat4(1.0f))) {
    look(0);
    for (int i = 0; i <= 20; ++i) {
      glm::mat4 upper(1.0f);
      upper[3].y = -0.016f * static_cast<float>(i) / 20.0f;
      pose(character, {glm::mat4(1.0f), upper});
      step();
    }
    steps(100);
  }
};

TEST(CollisionFrame, LevelsCarryTheDeformation) {
  LeveledRods w;
  const float pressed = w.centre(0).y;
  EXPECT_LT(pressed, -2.0e-4f);
  for (const std::uint32_t level : {1u, 2u, 1u, 0u}) {
    const glm::vec3 before[] = {w.centre(0), w.centre(1)};
    const std::array<float, 4> stretch[] = {w.stretch(0), w.stretch(1)};
    w.look(level);
    w.steps(2);  // one that announces it, one that makes it
    ASSERT_EQ(w.world.get<MuscleDetail>(w.musculature).level, level);
    for (std::uint32_t m = 0; m < 2; ++m) {
      EXPECT_LT(glm::distance(w.centre(m), before[m]), 0.0005f) << "to level " << level << " rod " << m;
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(w.stretch(m)[i], stretch[m][i], 0.08f) << "to level " << level << " rod " << m << " quarter " << i;
      }
    }
    w.steps(100);
    EXPECT_NEAR(w.centre(0).y, pressed, 0.0015f) << level;
    EXPECT_EQ(w.collision().fallbacks, 0u);
    EXPECT_FALSE(w.world.get<MuscleContacts>(w.musculature).now.empty());
  }
}

TEST(CollisionFrame, MorphIsFollowedInAStillPose) {
  // Nothing moves but the viewer, who goes away slowly.
  LeveledRods w;
  const float complete = w.levels->morphs[0].complete, begin = complete / kMorphBand;
  std::array<glm::vec3, 2> last = {w.centre(0), w.centre(1)};
  float morph = 0.0f;
  for (int i = 0; i <= 60; ++i) {
    const float size = begin + (complete - begin) * 0.9f * static_cast<float>(i) / 60.0f;
    const PointBinding& anchor = w.levels->anchor;
    const auto& bones = w.world.get<BoneMatrices>(w.character).world;
    const glm::vec3 place(
        bones[anchor.first_bone] * glm::vec4(anchor.first[0], anchor.first[1], anchor.first[2], anchor.first[3]) +
        bones[anchor.second_bone] * glm::vec4(anchor.second[0], anchor.second[1], anchor.second[2], anchor.second[3]));
    w.world.set_resource(Viewer{.enabled = true, .eye = place + glm::vec3(0, 0, 1000.0f * size + w.levels->radius),
                                .pixels_per_radian = 1000.0f});
    w.step();
    morph = w.world.get<Musculature>(w.musculature).morph;
    EXPECT_EQ(w.collision().morph, morph);
    for (std::uint32_t m = 0; m < 2; ++m) {
      EXPECT_LT(glm::distance(last[m], w.centre(m)), 0.0003f) << i;
      last[m] = w.centre(m);
    }
    for (std::uint32_t k = 1; k < w.asset().muscles[2].section_count; ++k) {  // the one that nothing touches
      const std::uint32_t first = w.asset().radius(2, k);
      for (std::uint32_t j = first; j < first + w.asset().muscles[2].section_vertices; ++j) {
        EXPECT_NEAR(w.world.get<CrossSections>(w.musculature).radii[j], w.collision().rest_radii[j], 1.0e-4f) << i;
      }
    }
  }
  EXPECT_GT(morph, 0.5f);
}

TEST(CollisionFrame, ChangesOfLevelAllocateNothing) {
  Leveled w(test::synthetic_levels({24, 1}, 2), body_bones(), test::rest_bones());
  for (const std::uint32_t level : {0u, 1u, 0u}) {  // once, for what is made at first
    w.look(level);
    for (int i = 0; i < 3; ++i) w.step();
  }
  for (const std::uint32_t level : {1u, 0u}) {
    w.look(level);
    const test::AllocationScope scope;
    for (int i = 0; i < 3; ++i) w.step();
    EXPECT_EQ(scope.allocations(), 0u) << level;
  }
}

TEST(CollisionFrame, LegacyModeAndBack) {
  Walkers w(1, 1);
  add_legacy_collision(w.world, w.musculatures[0], {});
  MuscleCollision& collision = w.world.get<MuscleCollision>(w.musculatures[0]);
  for (int frame = 0; frame < 60; ++frame) {
    if (frame == 20) collision.settings.mode = CollisionMode::kLegacy;
    if (frame == 40) collision.settings.mode = CollisionMode::kReduced;
    w.walk(frame);
    w.step();
    for (const SurfaceVertex& vertex : w.world.get<MuscleSurfaces>(w.musculatures[0]).vertices) {
      ASSERT_TRUE(std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z)) << frame;
    }
  }
  EXPECT_EQ(w.world.get<LegacyCollision>(w.musculatures[0]).steps, 20u);
}

TEST(CollisionFrame, CharactersWithTooFewBonesAreLeftAlone) {
  // A bone with a field that carries no muscle, and a character that does not have it.
  MuscleWorld w;
  const auto muscles = test::build_rods({{.from = {0, 0, -0.1f}, .to = {0, 0, 0.1f}}}, 3);
  test::BoneFields fields(3);
  fields[2] = test::sphere_bone(0.03f);
  const ecs::Entity character = w.add_character(std::vector<glm::mat4>(1, glm::mat4(1.0f)));
  const ecs::Entity musculature = spawn_musculature(w.world, character, muscles);
  add_collision(w.world, musculature, std::vector{test::build_collision(muscles, fields)}, CollisionSettings{});
  w.step();
  EXPECT_TRUE(w.world.get<MuscleContacts>(musculature).now.empty());
  EXPECT_EQ(w.world.get<CrossSections>(musculature).radii, muscles->rest_radii);
}

}  // namespace
}  // namespace fascicle::muscle
