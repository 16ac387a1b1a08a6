#include "modules/muscle/systems/4_solve/solve_surface_muscles.hpp"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/loop/frame_time.hpp"
#include "modules/muscle/kernels/surface/surface_reference.hpp"
#include "tests/modules/muscle/systems/surface_world.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/analytic_bones.hpp"

namespace fascicle::muscle {
namespace {

glm::mat4 at(const glm::vec3& place) { return glm::translate(glm::mat4(1.0f), place); }

TEST(SolveSurfaceMuscles, WithoutBonesOrTimeNothingHappens) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.bones = still_bones(1);  // too few
  w.steps(3);
  EXPECT_FALSE(w.state().started);
  EXPECT_EQ(w.rest_distance(), 0.0f);
  w.bones = still_bones(2);
  w.kick(0.002f);
  w.state().started = true;
  const float kicked = w.rest_distance();
  w.world.resource<FrameTime>().step = 0.0f;
  w.steps(3);
  EXPECT_EQ(w.rest_distance(), kicked);
  w.world.destroy(w.character);
  w.step();
  EXPECT_EQ(w.rest_distance(), kicked);
}

TEST(SolveSurfaceMuscles, AtRestNothingMovesForTenThousandSteps) {
  for (const bool free : {true, false}) {
    SurfaceWorld w(still_bones(2));
    w.add(free ? free_ball() : attached_ball());
    for (int i = 0; i < 10000; ++i) w.step();
    EXPECT_EQ(w.rest_distance(), 0.0f);
    EXPECT_EQ(w.state().fallbacks, 0u);
  }
}

TEST(SolveSurfaceMuscles, WhatIsKickedComesBack) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.steps(1);
  w.kick(0.003f);
  ASSERT_GT(w.rest_distance(), 0.002f);
  w.steps(120);
  EXPECT_LT(w.rest_distance(), 0.0003f);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 1e-4);
  // Not so without the solver's constraints: carried only, it would stand at rest at once; unsolved, for ever as kicked.
  w.kick(0.003f);
  const float kicked = w.rest_distance();
  w.world.resource<FrameTime>().step = 0.0f;
  w.steps(120);
  EXPECT_EQ(w.rest_distance(), kicked);
}

TEST(SolveSurfaceMuscles, AFreeBodyKeepsItsMomentum) {
  SurfaceMuscleDescription description = free_ball();
  description.settings.damping = 0.0f;
  SurfaceWorld w(still_bones(1));
  w.add(description);
  w.steps(1);
  w.kick(0.002f);
  const auto middle = [&] {
    glm::dvec3 sum(0.0);
    for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) sum += glm::dvec3(w.point(v));
    return sum / static_cast<double>(w.asset().vertex_count);
  };
  const glm::dvec3 before = middle();
  w.steps(200);
  EXPECT_LT(glm::distance(middle(), before), 2e-5);  // kicks leave no velocity, constraints none that is not undone
  EXPECT_NEAR(w.volume_ratio(), 1.0, 1e-4);
}

TEST(SolveSurfaceMuscles, AttachedVerticesAreWhereTheirBonesAre) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  for (int i = 0; i < 60; ++i) {
    const float t = static_cast<float>(i) / 60.0f;
    w.bones[1] = glm::rotate(at({0.01f * t, 0.0f, 0.03f * t}), 0.8f * t, glm::vec3(0.3f, 0.2f, 0.9f));
    w.steps(1);
    for (const AttachedVertex& attached : w.asset().attached) {
      const glm::mat4& bone = w.bones[static_cast<std::size_t>(w.asset().attachments[attached.attachment].bone)];
      const glm::vec3 want(bone * glm::vec4(w.rest_point(attached.vertex), 1.0f));
      EXPECT_LT(glm::distance(w.world_point(attached.vertex), want), 1e-6f);
    }
    EXPECT_NEAR(w.volume_ratio(), 1.0, 0.005);
  }
  EXPECT_GT(w.rest_distance(), 0.02f);
}

// The whole character may stand anywhere and turn: the muscle does the same, seen from it.
TEST(SolveSurfaceMuscles, TurningEverythingTurnsTheResult) {
  const auto run = [](const glm::mat4& place) {
    SurfaceWorld w(still_bones(2));
    w.add(attached_ball());
    for (int i = 1; i <= 30; ++i) {
      const float t = static_cast<float>(i) / 30.0f;
      w.bones = {place, place * glm::rotate(at({0.0f, 0.02f * t, 0.02f * t}), 0.5f * t, glm::vec3(1, 0, 0))};
      w.steps(1);
    }
    std::vector<glm::vec3> points;
    for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) points.push_back(w.world_point(v));
    return points;
  };
  const std::vector<glm::vec3> here = run(glm::mat4(1.0f));
  const glm::mat4 place = glm::rotate(at({3.0f, 1.0f, -2.0f}), 2.1f, glm::vec3(0.6f, 0.0f, 0.8f));
  const std::vector<glm::vec3> there = run(place);
  float furthest = 0.0f;
  for (std::size_t i = 0; i < here.size(); ++i) {
    furthest = std::max(furthest, glm::distance(glm::vec3(place * glm::vec4(here[i], 1.0f)), there[i]));
  }
  EXPECT_LT(furthest, 2e-5f);
}

// The same description with every place turned: constraints know no direction of space.
TEST(SolveSurfaceMuscles, ATurnedMuscleDeformsTheSameWay) {
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), 1.3f, glm::normalize(glm::vec3(1.0f, 2.0f, -1.0f)));
  const auto run = [](const glm::mat4& by) {
    SurfaceMuscleDescription description = attached_ball();
    description.mesh = test::moved(description.mesh, by);
    description.settings.along_fibres = 1.0f;
    SurfaceWorld w(still_bones(2));
    w.add(description);
    for (int i = 1; i <= 60; ++i) {
      const float t = static_cast<float>(i) / 60.0f;
      w.bones[1] = by * glm::rotate(at({0.0f, 0.01f * t, 0.02f * t}), 0.3f * t, glm::vec3(0, 0, 1)) * glm::inverse(by);
      w.steps(1);
    }
    std::vector<glm::vec3> points(w.asset().vertex_count);
    for (std::uint32_t v = 0; v < points.size(); ++v) points[w.asset().file_vertex[v]] = w.world_point(v);
    return points;
  };
  const std::vector<glm::vec3> here = run(glm::mat4(1.0f)), there = run(turn);
  float furthest = 0.0f;
  for (std::size_t i = 0; i < here.size(); ++i) {
    furthest = std::max(furthest, glm::distance(glm::vec3(turn * glm::vec4(here[i], 1.0f)), there[i]));
  }
  EXPECT_LT(furthest, 5e-4f);  // vertices are sorted by place, so hinges are passed in another order: close, not equal
}

TEST(SolveSurfaceMuscles, HalvingTheSubstepChangesLittle) {
  const auto run = [](std::uint32_t substeps) {
    SurfaceMuscleDescription description = attached_ball();
    description.settings.substeps = substeps;
    SurfaceWorld w(still_bones(2));
    w.add(description);
    w.bring(1, at({0.0f, 0.02f, 0.04f}), 60);
    std::vector<glm::vec3> points;
    for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) points.push_back(w.point(v));
    return points;
  };
  const std::vector<glm::vec3> coarse = run(5), fine = run(10);
  float furthest = 0.0f, stretched = 0.0f;
  for (std::size_t i = 0; i < coarse.size(); ++i) furthest = std::max(furthest, glm::distance(coarse[i], fine[i]));
  for (const glm::vec3& p : coarse) stretched = std::max(stretched, p.z);
  EXPECT_GT(stretched, 0.085f);
  EXPECT_LT(furthest, 0.01f * 0.17f);
}

TEST(SolveSurfaceMuscles, BonesAreKeptOut) {
  // A block comes down onto a ball that stands on another.
  const auto lower = test::box_bone({-0.1f, -0.1f, -0.08f}, {0.1f, 0.1f, -0.051f}, 0.002f);
  const auto upper = test::box_bone({-0.1f, -0.1f, 0.052f}, {0.1f, 0.1f, 0.1f}, 0.002f);
  SurfaceMuscleDescription description = free_ball();
  description.bones = {0, 1};
  SurfaceWorld w(still_bones(2), {lower, upper});
  w.add(description);
  const float keep = description.settings.contact_distance;
  for (int i = 1; i <= 60; ++i) {
    w.bones[1] = at({0.0f, 0.0f, -0.0006f * static_cast<float>(i)});
    w.steps(1);
    const float floor = -0.051f + keep, ceiling = 0.052f + w.bones[1][3].z - keep;
    for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) {
      EXPECT_GT(w.point(v).z, floor - 2e-4f) << i;
      EXPECT_LT(w.point(v).z, ceiling + 2e-4f) << i;
    }
    EXPECT_NEAR(w.volume_ratio(), 1.0, 0.02);
  }
  ASSERT_EQ(w.contacts().now.size(), 2u);
  EXPECT_EQ(w.contacts().now[0].bone, 0);
  EXPECT_EQ(w.contacts().now[1].bone, 1);
  EXPECT_GT(w.contacts().now[1].vertices, 10u);
  EXPECT_NEAR(w.contacts().now[1].place.z, 0.052f - 0.036f - keep, 1e-3f);
  // Without collision it is in the bone.
  w.world.get<SurfaceMuscle>(w.muscles[0]).settings.collide_with_bones = false;
  w.steps(60);
  float highest = 0.0f;
  for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) highest = std::max(highest, w.point(v).z);
  EXPECT_GT(highest, 0.052f - 0.036f + 0.001f);
  EXPECT_TRUE(w.contacts().now.empty());
}

// A bone that passes through within a step: the vertices that it overran go back to the side they came from.
TEST(SolveSurfaceMuscles, ABoneThatOverrunsPushesAheadOfIt) {
  const auto plate = test::box_bone({-0.1f, -0.1f, 0.08f}, {0.1f, 0.1f, 0.12f}, 0.002f);
  SurfaceMuscleDescription description = free_ball();
  description.bones = {1};
  SurfaceWorld w(still_bones(2), {nullptr, plate});
  w.add(description);
  for (int i = 1; i <= 4; ++i) {  // 14 mm a step
    w.bones[1] = at({0.0f, 0.0f, -0.014f * static_cast<float>(i)});
    w.steps(1);
  }
  w.steps(30);
  for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) EXPECT_LT(w.point(v).z, 0.08f - 0.056f + 1e-3f);
}

TEST(SolveSurfaceMuscles, FrictionHoldsWhatIsPressed) {
  const auto slide = [](float friction) {
    const auto lower = test::box_bone({-0.2f, -0.2f, -0.08f}, {0.2f, 0.2f, -0.048f}, 0.002f);
    const auto upper = test::box_bone({-0.2f, -0.2f, 0.045f}, {0.2f, 0.2f, 0.1f}, 0.002f);
    SurfaceMuscleDescription description = free_ball();
    description.bones = {0, 1};
    description.settings.friction = friction;
    description.frame_bone = 2;
    SurfaceWorld w(still_bones(3), {lower, upper, nullptr});
    w.add(description);
    w.steps(30);
    for (int i = 1; i <= 60; ++i) {  // both slide to one side
      w.bones[0] = w.bones[1] = at({0.0005f * static_cast<float>(i), 0.0f, 0.0f});
      w.steps(1);
    }
    float mean = 0.0f;
    for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) mean += w.point(v).x;
    return mean / static_cast<float>(w.asset().vertex_count);
  };
  const float smooth = std::abs(slide(0.0f)), rough = slide(1.0f);
  EXPECT_LT(smooth, 0.0002f);
  EXPECT_GT(rough, 0.001f);
  EXPECT_GT(slide(5.0f), 1.5f * rough);  // it slips, by Coulomb's law
}

TEST(SolveSurfaceMuscles, WhatDivergesFallsBackAndIsCounted) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.steps(2);
  w.state().velocity[40] = {1e30f, 0.0f, 0.0f, 0.0f};
  w.state().points[40].x = std::numeric_limits<float>::quiet_NaN();
  w.steps(1);
  EXPECT_EQ(w.state().fallbacks, 1u);
  EXPECT_EQ(w.rest_distance(), 0.0f);
  EXPECT_NEAR(w.state().volume / w.asset().volume, 1.0, 1e-5);
  w.steps(5);
  EXPECT_EQ(w.state().fallbacks, 1u);
}

TEST(SolveSurfaceMuscles, SettingsMayChangeAtAnyTime) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.steps(2);
  SurfaceSettings& settings = w.world.get<SurfaceMuscle>(w.muscles[0]).settings;
  settings.substeps = 0;
  w.bones[1] = at({0.0f, 0.0f, 0.005f});
  w.steps(10);
  EXPECT_EQ(w.state().fallbacks, 0u);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 0.005);
  settings.substeps = 9;
  settings.collide_with_itself = true;
  settings.anchor_compliance = 0.0f;
  w.steps(10);
  EXPECT_EQ(w.state().fallbacks, 0u);
}

TEST(SolveSurfaceMuscles, ATeleportIsNoMovement) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.steps(3);
  w.bones[1] = at({0.0f, 0.05f, 0.0f});
  w.world.get<BoneMatrices>(w.character).teleport_count = 1;
  w.steps(1);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 0.02);
  float fastest = 0.0f;
  for (const SurfacePoint& v : w.state().velocity) fastest = std::max(fastest, std::hypot(v.x, v.y, v.z));
  EXPECT_LT(fastest, 1.5f);  // what refines the new shape, not 5 cm in a sixtieth of a second
  EXPECT_EQ(w.state().fallbacks, 0u);
}

TEST(SolveSurfaceMuscles, SwitchedOffItIsCarriedOnly) {
  SurfaceWorld w(still_bones(2));
  w.add(attached_ball());
  w.state().enabled = false;
  w.bones[1] = at({0.0f, 0.0f, 0.05f});
  w.steps(1);
  EXPECT_GT(w.volume_ratio(), 1.2);
  w.state().enabled = true;
  w.steps(30);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 0.005);
}

// One that a musculotendon unit drives goes with its sections, at whatever level of detail that is.
TEST(SolveSurfaceMuscles, ADriverCarries) {
  const auto drivers = *build_muscle_asset(test::synthetic_muscles(8, 2), test::rest_bones());
  SurfaceMuscleDescription description = free_ball();
  const glm::vec3 middle = rest_point(*drivers, 0, drivers->muscles[0].section_count / 2);
  for (glm::vec3& p : description.mesh.positions) p = middle + 0.3f * p;
  description.driver = drivers->muscles[0].name;
  SurfaceWorld w(test::rest_bones());
  const ecs::Entity musculature = spawn_musculature(w.world, w.character, drivers);
  w.add(description, drivers.get(), musculature);
  w.steps(2);
  const glm::vec3 start = w.world_point(0);
  EXPECT_LT(w.rest_distance(), 1e-5f);
  for (int i = 1; i <= 30; ++i) {
    w.bones = test::walk_bones(static_cast<float>(i) / 60.0f);
    w.steps(1);
  }
  glm::vec3 mean(0.0f);
  for (std::uint32_t v = 0; v < w.asset().vertex_count; ++v) mean += w.world_point(v);
  mean /= static_cast<float>(w.asset().vertex_count);
  const glm::vec3 centre = line_point(*drivers, w.world.get<ActionLines>(musculature), 0,
                                      drivers->muscles[0].section_count / 2);
  EXPECT_LT(glm::distance(mean, centre), 0.004f);
  EXPECT_GT(glm::distance(w.world_point(0), start), 0.2f);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 0.005);
  // What is attached stands at its bone all the same, though the unit's sections are elsewhere.
  SurfaceMuscleDescription attached = description;
  attached.attachments = {{.bone = test::kPelvis, .origin = true, .vertices = {0, 1, 2, 3}}};
  const ecs::Entity second = w.add(attached, drivers.get(), musculature);
  w.world.get<SurfaceMuscle>(second).settings.collide_with_muscles = false;
  w.steps(3);
  for (const AttachedVertex& held : w.asset(1).attached) {
    const glm::vec3 want(w.bones[test::kPelvis] * glm::inverse(w.rest[test::kPelvis]) *
                         glm::vec4(w.rest_point(held.vertex, 1), 1.0f));
    EXPECT_LT(glm::distance(w.world_point(held.vertex, 1), want), 2e-6f);
  }
  // Detached, it has nothing that moves it.
  detach_muscle(w.world, muscle_entity(w.world, musculature, 0));
  w.steps(10);
  EXPECT_NEAR(w.volume_ratio(), 1.0, 0.005);
}

TEST(SolveSurfaceMuscles, TheStateIsTheSameForAnyWorkersAndInstructionSet) {
  const auto run = [](int workers, SimdLevel level) {
    MuscleSettings settings;
    settings.simd = level;
    SurfaceWorld w(still_bones(2), {}, workers, settings);
    for (int i = 0; i < 5; ++i) w.add(attached_ball(8 + 2 * static_cast<std::uint32_t>(i)));
    std::vector<std::uint64_t> hashes;
    for (int i = 1; i <= 12; ++i) {
      w.bones[1] = glm::rotate(at({0.0f, 0.0f, 0.002f * static_cast<float>(i)}), 0.05f * static_cast<float>(i),
                               glm::vec3(0, 1, 0));
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

TEST(SolveSurfaceMuscles, NothingIsAllocated) {
  const auto field = test::box_bone({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, -0.0405f}, 0.002f);
  SurfaceMuscleDescription description = attached_ball();
  description.bones = {0};
  for (const int workers : {1, 2}) {
    SurfaceWorld w(still_bones(2), {field, nullptr}, workers);
    w.add(description);
    w.add(description);
    w.steps(3);
    std::vector<std::vector<glm::mat4>> poses;
    for (int i = 0; i < 20; ++i) poses.push_back({glm::mat4(1.0f), at({0.0f, 0.0f, -0.001f * static_cast<float>(i)})});
    const test::AllocationScope scope;
    for (std::vector<glm::mat4>& pose : poses) {
      std::swap(w.world.get<BoneMatrices>(w.character).world, pose);
      w.step();
    }
    EXPECT_EQ(scope.allocations(), 0u);
    EXPECT_FALSE(w.contacts().now.empty());
  }
}

// The whole step by the plain code gives the same shape.
TEST(SolveSurfaceMuscles, AgreesWithTheReference) {
  const SurfaceMuscleDescription description = attached_ball();
  const auto asset = *build_surface_asset(description, 2);
  const auto run = [&](const SurfaceKernels& kernels) {
    AlignedVector<SurfacePoint> points = asset->rest, velocity(asset->rest.size());
    SurfaceScratch scratch;
    lay_out(*asset, scratch);
    for (int i = 0; i < 40; ++i) {
      const auto turned = [&](int k) {
        return glm::rotate(at({0.0f, 0.0f, 0.0005f * static_cast<float>(k)}), 0.01f * static_cast<float>(k),
                           glm::vec3(1, 0, 0));
      };
      const std::vector<RigidMotion> motions = {{}, {turned(i), turned(i + 1)}};
      step_surface({.asset = asset.get(), .kernels = &kernels, .settings = asset->settings, .step = 1.0f / 60.0f,
                    .attachments = motions, .carriers = motions, .bones = {}, .fields = {}, .rest_to_bone = {},
                    .points = points, .velocity = velocity},
                   scratch);
    }
    return points;
  };
  const auto fast = run(surface_kernels(detect_simd())), plain = run(surface_reference_kernels());
  float furthest = 0.0f, moved = 0.0f;
  for (std::uint32_t v = 0; v < asset->vertex_count; ++v) {
    furthest = std::max(furthest, std::hypot(fast[v].x - plain[v].x, fast[v].y - plain[v].y, fast[v].z - plain[v].z));
    moved = std::max(moved, std::abs(fast[v].z - asset->rest[v].z));
  }
  EXPECT_GT(moved, 0.015f);
  EXPECT_LT(furthest, 2e-5f);
}

TEST(SpawnSurfaceMuscles, DespawnLeavesNothing) {
  SurfaceWorld w(still_bones(2));
  const ecs::Entity muscle = w.add(attached_ball());
  list_surface_costs(w.world, muscle, "ball");
  w.steps(1);
  despawn_surface_muscle(w.world, muscle);
  EXPECT_FALSE(w.world.alive(muscle));
  despawn_surface_muscle(w.world, w.character);  // no surface muscle: stays
  EXPECT_TRUE(w.world.alive(w.character));
  w.step();
}

}  // namespace
}  // namespace fascicle::muscle
