// The solve as a whole, on rods: what is pressed gives way and comes back, keeps its area, and stays finite.
#include "modules/muscle/systems/4_solve/solve_muscles.hpp"

#include <limits>

#include "modules/muscle/components/muscle_measures.hpp"
#include "tests/modules/muscle/systems/collision_world.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kRadius = 0.02f;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

CollisionDescription with(const CollisionSettings& settings) {
  CollisionDescription description;
  description.settings = settings;
  return description;
}

TEST(SolveMuscles, NothingTouchedStaysAtRest) {
  RodWorld w({rod_along_z()}, ground());
  w.steps(30);
  EXPECT_LT(w.deformation(), 1.0e-6f);
  EXPECT_TRUE(w.contacts().now.empty());
  EXPECT_EQ(w.collision().fallbacks, 0u);
}

TEST(SolveMuscles, PressedSectionKeepsItsAreaAndFreeRadiiTheirRatios) {
  // Thesis 4.2.1. Without smoothing nothing else works on the free radii.
  CollisionSettings settings;
  settings.smoothing = 0.0f;
  RodWorld w({rod_along_z()}, ground(), with(settings));
  w.bring_bone(1, {0, 0.016f, 0});
  for (int round = 0; round < 3; ++round) {
    w.steps(20);
    float least = 1.0f;
    for (std::uint32_t k = 1; k + 1 < w.muscles->muscles[0].section_count; ++k) {
      const std::span<const float> radii = w.radii(0, k);
      const float rest = section_area(std::span(w.muscles->rest_radii).subspan(w.muscles->radius(0, k), radii.size()));
      EXPECT_NEAR(section_area(radii) / rest, 1.0f, 1.0e-4f) << k;
      float low = 1.0e3f, high = 0.0f;
      for (std::uint32_t i = 0; i < radii.size(); ++i) {
        const float ratio = radii[i] / w.rest_radius(0, k, i);
        least = std::min(least, ratio);
        if (w.direction(0, k, i).y < 0.3f) continue;  // the upper ones are free
        low = std::min(low, ratio);
        high = std::max(high, ratio);
      }
      EXPECT_GE(low, 1.0f) << k;
      EXPECT_NEAR(high / low, 1.0f, 1.0e-3f) << k;
    }
    EXPECT_LT(least, 0.97f);  // the lower ones are pressed
  }
}

TEST(SolveMuscles, BonesKeepMusclesOut) {
  for (const float depth : {0.002f, 0.006f, 0.012f}) {
    RodWorld w({rod_along_z()}, ground());
    w.bring_bone(1, {0, 0.010f + depth, 0});
    w.steps(40);
    EXPECT_LT(w.deepest(), 3.0e-4f) << depth;
    EXPECT_GT(w.deformation(), 0.3f * depth);
  }
}

TEST(SolveMuscles, PressedMuscleComesBackInHalfASecond) {
  RodWorld w({rod_along_z()}, ground());
  w.bring_bone(1, {0, 0.016f, 0});
  w.steps(60);
  ASSERT_GT(w.deformation(), 0.001f);
  w.place_bone(1, glm::mat4(1.0f));
  w.steps(30);
  EXPECT_LT(w.deformation(), 0.01f * kRadius);
}

TEST(SolveMuscles, RestingLongDoesNotHoldAMuscleBack) {
  // The solve goes to rest with the pose; a bone that goes away wakes it up, however slowly.
  RodWorld w({rod_along_z()}, ground());
  w.bring_bone(1, {0, 0.016f, 0});
  w.steps(200);
  const float pressed = w.deformation();
  w.bring_bone(1, {0, 0, 0}, 600);
  w.steps(10);
  EXPECT_LT(w.deformation(), 0.05f * pressed);
}

TEST(SolveMuscles, CrossingRodsAreMovedApart) {
  for (const float overlap : {0.003f, 0.008f}) {
    RodWorld w(crossing_rods(), {nullptr, nullptr});
    w.bring_bone(1, {0, -0.010f - overlap, 0});
    w.steps(60);
    EXPECT_LT(w.deepest(), 1.0e-4f) << overlap;
    // Both give way, the lower one downwards.
    EXPECT_LT(w.centre(0, 4).y, -1.0e-4f);
    EXPECT_GT(w.centre(1, 4).y, 0.04f - overlap + 1.0e-4f);
    for (std::uint32_t m = 0; m < 2; ++m) {
      const std::uint32_t last = w.muscles->muscles[m].section_count - 1;
      const glm::vec3 by = m == 0 ? glm::vec3(0.0f) : glm::vec3(0, -0.010f - overlap, 0);
      EXPECT_EQ(w.centre(m, 0), w.rest_centre(m, 0) + by);  // attachments never move
      EXPECT_EQ(w.centre(m, last), w.rest_centre(m, last) + by);
      for (const std::uint32_t k : {0u, last}) {
        for (std::uint32_t i = 0; i < w.radii(m, k).size(); ++i) EXPECT_EQ(w.radii(m, k)[i], w.rest_radius(m, k, i));
      }
    }
  }
}

TEST(SolveMuscles, ParallelRodsShareTheGap) {
  RodWorld w({{.from = {0, 0, -0.1f}, .to = {0, 0, 0.1f}},
              {.from = {0.05f, 0, -0.1f}, .to = {0.05f, 0, 0.1f}, .from_bone = 1, .to_bone = 1}}, {nullptr, nullptr});
  w.bring_bone(1, {-0.014f, 0, 0});
  w.steps(60);
  EXPECT_LT(w.deepest(), 3.0e-4f);
  // The scene is the same from both sides.
  EXPECT_NEAR(w.centre(0, 4).x, -(w.centre(1, 4).x - 0.036f), 3.0e-4f);
}

TEST(SolveMuscles, BellyKeepsItsVolumeAsItsLengthChanges) {
  for (const bool keep : {true, false}) {
    for (const float stretch : {0.8f, 1.0f, 1.25f}) {
      CollisionSettings settings;
      settings.keep_volume = keep;
      test::Rod rod = rod_along_z();
      rod.to_bone = 1;
      RodWorld w({rod}, {nullptr, nullptr}, with(settings));
      w.step();
      const float volume = w.world.get<MuscleMeasures>(w.musculature).volume[0];
      w.bring_bone(1, {0, 0, (stretch - 1.0f) * 0.2f});
      w.steps(60);
      // The ends, which are attached, keep their areas: a quarter of the rod takes half a part in it.
      EXPECT_NEAR(w.world.get<MuscleMeasures>(w.musculature).volume[0] / volume, keep ? 1.0f : stretch, 0.04f);
      for (std::uint32_t k = 1; k < 8; ++k) {
        const float rest = section_area(std::span(w.muscles->rest_radii).subspan(w.muscles->radius(0, k), 16));
        EXPECT_NEAR(section_area(w.radii(0, k)) / rest, keep ? 1.0f / stretch : 1.0f, 2.0e-4f) << stretch;
      }
    }
  }
}

TEST(SolveMuscles, AnyAccuracyGivesNearlyTheSameRest) {
  CollisionSettings fine;
  fine.substeps = 16;
  fine.iterations = 16;
  RodWorld reference(crossing_rods(), {nullptr, nullptr}, with(fine));
  reference.bring_bone(1, {0, -0.016f, 0});
  reference.steps(90);
  for (const std::uint32_t substeps : {1u, 2u, 4u, 32u}) {
    for (const std::uint32_t iterations : {2u, 3u, 10u}) {
      CollisionSettings settings;
      settings.substeps = substeps;
      settings.iterations = iterations;
      RodWorld w(crossing_rods(), {nullptr, nullptr}, with(settings));
      w.bring_bone(1, {0, -0.016f, 0});
      w.steps(90);
      EXPECT_LT(w.deepest(), 5.0e-4f) << substeps << " " << iterations;
      for (std::uint32_t m = 0; m < 2; ++m) {
        for (std::uint32_t k = 0; k < 9; ++k) {
          EXPECT_LT(glm::distance(w.centre(m, k), reference.centre(m, k)), 0.001f)
              << substeps << " " << iterations << ", rod " << m << " section " << k;
        }
      }
    }
  }
}

TEST(SolveMuscles, ExtremeSettingsStayFinite) {
  std::vector<CollisionSettings> extremes(7);
  extremes[0].substeps = extremes[0].iterations = 1;
  extremes[1].substeps = 32;
  extremes[1].iterations = 64;
  extremes[2].shape_time = extremes[2].line_time = extremes[2].via_time = 0.0f;
  extremes[3].shape_time = extremes[3].line_time = extremes[3].via_time = 1.0e6f;
  extremes[4].smoothing = 1.0f;
  extremes[5].bone_margin = extremes[5].muscle_margin = 0.02f;
  extremes[6].sample_spacing = 0.001f;
  for (std::size_t i = 0; i < extremes.size(); ++i) {
    test::BoneFields fields = ground();
    fields.push_back(nullptr);
    std::vector<test::Rod> rods = crossing_rods();
    rods[1].from_bone = rods[1].to_bone = 2;
    RodWorld w(rods, fields, with(extremes[i]));
    w.bring_bone(1, {0, 0.014f, 0});
    w.bring_bone(2, {0, -0.016f, 0});
    w.steps(30);
    EXPECT_TRUE(w.finite()) << i;
    EXPECT_LT(w.deformation(), 0.06f) << i;
  }
}

TEST(SolveMuscles, StepOfNoTimeIsHarmless) {
  RodWorld w({rod_along_z()}, ground());
  w.bring_bone(1, {0, 0.016f, 0});
  const float pressed = w.deformation();
  w.world.resource<FrameTime>().step = 0.0f;
  w.place_bone(1, glm::mat4(1.0f));  // away: the centres have no time to come back
  w.steps(5);
  EXPECT_TRUE(w.finite());
  EXPECT_LE(w.deformation(), 1.1f * pressed);
  EXPECT_GT(w.centre(0, 4).y, 0.0005f);
  w.place_bone(1, glm::translate(glm::mat4(1.0f), {0, 0.014f, 0}));
  w.steps(5);
  EXPECT_TRUE(w.finite());
}

TEST(SolveMuscles, TwoSectionsAreLeftAlone) {
  test::Rod rod = rod_along_z();
  rod.subdivision = 0;
  RodWorld w({rod, crossing_rods()[0]}, ground());
  w.bring_bone(1, {0, 0.016f, 0});
  EXPECT_TRUE(w.finite());
  EXPECT_EQ(w.centre(0, 0), w.rest_centre(0, 0));
  EXPECT_EQ(w.centre(0, 1), w.rest_centre(0, 1));
  for (std::uint32_t i = 0; i < 16; ++i) EXPECT_EQ(w.radii(0, 1)[i], w.rest_radius(0, 1, i));
}

TEST(SolveMuscles, MirroredSceneGivesTheMirroredResult) {
  const auto run = [](float side) {
    // A rod that leans on a sphere off its middle, and a thinner one on top.
    std::vector<test::Rod> rods = {{.from = {0.01f * side, 0, -0.1f}, .to = {-0.01f * side, 0.01f, 0.1f}},
                                   {.from = {-0.09f * side, 0.035f, 0.01f}, .to = {0.11f * side, 0.045f, 0.03f},
                                    .radius = 0.012f}};
    return std::make_unique<RodWorld>(rods, test::BoneFields{nullptr, test::sphere_bone(0.03f)});
  };
  const auto left = run(1.0f), right = run(-1.0f);
  for (int i = 0; i <= 40; ++i) {
    const float way = static_cast<float>(i) / 40.0f;
    left->place_bone(1, glm::translate(glm::mat4(1.0f), {0.012f, -0.2f + 0.165f * way, 0.02f}));
    right->place_bone(1, glm::translate(glm::mat4(1.0f), {-0.012f, -0.2f + 0.165f * way, 0.02f}));
    left->step();
    right->step();
  }
  left->steps(60);
  right->steps(60);
  EXPECT_GT(left->deformation(), 0.002f);
  for (std::uint32_t m = 0; m < 2; ++m) {
    for (std::uint32_t k = 0; k < 9; ++k) {
      const glm::vec3 a = left->centre(m, k), b = right->centre(m, k);
      EXPECT_LT(glm::distance(a, glm::vec3(-b.x, b.y, b.z)), 3.0e-4f) << m << " " << k;
    }
  }
}

TEST(SolveMuscles, RigidMotionChangesNoDeformation) {
  RodWorld still(crossing_rods(), {nullptr, nullptr}), moving(crossing_rods(), {nullptr, nullptr});
  for (int i = 0; i <= 60; ++i) {
    const float way = std::min(1.0f, 0.05f * static_cast<float>(i));
    const glm::mat4 upper = glm::translate(glm::mat4(1.0f), {0, -0.016f * way, 0});
    still.place_bone(1, upper);
    // Turning, and far away all at once in the middle.
    const glm::vec3 place = i < 30 ? glm::vec3(0.1f * static_cast<float>(i), 0, 0) : glm::vec3(40, -30, 20);
    const glm::mat4 motion = glm::rotate(glm::translate(glm::mat4(1.0f), place), 0.1f * static_cast<float>(i),
                                         glm::normalize(glm::vec3(1, 2, -1)));
    moving.bones = {motion, motion * upper};
    moving.pose(moving.character, moving.bones);
    still.step();
    moving.step();
    for (std::uint32_t m = 0; m < 2; ++m) {
      for (std::uint32_t k = 0; k < 9; ++k) {
        const glm::vec3 expected = motion * glm::vec4(still.centre(m, k), 1.0f);
        ASSERT_LT(glm::distance(moving.centre(m, k), expected), 2.0e-4f) << "frame " << i;
      }
    }
  }
  EXPECT_GT(moving.deformation(), 0.001f);
}

TEST(SolveMuscles, BonesWithoutNumbersHoldAndThenItGoesOn) {
  for (const float bad : {kNaN, kInf}) {
    for (const std::size_t bone : {0u, 1u}) {
      RodWorld w(crossing_rods(), ground());
      const glm::mat4 good = w.bones[bone];
      for (int round = 0; round < 2; ++round) {  // from the first step on, and later
        glm::mat4 broken = good;
        broken[3].y = broken[0].x = bad;
        w.place_bone(bone, broken);
        w.steps(3);
        EXPECT_TRUE(w.finite());
        w.place_bone(bone, good);
        w.steps(60);
        EXPECT_TRUE(w.finite());
        EXPECT_LT(w.deformation(), 1.0e-4f);
      }
      // Still alive: the upper rod comes down with bone 1, whose own surface comes down too.
      w.bring_bone(1, {0, -0.016f, 0});
      w.steps(30);
      EXPECT_LT(w.deepest(), 5.0e-4f) << "bone " << bone << ", " << bad;
      EXPECT_GT(w.deformation(), 0.0005f);
    }
  }
}

TEST(SolveMuscles, StateWithoutNumbersFallsBackAndRecovers) {
  for (const float bad : {kNaN, kInf, -kInf, 1.0e30f, -1.0e30f}) {
    for (const bool centre : {true, false}) {
      RodWorld w(crossing_rods(), {nullptr, nullptr});
      w.bring_bone(1, {0, -0.016f, 0});
      MuscleCollision& collision = w.collision();
      ASSERT_EQ(collision.fallbacks, 0u);
      if (centre) collision.offset_y[w.muscles->slot(0, 4)] = bad;
      else collision.radii[w.muscles->radius(0, 4) + 3] = bad;
      w.step();
      EXPECT_TRUE(w.finite()) << bad;
      w.steps(60);
      EXPECT_TRUE(w.finite()) << bad;
      EXPECT_LT(w.deepest(), 3.0e-4f) << bad;
      if (!(std::isfinite(bad) && !centre)) {  // a radius that is only too large is clamped
        EXPECT_GT(collision.fallbacks, 0u) << bad;
      }
      EXPECT_LT(collision.fallbacks, 10u) << bad;
    }
  }
}

TEST(SolveMuscles, FallingBackWakesASolveThatHasGoneToRest) {
  RodWorld w(crossing_rods(), {nullptr, nullptr});
  w.bring_bone(1, {0, -0.016f, 0});
  w.steps(200);
  w.collision().radii[w.muscles->radius(0, 4)] = kNaN;
  w.steps(60);
  EXPECT_GT(w.collision().fallbacks, 0u);
  EXPECT_TRUE(w.finite());
  EXPECT_LT(w.deepest(), 3.0e-4f);
}

TEST(SolveMuscles, TurnedOffAndOnAgain) {
  RodWorld w(crossing_rods(), {nullptr, nullptr});
  w.bring_bone(1, {0, -0.016f, 0});
  w.steps(120);  // the solve has gone to rest
  EXPECT_FALSE(w.contacts().now.empty());
  w.collision().settings.enabled = false;
  w.step();
  for (std::uint32_t k = 0; k < 9; ++k) {
    EXPECT_EQ(w.centre(0, k), w.rest_centre(0, k));
    for (std::uint32_t i = 0; i < 16; ++i) EXPECT_EQ(w.radii(0, k)[i], w.rest_radius(0, k, i));
  }
  w.steps(2);
  EXPECT_TRUE(w.contacts().now.empty());
  EXPECT_TRUE(w.contacts().began.empty());
  EXPECT_TRUE(w.contacts().ended.empty());
  w.collision().settings.enabled = true;
  w.steps(60);  // the pose has not changed since
  EXPECT_LT(w.deepest(), 3.0e-4f);
  EXPECT_FALSE(w.contacts().now.empty());
}

TEST(SolveMuscles, DetachedMuscleGivesWay) {
  RodWorld w(crossing_rods(), {nullptr, nullptr});
  w.bring_bone(1, {0, -0.016f, 0});
  w.steps(120);
  ASSERT_FALSE(w.contacts().now.empty());
  detach_muscle(w.world, muscle_entity(w.world, w.musculature, 1u));
  w.steps(90);
  EXPECT_TRUE(w.finite());
  EXPECT_TRUE(w.contacts().now.empty());
  for (std::uint32_t k = 0; k < 9; ++k) {
    EXPECT_LT(glm::distance(w.centre(0, k), w.rest_centre(0, k)), 3.0e-4f) << "nothing presses it any more";
  }
}

TEST(SolveMuscles, BonesKeepMusclesOutWithAnyNumberOfSubsteps) {
  // Pressed so far that centres have to go.
  for (const std::uint32_t substeps : {2u, 4u, 16u}) {
    CollisionSettings settings;
    settings.substeps = substeps;
    RodWorld w({rod_along_z()}, {nullptr, test::sphere_bone(0.03f)}, with(settings));
    w.place_bone(1, glm::translate(glm::mat4(1.0f), {0, -0.055f, 0}));
    w.steps(2);
    w.bring_bone(1, {0, -0.027f, 0}, 60);
    w.steps(60);
    EXPECT_LT(w.deepest(), 1.0e-3f) << substeps << " substeps";
    EXPECT_EQ(w.collision().fallbacks, 0u);
  }
}

TEST(SolveMuscles, NewSettingsCountInAStillPoseToo) {
  RodWorld w({rod_along_z()}, ground());
  w.bring_bone(1, {0, 0.012f, 0});
  w.steps(120);
  w.collision().settings.bone_margin = 0.004f;
  w.steps(40);
  float lowest = 1.0f;
  for (std::uint32_t i = 0; i < 16; ++i) {
    lowest = std::min(lowest, w.centre(0, 4).y + w.radii(0, 4)[i] * w.direction(0, 4, i).y);
  }
  EXPECT_GT(lowest, -0.030f + 0.012f + 0.0035f);
}

TEST(SolveMuscles, TurningItOffEndsWhatTouched) {
  RodWorld w(crossing_rods(), {nullptr, nullptr});
  w.bring_bone(1, {0, -0.016f, 0});
  ASSERT_EQ(w.contacts().now.size(), 1u);
  w.collision().settings.enabled = false;
  w.step();
  EXPECT_TRUE(w.contacts().now.empty());
  ASSERT_EQ(w.contacts().ended.size(), 1u);
  EXPECT_EQ(w.contacts().ended[0].other, 1u);
  EXPECT_EQ(w.collision().contact_count, 0u);
}

TEST(SolveMuscles, AnimalsOfAnySizeAreMovedApart) {
  // A mouse, a person, a horse; each at its own size's spacing.
  for (const float scale : {0.05f, 1.0f, 2.5f}) {
    CollisionSettings settings;
    settings.sample_spacing *= scale;
    std::vector<test::Rod> rods = crossing_rods();
    for (test::Rod& rod : rods) {
      rod.from *= scale;
      rod.to *= scale;
      rod.radius *= scale;
    }
    RodWorld w(rods, {nullptr, nullptr}, with(settings));
    w.bring_bone(1, scale * glm::vec3(0, -0.013f, 0), 60);
    w.steps(200);
    EXPECT_TRUE(w.finite());
    EXPECT_EQ(w.collision().fallbacks, 0u) << scale;
    EXPECT_LT(w.deepest(), scale * 3.0e-4f) << scale;
    EXPECT_LT(w.deformation(), scale * 0.012f) << scale;
    w.bring_bone(1, {0, 0, 0}, 60);
    w.steps(60);
    EXPECT_LT(w.deformation(), scale * 3.0e-4f) << scale;
  }
}

TEST(SolveMuscles, TeleportIntoABoneEndsOutOfIt) {
  // All at once 12 mm deep, as after a jump in time.
  RodWorld w({rod_along_z()}, ground());
  w.steps(3);
  w.place_bone(1, glm::translate(glm::mat4(1.0f), {0, 0.022f, 0}));
  w.steps(60);
  EXPECT_TRUE(w.finite());
  EXPECT_LT(w.deepest(), 5.0e-4f);
}

}  // namespace
}  // namespace fascicle::muscle
