// Counts (table 3), rest places, bindings, tendon lengths (1.4).
#include "modules/muscle/asset/build_muscle_asset.hpp"

#include <gtest/gtest.h>

#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

std::shared_ptr<const MuscleAsset> build(std::uint32_t section_vertices, std::uint32_t subdivision) {
  const auto result =
      build_muscle_asset(test::synthetic_muscles(section_vertices, subdivision), test::rest_bones());
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
  return result.ok() ? *result : nullptr;
}

TEST(BuildMuscleAsset, CountsAreTableThree) {
  struct Entry {
    std::uint32_t subdivision, section_vertices, sections, vertices;
  };
  const std::array<Entry, 13> table = {{{0, 6, 144, 960},   {0, 8, 144, 1248},  {0, 10, 144, 1536}, {0, 12, 144, 1824},
                                        {1, 6, 240, 1536},  {1, 8, 240, 2016},  {1, 10, 240, 2496}, {1, 12, 240, 2976},
                                        {1, 36, 240, 8736}, {2, 6, 432, 2688},  {2, 8, 432, 3552},  {2, 10, 432, 4416},
                                        {2, 12, 432, 5280}}};
  for (const Entry& entry : table) {
    const auto asset = build(entry.section_vertices, entry.subdivision);
    ASSERT_NE(asset, nullptr);
    const MuscleCounts counts = count_muscles(*asset);
    EXPECT_EQ(counts.muscles, 48u);
    EXPECT_EQ(counts.sections, entry.sections);
    EXPECT_EQ(counts.vertices, entry.vertices);
    // What is drawn has the tendon sections on top, one a muscle.
    EXPECT_EQ(asset->vertex_count, entry.vertices + 48 * entry.section_vertices);
  }
}

TEST(BuildMuscleAsset, ExtraViaPointsAreLeftOutOfTheCounts) {
  std::vector<MuscleDescription> muscles = test::synthetic_muscles(8, 1);
  const auto before = build_muscle_asset(muscles, test::rest_bones());
  muscles[0].attachments.insert(muscles[0].attachments.begin() + 1,
                                AttachmentDescription{0, {0.1f, -0.05f, 0.1f}, false});
  const auto after = build_muscle_asset(muscles, test::rest_bones());
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_EQ(count_muscles(**before).vertices, count_muscles(**after).vertices);
  EXPECT_EQ((*before)->muscles[0].section_count + 2, (*after)->muscles[0].section_count);
}

TEST(BuildMuscleAsset, RestPointsAreTheAttachmentsAndTheirMidpoints) {
  const std::vector<MuscleDescription> muscles = test::synthetic_muscles(8, 2);
  const std::vector<glm::mat4> bones = test::rest_bones();
  const auto asset = build(8, 2);
  for (std::uint32_t m = 0; m < muscles.size(); ++m) {
    for (std::uint32_t k = 0; k < asset->muscles[m].section_count; ++k) {
      const auto place = [&](std::uint32_t i) {
        const AttachmentDescription& a = muscles[m].attachments[i];
        return glm::vec3(bones[static_cast<std::size_t>(a.bone)] * glm::vec4(a.position, 1.0f));
      };
      const float s = static_cast<float>(k % 4) / 4.0f;
      const glm::vec3 expected = k % 4 == 0 ? place(k / 4) : glm::mix(place(k / 4), place(k / 4 + 1), s);
      EXPECT_LT(glm::distance(rest_point(*asset, m, k), expected), 1.0e-6f) << m << " " << k;
    }
  }
}

TEST(BuildMuscleAsset, SlotsAreDistinctAndWithinTheirBlocks) {
  const auto asset = build(8, 1);
  std::vector<int> used(asset->slot_count, 0);
  for (std::uint32_t m = 0; m < asset->size(); ++m) {
    for (std::uint32_t k = 0; k < asset->muscles[m].section_count; ++k) ++used[asset->slot(m, k)];
    const LaneBlock& block = asset->blocks[asset->muscles[m].lane_index / kLanes];
    EXPECT_EQ(block.muscles[asset->muscles[m].lane_index % kLanes], static_cast<int>(m));
    EXPECT_LE(asset->muscles[m].section_count, block.height);
  }
  int sum = 0;
  for (const int count : used) {
    EXPECT_LE(count, 1);
    sum += count;
  }
  EXPECT_EQ(sum, 240);
  // A muscle with via points has its attachments a second time, where nothing displaces them.
  std::size_t attachments = 0;
  for (const MuscleLayout& muscle : asset->muscles) {
    if (muscle.attachment_count > 2) attachments += muscle.attachment_count;
  }
  EXPECT_GT(attachments, 0u);
  EXPECT_EQ(asset->points.size(), 240u + attachments);
}

TEST(BuildMuscleAsset, TendonOfTibialisAnterior) {
  // Method 1.4: the line is .292 long on the character, .303 in the model.
  MuscleDescription muscle;
  muscle.name = "tibialis_anterior";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.2f, 0.0f}, true}, {0, {0.0f, -0.292f, 0.0f}, true}};
  muscle.hill = {603.0f, 0.098f, 0.223f, 0.087f};
  muscle.source_length = 0.303f;
  const auto result = build_muscle_asset(std::vector{muscle}, std::vector{glm::mat4(1.0f)});
  ASSERT_TRUE(result.ok()) << to_text(result.diagnostics());
  const MuscleLayout& layout = (*result)->muscles[0];
  EXPECT_NEAR(layout.rest_length, 0.292f, 1.0e-6f);
  EXPECT_NEAR(layout.source_rest_length, 0.3206f, 5.0e-5f);
  EXPECT_NEAR(layout.scaled_rest_length, 0.309f, 5.0e-4f);
  EXPECT_NEAR(layout.scaled_tendon_slack_length, 0.215f, 5.0e-4f);
  EXPECT_NEAR(layout.tendon_lengths[1], 0.107f, 5.0e-4f);
  EXPECT_EQ(layout.tendon_lengths[0], 0.0f);
  EXPECT_TRUE(layout.tendon_drawn[1]);
  EXPECT_FALSE(layout.tendon_drawn[0]);
}

TEST(BuildMuscleAsset, FindsMusclesByName) {
  const auto asset = build(8, 1);
  EXPECT_EQ(find_muscle(*asset, "left_0"), 0);
  EXPECT_EQ(find_muscle(*asset, "right_23"), 47);
  EXPECT_EQ(find_muscle(*asset, "nobody"), -1);
}

TEST(BuildMuscleAsset, DisplacementsMoveTheDrawnLineAlone) {
  const std::vector<MuscleDescription> muscles = test::synthetic_muscles(8, 1);
  const auto plain = build(8, 1);
  std::vector<MuscleFit> fits(muscles.size());
  const std::uint32_t m = 23;  // five via points
  fits[m].displacements.assign(plain->muscles[m].section_count, glm::vec3(0.01f, -0.02f, 0.03f));
  const auto moved = build_muscle_asset(muscles, test::rest_bones(), fits);
  ASSERT_TRUE(moved.ok());
  for (std::uint32_t k = 0; k < plain->muscles[m].section_count; ++k) {
    const glm::vec3 expected = rest_point(*plain, m, k) + glm::vec3(0.01f, -0.02f, 0.03f);
    EXPECT_LT(glm::distance(rest_point(**moved, m, k), expected), 1.0e-6f);
  }
  // The attachments that the functional length reads stayed.
  const MuscleLayout& layout = (*moved)->muscles[m];
  EXPECT_GE(layout.first_attachment_slot, 16u * 13u);
  EXPECT_EQ((*moved)->rest_x[layout.first_attachment_slot], rest_point(*plain, m, 0).x);
}

}  // namespace
}  // namespace fascicle::muscle
