#include "modules/muscle/asset/fibres/isocontours.hpp"

#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "modules/muscle/asset/fibres/fibre_template.hpp"
#include "modules/muscle/asset/fibres/spanned_disc.hpp"
#include "tests/modules/muscle/asset/fibres/tube_muscle.hpp"

namespace fascicle::muscle {
namespace {

std::vector<float> heights(const TriangleMesh& mesh, float top) {
  std::vector<float> field;
  for (const glm::vec3& p : mesh.positions) field.push_back(p.z / top);
  return field;
}

TEST(Isocontours, AFieldThatNoLevelCutsHasNone) {
  const TriangleMesh tube = test::make_tube(1.0f, 4.0f);
  const std::vector<float> flat(tube.positions.size(), 0.0f);
  EXPECT_TRUE(trace_contours(tube.positions, tube.indices, flat, 8).loops.empty());
}

TEST(Isocontours, RunRoundATubeOnceTheSameWayWithoutTwist) {
  const TriangleMesh tube = test::make_tube(1.0f, 4.0f);
  const Contours contours = trace_contours(tube.positions, tube.indices, heights(tube, 4.0f), 9);
  ASSERT_EQ(contours.loops.size(), 9u);
  EXPECT_EQ(contours.split_levels, 0u);
  EXPECT_NEAR(contours.length, 4.0, 0.01);
  for (std::size_t i = 0; i < 9; ++i) {
    const Loop& loop = contours.loops[i];
    ASSERT_EQ(loop.size(), kContourPoints);
    EXPECT_NEAR(loop_centre(loop).z, 0.5 * static_cast<double>(i), 0.006);
    EXPECT_NEAR(loop_length(loop), 2.0 * std::numbers::pi, 0.03);
    // Seen from the insertion's side all turn one way: which one follows from where the higher values are.
    EXPECT_LT(glm::cross(loop[0], loop[10]).z, 0.0);
    EXPECT_LT(glm::length(glm::dvec2(loop[0]) - glm::dvec2(contours.loops[0][0])), 0.02) << "twisted";
  }
}

TEST(Isocontours, ALevelOfSeveralLoopsGivesTheLongest) {
  const TriangleMesh both = test::join(test::make_tube(1.0f, 4.0f), test::moved(test::make_tube(0.3f, 4.0f),
                                       glm::mat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1)));
  const MeshEdges edges = find_edges(both.indices, both.positions.size());
  const std::vector<Loop> loops = trace_level(both.positions, both.indices, edges, heights(both, 4.0f), 0.3);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_GT(loop_length(loops[0]), 3.0 * loop_length(loops[1]));
  const Contours contours = trace_contours(both.positions, both.indices, heights(both, 4.0f), 4);
  EXPECT_EQ(contours.split_levels, 4u);
  for (const Loop& loop : contours.loops) EXPECT_LT(glm::length(glm::dvec2(loop[0])), 1.01);
}

TEST(SpannedDisc, ACircleIsMappedToItselfAndADentIsNotBridged) {
  Loop circle, crescent;
  for (std::size_t i = 0; i < kContourPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kContourPoints;
    circle.emplace_back(3.0 * std::cos(angle), 3.0 * std::sin(angle), 1.0);
  }
  EXPECT_FALSE(SpannedDisc::span(std::span(circle).first(2)));
  const std::optional<SpannedDisc> disc = SpannedDisc::span(circle);
  ASSERT_TRUE(disc);
  for (const glm::dvec2& p : spread_over_disc(60))
    EXPECT_LT(glm::distance(disc->at(p), glm::dvec3(3.0 * p.x, 3.0 * p.y, 1.0)), 0.01);
  EXPECT_LT(glm::distance(disc->at({2.0, 0.0}), glm::dvec3(3, 0, 1)), 0.01) << "the nearest in the disc";

  // An outer arc and an inner one round the same centre, three quarters of a turn.
  for (std::size_t i = 0; i < 60; ++i) {
    const double angle = 1.5 * std::numbers::pi * static_cast<double>(i) / 59.0;
    crescent.emplace_back(3.0 * std::cos(angle), 3.0 * std::sin(angle), 0.1 * angle);
  }
  for (std::size_t i = 60; i-- > 0;) crescent.push_back(glm::dvec3(2.0, 2.0, 3.0) / 3.0 * crescent[i]);
  const std::optional<SpannedDisc> bent = SpannedDisc::span(resample_loop(crescent, kContourPoints));
  ASSERT_TRUE(bent);
  for (const glm::dvec2& p : spread_over_disc(200)) {
    const double radius = glm::length(glm::dvec2(bent->at(p)));
    EXPECT_GT(radius, 1.95);
    EXPECT_LT(radius, 3.05);
  }
}

TEST(FibreTemplate, HasAsManyFibresAsAskedWithinTheDisc) {
  for (const FibreArrangement arrangement :
       {FibreArrangement::kParallel, FibreArrangement::kPennate, FibreArrangement::kFan}) {
    for (const std::uint32_t count : {1u, 7u, 500u}) {
      const std::vector<TemplateFibre> fibres = make_template(arrangement, count, 3.0);
      ASSERT_EQ(fibres.size(), count);
      for (const TemplateFibre& fibre : fibres) {
        for (const double t : {0.0, 0.3, 1.0}) {
          EXPECT_LE(glm::length(glm::dvec2(fibre.at(t))), kTemplateRadius + 1e-9);
          EXPECT_GE(fibre.at(t).z, -1e-9);
          EXPECT_LE(fibre.at(t).z, 1.0 + 1e-9);
        }
        EXPECT_LT(fibre.at(0.0).z, fibre.at(1.0).z);
      }
    }
  }
  const TemplateFibre pennate = make_template(FibreArrangement::kPennate, 9, 3.0)[4];
  const glm::dvec3 way = pennate.at(1.0) - pennate.at(0.0);
  EXPECT_NEAR(way.x / way.z, 3.0, 1e-9);
  EXPECT_EQ(way.y, 0.0);
  const TemplateFibre fan = make_template(FibreArrangement::kFan, 9, 0.0)[8];
  EXPECT_NEAR(glm::length(glm::dvec2(fan.at(1.0))), 0.25 * glm::length(glm::dvec2(fan.at(0.0))), 1e-9);
}

}  // namespace
}  // namespace fascicle::muscle
