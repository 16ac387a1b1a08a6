// What a hull asset refuses, and what the matrices of a good one promise.
#include "modules/muscle/asset/hull/hull_asset.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modules/muscle/kernels/hull/mesh_volume.hpp"
#include "tests/modules/muscle/kernels/hull/posed_spindle.hpp"

namespace fascicle::muscle {
namespace {

struct Given {
  SurfaceMuscleDescription description;
  TriangleMesh hull;
};

Given good() {
  static const PosedSpindle spindle;
  Given given{spindle.description, {}};
  given.hull.positions = spindle.hull->rest;
  given.hull.indices = spindle.hull->triangles;
  return given;
}

Result<std::shared_ptr<const HullAsset>> build(const Given& given) {
  const auto surface = build_surface_asset(given.description, 3);
  EXPECT_TRUE(surface.ok());
  return build_hull_asset(**surface, given.description, given.hull);
}

struct Broken {
  const char* what;
  std::function<void(Given&)> spoil;
  const char *place, *cause;
};

class BrokenHull : public testing::TestWithParam<Broken> {};

TEST_P(BrokenHull, IsToldWithItsPlaceCauseAndRemedy) {
  Given given = good();
  given.description.where = {"spindle.json", 7, 3, "/surface_muscles/0", "", ""};
  GetParam().spoil(given);
  const auto built = build(given);
  ASSERT_FALSE(built.ok());
  const Diagnostic& error = built.diagnostics().errors.front();
  EXPECT_EQ(error.file, "spindle.json");
  EXPECT_THAT(error.path, testing::HasSubstr(GetParam().place));
  EXPECT_THAT(error.cause, testing::HasSubstr(GetParam().cause));
  EXPECT_FALSE(error.remedy.empty());
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All, BrokenHull,
    testing::Values(
        Broken{"no_line", [](Given& g) { g.description.action_line.clear(); }, "action_line", "action line"},
        Broken{"one_point", [](Given& g) { g.description.action_line.resize(1); }, "action_line", "one point"},
        Broken{"no_length", [](Given& g) { g.description.action_line[1] = g.description.action_line[0]; }, "action_line",
               "no length"},
        Broken{"line_of_no_numbers", [](Given& g) { g.description.action_line[1].position.x = kNaN; }, "action_line",
               "no length"},
        Broken{"free", [](Given& g) { g.description.attachments.clear(); }, "attachments", "no bone"},
        Broken{"empty_hull", [](Given& g) { g.hull = {}; }, "hull", "no closed mesh"},
        Broken{"open_hull", [](Given& g) { g.hull.indices.resize(g.hull.indices.size() - 3); }, "hull", "no closed mesh"},
        Broken{"wild_index", [](Given& g) { g.hull.indices[4] = 1000; }, "hull", "no closed mesh"},
        Broken{"hull_of_no_numbers", [](Given& g) { g.hull.positions[3].y = kNaN; }, "hull", "does not reproduce"},
        Broken{"too_many", [](Given& g) { g.hull.positions.resize(5000); }, "hull", "5000 vertices"},
        Broken{"weight", [](Given& g) { g.description.hull.bending = -1.0f; }, "hull", "weight"},
        Broken{"weight_nan", [](Given& g) { g.description.hull.direction = kNaN; }, "hull", "weight"},
        Broken{"tolerance", [](Given& g) { g.description.hull.tolerance = 0.0f; }, "hull", "no end"},
        Broken{"iterations", [](Given& g) { g.description.hull.iterations = 0; }, "hull", "no end"}),
    [](const auto& each) { return std::string(each.param.what); });

TEST(BuildHullAsset, WeightsReproduceTheFullMesh) {
  const PosedSpindle spindle;
  const DenseRows& weights = spindle.hull->weights;
  for (std::uint32_t v = 0; v < spindle.asset->vertex_count; ++v) {
    glm::dvec3 sum(0.0);
    double total = 0.0;
    for (std::uint32_t h = 0; h < weights.columns; ++h) {
      const auto w = static_cast<double>(weights.values[weights.index(v, h)]);
      sum += w * glm::dvec3(spindle.hull->rest[h]);
      total += w;
    }
    EXPECT_LT(glm::distance(sum, glm::dvec3(spindle.rest(v))), 1e-6 * static_cast<double>(spindle.asset->size));
    EXPECT_NEAR(total, 1.0, 1e-6);
  }
}

TEST(BuildHullAsset, TheInverseIsOne) {
  const PosedSpindle spindle;
  const DenseRows &a = spindle.hull->shape.stiffness, &inverse = spindle.hull->shape.inverse;
  double most = 0.0;
  for (std::uint32_t i = 0; i < a.rows; ++i) {
    for (std::uint32_t j = 0; j < a.columns; ++j) {
      double sum = i == j ? -1.0 : 0.0;
      for (std::uint32_t k = 0; k < a.columns; ++k) {
        sum += static_cast<double>(a.values[a.index(i, k)]) * static_cast<double>(inverse.values[inverse.index(k, j)]);
      }
      most = std::max(most, std::abs(sum));
    }
  }
  EXPECT_LT(most, 1e-3);
}

TEST(BuildHullAsset, SamplesOfASmallMuscleAreAllVertices) {
  const PosedSpindle spindle;
  const HullSamples& samples = spindle.hull->samples;
  ASSERT_EQ(samples.vertices.size(), spindle.asset->vertex_count);
  EXPECT_TRUE(std::ranges::is_sorted(samples.vertices));
  EXPECT_NEAR(samples.volume, spindle.asset->volume, 1e-6 * spindle.asset->volume);
}

TEST(BuildHullAsset, SamplesOfALargeMuscleAreAClosedMeshOfNearlyItsVolume) {
  Given given = good();
  given.description.mesh = test::make_sphere(0.05f, 60, 64);
  given.description.attachments.resize(1);
  given.description.attachments[0].vertices = {0, 1, 2, 3};
  const auto built = build(given);
  // The hull encloses a spindle, and the ball has it inside: coordinates are found for any point.
  ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
  const HullSamples& samples = (*built)->samples;
  EXPECT_LE(samples.vertices.size(), 1600u);
  EXPECT_GE(samples.vertices.size(), 1000u);
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (std::size_t t = 0; t < samples.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(sides.insert({samples.triangles[t + k], samples.triangles[t + (k + 1) % 3]}).second);
    }
  }
  for (const auto& side : sides) EXPECT_TRUE(sides.contains({side.second, side.first}));
  const double ball = 4.0 / 3.0 * 3.14159265 * 0.05 * 0.05 * 0.05;
  EXPECT_NEAR(samples.volume, ball, 0.02 * ball);
}

}  // namespace
}  // namespace fascicle::muscle
