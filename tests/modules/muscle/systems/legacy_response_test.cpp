// The thesis's response, run on straight muscles along z: round, 8 vertices a section, vertex 0 on +x.
#include "modules/muscle/systems/4_solve/legacy_response.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/components/lay_out_state.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"
#include "tests/support/allocation_counter.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::uint32_t kCount = 8, kMiddle = 2;  // sections 0..4, 0.1 m apart
constexpr float kRadius = 0.02f, kNan = std::numeric_limits<float>::quiet_NaN();

// Muscles on bone 0 at these places, from z = 0 to z = 0.4; bone 1 is for pressing.
struct World {
  std::shared_ptr<const MuscleAsset> muscles;
  CollisionAsset asset;
  LegacyPlan plan;
  std::vector<glm::mat4> bones{glm::mat4(1.0f), glm::mat4(1.0f)};
  std::vector<std::shared_ptr<const TriangleTree>> trees{nullptr, nullptr};
  ActionLines lines;
  CrossSections sections;
  MuscleCollision collision;

  explicit World(const std::vector<glm::vec3>& places, std::uint32_t subdivision = 2) {
    std::vector<MuscleDescription> descriptions;
    for (std::size_t m = 0; m < places.size(); ++m) {
      MuscleDescription muscle;
      muscle.name = std::string(1, static_cast<char>('a' + m));
      muscle.attachments = {{0, places[m], true}, {0, places[m] + glm::vec3(0, 0, 0.4f), true}};
      muscle.profile = {.fractions = {0.0f, 1.0f}, .radii = {kRadius, kRadius}, .absolute = true};
      muscle.longitudinal_subdivision = subdivision;
      descriptions.push_back(muscle);
    }
    const auto built = build_muscle_asset(descriptions, bones);
    EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
    muscles = *built;
    asset.muscles = muscles;
    for (std::uint32_t m = 0; m < muscles->size(); ++m) {
      asset.first_section.push_back(static_cast<std::uint32_t>(asset.sections.size()));
      const std::uint32_t count = muscles->muscles[m].section_count;
      for (std::uint32_t k = 0; k < count; ++k) {
        CollisionSection section;
        section.muscle = m;
        section.section = k;
        section.slot = muscles->slot(m, k);
        section.first_radius = muscles->radius(m, k);
        section.count = kCount;
        section.end = k == 0 || k + 1 == count;
        section.rest_area =
            section_area(std::span(muscles->rest_radii).subspan(section.first_radius, section.count));
        asset.sections.push_back(section);
      }
    }
    asset.first_section.push_back(static_cast<std::uint32_t>(asset.sections.size()));
    lay_out(*muscles, lines);
    lay_out(*muscles, sections);
    collision.offset_x.assign(muscles->slot_count, 0.0f);
    collision.offset_y = collision.offset_z = collision.offset_x;
    collision.radii = muscles->rest_radii;
    // Vertex 0 looks along +x whatever direction the frames took at rest.
    for (std::uint32_t slot = 0; slot < muscles->slot_count; ++slot) {
      sections.ux[slot] = sections.vy[slot] = 1.0f;
      sections.uy[slot] = sections.uz[slot] = sections.vx[slot] = sections.vz[slot] = 0.0f;
    }
  }

  // A section's tag against a bone's point.
  void tag_bone(std::uint32_t section, std::uint32_t vertex, std::int32_t bone, glm::vec3 point) {
    Transversal tag;
    tag.section = section;
    tag.vertex = vertex;
    tag.bone = bone;
    tag.point = point;
    asset.transversals.push_back(tag);
  }
  void tag(std::uint32_t section, std::uint32_t vertex, std::uint32_t other_section, std::uint32_t other_vertex) {
    Transversal tag;
    tag.section = section;
    tag.vertex = vertex;
    tag.other_section = other_section;
    tag.other_vertex = other_vertex;
    asset.transversals.push_back(tag);
  }
  LegacyOutcome run() { return respond_as_legacy(asset, plan, bones, sections, lines, collision); }

  std::uint32_t number(std::uint32_t muscle, std::uint32_t k) const { return asset.first_section[muscle] + k; }
  glm::vec3 centre(std::uint32_t number) const {
    const std::uint32_t slot = asset.sections[number].slot;
    return {lines.x[slot], lines.y[slot], lines.z[slot]};
  }
  glm::vec3 offset(std::uint32_t number) const {
    const std::uint32_t slot = asset.sections[number].slot;
    return {collision.offset_x[slot], collision.offset_y[slot], collision.offset_z[slot]};
  }
  std::span<const float> radii(std::uint32_t number) const {
    return std::span(collision.radii).subspan(asset.sections[number].first_radius, kCount);
  }
  bool all_finite() const {
    for (std::uint32_t k = 0; k < asset.sections.size(); ++k) {
      const glm::vec3 a = centre(k), o = offset(k);
      if (!std::isfinite(glm::dot(a, a)) || !(glm::length(o) <= 1.001f * kLegacyReach)) return false;
      for (const float radius : radii(k)) {
        if (!(std::abs(radius) <= kLegacyReach)) return false;
      }
    }
    return true;
  }
};

std::shared_ptr<const TriangleTree> box(glm::vec3 lower, glm::vec3 upper) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) ? upper.x : lower.x, (i & 2) ? upper.y : lower.y, (i & 4) ? upper.z : lower.z);
  }
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return std::make_shared<const TriangleTree>(build_triangle_tree(mesh));
}

// A muscle whose middle section a narrow box presses in from +x.
World pressed() {
  World world({glm::vec3(0.0f)});
  world.tag_bone(kMiddle, 0, 1, {0.015f, 0.0f, 0.2f});
  world.trees[1] = box({0.015f, -0.2f, 0.19f}, {0.2f, 0.2f, 0.21f});
  world.plan = make_legacy_plan(world.asset, world.trees);
  return world;
}

TEST(LegacyPlan, NothingToSweep) {
  World world({glm::vec3(0.0f)});
  EXPECT_TRUE(make_legacy_plan(world.asset, {}).sweeps.empty());
  world.tag_bone(kMiddle, 0, 1, {});
  EXPECT_TRUE(make_legacy_plan(world.asset, {}).sweeps.empty());           // a bone beyond those there are
  EXPECT_TRUE(make_legacy_plan(world.asset, world.trees).sweeps.empty());  // a bone without a mesh
  world.trees[1] = box(glm::vec3(0), glm::vec3(1));
  EXPECT_TRUE(make_legacy_plan(world.asset, world.trees, true).sweeps.empty());  // no tag asks for it
  EXPECT_EQ(make_legacy_plan(world.asset, world.trees).sweeps.size(), 1u);
}

TEST(LegacyPlan, BySectionOnceEach) {
  World world({glm::vec3(0.0f), glm::vec3(0.1f, 0, 0)});
  world.trees[1] = box(glm::vec3(0), glm::vec3(1));
  const std::uint32_t a = world.number(0, kMiddle), b = world.number(1, kMiddle);
  world.tag(b, 4, a, 0);
  world.tag_bone(a, 0, 1, {});
  world.tag_bone(a, 3, 1, {});
  world.tag(a, 1, b, 5);
  world.tag(world.number(0, 0), 0, b, 4);  // an end: it never moves, and is no reason for it not to be hit
  world.asset.transversals.back().second_yields = false;
  const LegacyPlan plan = make_legacy_plan(world.asset, world.trees);
  ASSERT_EQ(plan.sweeps.size(), 3u);
  EXPECT_EQ(plan.sweeps[0].section, a);
  EXPECT_EQ(plan.sweeps[0].bone, 1);
  EXPECT_EQ(plan.sweeps[1].section, a);
  EXPECT_EQ(plan.sweeps[1].other_section, b);
  EXPECT_EQ(plan.sweeps[2].section, b);
  EXPECT_EQ(plan.sweeps[2].other_section, a);
}

TEST(LegacyResponse, NotFiniteInNothingDone) {
  const World before = pressed();
  const auto expect_nothing = [&](World world, bool refused) {
    const LegacyOutcome outcome = world.run();
    EXPECT_EQ(outcome.moved, 0u);
    EXPECT_EQ(outcome.clamped > 0, refused);
    EXPECT_EQ(world.offset(kMiddle), glm::vec3(0.0f));
  };
  World world = before;
  world.bones[1][3].x = kNan;  // the bone that presses
  expect_nothing(world, false);
  world = before;
  world.lines.x[world.asset.sections[kMiddle].slot] = kNan;
  expect_nothing(world, false);
  world = before;
  world.bones[0][0].x = kNan;  // the bone that carries the section
  expect_nothing(world, true);
}

TEST(LegacyResponse, HeldMusclesStay) {
  World world = pressed();
  world.lines.held[0] = 1;
  world.lines.any_held = true;
  const LegacyOutcome outcome = world.run();
  EXPECT_EQ(outcome.moved + outcome.shrunk + outcome.inflated, 0u);
}

TEST(LegacyResponse, FreeOfEverythingItStays) {
  World world = pressed();
  world.bones[1] = glm::translate(glm::mat4(1.0f), {1.0f, 0.0f, 0.0f});
  const World before = world;
  const LegacyOutcome outcome = world.run();
  EXPECT_EQ(outcome.moved + outcome.shrunk + outcome.inflated + outcome.clamped, 0u);
  EXPECT_EQ(world.collision.radii, before.collision.radii);
  EXPECT_EQ(world.lines.x, before.lines.x);
}

TEST(LegacyResponse, ABonePressesRadiiInAndTheOthersInflate) {
  World world = pressed();
  const LegacyOutcome first = world.run();
  // Vertex 0 and its neighbours lose a tenth; the diagonal from vertex 0 leaves the box and pushes the centre.
  EXPECT_EQ(first.shrunk, 3u);
  EXPECT_FLOAT_EQ(world.radii(kMiddle)[0], 0.9f * kRadius);
  EXPECT_FLOAT_EQ(world.radii(kMiddle)[1], 0.9f * kRadius);
  EXPECT_FLOAT_EQ(world.radii(kMiddle)[7], 0.9f * kRadius);
  EXPECT_GT(world.radii(kMiddle)[4], kRadius);
  EXPECT_EQ(first.moved, 1u);
  EXPECT_NEAR(world.centre(kMiddle).x, -0.1f * kRadius, 1e-7f);
  EXPECT_EQ(world.offset(kMiddle), world.centre(kMiddle) - glm::vec3(0, 0, 0.2f));

  int runs = 1;
  while (world.run().shrunk > 0) ASSERT_LT(++runs, 50);
  EXPECT_GE(runs, 2);
  EXPECT_LE(world.centre(kMiddle).x + world.radii(kMiddle)[0], 0.015f);
  const float rest = world.asset.sections[kMiddle].rest_area;
  EXPECT_NEAR(section_area(world.radii(kMiddle)), rest, 2.0f * kLegacyAreaTolerance * rest);
  for (const std::uint32_t k : {0u, 1u, 3u, 4u}) {
    EXPECT_EQ(world.offset(k), glm::vec3(0.0f));
    for (const float radius : world.radii(k)) EXPECT_FLOAT_EQ(radius, kRadius);
  }
}

// What the thesis names as its flaw, and what `legacy` is there to show.
TEST(LegacyResponse, WhatItDidStays) {
  World world = pressed();
  for (int i = 0; i < 20; ++i) world.run();
  const World after = world;
  ASSERT_LT(world.radii(kMiddle)[0], 0.95f * kRadius);
  world.bones[1] = glm::translate(glm::mat4(1.0f), {10.0f, 0.0f, 0.0f});
  for (int i = 0; i < 50; ++i) {
    const LegacyOutcome outcome = world.run();
    EXPECT_EQ(outcome.moved + outcome.shrunk + outcome.inflated, 0u);
  }
  EXPECT_EQ(world.collision.radii, after.collision.radii);
  EXPECT_EQ(world.lines.x, after.lines.x);
  EXPECT_EQ(world.collision.offset_x, after.collision.offset_x);
}

TEST(LegacyResponse, AtTheSmallestRadiusTheCentreMovesInstead) {
  // A thin bar that reaches past the centre: no radius is short enough to be free of it.
  World world({glm::vec3(0.0f)});
  world.tag_bone(kMiddle, 0, 1, {0.5f, 0.0f, 0.2f});
  world.trees[1] = box({-0.0005f, -0.2f, 0.199f}, {0.2f, 0.2f, 0.201f});
  world.plan = make_legacy_plan(world.asset, world.trees);
  float smallest = kRadius, furthest = 0.0f;
  for (int i = 0; i < 60; ++i) {
    world.run();
    for (const float radius : world.radii(kMiddle)) smallest = std::min(smallest, radius);
    furthest = std::min(furthest, world.centre(kMiddle).x);
  }
  EXPECT_GE(smallest, kLegacySmallestRadius);
  EXPECT_LT(furthest, -0.001f);
  EXPECT_TRUE(world.all_finite());
}

TEST(LegacyResponse, SwappedSidesMoveTheCentreOfWhoYields) {
  for (const bool first_yields : {true, false}) {
    World world({glm::vec3(0.0f), glm::vec3(-0.01f, 0.0f, 0.0f)});  // the second belongs on +x
    const std::uint32_t a = world.number(0, kMiddle), b = world.number(1, kMiddle);
    world.tag(a, 0, b, 4);
    world.asset.transversals[0].first_yields = first_yields;
    world.asset.transversals[0].second_yields = !first_yields;
    // Tags at x = 0.02 and -0.03: rho is 0.05 at both, and 0.1 is more than the radius (4.4).
    const LegacyOutcome outcome = world.run();
    EXPECT_EQ(outcome.moved, 1u);
    EXPECT_NEAR(world.centre(a).x, first_yields ? 0.02f - 0.1f : 0.0f, 1e-6f);
    EXPECT_NEAR(world.centre(b).x, first_yields ? -0.01f : -0.03f + 0.1f, 1e-6f);
    EXPECT_EQ(world.offset(first_yields ? b : a), glm::vec3(0.0f));
    EXPECT_NEAR(world.centre(a).y, 0.0f, 1e-7f);
  }
}

TEST(LegacyResponse, OffsetsAreKeptInTheBonesFrame) {
  World world({glm::vec3(0.0f), glm::vec3(-0.01f, 0.0f, 0.0f)});
  const std::uint32_t a = world.number(0, kMiddle), b = world.number(1, kMiddle);
  world.tag(a, 0, b, 4);
  world.asset.transversals[0].second_yields = false;
  world.bones[0] = glm::rotate(glm::mat4(1.0f), glm::radians(90.0f), {0.0f, 0.0f, 1.0f});  // its y is the world's -x
  world.run();
  EXPECT_NEAR(world.centre(a).x, -0.08f, 1e-6f);
  EXPECT_NEAR(world.offset(a).x, 0.0f, 1e-6f);
  EXPECT_NEAR(world.offset(a).y, 0.08f, 1e-6f);
}

TEST(LegacyResponse, ShallowTagsMoveNothing) {
  World world({glm::vec3(0.0f), glm::vec3(0.035f, 0.0f, 0.0f)});
  world.tag(world.number(0, kMiddle), 0, world.number(1, kMiddle), 4);  // rho = 5 mm at both
  EXPECT_EQ(world.run().moved, 0u);
}

TEST(LegacyResponse, EndsStayOnTheirBones) {
  World world({glm::vec3(0.0f), glm::vec3(-0.01f, 0.0f, 0.0f)});
  world.tag(world.number(0, 0), 0, world.number(1, 0), 4);
  EXPECT_EQ(world.run().moved, 0u);
}

TEST(LegacyResponse, MusclesPressEachOther) {
  // Overlapping by 5 mm: each one's latitudinal edges cut the other's surface.
  World world({glm::vec3(0.0f), glm::vec3(0.035f, 0.0f, 0.0f)});
  const std::uint32_t a = world.number(0, kMiddle), b = world.number(1, kMiddle);
  world.tag(a, 0, b, 4);
  world.plan = make_legacy_plan(world.asset, world.trees);
  const LegacyOutcome outcome = world.run();
  EXPECT_GT(outcome.shrunk, 0u);
  EXPECT_LT(world.radii(a)[0], kRadius);
  for (int i = 0; i < 30; ++i) world.run();
  EXPECT_TRUE(world.all_finite());
}

// Tags that ask for opposite things: it never settles, and what is drawn stays finite.
TEST(LegacyResponse, ExplodesNoFurtherThanItsReach) {
  World world({glm::vec3(0.0f), glm::vec3(0.01f, 0.0f, 0.0f), glm::vec3(0.0f, 0.01f, 0.0f)});
  for (std::uint32_t m = 0; m < 3; ++m) {
    for (std::uint32_t k = 1; k < 4; ++k) {
      world.tag(world.number(m, k), 0, world.number((m + 1) % 3, k), 0);
      world.tag(world.number(m, k), 4, world.number((m + 1) % 3, k), 0);
      world.tag(world.number(m, k), 2, world.number((m + 2) % 3, k), 2);
    }
  }
  world.plan = make_legacy_plan(world.asset, world.trees);
  LegacyOutcome sum;
  for (int i = 0; i < 300; ++i) {
    const LegacyOutcome outcome = world.run();
    sum.moved += outcome.moved;
    sum.clamped += outcome.clamped;
    ASSERT_TRUE(world.all_finite()) << "run " << i;
  }
  EXPECT_GT(sum.moved, 300u);
  EXPECT_GT(sum.clamped, 0u);
}

TEST(LegacyResponse, AllocatesNothing) {
  World world = pressed();
  world.tag(kMiddle, 0, kMiddle + 1, 4);
  world.plan = make_legacy_plan(world.asset, world.trees);
  const test::AllocationScope scope;
  world.run();
  EXPECT_EQ(scope.allocations(), 0u);
}

}  // namespace
}  // namespace fascicle::muscle
