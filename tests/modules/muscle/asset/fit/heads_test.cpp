// Several action lines in one mesh: each head keeps to its own part, and together they cover the mesh.
#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/asset/fit/head_region.hpp"
#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using test::ellipse;
using test::line_muscle;
using test::make_tube;

// Two lines along x, 40 mm apart.
const std::vector<std::vector<glm::dvec3>> kLines{{{0, 0.02, 0}, {0.3, 0.02, 0}}, {{0, -0.02, 0}, {0.3, -0.02, 0}}};

TEST(HeadRegion, PointsBelongToTheNearestLine) {
  const HeadRegion first(kLines, 0), second(kLines, 1);
  EXPECT_TRUE(first.contains({0.1, 0.005, 0.01}));
  EXPECT_FALSE(second.contains({0.1, 0.005, 0.01}));
  EXPECT_FALSE(first.contains({0.1, -0.005, 0.01}));
  EXPECT_TRUE(second.contains({0.1, -0.005, 0.01}));
  EXPECT_TRUE(first.contains({0.1, 0.0, 0.01}) && second.contains({0.1, 0.0, 0.01}));
  test::Numbers numbers(2);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p = numbers.point(-0.1f, 0.4f);
    EXPECT_TRUE(first.contains(p) || second.contains(p));
    EXPECT_TRUE(p.y < 0.0 ? second.contains(p) : first.contains(p));
  }
}

TEST(HeadRegion, StretchesAreCutAtTheBorder) {
  const HeadRegion first(kLines, 0);
  std::vector<InsideInterval> stretches{{-9.0, -8.0}, {-0.05, 0.05}};
  first.clip({0.1, 0.0, 0.0}, {0.0, 1.0, 0.0}, 1, stretches);
  ASSERT_EQ(stretches.size(), 2u);  // the first is not its business
  EXPECT_EQ(stretches[0].from, -9.0);
  EXPECT_NEAR(stretches[1].from, -0.02 * 0.1 / 2.1, 1e-6);  // 0.02 - y = 1.1 (0.02 + y)
  EXPECT_EQ(stretches[1].to, 0.05);
  stretches = {{-0.05, -0.03}};
  first.clip({0.1, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0, stretches);
  EXPECT_TRUE(stretches.empty());
}

TEST(HeadRegion, SubdivisionOfStraightPiecesChangesNothing) {
  const std::vector<std::vector<glm::dvec3>> bent{{{0, 0.02, 0}, {0.11, 0.03, 0.007}, {0.3, 0.02, 0.01}}, kLines[1]};
  std::vector<std::vector<glm::dvec3>> subdivided;
  for (const std::vector<glm::dvec3>& line : bent) {
    subdivided.push_back({line[0]});
    for (std::size_t i = 1; i < line.size(); ++i) {
      for (int k = 1; k <= 64; ++k) subdivided.back().push_back(line[i - 1] + (line[i] - line[i - 1]) * (k / 64.0));
    }
  }
  const HeadRegion plain(bent, 0), fine(subdivided, 0);
  test::Numbers numbers(3);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p = numbers.point(-0.1f, 0.4f);
    EXPECT_EQ(plain.contains(p), fine.contains(p));
  }
  // A line that turns back on itself reaches to its tip.
  const std::vector<std::vector<glm::dvec3>> back{{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, {{0, 0.2, 0}, {1, 0.2, 0}}};
  EXPECT_TRUE(HeadRegion(back, 0).contains({1, 0.05, 0}));
}

struct Heads {
  TriangleMesh mesh;
  std::vector<MuscleDescription> muscles;
};

Heads flat_muscle() {
  const auto outline = [](double s) { return ellipse({0.0, 0.0}, 0.04 + 0.01 * std::sin(3.0 * s), 0.015); };
  Heads heads{make_tube(outline, 0.3, 20), {}};
  for (const float y : {0.02f, -0.02f}) heads.muscles.push_back(line_muscle({{0.002f, y, 0}, {0.298f, y, 0}}, 36, 3));
  return heads;
}

Heads biceps() {
  const auto head = [](double side) {
    return make_tube([=](double s) { return ellipse({side * 0.03 * std::max(0.0, 1.0 - s / 0.7), 0.0}, 0.014, 0.014); },
                     0.3, 40);
  };
  Heads heads{test::join(head(1.0), head(-1.0)), {}};
  for (const float side : {1.0f, -1.0f}) {
    heads.muscles.push_back(line_muscle(
        {{0.002f, side * 0.0297f, 0}, {0.2f, side * 0.004f, 0}, {0.298f, side * 0.001f, 0}}, 36, 3));
  }
  return heads;
}

Heads three_heads() {
  Heads heads{make_tube([](double) { return ellipse({0.0, 0.0}, 0.05, 0.04); }, 0.3, 20), {}};
  for (int i = 0; i < 3; ++i) {
    const float angle = 0.4f + 2.0943951f * static_cast<float>(i);
    const glm::vec3 off(0.0f, 0.024f * std::cos(angle), 0.02f * std::sin(angle));
    heads.muscles.push_back(line_muscle({glm::vec3(0.002f, 0, 0) + off, glm::vec3(0.298f, 0, 0) + off}, 36, 2));
  }
  return heads;
}

class HeadsTest : public testing::TestWithParam<Heads (*)()> {};

TEST_P(HeadsTest, TogetherCoverTheMesh) {
  const Heads heads = GetParam()();
  std::vector<FitInput> inputs;
  for (const MuscleDescription& muscle : heads.muscles) inputs.push_back({&muscle, &heads.mesh, {}});
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  const std::vector<FittedMuscle> fitted = fit_muscles(inputs, bones);
  std::vector<TriangleMesh> surfaces;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    ASSERT_FALSE(fitted[i].fit.radii.empty()) << to_text(fitted[i].diagnostics);
    for (const SectionReport& section : fitted[i].sections) EXPECT_TRUE(section.inside);
    const auto built = build_muscle_asset(std::span(&heads.muscles[i], 1), bones, std::span(&fitted[i].fit, 1));
    ASSERT_TRUE(built.ok());
    surfaces.push_back(rest_surface(**built, 0));
  }

  // Points inside, but for the outermost 1.5 mm: facets cut them off where the border between heads meets the mesh.
  const ClosestPoints mesh_surface(heads.mesh);
  const WindingField mesh_winding(heads.mesh);
  test::Numbers numbers(12);
  std::size_t inside = 0, several = 0;
  while (inside < 4000) {
    const glm::vec3 p(0.004f + 0.292f * numbers.next(), numbers.point(-0.06f, 0.06f).y, numbers.point(-0.06f, 0.06f).z);
    if (!mesh_winding.inside(p) || mesh_surface.at(p).distance < 0.0015f) continue;
    ++inside;
    std::size_t covering = 0;
    for (const TriangleMesh& surface : surfaces) covering += winding_number(surface, p) > 0.5 ? 1 : 0;
    ASSERT_GE(covering, 1u) << p.x << " " << p.y << " " << p.z;
    several += covering > 1 ? 1 : 0;
  }
  EXPECT_LT(several, inside * 2 / 5);  // they overlap little but where their lines run together

  for (const glm::vec3& p : heads.mesh.positions) {
    if (mesh_winding.at(glm::dvec3(p)) > 0.9) continue;  // inside the other shell
    if (p.x < 0.01f || p.x > 0.29f) continue;            // the caps lie 2 mm further in
    float nearest = 1.0f;
    for (const TriangleMesh& surface : surfaces) nearest = std::min(nearest, ClosestPoints(surface).at(p).distance);
    EXPECT_LT(nearest, 0.003f) << p.x << " " << p.y << " " << p.z;
  }
}

TEST_P(HeadsTest, AloneEachTakesAll) {
  const Heads heads = GetParam()();
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  const TriangleMesh copy = heads.mesh;
  const std::vector<FitInput> together{{&heads.muscles[0], &heads.mesh, {}}, {&heads.muscles[1], &heads.mesh, {}}};
  const std::vector<FitInput> apart{{&heads.muscles[0], &heads.mesh, {}}, {&heads.muscles[1], &copy, {}}};
  const std::vector<FittedMuscle> shared = fit_muscles(together, bones), whole = fit_muscles(apart, bones);
  const auto volume = [&](const FittedMuscle& fitted) {
    const auto built = build_muscle_asset(std::span(&heads.muscles[0], 1), bones, std::span(&fitted.fit, 1));
    return mesh_volume(rest_surface(**built, 0));
  };
  EXPECT_LT(volume(shared[0]), 0.85 * volume(whole[0]));
}

constexpr const char* kNames[] = {"flat", "biceps", "three"};
INSTANTIATE_TEST_SUITE_P(Shapes, HeadsTest, testing::Values(flat_muscle, biceps, three_heads),
                         [](const auto& shape) { return std::string(kNames[shape.index]); });

TEST(HeadRegion, AHeadWithoutAnyOfTheMeshIsToldWhy) {
  const TriangleMesh mesh = make_tube([](double) { return ellipse({0.0, 0.0}, 0.03, 0.02); }, 0.3, 12);
  const MuscleDescription through = line_muscle({{0.003f, 0, 0}, {0.297f, 0, 0}}, 12, 2),
                          beside = line_muscle({{0.003f, 0.1f, 0}, {0.297f, 0.1f, 0}}, 12, 2);
  const std::vector<FitInput> inputs{{&through, &mesh, {}}, {&beside, &mesh, {}}};
  const glm::mat4 bone(1.0f);
  const std::vector<FittedMuscle> fitted = fit_muscles(inputs, std::span(&bone, 1));
  EXPECT_FALSE(fitted[0].fit.radii.empty());
  EXPECT_TRUE(fitted[0].diagnostics.warnings.empty()) << to_text(fitted[0].diagnostics);
  EXPECT_TRUE(fitted[1].fit.radii.empty());
  EXPECT_THAT(to_text(fitted[1].diagnostics), testing::HasSubstr("nearer to other heads"));
}

TEST(HeadRegion, HeadsWithTheSameLineAreToldOnce) {
  const TriangleMesh mesh = make_tube([](double) { return ellipse({0.0, 0.0}, 0.03, 0.02); }, 0.3, 12), copy = mesh;
  std::vector<MuscleDescription> muscles(2, line_muscle({{0.003f, 0, 0}, {0.297f, 0, 0}}, 12, 2));
  muscles[0].name = "long head";
  muscles[1].longitudinal_subdivision = 3;  // which the line does not depend on
  const glm::mat4 bone(1.0f);
  const auto said = [&](const TriangleMesh& second) {
    const std::vector<FitInput> inputs{{&muscles[0], &mesh, {}}, {&muscles[1], &second, {}}};
    std::string text;
    for (const FittedMuscle& fitted : fit_muscles(inputs, std::span(&bone, 1))) {
      EXPECT_FALSE(fitted.fit.radii.empty());
      text += to_text(fitted.diagnostics);
    }
    return text;
  };
  const std::string text = said(mesh);
  EXPECT_EQ(std::ranges::count(text, '\n'), 1) << text;
  EXPECT_THAT(text, testing::HasSubstr("shared whole with 'long head'"));
  EXPECT_EQ(said(copy), "");
  muscles[1].attachments[0].position.y = 0.01f;
  EXPECT_EQ(said(mesh), "");
}

}  // namespace
}  // namespace fascicle::muscle
