// The committed walker's levels of detail, as they are loaded: nothing pops where one takes another's place, through
// its walk; what coarser levels save.
#include <cmath>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/clip.hpp"
#include "engine/animation/skeleton.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "tests/support/leveled_state.hpp"

namespace fascicle::muscle {
namespace {

using test::LeveledState;
using test::SurfaceGap;

constexpr int kPoses = 6;

const CharacterAsset& walker() {
  static const auto loaded = load_character(std::filesystem::path(FASCICLE_SOURCE_DIR) /
                                            "content/characters/walker/walker.character.json");
  if (!loaded.ok()) throw std::runtime_error(to_text(loaded.diagnostics()));
  return **loaded;
}

// Of the clip's pose at `way` through it, 0..1.
std::vector<glm::mat4> walk_pose(float way) {
  const Skeleton& skeleton = *walker().skeleton;
  const Clip& clip = *walker().clips.front();
  std::vector<Trs> local = skeleton.rest_local;
  sample_clip(clip, clip.start + way * clip.duration(), local);
  std::vector<glm::mat4> bones(local.size());
  compose(skeleton, local, glm::mat4(1.0f), bones);
  return bones;
}

void step(LeveledState& state, const std::vector<glm::mat4>& bones, bool restart_twist = true) {
  state.step(mtu_kernels(detect_simd()), bones, restart_twist);
}

TEST(WalkerLevels, EachHasFewerVertices) {
  const MuscleLevels& levels = *walker().levels;
  ASSERT_GE(levels.assets.size(), 2u);
  EXPECT_EQ(levels.assets.front(), walker().muscles);
  for (std::size_t level = 1; level < levels.assets.size(); ++level) {
    EXPECT_LT(levels.assets[level]->vertex_count, levels.assets[level - 1]->vertex_count);
  }
}

// A pixel is as large as the morph's completion says: where the next level takes over, what changes lies under it.
TEST(WalkerLevels, AnExchangeChangesLessThanAPixelInAWalk) {
  const std::shared_ptr<const MuscleLevels> levels = walker().levels;
  for (std::uint32_t level = 0; level + 1 < levels->assets.size(); ++level) {
    const float pixel = levels->morphs[level].complete;
    LeveledState plain(levels, {level, 0.0f}), fine(levels, {level, 1.0f}), coarse(levels, {level + 1, 0.0f});
    for (int pose = 0; pose <= kPoses; ++pose) {
      const std::vector<glm::mat4> bones =
          pose == 0 ? walker().skeleton->rest_world : walk_pose(static_cast<float>(pose) / kPoses);
      for (LeveledState* state : {&plain, &fine, &coarse}) step(*state, bones);
      const SurfaceGap morphed(fine, coarse), abrupt(plain, coarse);
      EXPECT_LT(morphed.percentile(0.99f), 0.25f * pixel) << "level " << level << ", pose " << pose;
      EXPECT_LT(morphed.max(), pixel) << "level " << level << ", pose " << pose;
      EXPECT_LT(morphed.rms(), 0.2f * abrupt.rms());
    }
  }
}

// The walker recedes at 5 m/s through all its levels: what the level's change adds to a step, in pixels as they are
// then, beside what an exchange without a morph would add.
TEST(WalkerLevels, ARecedingWalkerNeverJumps) {
  const std::shared_ptr<const MuscleLevels> levels = walker().levels;
  const float speed = 5.0f / 60.0f;       // m a step
  const float pixels_per_radian = 1000.0f;
  for (const bool morphs : {true, false}) {
    LeveledState before(levels), now(levels);
    LevelChoice was;
    float most = 0.0f;
    for (float distance = 1.0f; was.level + 1 < levels->assets.size(); distance += speed) {
      const float pixel = distance / pixels_per_radian;
      LevelChoice choice = choose_level(*levels, pixel, 1.0f);
      if (!morphs) choice.morph = 0.0f;
      if (choice.level != was.level || choice.morph != was.morph) {
        const std::vector<glm::mat4> bones = walk_pose(std::fmod(distance, 1.0f));
        before.set(was);
        now.set(choice);
        step(before, bones, false);
        step(now, bones, false);
        const SurfaceGap gap(before, now);
        most = std::max(most, gap.percentile(0.99f) / pixel);
      }
      was = choice;
    }
    if (morphs) EXPECT_LT(most, 0.25f);
    else EXPECT_GT(most, 0.5f);
  }
}

}  // namespace
}  // namespace fascicle::muscle
