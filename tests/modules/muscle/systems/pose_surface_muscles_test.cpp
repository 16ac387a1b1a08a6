// Surface muscles that their coarse hull poses: within a frame, beside dynamics, blended where one follows the other.
#include "modules/muscle/systems/4_solve/pose_surface_muscles.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "modules/muscle/kernels/hull/blend_surface.hpp"
#include "tests/modules/muscle/systems/hull_world.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/analytic_bones.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

glm::mat4 at(const glm::vec3& place) { return glm::translate(glm::mat4(1.0f), place); }

// Of the upper bone: `t` 0 at rest, 1 bent and pulled.
glm::mat4 bent(float t) {
  return glm::rotate(at({0.01f * t, 0.0f, 0.015f * t}), 0.6f * t, glm::normalize(glm::vec3(0.3f, 1.0f, 0.2f)));
}

void set_time(HullWorld& w, float step) { w.world.resource<FrameTime>().step = step; }

float fastest(HullWorld& w) {
  float speed = 0.0f;
  for (const SurfacePoint& v : w.state().velocity) speed = std::max(speed, std::hypot(v.x, v.y, v.z));
  return speed;
}

TEST(AddHull, WhatDoesNotFitIsRefused) {
  HullWorld w(still_bones(2));
  const SurfaceMuscleDescription description = ball_with_line();
  const ecs::Entity muscle = w.add(description);
  const auto hull = build_hull(w.asset(), description);
  add_hull(w.world, muscle, nullptr);
  add_hull(w.world, w.character, hull);  // no muscle
  add_hull(w.world, ecs::kNoEntity, hull);
  auto other = std::make_shared<HullAsset>(*hull);
  other->weights = make_dense_rows(w.asset().vertex_count + 1, 8);
  add_hull(w.world, muscle, other);
  other = std::make_shared<HullAsset>(*hull);
  other->line[0].bone = 2;
  add_hull(w.world, muscle, other);
  other->line[0] = {.rest = {}, .bone = -1, .carrier = 1000};
  add_hull(w.world, muscle, other);
  EXPECT_FALSE(w.world.has<SurfaceHull>(muscle));
  EXPECT_FALSE(w.world.has<SurfaceHull>(w.character));
  EXPECT_FALSE(pose_now(w.world, muscle));
  EXPECT_FALSE(pose_now(w.world, ecs::kNoEntity));
  add_hull(w.world, muscle, hull);
  EXPECT_TRUE(w.world.has<SurfaceHull>(muscle));
  despawn_surface_muscle(w.world, muscle);
  w.steps(1);
}

TEST(PoseSurfaceMuscles, WithoutSoundBonesItStaysAsItIs) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line());
  w.bones = still_bones(1);  // too few
  w.steps(2);
  EXPECT_FALSE(w.state().started);
  EXPECT_FALSE(pose_now(w.world, w.muscles[0]));
  w.bones = {glm::mat4(1.0f), bent(1.0f)};
  w.steps(1);
  const auto posed = w.points();
  EXPECT_GT(w.rest_distance(), 0.005f);
  for (const float bad : {kNaN, std::numeric_limits<float>::infinity()}) {
    for (const std::size_t bone : {std::size_t{0}, std::size_t{1}}) {
      w.bones = still_bones(2);
      w.bones[bone][3].y = bad;
      w.steps(1);
      EXPECT_EQ(w.points(), posed);
      EXPECT_FALSE(pose_now(w.world, w.muscles[0]));
    }
  }
  w.bones = still_bones(2);
  w.bones[0] = glm::mat4(0.0f);  // the frame's bone, without a size
  w.steps(1);
  EXPECT_EQ(w.points(), posed);
  // Without a character, too; and all is well as soon as bones are.
  w.bones = still_bones(2);
  w.steps(1);
  EXPECT_LT(w.rest_distance(), 1e-5f);
  EXPECT_EQ(w.state().fallbacks, 0u);
  w.world.destroy(w.character);
  w.step();
  EXPECT_LT(w.rest_distance(), 1e-5f);
}

// Dynamics hold their shape as well where a bone's matrix is none.
TEST(SolveSurfaceMuscles, BonesThatAreNoMatricesHoldTheShape) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.bones[1] = bent(0.3f);
  w.steps(5);
  const std::uint64_t before = hash_surface_state(w.world);
  w.bones[1][2].z = kNaN;
  w.steps(3);
  EXPECT_EQ(hash_surface_state(w.world), before);
  w.bones[1] = bent(0.3f);
  w.steps(1);
  EXPECT_TRUE(std::isfinite(w.rest_distance()));
  EXPECT_EQ(w.state().fallbacks, 0u);
}

TEST(PoseSurfaceMuscles, AtRestItIsItsRestShape) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line());
  w.steps(5);
  EXPECT_LT(w.rest_distance(), 1e-6f);
  EXPECT_EQ(w.hull().switches, 0u);
  EXPECT_EQ(w.state().fallbacks, 0u);
  EXPECT_EQ(fastest(w), 0.0f);
}

TEST(PoseSurfaceMuscles, AttachedVerticesAndTheLineGoWithTheirBones) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line());
  const glm::mat4 place = glm::rotate(at({3.0f, 1.0f, -2.0f}), 2.1f, glm::vec3(0.6f, 0.0f, 0.8f));
  w.bones = {place, place * bent(1.0f)};
  w.steps(1);
  for (const AttachedVertex& attached : w.asset().attached) {
    const glm::mat4& bone = w.bones[static_cast<std::size_t>(w.asset().attachments[attached.attachment].bone)];
    const glm::vec3 want(bone * glm::vec4(w.rest_point(attached.vertex), 1.0f));
    EXPECT_LT(glm::distance(w.world_point(attached.vertex), want), 1e-5f);
  }
  ASSERT_EQ(w.hull().line.size(), 2u);
  EXPECT_LT(glm::distance(w.hull().line[0], {0.0f, 0.0f, -0.05f}), 1e-6f);
  EXPECT_LT(glm::distance(w.hull().line[1], glm::vec3(bent(1.0f) * glm::vec4(0.0f, 0.0f, 0.05f, 1.0f))), 1e-5f);
}

// Whatever came before: other poses, dynamics, a step of no length, a jump.
TEST(PoseSurfaceMuscles, ThePoseAloneMakesTheShape) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line());
  w.hull().blend_time = 0.0f;
  w.bones[1] = bent(0.7f);
  w.steps(1);
  const auto first = w.points();
  const double volume = w.state().volume;
  EXPECT_GT(w.rest_distance(), 0.005f);
  const auto expect_same = [&](const char* what) {
    w.bones[1] = bent(0.7f);
    w.steps(1);
    EXPECT_EQ(furthest(w.points(), first), 0.0f) << what;
    EXPECT_EQ(w.state().volume, volume) << what;
  };
  expect_same("a second time");
  w.bring(1, bent(1.0f), 10);
  expect_same("after others");
  w.force(SurfaceSolver::kDynamic);
  w.bring(1, bent(0.1f), 10);
  w.force(SurfaceSolver::kCoarseHull);
  expect_same("after dynamics");
  w.world.get<BoneMatrices>(w.character).teleport_count = 7;
  expect_same("after a jump");
  w.bones[1] = bent(0.2f);
  w.steps(1);
  set_time(w, 0.0f);
  expect_same("in a step of no length");
}

TEST(PoseSurfaceMuscles, APoseMayBeAskedForOutsideOfTheSchedule) {
  HullWorld w(still_bones(2)), scrubbed(still_bones(2));
  for (HullWorld* world : {&w, &scrubbed}) world->add_with_hull(ball_with_line());
  scrubbed.force(SurfaceSolver::kDynamic);
  scrubbed.steps(3);
  for (const float t : {0.9f, 0.2f, 0.5f}) {
    w.bones[1] = scrubbed.bones[1] = bent(t);
    w.steps(1);
    scrubbed.pose(scrubbed.character, scrubbed.bones);
    ASSERT_TRUE(pose_now(scrubbed.world, scrubbed.muscles[0]));
    EXPECT_EQ(scrubbed.points(), w.points());
    const auto& expected = w.world.get<DrawnSurface>(w.muscles[0]).vertices;
    const auto& drawn = scrubbed.world.get<DrawnSurface>(scrubbed.muscles[0]).vertices;
    for (std::size_t v = 0; v < drawn.size(); ++v) EXPECT_EQ(drawn[v].position, expected[v].position);
  }
  EXPECT_EQ(scrubbed.hull().solver, SurfaceSolver::kDynamic);
  // Nor does it matter how large it is in the picture.
  const auto before = scrubbed.points();
  scrubbed.hull().refinements = 0;
  ASSERT_TRUE(pose_now(scrubbed.world, scrubbed.muscles[0]));
  EXPECT_EQ(scrubbed.points(), before);
  scrubbed.hull().settings.refinements = 0;
  ASSERT_TRUE(pose_now(scrubbed.world, scrubbed.muscles[0]));
  EXPECT_NE(scrubbed.points(), before);
  // Not while it is switched off.
  scrubbed.state().enabled = false;
  EXPECT_FALSE(pose_now(scrubbed.world, scrubbed.muscles[0]));
}

// What the fade allows: the share that goes in a frame, of the furthest that the shapes are apart.
TEST(PoseSurfaceMuscles, AChangeToTheHullIsBlended) {
  HullWorld w(still_bones(2)), posed(still_bones(2));
  for (HullWorld* world : {&w, &posed}) {
    world->add_with_hull(ball_with_line({kDynamicLevel}));
    world->force(SurfaceSolver::kDynamic);
    world->bring(1, bent(0.8f), 20);
    world->steps(200);  // until nothing moves but by the solver's choice
  }
  posed.force(SurfaceSolver::kCoarseHull);
  posed.hull().blend_time = 0.0f;
  posed.steps(1);
  const double old_volume = w.state().volume, new_volume = posed.state().volume;
  auto before = w.points();
  const float apart = furthest(before, posed.points());
  ASSERT_GT(apart, 0.0005f);
  w.force(SurfaceSolver::kCoarseHull);
  const float time = w.hull().blend_time, step = w.world.resource<FrameTime>().step;
  float share = 1.0f, furthest_move = 0.0f;
  const int frames = static_cast<int>(std::ceil(time / step));
  for (int frame = 1; frame <= frames; ++frame) {
    w.steps(1);
    const float next = frame == frames ? 0.0f : fading((time - step * static_cast<float>(frame)) / time);
    const float moved = furthest(w.points(), before);
    EXPECT_LE(moved, 1.1f * (share - next) * apart + 2e-5f) << frame;
    EXPECT_NEAR(w.state().volume / old_volume,
                static_cast<double>(next) + static_cast<double>(1.0f - next) * new_volume / old_volume, 0.002)
        << frame;
    furthest_move = std::max(furthest_move, moved);
    before = w.points();
    share = next;
  }
  EXPECT_GT(furthest_move, 0.02f * apart);
  EXPECT_EQ(w.hull().blend_left, 0.0f);
  EXPECT_EQ(w.points(), posed.points());
  EXPECT_EQ(w.hull().switches, 1u);
  w.steps(3);
  EXPECT_EQ(w.points(), posed.points());
}

TEST(PoseSurfaceMuscles, WhileItFadesTheBonesMayGoOn) {
  HullWorld w(still_bones(2)), posed(still_bones(2));
  for (HullWorld* world : {&w, &posed}) world->add_with_hull(ball_with_line());
  w.force(SurfaceSolver::kDynamic);
  float t = 0.0f;
  const auto step = [&] {
    t += 0.01f;
    w.bones[1] = posed.bones[1] = bent(t);
    w.steps(1);
    posed.steps(1);
    for (const AttachedVertex& attached : w.asset().attached) {
      EXPECT_LT(glm::distance(w.point(attached.vertex), posed.point(attached.vertex)), 1e-5f);
    }
    return furthest(w.points(), posed.points());
  };
  for (int i = 0; i < 40; ++i) step();
  w.force(SurfaceSolver::kCoarseHull);
  float apart = step();
  EXPECT_GT(apart, 0.0f);
  for (int i = 0; i < 20; ++i) {
    const float now = step();
    EXPECT_LE(now, apart + 1e-5f);
    apart = now;
  }
  EXPECT_EQ(apart, 0.0f);
}

TEST(PoseSurfaceMuscles, OtherRefinementsAreBlendedToo) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line({kHullLevel, {.solver = SurfaceSolver::kCoarseHull, .refinements = 0}}));
  w.bones[1] = bent(0.6f);
  w.steps(2);
  EXPECT_EQ(w.hull().blend_left, 0.0f);  // the first shape is nothing to blend from
  w.world.set_resource(Viewer{.enabled = true, .eye = {}, .pixels_per_radian = 1.0f, .level = 1});
  const auto before = w.points();
  set_time(w, 0.0f);
  w.steps(1);
  EXPECT_GT(w.hull().blend_left, 0.0f);
  EXPECT_LT(furthest(w.points(), before), 2e-6f);  // no time has gone
  set_time(w, 1.0f);
  w.steps(1);
  EXPECT_EQ(w.hull().blend_left, 0.0f);
  EXPECT_EQ(w.hull().switches, 0u);
}

TEST(PoseSurfaceMuscles, AJumpOrNoTimeEndsABlend) {
  for (const int how : {0, 1, 2}) {
    HullWorld w(still_bones(2)), posed(still_bones(2));
    for (HullWorld* world : {&w, &posed}) world->add_with_hull(ball_with_line());
    w.force(SurfaceSolver::kDynamic);
    w.bring(1, bent(0.8f), 10);
    w.force(SurfaceSolver::kCoarseHull);
    w.steps(1);
    EXPECT_GT(w.hull().blend_left, 0.0f);
    posed.bones[1] = bent(0.8f);
    posed.steps(1);
    EXPECT_GT(furthest(w.points(), posed.points()), 1e-4f);
    if (how == 0) w.world.get<BoneMatrices>(w.character).teleport_count = 1;
    if (how == 1) w.hull().blend_time = 0.0f;
    if (how == 2) w.hull().blend_time = kNaN;
    w.steps(1);
    EXPECT_EQ(w.points(), posed.points()) << how;
    EXPECT_EQ(w.state().fallbacks, 0u);
  }
}

// As if it had never been anything else: what dynamics do next depends on the posed shape alone.
TEST(PoseSurfaceMuscles, DynamicsGoOnFromThePoseAtRest) {
  HullWorld w(still_bones(2)), fresh(still_bones(2));
  for (HullWorld* world : {&w, &fresh}) {
    world->add_with_hull(ball_with_line());
    world->hull().blend_time = 0.0f;
    world->world.get<SurfaceMuscle>(world->muscles[0]).settings.collide_with_itself = true;
  }
  w.force(SurfaceSolver::kDynamic);
  w.bring(1, bent(0.8f), 10);
  EXPECT_GT(fastest(w), 0.01f);
  w.force(SurfaceSolver::kCoarseHull);
  w.steps(1);
  EXPECT_EQ(fastest(w), 0.0f);
  fresh.bones[1] = bent(0.8f);
  fresh.steps(2);
  for (HullWorld* world : {&w, &fresh}) {
    world->force(SurfaceSolver::kDynamic);
    world->steps(5);
  }
  EXPECT_EQ(w.points(), fresh.points());
  EXPECT_EQ(w.hull().switches, 3u);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 0.005);
}

TEST(PoseSurfaceMuscles, AShapeThatIsNoneFallsBackAndIsCounted) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line());
  w.force(SurfaceSolver::kDynamic);
  w.steps(2);
  w.state().points[40].x = kNaN;
  w.force(SurfaceSolver::kCoarseHull);
  w.steps(1);
  EXPECT_EQ(w.state().fallbacks, 1u);
  EXPECT_EQ(w.rest_distance(), 0.0f);
  w.steps(5);
  EXPECT_EQ(w.state().fallbacks, 1u);
  EXPECT_LT(w.rest_distance(), 1e-5f);
  // What is nowhere near has nothing to fall back to but where its carriers bring it, and that is finite.
  w.bones[1] = at({1e6f, 0.0f, 0.0f});
  w.steps(1);
  EXPECT_TRUE(std::isfinite(w.rest_distance()));
  EXPECT_EQ(w.state().fallbacks, 2u);
}

TEST(PoseSurfaceMuscles, SwitchedOffItIsCarriedOnly) {
  HullWorld w(still_bones(2)), plain(still_bones(2));
  w.add_with_hull(ball_with_line());
  plain.add(attached_ball());
  for (HullWorld* world : {&w, &plain}) {
    world->state().enabled = false;
    world->bones[1] = bent(1.0f);
    world->steps(2);
  }
  for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) EXPECT_EQ(w.point(v), plain.point(v));
  EXPECT_TRUE(w.contacts().now.empty());
  // Switched on again it goes to its pose without a jump.
  const auto carried = w.points();
  w.state().enabled = true;
  w.steps(1);
  EXPECT_LT(furthest(w.points(), carried), 0.002f);
  w.steps(30);
  EXPECT_EQ(w.hull().blend_left, 0.0f);
}

// One that is posed takes no part in what muscles do to each other, and is not moved by it.
TEST(PoseSurfaceMuscles, NeighboursLeaveItAlone) {
  SurfaceMuscleDescription other = ball_with_line();
  for (glm::vec3& p : other.mesh.positions) p.x += 0.102f;
  for (ActionLinePoint& p : other.action_line) p.position.x += 0.102f;
  other.name = "other";
  const auto run = [&](SurfaceSolver second) {
    auto w = std::make_unique<HullWorld>(still_bones(3));
    w->add_with_hull(ball_with_line());
    for (SurfaceAttachment& attachment : other.attachments) attachment.bone = 2;
    w->add_with_hull(other);
    w->force(SurfaceSolver::kDynamic, 0);
    w->force(second, 1);
    w->bring(2, at({-0.01f, 0.0f, 0.0f}), 20);
    w->steps(10);
    return w;
  };
  const auto both = run(SurfaceSolver::kDynamic), one = run(SurfaceSolver::kCoarseHull);
  EXPECT_GT(both->rest_distance(0), 0.0005f);  // they press each other
  EXPECT_LT(one->rest_distance(0), 1e-5f);
  // Back among dynamics it presses again, once it has come out.
  one->force(SurfaceSolver::kDynamic, 1);
  one->bring(2, at({0.01f, 0.0f, 0.0f}), 20);
  one->steps(120);
  EXPECT_LT(one->rest_distance(0), 2e-4f);
  one->bring(2, at({-0.01f, 0.0f, 0.0f}), 20);
  EXPECT_GT(one->rest_distance(0), 0.0005f);
  for (const std::size_t i : {0, 1}) {
    EXPECT_EQ(one->state(i).fallbacks, 0u);
    EXPECT_NEAR(one->volume_ratio(i), 1.0, 0.01);
  }
}

TEST(PoseSurfaceMuscles, TheStateIsTheSameForAnyWorkersAndInstructionSet) {
  const auto run = [](int workers, SimdLevel level) {
    MuscleSettings settings;
    settings.simd = level;
    HullWorld w(still_bones(2), {}, workers, settings);
    const SurfaceMuscleDescription description = ball_with_line();
    for (int i = 0; i < 5; ++i) w.add_with_hull(description);
    std::vector<std::uint64_t> hashes;
    for (int i = 1; i <= 12; ++i) {
      for (std::size_t m = 0; m < 5; ++m) {
        const bool dynamic = (static_cast<std::size_t>(i) / 4 + m) % 3 == 0;
        w.force(dynamic ? SurfaceSolver::kDynamic : SurfaceSolver::kCoarseHull, m);
        w.world.get<SurfaceMuscle>(w.muscles[m]).settings.collide_with_muscles = false;
      }
      w.bones[1] = bent(0.05f * static_cast<float>(i));
      w.steps(1);
      hashes.push_back(hash_surface_state(w.world));
    }
    return hashes;
  };
  const auto expected = run(1, SimdLevel::kPortable);
  for (std::size_t i = 1; i < expected.size(); ++i) EXPECT_NE(expected[i], expected[i - 1]);
  for (const int workers : {1, 2, 3, 8}) {
    for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
      if (level > detect_simd()) continue;
      EXPECT_EQ(run(workers, level), expected) << workers << " " << to_string(level);
    }
  }
}

TEST(PoseSurfaceMuscles, TheHashTellsBlendsApart) {
  HullWorld w(still_bones(2));
  w.add_with_hull(ball_with_line());
  w.force(SurfaceSolver::kDynamic);
  w.bring(1, bent(0.5f), 5);
  w.force(SurfaceSolver::kCoarseHull);
  w.steps(1);
  const std::uint64_t before = hash_surface_state(w.world);
  w.hull().difference[60].x += 1e-4f;
  EXPECT_NE(hash_surface_state(w.world), before);
  w.hull().difference[60].x -= 1e-4f;
  w.hull().blend_left *= 0.5f;
  EXPECT_NE(hash_surface_state(w.world), before);
}

TEST(PoseSurfaceMuscles, NothingIsAllocated) {
  const auto field = test::box_bone({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, -0.0405f}, 0.002f);
  SurfaceMuscleDescription description = ball_with_line();
  description.bones = {0};
  for (const int workers : {1, 2}) {
    HullWorld w(still_bones(2), {field, nullptr}, workers);
    w.add_with_hull(description);
    w.add_with_hull(description);
    w.steps(3);
    std::vector<std::vector<glm::mat4>> poses;
    for (int i = 0; i < 20; ++i) poses.push_back({glm::mat4(1.0f), bent(0.02f * static_cast<float>(i))});
    const test::AllocationScope scope;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      w.force(i % 8 < 4 ? SurfaceSolver::kCoarseHull : SurfaceSolver::kDynamic);
      std::swap(w.world.get<BoneMatrices>(w.character).world, poses[i]);
      w.step();
    }
    EXPECT_EQ(scope.allocations(), 0u);
  }
}

TEST(PoseSurfaceMuscles, ItsTimeIsInTheLedger) {
  HullWorld w(still_bones(2));
  const ecs::Entity muscle = w.add_with_hull(ball_with_line());
  list_surface_costs(w.world, muscle, "ball");
  w.world.resource<CostLedger>().set_enabled(true);
  w.steps(1);
  w.world.resource<CostLedger>().end_frame();
  bool posed = false;
  for (const ItemCost& cost : w.world.resource<CostLedger>().statistics()) {
    EXPECT_NE(cost.system, "solve_surface_muscles");
    posed = posed || (cost.system == "pose_surface_muscles" && cost.owner == "ball");
  }
  EXPECT_TRUE(posed);
}

}  // namespace
}  // namespace fascicle::muscle
