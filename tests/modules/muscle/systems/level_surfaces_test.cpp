// Nothing pops: where a level is exchanged for the next, both draw the same, in any pose.
#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/leveled_state.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::LeveledState;
using test::SurfaceGap;

void step(LeveledState& state, const std::vector<glm::mat4>& bones) {
  state.step(mtu_kernels(detect_simd()), bones, true);
}

TEST(LevelSurfaces, AMorphedLevelDrawsTheNextAtRest) {
  for (const float noise : {0.0f, 0.1f}) {
    const auto levels = test::synthetic_levels({36, 3}, 3, noise);
    for (std::uint32_t level = 0; level < 2; ++level) {
      LeveledState plain(levels, {level, 0.0f}), fine(levels, {level, 1.0f}), coarse(levels, {level + 1, 0.0f});
      for (LeveledState* state : {&plain, &fine, &coarse}) step(*state, test::rest_bones());
      const SurfaceGap morphed(fine, coarse), abrupt(plain, coarse);
      EXPECT_LT(morphed.percentile(0.99f), 2.0e-4f) << level;
      EXPECT_LT(morphed.max(), 1.0e-3f) << level;
      EXPECT_GT(abrupt.max(), 3.0e-3f) << level;
    }
  }
}

// Sections that go keep the radii that they have at rest, where the coarser surface narrows as the line bends: a gap
// grows with the bend. These lines bend by up to 118 degrees between two sections; half the gap is below 0.1 mm.
TEST(LevelSurfaces, AMorphedLevelDrawsAlmostTheNextInAWalk) {
  const auto levels = test::synthetic_levels();
  for (std::uint32_t level = 0; level < 2; ++level) {
    LeveledState fine(levels, {level, 1.0f}), coarse(levels, {level + 1, 0.0f});
    for (int pose = 0; pose < 6; ++pose) {
      const std::vector<glm::mat4> bones = test::walk_bones(static_cast<float>(pose) / 6.0f);
      for (LeveledState* state : {&fine, &coarse}) step(*state, bones);
      const SurfaceGap morphed(fine, coarse);
      EXPECT_LT(morphed.percentile(0.5f), 1.0e-4f);
      EXPECT_LT(morphed.percentile(0.95f), 1.0e-3f);
    }
  }
}

// The largest distance by which a frame moves the surface while nothing but the level changes.
float largest_jump(const std::shared_ptr<const MuscleLevels>& levels, bool morphs) {
  constexpr int kFrames = 60;
  const std::vector<glm::mat4> bones = test::rest_bones();
  LeveledState before(levels), now(levels);
  step(before, bones);
  float largest = 0.0f;
  for (int frame = 0; frame < kFrames; ++frame) {
    const float away = 1.3f * levels->morphs.back().complete * static_cast<float>(frame) / kFrames;
    LevelChoice choice = choose_level(*levels, away, 1.0f);
    if (!morphs) choice.morph = 0.0f;
    now.set(choice);
    step(now, bones);
    largest = std::max(largest, SurfaceGap(before, now).max());
    before.set(choice);
    step(before, bones);
  }
  return largest;
}

TEST(LevelSurfaces, ARecedingCharacterNeverJumps) {
  const auto levels = test::synthetic_levels({24, 1}, 2);
  const float jump = largest_jump(levels, true), abrupt = largest_jump(levels, false);
  EXPECT_LT(jump, 0.1f * abrupt);
}

}  // namespace
}  // namespace fascicle::muscle
