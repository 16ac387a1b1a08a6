#include "modules/muscle/systems/5_present/draw_collision.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"

namespace fascicle::muscle {
namespace {

constexpr CollisionColours kColours;

TEST(MarkContacts, NothingTouchesNothing) {
  CollisionMarks marks;
  mark_contacts({}, marks);
  EXPECT_TRUE(marks.lines.empty() && marks.points.empty());
}

TEST(MarkContacts, AContactsKindDepthAndWhatIsLeftAreTold) {
  MuscleContacts contacts;
  const glm::vec3 place(1, 2, 3), normal(0, 1, 0);
  contacts.now.push_back({.bone = 4, .depth = 0.01f, .place = place, .normal = normal});
  contacts.now.push_back({.other = 2, .depth = 0.01f, .place = place, .normal = normal});
  contacts.now.push_back({.other = 3, .depth = 0.0f, .place = place, .normal = normal});
  contacts.now.push_back({.other = 4, .depth = 0.01f, .left = 0.0004f, .place = place, .normal = normal});
  contacts.now.push_back({.other = 5, .depth = 5.0f, .left = 0.0006f, .place = place, .normal = normal});
  CollisionMarks marks;
  mark_contacts(contacts, marks);
  ASSERT_EQ(marks.lines.size(), 5u);
  ASSERT_EQ(marks.points.size(), 5u);
  EXPECT_EQ(marks.lines[0].colour, kColours.bone_contact);
  EXPECT_EQ(marks.lines[1].colour, kColours.muscle_contact);
  EXPECT_NE(marks.lines[2].colour, kColours.muscle_contact) << "paler";
  EXPECT_EQ(marks.lines[3].colour, kColours.muscle_contact) << "half a millimetre is let pass";
  EXPECT_EQ(marks.lines[4].colour, kColours.left);
  const auto length = [&](std::size_t i) { return glm::distance(marks.lines[i].from, marks.lines[i].to); };
  EXPECT_NEAR(length(0), 0.04f, 1e-6f);
  EXPECT_GT(length(2), 0.0f);
  EXPECT_LT(length(2), length(0));
  EXPECT_LT(length(4), 0.1f) << "however deep";
  EXPECT_GT(marks.lines[0].to.y, place.y) << "out of the other";
  for (const MarkPoint& point : marks.points) EXPECT_EQ(point.at, place);
}

class MarkMuscles : public testing::Test {
 protected:
  void SetUp() override {
    asset_ = synthetic_asset();
    const ecs::Entity character = world_.add_character(test::rest_bones());
    musculature_ = spawn_musculature(world_.world, character, asset_);
    world_.step();
    auto collision = std::make_shared<CollisionAsset>();
    collision->muscles = asset_;
    for (const std::uint32_t m : {0u, 1u}) {
      for (std::uint32_t k = 0; k < asset_->muscles[m].section_count; ++k) {
        collision->sections.push_back({.muscle = m, .section = k, .slot = asset_->slot(m, k), .bone = test::kPelvis});
      }
    }
    shared_ = collision;
  }
  const ActionLines& lines() { return world_.world.get<ActionLines>(musculature_); }
  const CrossSections& sections() { return world_.world.get<CrossSections>(musculature_); }
  glm::vec3 vertex(std::uint32_t m, std::uint32_t k, std::uint32_t i) {
    return section_vertex(*asset_, lines(), sections(), m, k, i);
  }
  // Number of section 1 of muscle `m`.
  std::uint32_t number(std::uint32_t m) { return (m == 0 ? 0 : asset_->muscles[0].section_count) + 1; }

  MuscleWorld world_;
  std::shared_ptr<const MuscleAsset> asset_;
  std::shared_ptr<CollisionAsset> shared_;
  ecs::Entity musculature_;
};

// The drawn surface is the oracle of where a section's vertices are.
TEST_F(MarkMuscles, SectionsVerticesAreThoseOfTheSurface) {
  const MuscleSurfaceView surface = surface_of(*asset_, world_.world.get<MuscleSurfaces>(musculature_), 2);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_LT(glm::distance(vertex(2, 0, i), surface.vertices[i].position), 1e-6f);
  }
  CollisionMarks marks;
  mark_section(*asset_, lines(), sections(), 2, 0, 3, 0xffffffffu, marks);
  ASSERT_EQ(marks.lines.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(marks.lines[i].to, marks.lines[(i + 1) % 8].from) << "a closed ring";
  ASSERT_EQ(marks.points.size(), 1u);
  EXPECT_EQ(marks.points[0].at, vertex(2, 0, 3));
}

TEST_F(MarkMuscles, BeforeTheFirstStepThereIsNothingToShow) {
  const MuscleCollision none;
  CollisionMarks marks;
  mark_transversals(none, lines(), sections(), {}, {}, marks);
  mark_displacements(none, lines(), {}, marks);
  EXPECT_TRUE(marks.lines.empty() && marks.points.empty());
}

TEST_F(MarkMuscles, TagsTellWhoPlacedThemAndWhetherTheyAct) {
  std::vector<TransversalTag> tags(3);
  tags[1].automatic = true;
  const auto add = [&](std::uint32_t tag, std::int32_t bone, const glm::vec3& point) {
    Transversal transversal{.section = number(0), .vertex = 2, .bone = bone, .other_section = number(1),
                            .other_vertex = 5, .point = point};
    transversal.rest_depth = 1.0f;  // whatever their place, they are no deeper than at rest
    transversal.tag = tag;
    shared_->transversals.push_back(transversal);
  };
  add(0, -1, {});
  add(1, -1, {});
  // A bone's point behind the tag, towards the centre: the tag is in it.
  const glm::vec3 tagged = vertex(0, 1, 2), centre = line_point(*asset_, lines(), 0, 1);
  add(2, test::kPelvis, glm::mix(tagged, centre, 0.5f));
  shared_->transversals[2].rest_depth = 0.0f;
  const std::vector<glm::mat4> bones(test::kSyntheticBones, glm::mat4(1.0f));
  MuscleCollision collision;
  collision.asset = shared_.get();
  CollisionMarks marks;
  mark_transversals(collision, lines(), sections(), tags, bones, marks);
  ASSERT_EQ(marks.lines.size(), 3u);
  EXPECT_EQ(marks.lines[0].colour, kColours.author_tag);
  EXPECT_EQ(marks.lines[1].colour, kColours.automatic_tag);
  EXPECT_EQ(marks.lines[2].colour, kColours.acting_tag);
  EXPECT_EQ(marks.lines[0].from, tagged);
  EXPECT_EQ(marks.lines[0].to, vertex(1, 1, 5));
  EXPECT_LT(glm::distance(marks.lines[2].to, glm::mix(tagged, centre, 0.5f)), 1e-6f);

  marks = {};
  mark_transversals(collision, lines(), sections(), tags, {}, marks);
  EXPECT_EQ(marks.lines.size(), 2u) << "a bone that is missing has no point";
}

TEST_F(MarkMuscles, DisplacedCentresHaveALineFromWhereTheirBonesCarryThem) {
  MuscleCollision collision;
  collision.asset = shared_.get();
  for (auto* offset : {&collision.offset_x, &collision.offset_y, &collision.offset_z}) {
    offset->resize(asset_->slot_count, 0.0f);
  }
  collision.offset_x[asset_->slot(0, 1)] = 0.01f;
  collision.offset_x[asset_->slot(0, 2)] = 0.0001f;  // too little to see
  std::vector<glm::mat4> bones(test::kSyntheticBones, glm::mat4(1.0f));
  bones[test::kPelvis] = glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(0, 0, 1));  // x to y
  CollisionMarks marks;
  mark_displacements(collision, lines(), bones, marks);
  ASSERT_EQ(marks.lines.size(), 1u);
  EXPECT_EQ(marks.lines[0].to, line_point(*asset_, lines(), 0, 1));
  EXPECT_LT(glm::distance(marks.lines[0].to - marks.lines[0].from, glm::vec3(0, 0.01f, 0)), 1e-6f);
}

}  // namespace
}  // namespace fascicle::muscle
