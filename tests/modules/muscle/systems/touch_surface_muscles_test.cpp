// Surface muscles' contacts with themselves and with each other, through the whole step.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/self_intersections.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/components/surface_neighbours.hpp"
#include "tests/modules/muscle/systems/surface_world.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/sheet.hpp"

namespace fascicle::muscle {
namespace {

glm::mat4 at(const glm::vec3& place) { return glm::translate(glm::mat4(1.0f), place); }

TriangleMesh drawn(SurfaceWorld& w, std::size_t i) {
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < w.asset(i).vertex_count; ++v) mesh.positions.push_back(w.world_point(v, i));
  mesh.indices = w.asset(i).triangles;
  return mesh;
}

std::size_t crossings(const TriangleMesh& mesh) {
  return find_self_intersections(mesh.positions, mesh.indices, 100000).pairs;
}

// m: how deep the deepest vertex of one is in the other.
float depth(const TriangleMesh& of, const TriangleMesh& in) {
  const ClosestPoints closest(in);
  const WindingField winding(in);
  float deepest = 0.0f;
  for (const glm::vec3& p : of.positions) {
    if (winding.inside(p)) deepest = std::max(deepest, closest.at(p).distance);
  }
  return deepest;
}

// A ball of 5 cm about (0, 0, 0) that bone 0 holds from below, or about (0, 0, 0.11) that bone 1 holds from above.
SurfaceMuscleDescription held_ball(bool above, bool contacts, float height = 0.11f) {
  SurfaceMuscleDescription ball;
  ball.name = above ? "above" : "below";
  ball.mesh = test::make_sphere(0.05f, 20, 30, {0.0f, 0.0f, above ? height : 0.0f});
  SurfaceAttachment attachment{.bone = above ? 1 : 0, .origin = true, .vertices = {}};
  for (std::uint32_t v = 0; v < ball.mesh.positions.size(); ++v) {
    const float z = ball.mesh.positions[v].z;
    if (above ? z > height + 0.035f : z < -0.035f) attachment.vertices.push_back(v);
  }
  ball.attachments = {attachment};
  ball.settings.collide_with_muscles = contacts;
  return ball;
}

// Bone 1 comes down by 4 cm, over 100 steps; the balls are 1 cm apart.
struct PressedBalls : SurfaceWorld {
  explicit PressedBalls(bool contacts, int workers = 1, std::int32_t frame = 0, int frames = 100)
      : SurfaceWorld(still_bones(2), {}, workers) {
    add(held_ball(false, contacts));
    SurfaceMuscleDescription above = held_ball(true, contacts);
    above.frame_bone = frame;
    add(above);
    bring(1, at({0.0f, 0.0f, -0.04f}), frames);
  }
};

TEST(TouchSurfaceMuscles, TwoThatArePressedTogetherDoNotGoIntoEachOther) {
  PressedBalls apart(true);
  EXPECT_LT(depth(drawn(apart, 0), drawn(apart, 1)), 1e-5f);
  EXPECT_LT(depth(drawn(apart, 1), drawn(apart, 0)), 1e-5f);
  EXPECT_EQ(crossings(test::join(drawn(apart, 0), drawn(apart, 1))), 0u);
  EXPECT_NEAR(apart.volume_ratio(0), 1.0, 0.005);
  EXPECT_NEAR(apart.volume_ratio(1), 1.0, 0.005);
  EXPECT_EQ(apart.state(0).fallbacks + apart.state(1).fallbacks, 0u);
  EXPECT_EQ(apart.world.get<SurfaceNeighbours>(apart.character).pairs[0].pairs.overflows, 0u);
  // Both give way.
  EXPECT_GT(apart.rest_distance(0), 0.005f);

  PressedBalls through(false);
  EXPECT_GT(depth(drawn(through, 0), drawn(through, 1)), 0.02f);
  EXPECT_GT(crossings(test::join(drawn(through, 0), drawn(through, 1))), 50u);
}

TEST(TouchSurfaceMuscles, WhatIsReleasedComesBack) {
  PressedBalls w(true);
  w.bring(1, at({0.0f, 0.0f, 0.0f}), 100);
  w.steps(200);
  EXPECT_LT(w.rest_distance(0), 0.0003f);
  EXPECT_LT(w.rest_distance(1), 0.0003f);
}

TEST(TouchSurfaceMuscles, InFramesOfTheirOwnTheyDoTheSame) {
  PressedBalls one(true), two(true, 1, 1);
  ASSERT_NE(two.state(0).frame, two.state(1).frame);
  float furthest = 0.0f;
  for (std::uint32_t v = 0; v < one.asset(1).vertex_count; ++v) {
    furthest = std::max(furthest, glm::distance(one.world_point(v, 1), two.world_point(v, 1)));
  }
  EXPECT_LT(furthest, 0.003f);  // of 40 mm: what is inert lags behind in another frame
  EXPECT_LT(depth(drawn(two, 0), drawn(two, 1)), 1e-5f);
  EXPECT_LT(depth(drawn(two, 1), drawn(two, 0)), 1e-5f);
}

// The frame bone of one goes about by centimetres a step, and neither muscle has anything to do with that.
TEST(TouchSurfaceMuscles, AFrameThatMovesMakesNoContacts) {
  SurfaceWorld w(still_bones(2));
  w.add(held_ball(false, true));
  SurfaceMuscleDescription above = held_ball(true, true, 0.1015f);
  above.attachments[0].bone = 0;
  above.frame_bone = 1;
  w.add(above);
  std::uint32_t pushed = 0;
  for (int i = 0; i < 60; ++i) {
    const float t = 0.4f * static_cast<float>(i);
    w.bones[1] = glm::rotate(at({0.05f * std::sin(t), 0.0f, 0.04f * std::sin(2.0f * t)}), 0.3f * std::sin(t), {0, 1, 0});
    w.steps(1);
    pushed += w.world.get<SurfaceNeighbours>(w.character).pairs[0].pairs.pushed;
    for (std::uint32_t v = 0; v < w.asset(1).vertex_count; ++v) {
      ASSERT_LT(glm::distance(w.world_point(v, 1), w.rest_point(v, 1)), 0.0005f) << i;
    }
  }
  EXPECT_EQ(pushed, 0u);
  EXPECT_LT(w.rest_distance(0), 0.0002f);  // within a step a motion and its inverse do not take quite the same way
}

TEST(TouchSurfaceMuscles, WhatOverlapsAtRestStaysExactly) {
  SurfaceWorld w(still_bones(2));
  SurfaceMuscleDescription below = held_ball(false, true), above = held_ball(true, true, 0.097f);
  below.settings.collide_with_itself = above.settings.collide_with_itself = true;
  w.add(below);
  w.add(above);
  ASSERT_GT(depth(drawn(w, 0), drawn(w, 1)), 0.002f);
  w.steps(300);
  EXPECT_EQ(w.rest_distance(0), 0.0f);
  EXPECT_EQ(w.rest_distance(1), 0.0f);
  ASSERT_FALSE(w.world.get<SurfaceNeighbours>(w.character).pairs[0].pairs.pairs.empty());
  // As deep as at rest, no deeper.
  w.bring(1, at({0.0f, 0.0f, -0.02f}), 60);
  EXPECT_LT(depth(drawn(w, 0), drawn(w, 1)), 0.0035f);
}

TEST(TouchSurfaceMuscles, TheSameForAnyNumberOfWorkersWithoutAllocation) {
  const auto run = [](int workers) {
    PressedBalls w(true, workers, 0, 40);
    w.steps(1);
    const test::AllocationScope scope;
    for (int i = 0; i < 20; ++i) w.step();
    EXPECT_TRUE(workers > 1 || scope.allocations() == 0) << scope.allocations();  // oneTBB allocates tasks as it likes
    return hash_surface_state(w.world);
  };
  const std::uint64_t expected = run(1);
  EXPECT_EQ(run(2), expected);
  EXPECT_EQ(run(5), expected);
}

TEST(TouchSurfaceMuscles, OneThatGoesLeavesTheOthers) {
  SurfaceWorld w(still_bones(2));
  for (int i = 0; i < 3; ++i) w.add(held_ball(i != 0, true, i == 2 ? 0.3f : 0.11f));
  EXPECT_EQ(w.world.get<SurfaceNeighbours>(w.character).pairs.size(), 3u);
  w.steps(2);
  despawn_surface_muscle(w.world, w.muscles[0]);
  w.muscles.erase(w.muscles.begin());
  const SurfaceNeighbours& left = w.world.get<SurfaceNeighbours>(w.character);
  ASSERT_EQ(left.pairs.size(), 1u);
  EXPECT_EQ(left.pairs[0].first, 0u);
  EXPECT_EQ(left.pairs[0].second, 1u);
  w.steps(2);
  w.world.destroy(w.muscles[0]);  // without a word
  w.steps(2);
  EXPECT_EQ(w.state(1).fallbacks, 0u);
  EXPECT_EQ(w.rest_distance(1), 0.0f);
}

TEST(TouchSurfaceMuscles, ThoseThatDoNotCollideHaveNoNeighbours) {
  PressedBalls w(false, 1, 0, 1);
  EXPECT_EQ(w.world.try_get<SurfaceNeighbours>(w.character), nullptr);
}

// A sheet 80 mm long and 2 mm thick. Bone 0 holds its left end, bone 1 the right one, which turns over and comes down on
// the middle of the left half, and 6 mm on.
struct FoldedSheet : SurfaceWorld {
  explicit FoldedSheet(bool contacts) : SurfaceWorld(still_bones(2)) {
    SurfaceMuscleDescription sheet;
    sheet.name = "sheet";
    sheet.mesh = test::make_sheet({0.08f, 0.002f, 0.02f}, 48, 12);
    SurfaceAttachment left{.bone = 0, .origin = true, .vertices = {}}, right{.bone = 1, .origin = false, .vertices = {}};
    for (std::uint32_t v = 0; v < sheet.mesh.positions.size(); ++v) {
      if (sheet.mesh.positions[v].x < 0.006f) left.vertices.push_back(v);
      if (sheet.mesh.positions[v].x > 0.074f) right.vertices.push_back(v);
    }
    sheet.attachments = {left, right};
    sheet.settings.collide_with_itself = contacts;
    sheet.settings.anchor_compliance = 0.0f;
    add(sheet);
    constexpr int kFrames = 150;
    for (int i = 1; i <= kFrames; ++i) {
      const float t = static_cast<float>(i) / kFrames, turn = std::min(1.25f * t, 1.0f) * std::numbers::pi_v<float>;
      const float down = std::max(t - 0.8f, 0.0f) / 0.2f;
      // The end goes round in a half circle about (45 mm, 6 mm) and then down.
      const glm::vec3 centre(0.045f, 0.006f, 0.0f);
      const glm::vec3 place = centre + 0.024f * glm::vec3(std::cos(turn), std::sin(turn), 0.0f) +
                              glm::vec3(0.006f * (1.0f - t), -0.006f * (1.0f - std::min(1.25f * t, 1.0f)), 0.0f) +
                              glm::vec3(0.0f, -0.012f * down, 0.0f);
      bones[1] = glm::rotate(at(place), turn, glm::vec3(0, 0, 1)) * at({-0.075f, 0.0f, 0.0f});
      steps(1);
    }
    steps(10);
  }
};

TEST(TouchSurfaceMuscles, AFoldedSheetDoesNotPassThroughItself) {
  FoldedSheet kept(true);
  EXPECT_EQ(kept.state().fallbacks, 0u);
  EXPECT_EQ(kept.state().scratch.itself.overflows, 0u);
  EXPECT_EQ(crossings(drawn(kept, 0)), 0u);
  FoldedSheet through(false);
  EXPECT_GT(crossings(drawn(through, 0)), 50u);
}

TEST(TouchSurfaceMuscles, AGameMaySwitchContactsWithItselfOn) {
  SurfaceMuscleDescription sheet;
  sheet.mesh = test::make_sheet({0.04f, 0.0006f, 0.02f}, 24, 12);
  SurfaceWorld w(still_bones(1));
  w.add(sheet);
  w.steps(2);
  EXPECT_TRUE(w.state().scratch.itself.pairs.empty());
  w.world.get<SurfaceMuscle>(w.muscles[0]).settings.collide_with_itself = true;
  w.steps(2);
  EXPECT_FALSE(w.state().scratch.itself.pairs.empty());
  EXPECT_EQ(w.rest_distance(), 0.0f);
}

}  // namespace
}  // namespace fascicle::muscle
