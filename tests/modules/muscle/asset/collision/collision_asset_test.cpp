// Where a collision asset has its samples, and what it says of the rest pose.
#include "modules/muscle/asset/collision/collision_asset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "tests/support/analytic_bones.hpp"
#include "tests/support/collision_rods.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace fascicle::muscle {
namespace {

// The lower body with bent lines and lobed sections; without tendons its drawn rows are its sections.
std::shared_ptr<const MuscleAsset> body(bool tendons = true) {
  std::vector<MuscleDescription> descriptions = test::synthetic_muscles(12, 2);
  for (MuscleDescription& description : descriptions) {
    if (!tendons) description.tendon_at_origin = description.tendon_at_insertion = 0.0f;
  }
  return test::synthetic_level(descriptions);
}

std::shared_ptr<const CollisionAsset> collision_of(std::shared_ptr<const MuscleAsset> muscles, float spacing) {
  CollisionDescription description;
  description.settings.sample_spacing = spacing;
  const test::BoneFields fields(test::kSyntheticBones);
  return build_collision_asset(std::move(muscles), description, fields, test::rest_bones());
}

// Row k, vertex i at rest.
glm::vec3 vertex_at_rest(const MuscleAsset& muscles, std::uint32_t m, std::uint32_t k, std::uint32_t i) {
  const std::uint32_t slot = muscles.slot(m, k);
  const Circle& circle = muscles.circles[muscles.layouts[m].circle];
  const glm::vec3 u(muscles.rest_ux[slot], muscles.rest_uy[slot], muscles.rest_uz[slot]);
  const glm::vec3 v(muscles.rest_vx[slot], muscles.rest_vy[slot], muscles.rest_vz[slot]);
  return rest_point(muscles, m, k) +
         muscles.rest_radii[muscles.radius(m, k) + i] * (circle.cosines[i] * u + circle.sines[i] * v);
}

float distance_to_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 normal = glm::cross(b - a, c - a);
  const float area2 = glm::length(normal);
  if (area2 < 1.0e-12f) return std::numeric_limits<float>::max();
  const glm::vec3 n = normal / area2;
  const float w0 = glm::dot(glm::cross(c - b, p - b), n), w1 = glm::dot(glm::cross(a - c, p - c), n),
              w2 = glm::dot(glm::cross(b - a, p - a), n);
  const float slack = -1.0e-4f * area2 - 1.0e-9f;
  if (w0 < slack || w1 < slack || w2 < slack) return std::numeric_limits<float>::max();
  return std::abs(glm::dot(p - a, n));
}

TEST(CollisionAsset, WeightsAddUpAndFavourNobodyTwice) {
  for (float along = 0.0f; along <= 1.0f; along += 0.125f) {
    for (float around = 0.0f; around <= 1.0f; around += 0.125f) {
      const SampleWeights w = sample_weights(along, around);
      float sum = 0.0f;
      for (const float weight : w.of) {
        EXPECT_GE(weight, 0.0f);
        sum += weight;
      }
      EXPECT_FLOAT_EQ(sum, 1.0f);
      EXPECT_FLOAT_EQ(w.of[2] + w.of[3], along);
      EXPECT_FLOAT_EQ(w.of[1] + w.of[3], around);
      EXPECT_TRUE(w.of[1] == 0.0f || w.of[2] == 0.0f);  // one triangle
    }
  }
}

TEST(CollisionAsset, SamplesLieOnDrawnTriangles) {
  const auto muscles = body(false);
  const auto asset = collision_of(muscles, 0.006f);
  test::CollisionState state(asset, test::kSyntheticBones);
  int between = 0;
  for (const SampleRow& row : asset->rows) {
    const CollisionSection& section = asset->sections[row.section];
    const std::uint32_t m = section.muscle, count = section.count;
    const MuscleLayout& layout = muscles->muscles[m];
    ASSERT_FALSE(layout.tendon_drawn[0] || layout.tendon_drawn[1]);
    // The strip of this segment: 2 (|C| + 1) indices a segment, row after row.
    const std::uint32_t k = row.weight > 0.0f ? section.section : section.section - 1;
    const std::uint32_t row_length = layout.strip_index_count / (layout.section_count - 1);
    const std::uint32_t* strip = &muscles->strip_indices[layout.first_strip_index + k * row_length];
    const auto drawn = [&](std::uint32_t index) {
      const std::uint32_t vertex = index - layout.first_vertex;
      return vertex_at_rest(*muscles, m, vertex / count, vertex % count);
    };
    for (std::uint32_t i = 0; i < row.sample_count; ++i) {
      const std::uint32_t s = row.first_sample + i;
      const glm::vec3 p(state.work.sample_x[s], state.work.sample_y[s], state.work.sample_z[s]);
      float nearest = std::numeric_limits<float>::max();
      for (std::uint32_t j = 2; j < row_length && strip[j] != kRestartIndex; ++j) {
        nearest = std::min(nearest, distance_to_triangle(p, drawn(strip[j - 2]), drawn(strip[j - 1]), drawn(strip[j])));
      }
      ASSERT_LT(nearest, 2.0e-6f) << layout.name << " section " << k << " weight " << row.weight;
      between += row.weight > 0.0f && asset->samples[s].fraction > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 100);
}

TEST(CollisionAsset, SpacingIsKeptAndEndsAreLeftOut) {
  for (const float spacing : {0.004f, 0.012f, 0.05f}) {
    const auto muscles = test::build_rods({{.from = {0, 0, -0.15f}, .to = {0, 0, 0.15f}, .section_vertices = 8,
                                            .subdivision = 2}}, 1);
    const auto asset = test::build_collision(muscles, {nullptr}, [&] {
      CollisionDescription description;
      description.settings.sample_spacing = spacing;
      return description;
    }());
    ASSERT_FALSE(asset->rows.empty());
    float before = -1.0f;
    const float segment = 0.3f / 4.0f;
    for (const SampleRow& row : asset->rows) {
      const float at = segment * (static_cast<float>(row.section) + row.weight);
      EXPECT_GE(at, 0.5f * segment - 1.0e-5f);
      EXPECT_LE(at, 0.3f - 0.5f * segment + 1.0e-5f);
      EXPECT_GT(at, before);
      if (before >= 0.0f) {
        EXPECT_LE(at - before, spacing + 1.0e-5f);
      }
      before = at;
      // Round the section: half as far again at most, for whole numbers of parts.
      const float edge = 2.0f * 0.02f * std::sin(3.14159265f / 8.0f);
      const float parts = static_cast<float>(row.sample_count) / 8.0f;
      EXPECT_LE(edge / parts, std::max(1.5f * spacing, 1.0e-6f));
    }
  }
}

TEST(CollisionAsset, EveryInnerSectionHasItsRow) {
  const auto muscles = body();
  const auto asset = collision_of(muscles, 0.012f);
  ASSERT_EQ(asset->first_section.size(), muscles->size() + 1);
  EXPECT_EQ(asset->first_section.back(), asset->sections.size());
  EXPECT_EQ(asset->first_row.back(), asset->rows.size());
  std::uint32_t next_sample = 0;
  for (const SampleRow& row : asset->rows) {
    EXPECT_EQ(row.first_sample, next_sample);
    next_sample += row.sample_count;
    EXPECT_LE(row.sample_count, kMaxRowSamples);
    EXPECT_GE(row.sample_count, asset->sections[row.section].count);
    if (row.weight > 0.0f) {
      EXPECT_EQ(asset->sections[row.section + 1].muscle, asset->sections[row.section].muscle);
    }
  }
  EXPECT_EQ(next_sample, asset->samples.size());
  for (std::uint32_t s = 0; s < asset->sections.size(); ++s) {
    const CollisionSection& section = asset->sections[s];
    const auto rows = std::count_if(asset->rows.begin(), asset->rows.end(), [&](const SampleRow& row) {
      return row.section == s && row.weight == 0.0f;
    });
    EXPECT_EQ(rows, section.end ? 0 : 1);
    EXPECT_GT(section.rest_area, 0.0f);
    EXPECT_GE(section.belly, 0.0f);
    EXPECT_LE(section.belly, 1.0f);
  }
}

TEST(CollisionAsset, NothingCollidesAtRest) {
  // Muscles of the lower body overlap each other at rest, and a bone runs through them: all of it is allowed.
  const auto muscles = body();
  test::BoneFields fields(test::kSyntheticBones);
  fields[test::kFemurLeft] = test::box_bone({-0.02f, -0.40f, -0.02f}, {0.02f, -0.02f, 0.02f});
  CollisionDescription description;
  const auto asset = build_collision_asset(muscles, description, fields, test::rest_bones());
  EXPECT_FALSE(asset->overlaps.empty());
  test::CollisionState state(asset, 0);
  state.bones = test::rest_bones();
  state.work.contacts.reserve(200000);
  state.find();
  EXPECT_FALSE(state.work.overflow);
  ASSERT_FALSE(state.work.contacts.empty());
  EXPECT_LE(state.deepest(), 1.0e-6f);
  for (const float depth : asset->rest_depths) EXPECT_GE(depth, 0.0f);
}

TEST(CollisionAsset, TwoSectionsAreEnough) {
  const auto muscles = test::build_rods({{.from = {0, 0, 0}, .to = {0, 0, 0.1f}, .subdivision = 0}}, 1);
  const auto asset = test::build_collision(muscles, {nullptr});
  EXPECT_EQ(asset->sections.size(), 2u);
  EXPECT_TRUE(asset->sections[0].end && asset->sections[1].end);
  test::CollisionState state(asset, 1);
  state.find();
  EXPECT_TRUE(state.work.contacts.empty());
}

TEST(CollisionAsset, IsTheSameEveryTime) {
  const auto first = collision_of(body(), 0.012f), second = collision_of(body(), 0.012f);
  EXPECT_EQ(first->rest_depths, second->rest_depths);
  EXPECT_EQ(first->first_overlap, second->first_overlap);
  EXPECT_EQ(first->row_bone_depths, second->row_bone_depths);
  EXPECT_GT(heap_bytes(*first), first->samples.size() * sizeof(SurfaceSample));
}

}  // namespace
}  // namespace fascicle::muscle
