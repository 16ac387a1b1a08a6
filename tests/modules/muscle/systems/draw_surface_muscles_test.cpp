#include "modules/muscle/systems/5_present/draw_surface_muscles.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "modules/muscle/asset/fibres/fibre_bundle.hpp"

namespace fascicle::muscle {
namespace {

constexpr CollisionColours kColours;

int red(std::uint32_t colour) { return static_cast<int>(colour & 0xff); }
int blue(std::uint32_t colour) { return static_cast<int>(colour >> 16 & 0xff); }

TEST(FibreIndices, AStripAFibre) {
  FibreBundleAsset bundle;
  EXPECT_TRUE(make_fibre_indices(bundle).empty());
  bundle.count = 2;
  bundle.points_per_fibre = 3;
  EXPECT_EQ(make_fibre_indices(bundle),
            (std::vector<std::uint32_t>{0, 1, 2, kPrimitiveRestart, 3, 4, 5, kPrimitiveRestart}));
}

TEST(FibreColour, TellsLongerFromShorterAndEndsSomewhere) {
  for (const std::uint32_t index : {0u, 1u, 7u, 999u}) {
    EXPECT_GT(red(fibre_colour(1.2f, index)), blue(fibre_colour(1.2f, index)) + 40);
    EXPECT_GT(blue(fibre_colour(0.75f, index)), red(fibre_colour(0.75f, index)) + 40);
    EXPECT_EQ(fibre_colour(1.3f, index), fibre_colour(7.0f, index));
    EXPECT_EQ(fibre_colour(0.7f, index), fibre_colour(0.0f, index));
    EXPECT_NE(fibre_colour(1.0f, index), fibre_colour(1.02f, index));
    EXPECT_EQ(fibre_colour(1.0f, index) >> 24, 0xffu) << "opaque";
    EXPECT_NE(fibre_colour(1.0f, index), fibre_colour(1.0f, index + 1)) << "told apart";
  }
}

TEST(MarkSurfaces, AttachedVerticesByTheirEndAndBonesThatAreTouched) {
  SurfaceAsset asset;
  asset.attachments = {{.bone = 1, .origin = true, .count = 1}, {.bone = 2, .origin = false, .count = 2}};
  asset.attached = {{0, 1}, {2, 0}, {9, 1}};
  DrawnSurface drawn;
  for (const float x : {0.0f, 1.0f, 2.0f}) drawn.vertices.push_back({glm::vec3(x), 0});
  CollisionMarks marks;
  mark_attached(asset, drawn, marks);
  ASSERT_EQ(marks.points.size(), 2u) << "there is no vertex 9";
  EXPECT_EQ(marks.points[0].at, glm::vec3(0.0f));
  EXPECT_EQ(marks.points[1].at, glm::vec3(2.0f));
  EXPECT_NE(marks.points[0].colour, marks.points[1].colour);

  SurfaceContacts contacts;
  contacts.now = {{3, 0, 0.0f, glm::vec3(5.0f)}, {4, 2, 0.001f, glm::vec3(6.0f)}};
  marks.points.clear();
  mark_surface_contacts(contacts, marks);
  ASSERT_EQ(marks.points.size(), 1u) << "bone 3 is near, but not touched";
  EXPECT_EQ(marks.points[0].at, glm::vec3(6.0f));
  EXPECT_EQ(marks.points[0].colour, kColours.bone_contact);
}

}  // namespace
}  // namespace fascicle::muscle
