// Muscles against muscles: overlaps that are known, and the grid against a search over everything.
#include "modules/muscle/kernels/collision/muscle_contacts.hpp"

#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/kernels/collision/contact_rows.hpp"
#include "modules/muscle/kernels/collision/section_outline.hpp"
#include "tests/support/collision_rods.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kSagitta = 0.00005f;  // m: of two circles of 20 mm with 64 vertices

using Touch = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // row, sample, other muscle

std::set<Touch> touches(const test::CollisionState& state, float least_depth) {
  std::set<Touch> found;
  for (const Contact& contact : state.work.contacts) {
    if (contact.bone >= 0 || -contact.found < least_depth) continue;
    found.insert({contact.row, contact.sample, state.asset->sections[contact.other_section].muscle});
  }
  return found;
}

// Every sample against every segment of every other muscle.
std::set<Touch> search(const test::CollisionState& state, float least_depth, float reach) {
  const CollisionAsset& asset = *state.asset;
  const CollisionWork& work = state.work;
  std::set<Touch> found;
  for (std::uint32_t r = 0; r < asset.rows.size(); ++r) {
    const std::uint32_t m = asset.sections[asset.rows[r].section].muscle;
    for (std::uint32_t i = 0; i < asset.rows[r].sample_count; ++i) {
      const std::uint32_t s = asset.rows[r].first_sample + i;
      const glm::vec3 p(work.sample_x[s], work.sample_y[s], work.sample_z[s]);
      for (std::uint32_t n = 0; n + 1 < asset.sections.size(); ++n) {
        const std::uint32_t other = asset.sections[n].muscle;
        if (other == m || asset.sections[n + 1].muscle != other) continue;
        const float before = glm::dot(p - work.a[n], work.t[n]), behind = glm::dot(p - work.a[n + 1], work.t[n + 1]);
        if (before < 0.0f || behind >= 0.0f) continue;
        OutlineSegment segment;
        segment.count = asset.sections[n].count;
        for (std::uint32_t k = 0; k < 2; ++k) {
          segment.x[k] = &work.vertex_x[asset.sections[n + k].first_radius];
          segment.y[k] = &work.vertex_y[asset.sections[n + k].first_radius];
          segment.z[k] = &work.vertex_z[asset.sections[n + k].first_radius];
          segment.u[k] = work.u[n + k];
          segment.v[k] = work.v[n + k];
        }
        OutlinePoint point;
        const glm::vec3 outward = sample_normal(asset, work, r, i);
        if (find_outline_point(segment, before / (before - behind), p, outward, reach, point) &&
            -point.distance >= least_depth) {
          found.insert({r, i, other});
        }
      }
    }
  }
  return found;
}

test::Rod rod(const glm::vec3& middle, const glm::vec3& half, std::uint32_t section_vertices = 64) {
  return {.from = middle - half, .to = middle + half, .section_vertices = section_vertices};
}

test::CollisionState rods(const std::vector<test::Rod>& list, const CollisionDescription& description = {}) {
  return test::CollisionState(test::build_collision(test::build_rods(list, 1), {nullptr}, description), 1);
}

// 48 rods in all directions, apart at rest, then thrown together in a cube of `scale` times 0.4 m.
test::CollisionState tangle(float scale, std::uint32_t seed, const glm::vec3& place = glm::vec3(0.0f)) {
  test::Numbers numbers(seed);
  std::vector<test::Rod> list;
  std::vector<glm::vec3> to;
  for (int m = 0; m < 48; ++m) {
    const glm::vec3 half = scale * 0.15f * glm::normalize(numbers.point(-1.0f, 1.0f));
    const glm::vec3 apart = scale * 0.5f * glm::vec3(m % 4, m / 4 % 4, m / 16);
    test::Rod next = rod(apart, half, 12);
    next.radius = scale * (0.005f + 0.02f * numbers.next());
    next.subdivision = 2 + static_cast<std::uint32_t>(2.0f * numbers.next());
    list.push_back(next);
    to.push_back(place + scale * numbers.point(-0.2f, 0.2f) - apart);
  }
  CollisionDescription description;
  description.settings.sample_spacing = scale * 0.02f;
  test::CollisionState state = rods(list, description);
  for (std::uint32_t m = 0; m < 48; ++m) state.move(m, to[m]);
  state.work.contacts.reserve(200000);
  state.place();
  return state;
}

void find(test::CollisionState& state, float reach) {
  state.work.contacts.clear();
  state.work.overflow = false;
  fill_grid(*state.asset, state.work);
  find_muscle_contacts(*state.asset, 0.0f, reach, false, state.work);
}

TEST(MuscleContacts, NothingWhereNothingTouches) {
  test::CollisionState state = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0.05f, 0, 0}, {0, 0, 0.1f})});
  state.find();
  EXPECT_TRUE(state.work.contacts.empty());
  test::CollisionState alone = rods({rod({0, 0, 0}, {0, 0, 0.1f})});
  alone.find();
  EXPECT_TRUE(alone.work.contacts.empty());
}

TEST(MuscleContacts, ParallelRodsOverlapByTheDistanceThatIsMissing) {
  test::CollisionState state = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0.06f, 0, 0}, {0, 0, 0.1f})});
  state.move(1, {-0.025f, 0, 0});
  state.find();
  EXPECT_NEAR(state.deepest(), 0.005f, kSagitta);
  bool first = false, second = false;
  for (const Contact& contact : state.work.contacts) {
    const std::uint32_t m = state.asset->sections[contact.section].muscle;
    (m == 0 ? first : second) = true;
    if (contact.found > -0.002f) continue;
    EXPECT_GT(m == 0 ? -contact.normal.x : contact.normal.x, 0.9f);
    EXPECT_NEAR(contact_value(contact, state.work), contact.found, 2.0e-6f);
  }
  EXPECT_TRUE(first && second);  // both surfaces are sampled
}

TEST(MuscleContacts, CrossingRodsOverlapWhereTheyCross) {
  test::CollisionState state = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0, 0.06f, 0}, {0.1f, 0, 0})});
  state.move(1, {0, -0.025f, 0});
  state.find();
  EXPECT_NEAR(state.deepest(), 0.005f, 3.0f * kSagitta);
  for (const Contact& contact : state.work.contacts) {
    EXPECT_LT(glm::distance(contact.place, glm::vec3(0, 0.0175f, 0)), 0.03f);
  }
}

TEST(MuscleContacts, WhatOverlapsAtRestMayStayAsDeep) {
  test::CollisionState state = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0.037f, 0, 0}, {0, 0, 0.1f})});
  state.find();
  EXPECT_FALSE(state.work.contacts.empty());
  EXPECT_LE(state.deepest(), 0.0f);
  state.move(1, {-0.002f, 0, 0});
  state.find();
  EXPECT_NEAR(state.deepest(), 0.002f, 4.0e-4f);
}

TEST(MuscleContacts, MarginIsKeptAndIgnoredPairsNeverTouch) {
  CollisionDescription description;
  description.settings.muscle_margin = 0.004f;
  test::CollisionState state = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0.06f, 0, 0}, {0, 0, 0.1f})}, description);
  state.move(1, {-0.018f, 0, 0});
  state.find(description.settings);
  EXPECT_NEAR(state.deepest(), 0.002f, kSagitta);

  description.ignored.push_back({.muscle = 1, .bone = -1, .other = 0, .where = {}});
  test::CollisionState ignoring = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0.06f, 0, 0}, {0, 0, 0.1f})}, description);
  ignoring.move(1, {-0.03f, 0, 0});
  ignoring.find(description.settings);
  EXPECT_TRUE(ignoring.work.contacts.empty());
}

TEST(MuscleContacts, ValueFollowsBothMuscles) {
  test::CollisionState state = rods({rod({0, 0, 0}, {0, 0, 0.1f}), rod({0.06f, 0, 0}, {0, 0, 0.1f})});
  state.move(1, {-0.024f, 0.003f, 0.004f});
  state.find();
  const std::vector<Contact> contacts = state.work.contacts;
  ASSERT_FALSE(contacts.empty());
  const glm::vec3 both(0.01f, -0.02f, 0.005f), one(0.001f, 0.002f, -0.001f);
  state.move(0, both);
  state.move(1, both);
  for (const Contact& contact : contacts) EXPECT_NEAR(contact_value(contact, state.work), contact.found, 2.0e-6f);
  state.move(1, one);
  for (const Contact& contact : contacts) {
    const float sign = state.asset->sections[contact.section].muscle == 1 ? 1.0f : -1.0f;
    EXPECT_NEAR(contact_value(contact, state.work), contact.found + sign * glm::dot(contact.normal, one), 2.0e-6f);
  }
  // Thicker muscles are deeper in each other.
  for (std::size_t i = 0; i < state.work.radii.size(); ++i) state.work.radii[i] += 0.001f;
  for (const Contact& contact : contacts) {
    if (contact.found > -0.001f) continue;
    const float sign = state.asset->sections[contact.section].muscle == 1 ? 1.0f : -1.0f;
    EXPECT_NEAR(contact_value(contact, state.work),
                contact.found + sign * glm::dot(contact.normal, one) - 0.002f, 2.0e-4f);
  }
}

TEST(MuscleContacts, GridFindsWhatASearchOverAllSegmentsFinds) {
  for (const float scale : {1.0f, 0.05f, 20.0f}) {
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
      test::CollisionState state = tangle(scale, seed);
      const float reach = 0.0025f * scale;
      find(state, reach);
      ASSERT_FALSE(state.work.overflow);
      const std::set<Touch> expected = search(state, 0.0f, reach);
      EXPECT_GT(expected.size(), 500u);
      EXPECT_EQ(touches(state, 0.0f), expected) << "scale " << scale;
    }
  }
}

TEST(MuscleContacts, GridWorksAKilometreAway) {
  test::CollisionState state = tangle(1.0f, 4, {1000.0f, -1000.0f, 1000.0f});
  find(state, 0.0025f);
  const std::set<Touch> expected = search(state, 0.0f, 0.0025f);
  EXPECT_GT(expected.size(), 500u);
  EXPECT_EQ(touches(state, 0.0f), expected);
}

TEST(MuscleContacts, DegenerateSegmentsAreHarmless) {
  test::CollisionState state = tangle(1.0f, 5);
  for (std::uint32_t m = 0; m < 48; m += 3) {  // two sections at one place; a muscle all in one point
    state.work.a[state.section(m, 2)] = state.work.a[state.section(m, 1)];
    if (m % 2 == 0) continue;
    for (std::uint32_t k = 1; k < state.section_count(m); ++k) {
      state.work.a[state.section(m, k)] = state.work.a[state.section(m, 0)];
    }
  }
  for (std::uint32_t k = 0; k < state.section_count(1); ++k) {  // and one without thickness
    const CollisionSection& section = state.asset->sections[state.section(1, k)];
    std::fill_n(&state.work.radii[section.first_radius], section.count, 0.0f);
  }
  state.place();
  find(state, 0.0025f);
  EXPECT_EQ(touches(state, 0.0f), search(state, 0.0f, 0.0025f));
  for (const Contact& contact : state.work.contacts) {
    EXPECT_TRUE(std::isfinite(contact.found));
    EXPECT_TRUE(std::isfinite(contact.inverse_mass));
    EXPECT_NEAR(glm::length(contact.normal), 1.0f, 1.0e-3f);
  }
}

TEST(MuscleContacts, OrderIsTheSameWhateverTheScratchHeldBefore) {
  test::CollisionState state = tangle(1.0f, 6);
  find(state, 0.0025f);
  const std::vector<Contact> first = state.work.contacts;
  // The scratch of a larger musculature, left as it is after that one's step.
  std::vector<test::Rod> many;
  for (int m = 0; m < 60; ++m) many.push_back(rod({0.03f * static_cast<float>(m), 0, 0}, {0, 0, 0.3f}, 24));
  test::CollisionState large = rods(many);
  large.find();
  const CollisionWork own = state.work;
  state.work = large.work;
  state.work.reserve(*state.asset);
  state.work.contacts.reserve(200000);
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); };
  copy(own.a, state.work.a);
  copy(own.u, state.work.u);
  copy(own.v, state.work.v);
  copy(own.t, state.work.t);
  copy(own.mobility, state.work.mobility);
  copy(own.radii, state.work.radii);
  state.place();
  find(state, 0.0025f);
  ASSERT_EQ(state.work.contacts.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(state.work.contacts[i].row, first[i].row);
    EXPECT_EQ(state.work.contacts[i].sample, first[i].sample);
    EXPECT_EQ(state.work.contacts[i].other_section, first[i].other_section);
    EXPECT_EQ(state.work.contacts[i].found, first[i].found);
  }
}

TEST(MuscleContacts, MoreThanThereIsRoomForIsSaidAndHarmless) {
  std::vector<test::Rod> list;
  for (int m = 0; m < 40; ++m) list.push_back(rod({0.1f * static_cast<float>(m), 0, 0}, {0, 0, 0.1f}, 12));
  test::CollisionState state = rods(list);
  for (std::uint32_t m = 0; m < 40; ++m) state.move(m, {-0.0999f * static_cast<float>(m), 0, 0});
  const std::size_t room = state.work.contacts.capacity();
  state.find();
  EXPECT_TRUE(state.work.overflow);
  EXPECT_LE(state.work.contacts.size(), room);
  EXPECT_EQ(state.work.contacts.capacity(), room);
}

}  // namespace
}  // namespace fascicle::muscle
