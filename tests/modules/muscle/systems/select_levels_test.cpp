// The system that chooses levels: by size alone, continuous, and careful with what a switch must not lose.
#include "modules/muscle/systems/1_drive/select_levels.hpp"

#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/ecs/world.hpp"
#include "engine/math/state_hash.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// A world whose viewer stands so far from the first character's anchor, m, that a pixel is 1 mm at a metre.
struct LeveledWorld : MuscleWorld {
  std::shared_ptr<const MuscleLevels> levels;
  ecs::Entity watched = ecs::kNoEntity;

  explicit LeveledWorld(std::shared_ptr<const MuscleLevels> chain, int workers = 1, const MuscleSettings& settings = {})
      : MuscleWorld(workers, settings), levels(std::move(chain)) {}

  ecs::Entity spawn(ecs::Entity character) {
    if (!world.alive(watched)) watched = character;
    return spawn_musculature(world, character, levels);
  }
  void look_from(float distance) {
    const std::vector<glm::mat4>& bones = world.get<BoneMatrices>(watched).world;
    glm::vec3 anchor(0.0f);
    for (const auto& [bone, p] : {std::pair(levels->anchor.first_bone, levels->anchor.first),
                                  std::pair(levels->anchor.second_bone, levels->anchor.second)}) {
      anchor += glm::vec3(bones[bone] * glm::vec4(p[0], p[1], p[2], p[3]));
    }
    world.set_resource(Viewer{.enabled = true, .eye = anchor + glm::vec3(0.0f, 0.0f, distance),
                              .pixels_per_radian = 1000.0f});
  }
  // A step that announces a level's change, and the one that makes it.
  void settle() {
    step();
    step();
  }
  const MuscleDetail& detail(ecs::Entity muscles) { return world.get<MuscleDetail>(muscles); }
  float morph(ecs::Entity muscles) { return world.get<Musculature>(muscles).morph; }
};

// m from the eye at which a level's morph is at `way`.
float distance_of(const MuscleLevels& levels, std::uint32_t level, float way) {
  const float complete = levels.morphs[level].complete, begin = complete / kMorphBand;
  return 1000.0f * (begin + way * (complete - begin)) + levels.radius;
}

TEST(ChooseLevel, SizesThatAreNoNumbersChooseTheFinest) {
  const auto levels = test::synthetic_levels({24, 1}, 2);
  for (const float size : {kNaN, -1.0f, -std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(choose_level(*levels, size, 1.0f).level, 0u);
    EXPECT_EQ(choose_level(*levels, size, 1.0f).morph, 0.0f);
  }
  EXPECT_EQ(choose_level(*levels, 1.0f, kNaN).level, 0u);
  const LevelChoice far = choose_level(*levels, std::numeric_limits<float>::infinity(), 1.0f);
  EXPECT_EQ(far.level, 1u);
  EXPECT_EQ(far.morph, 0.0f);
}

TEST(ChooseLevel, IsMonotoneAndContinuous) {
  const auto levels = test::synthetic_levels();
  float before = 0.0f;
  for (int i = 0; i <= 4000; ++i) {
    const float size = 1.2f * levels->morphs[1].complete * static_cast<float>(i) / 4000.0f;
    const LevelChoice choice = choose_level(*levels, size, 1.0f);
    const float now = static_cast<float>(choice.level) + choice.morph;
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 0.01f);
    EXPECT_LT(choice.morph, 1.0f);
    before = now;
  }
  EXPECT_EQ(before, 2.0f);
  // Twice the tolerance, half the distance.
  EXPECT_NEAR(choose_level(*levels, 0.9f * levels->morphs[0].complete, 1.0f).morph,
              choose_level(*levels, 0.45f * levels->morphs[0].complete, 2.0f).morph, 1.0e-5f);
}

TEST(SelectLevels, NobodyLookingOrOneLevelChangesNothing) {
  const auto levels = test::synthetic_levels();
  MuscleWorld plain;
  LeveledWorld unwatched(levels), single(test::synthetic_levels({36, 3}, 1));
  const std::vector<glm::mat4> rest = test::rest_bones();
  const ecs::Entity characters[] = {plain.add_character(rest), unwatched.add_character(rest),
                                    single.add_character(rest)};
  spawn_musculature(plain.world, characters[0], levels->assets.front());
  unwatched.spawn(characters[1]);
  single.spawn(characters[2]);
  single.look_from(1000.0f);
  for (int frame = 0; frame < 8; ++frame) {
    const std::vector<glm::mat4> bones = test::walk_bones(0.1f * static_cast<float>(frame));
    plain.pose(characters[0], bones);
    unwatched.pose(characters[1], bones);
    single.pose(characters[2], bones);
    plain.step();
    unwatched.step();
    single.step();
    EXPECT_EQ(hash_state(unwatched.world), hash_state(plain.world));
    EXPECT_EQ(hash_state(single.world), hash_state(plain.world));
  }
}

// What is drawn, and the twist.
std::uint64_t bits_of(const ecs::World& world, ecs::Entity muscles) {
  StateHash hash;
  hash.add(std::span<const SurfaceVertex>(world.get<MuscleSurfaces>(muscles).vertices));
  hash.add(std::span<const SurfaceRow>(world.get<MuscleSurfaces>(muscles).rows));
  hash.add(std::span<const float>(world.get<CrossSections>(muscles).twist));
  return hash.value();
}

// A level comes back the way it went, and each is the same as that level's asset by itself.
TEST(SelectLevels, ALevelIsTheSameAsItsAssetAlone) {
  const auto levels = test::synthetic_levels();
  LeveledWorld w(levels);
  const ecs::Entity character = w.add_character(test::walk_bones(0.3f));
  const ecs::Entity muscles = w.spawn(character);
  const float far = 2.0f * distance_of(*levels, 1, 1.0f), middle = distance_of(*levels, 0, 1.0f) + 0.5f;
  const std::pair<float, std::uint32_t> places[] = {{1.0f, 0}, {middle, 1}, {far, 2}, {1.0f, 0}, {far, 2}, {middle, 1}};
  for (const auto& [distance, level] : places) {
    w.look_from(distance);
    w.settle();
    ASSERT_EQ(w.detail(muscles).level, level) << distance;
    ASSERT_EQ(w.morph(muscles), 0.0f);
    MuscleWorld alone;
    const ecs::Entity other =
        spawn_musculature(alone.world, alone.add_character(test::walk_bones(0.3f)), levels->assets[level]);
    alone.step();
    EXPECT_EQ(bits_of(w.world, muscles), bits_of(alone.world, other)) << level;
  }
  EXPECT_EQ(w.detail(muscles).switches, 5u);
  // And for a fixed level, or one beyond the coarsest.
  for (const std::uint32_t fixed : {2u, 7u}) {
    w.world.resource<Viewer>().level = fixed;
    w.settle();
    EXPECT_EQ(w.detail(muscles).level, 2u);
  }
  w.world.resource<Viewer>() = Viewer{};
  w.settle();
  EXPECT_EQ(w.detail(muscles).level, 0u);
}

// A step before the exchange the level that goes is drawn as what comes; who turns back in that step is not exchanged.
TEST(SelectLevels, AnExchangeIsAnnouncedByAStep) {
  const auto levels = test::synthetic_levels();
  LeveledWorld w(levels);
  const ecs::Entity muscles = w.spawn(w.add_character(test::rest_bones()));
  const auto expect = [&](std::uint32_t level, std::uint32_t next, float morph) {
    EXPECT_EQ(w.detail(muscles).level, level);
    EXPECT_EQ(w.detail(muscles).next, next);
    EXPECT_NEAR(w.morph(muscles), morph, 2.0e-3f);
  };
  const auto step_at = [&](std::uint32_t level, float way) {
    w.look_from(distance_of(*levels, level, way));
    w.step();
  };
  step_at(0, 0.9f);
  expect(0, 0, 0.9f);
  step_at(1, 0.1f);
  expect(0, 1, 1.0f);
  step_at(0, 0.8f);  // back again
  expect(0, 0, 0.8f);
  step_at(1, 0.1f);
  expect(0, 1, 1.0f);
  step_at(1, 0.2f);
  expect(1, 1, 0.2f);
  step_at(0, 0.95f);
  expect(1, 0, 0.0f);
  step_at(0, 0.9f);
  expect(0, 0, 0.9f);
  EXPECT_EQ(w.detail(muscles).switches, 2u);
  step_at(1, 1.1f);  // over level 1: at once
  expect(2, 2, 0.0f);
}

TEST(SelectLevels, MorphsWhatEachBandSays) {
  const auto levels = test::synthetic_levels();
  LeveledWorld w(levels);
  const ecs::Entity muscles = w.spawn(w.add_character(test::rest_bones()));
  for (std::uint32_t level = 0; level < 2; ++level) {
    for (const float way : {0.25f, 0.75f}) {
      w.look_from(distance_of(*levels, level, way));
      w.settle();
      EXPECT_EQ(w.detail(muscles).level, level);
      EXPECT_NEAR(w.morph(muscles), way, 1.0e-3f);
      const CrossSections& sections = w.world.get<CrossSections>(muscles);
      const MuscleAsset& now = *levels->assets[level];
      const std::uint32_t r = now.radius(20, 1) + 1;
      const float from = now.rest_radii[r], to = levels->morphs[level].radii[r];
      EXPECT_NE(from, to);
      EXPECT_FLOAT_EQ(sections.radii[r], from + w.morph(muscles) * (to - from));
    }
  }
}

// A muscle wound up by more than half a turn stays so, whichever lane its level gives it.
TEST(SelectLevels, TwistGoesWithItsMuscle) {
  std::vector<MuscleDescription> descriptions(2);
  descriptions[0].name = "plain";
  descriptions[1].name = "wound";
  for (MuscleDescription& muscle : descriptions) {
    muscle.volume = 1.0e-4f;
    muscle.section_vertices = 12;
  }
  // The shorter in sections at the fine level is as long as the other at the coarse one: their lanes change places.
  descriptions[0].attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.3f, 0.0f}, true}};
  descriptions[1].attachments = {{0, {0.1f, 0.0f, 0.0f}, true}, {1, {0.1f, -0.3f, 0.0f}, true}};
  descriptions[0].longitudinal_subdivision = 1;
  descriptions[1].longitudinal_subdivision = 2;
  const std::vector<glm::mat4> rest(2, glm::mat4(1.0f));
  const auto fine = build_muscle_asset(descriptions, rest);
  descriptions[1].longitudinal_subdivision = 1;
  const auto coarse = build_muscle_asset(descriptions, rest);
  ASSERT_TRUE(fine.ok() && coarse.ok());
  ASSERT_NE((*fine)->muscles[1].lane_index, (*coarse)->muscles[1].lane_index);
  const auto levels = make_muscle_levels(std::vector{*fine, *coarse});
  ASSERT_TRUE(levels.ok());

  LeveledWorld w(*levels);
  const ecs::Entity character = w.add_character(rest);
  const ecs::Entity muscles = w.spawn(character);
  w.world.resource<Viewer>() = {.enabled = true, .level = 0u};
  for (int degrees = 0; degrees <= 270; degrees += 30) {
    const glm::vec3 axis(0.0f, -1.0f, 0.0f), pivot(0.1f, 0.0f, 0.0f);
    const glm::mat4 turned = glm::translate(
        glm::rotate(glm::translate(glm::mat4(1.0f), pivot), glm::radians(static_cast<float>(degrees)), axis), -pivot);
    w.pose(character, {glm::mat4(1.0f), turned});
    w.settle();
  }
  const auto twist = [&](std::uint32_t m) {
    const MuscleAsset& asset = *w.world.get<Musculature>(muscles).asset;
    return w.world.get<CrossSections>(muscles).twist[asset.muscles[m].lane_index];
  };
  for (const std::uint32_t level : {0u, 1u, 0u, 1u}) {
    w.world.resource<Viewer>().level = level;
    w.settle();
    EXPECT_EQ(w.detail(muscles).level, level);
    EXPECT_NEAR(twist(0), 0.0f, 1.0e-4f);
    EXPECT_NEAR(twist(1), glm::radians(270.0f), 1.0e-3f);
  }
}

TEST(SelectLevels, DetachedMusclesStayDetachedAndMeasuresGoOn) {
  const auto levels = test::synthetic_levels();
  LeveledWorld w(levels);
  const ecs::Entity muscles = w.spawn(w.add_character(test::walk_bones(0.2f)));
  w.look_from(1.0f);
  w.settle();
  detach_muscle(w.world, muscle_entity(w.world, muscles, 5u));
  const std::vector<float> lengths = w.world.get<MuscleMeasures>(muscles).length;
  for (const float distance : {1.0e5f, 1.0f}) {
    w.look_from(distance);
    w.settle();
    const Musculature& musculature = w.world.get<Musculature>(muscles);
    const MuscleSurfaces& surfaces = w.world.get<MuscleSurfaces>(muscles);
    const glm::vec3 place = line_point(*musculature.asset, w.world.get<ActionLines>(muscles), 5, 0);
    for (const SurfaceVertex& vertex : surface_of(*musculature.asset, surfaces, 5).vertices) {
      ASSERT_EQ(vertex.position, place);
    }
    EXPECT_EQ(w.world.get<MuscleMeasures>(muscles).volume[5], 0.0f);
    for (std::uint32_t m = 0; m < 48; ++m) {  // the functional length sees no level
      EXPECT_NEAR(w.world.get<MuscleMeasures>(muscles).length[m], m == 5 ? 0.0f : lengths[m], 1.0e-6f);
    }
    // A muscle's view has the level's indices.
    const MuscleSurfaceView view = surface_of(w.world, muscle_entity(w.world, muscles, 7u));
    EXPECT_EQ(view.section_vertices, musculature.asset->muscles[7].section_vertices);
    for (const std::uint32_t index : view.strips) {
      if (index != kRestartIndex) {
        ASSERT_LT(index - view.first_vertex, view.vertices.size());
      }
    }
    for (const SurfaceRow& row : view.rows) EXPECT_EQ(row.muscle, 7u);
  }
}

// Nor does a muscle get weaker as its surface loses volume.
TEST(SelectLevels, VolumeIsThatOfTheFinestLevel) {
  const auto levels = test::synthetic_levels();
  const MuscleAsset& finest = *levels->assets.front();
  EXPECT_LT(levels->assets[2]->muscles[3].rest_volume, 0.9f * finest.muscles[3].rest_volume);
  LeveledWorld w(levels);
  const ecs::Entity muscles = w.spawn(w.add_character(test::rest_bones()));
  for (const std::uint32_t level : {0u, 1u, 2u}) {
    for (const float way : {0.0f, 0.5f}) {
      if (level == 2 && way > 0.0f) continue;
      w.look_from(level == 2 ? 1.0e4f : distance_of(*levels, level, way == 0.0f ? (level == 0 ? -0.1f : 0.0f) : way));
      w.settle();
      ASSERT_EQ(w.detail(muscles).level, level);
      const MuscleMeasures& measures = w.world.get<MuscleMeasures>(muscles);
      for (std::uint32_t m = 0; m < 48; ++m) {
        const float expected = finest.muscles[m].rest_volume;
        ASSERT_NEAR(measures.volume[m], expected, (way > 0.0f ? 0.02f : 1.0e-4f) * expected) << level << " " << m;
        ASSERT_FLOAT_EQ(measures.mass[m], measures.volume[m] * kMuscleDensity);
      }
    }
  }
}

TEST(SelectLevels, HeldCharactersKeepTheirLevel) {
  const auto levels = test::synthetic_levels();
  LeveledWorld w(levels);
  const ecs::Entity character = w.add_character(test::walk_bones(0.2f));
  const ecs::Entity muscles = w.spawn(character);
  w.look_from(distance_of(*levels, 0, 0.5f));
  w.step();
  const float morph = w.morph(muscles);
  EXPECT_GT(morph, 0.0f);
  std::vector<glm::mat4> broken = test::walk_bones(0.25f);
  broken[test::kFootLeft][3].y = kNaN;
  w.pose(character, broken);
  for (const float distance : {1.0e5f, 0.5f, kNaN}) {
    w.look_from(distance);
    w.step();
    EXPECT_EQ(w.detail(muscles).level, 0u);
    EXPECT_EQ(w.morph(muscles), morph);
    for (const SurfaceVertex& vertex : w.world.get<MuscleSurfaces>(muscles).vertices) {
      ASSERT_TRUE(std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z));
    }
  }
  w.look_from(1.0e5f);
  w.pose(character, test::walk_bones(0.3f));
  w.settle();
  EXPECT_EQ(w.detail(muscles).level, 2u);
  // No bones at all.
  w.look_from(0.5f);
  w.world.remove<BoneMatrices>(character);
  w.step();
  EXPECT_EQ(w.detail(muscles).level, 2u);
}

// Walkers at all distances, moving through all levels: hashes of each frame.
std::vector<std::uint64_t> run_walkers(int workers, const MuscleSettings& settings, bool costs) {
  LeveledWorld w(test::synthetic_levels({24, 2}, 3), workers, settings);
  std::vector<ecs::Entity> characters;
  for (int i = 0; i < 9; ++i) {
    characters.push_back(w.add_character(test::rest_bones()));
    list_costs(w.world, w.spawn(characters.back()), "walker");
  }
  w.world.resource<CostLedger>().set_enabled(costs);
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame < 16; ++frame) {
    for (std::size_t i = 0; i < characters.size(); ++i) {
      const glm::vec3 start(0.0f, 0.95f, -2.0f * static_cast<float>(i));
      w.pose(characters[i], test::walk_bones(0.05f * static_cast<float>(frame), start));
    }
    w.look_from(static_cast<float>(frame % 11));
    const test::AllocationScope scope;
    w.step();
    if (frame >= 11) {  // every level has been everywhere
      EXPECT_EQ(scope.allocations(), 0u) << "frame " << frame;
    }
    w.world.resource<CostLedger>().end_frame();
    hashes.push_back(hash_state(w.world));
  }
  std::uint64_t switches = 0;
  w.world.view<const MuscleDetail>().each([&](const MuscleDetail& detail) { switches += detail.switches; });
  EXPECT_GT(switches, 9u);
  return hashes;
}

TEST(SelectLevels, StateIsTheSameForAnyWorkersAndInstructionSetAndNothingIsAllocated) {
  MuscleSettings settings;
  settings.simd = SimdLevel::kPortable;
  const std::vector<std::uint64_t> expected = run_walkers(1, settings, false);
  for (const int workers : {1, 2, 3}) {
    for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
      if (level > detect_simd()) continue;
      settings.simd = level;
      EXPECT_EQ(run_walkers(workers, settings, workers == 3), expected) << workers << " " << to_string(level);
    }
  }
}

// Even the first switch finds its arrays large enough.
TEST(SelectLevels, TheFirstSwitchAllocatesNothing) {
  LeveledWorld w(test::synthetic_levels());
  w.spawn(w.add_character(test::rest_bones()));
  w.step();
  for (const float distance : {1.0e5f, 1.0f}) {
    w.look_from(distance);
    const test::AllocationScope scope;
    w.step();
    EXPECT_EQ(scope.allocations(), 0u);
  }
}

}  // namespace
}  // namespace fascicle::muscle
