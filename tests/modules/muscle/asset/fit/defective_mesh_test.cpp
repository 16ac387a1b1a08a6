// Meshes as authors bring them: each gives a clear warning, and a fit where there can be one; never a crash, always
// finite numbers.
#include <cmath>
#include <functional>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/fit/check_mesh.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using test::ellipse;
using test::line_muscle;
using testing::HasSubstr;
using testing::Not;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TriangleMesh tube() {
  return test::make_tube([](double s) { return ellipse({0.2 * s * (1.0 - s), 0.0}, 0.03, 0.02); }, 0.3, 24);
}

MuscleDescription muscle() { return line_muscle({{0.004f, 0, 0}, {0.296f, 0, 0}}, 12, 3); }

FittedMuscle fit(const TriangleMesh& mesh, const MuscleDescription& description = muscle()) {
  const FitInput input{&description, &mesh, {}};
  const glm::mat4 bone(1.0f);
  return fit_muscles(std::span(&input, 1), std::span(&bone, 1))[0];
}

std::string said(const FittedMuscle& fitted) { return to_text(fitted.diagnostics); }

void expect_unfitted(const FittedMuscle& fitted, const std::string& cause) {
  EXPECT_TRUE(fitted.fit.radii.empty() && fitted.fit.displacements.empty() && fitted.sections.empty());
  EXPECT_TRUE(fitted.diagnostics.errors.empty());
  ASSERT_EQ(fitted.diagnostics.warnings.size(), 1u) << said(fitted);
  EXPECT_THAT(said(fitted), HasSubstr(cause));
  EXPECT_THAT(said(fitted), HasSubstr("keeps its unfitted shape"));
}

// Fitted, every centre inside the whole tube that the defective one was made from, every vertex near it.
void expect_fitted(const FittedMuscle& fitted, const std::string& cause, double tolerance) {
  EXPECT_TRUE(fitted.diagnostics.errors.empty());
  ASSERT_EQ(fitted.diagnostics.warnings.size(), cause.empty() ? 0u : 1u) << said(fitted);
  EXPECT_THAT(said(fitted), HasSubstr(cause));
  const MuscleDescription description = muscle();
  const auto built = build_muscle_asset(std::span(&description, 1), std::vector{glm::mat4(1.0f)},
                                        std::span(&fitted.fit, 1));
  ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
  const MuscleAsset& asset = **built;
  const TriangleMesh whole = tube();
  const ClosestPoints surface(whole);
  const TriangleMesh rest = rest_surface(asset, 0);
  for (std::uint32_t k = 0; k < asset.muscles[0].section_count; ++k) {
    EXPECT_GT(winding_number(whole, glm::dvec3(rest_point(asset, 0, k))), 0.5) << k;
    for (std::uint32_t i = 0; i < 12; ++i) {
      EXPECT_LT(surface.at(rest.positions[12 * k + i]).distance, tolerance) << k << " " << i;
    }
  }
}

TEST(DefectiveMesh, AWholeOneGivesNoWarning) { expect_fitted(fit(tube()), "", 2e-6); }

TEST(DefectiveMesh, WithoutTriangles) {
  expect_unfitted(fit({}), "has no triangles");
  TriangleMesh points = tube();
  points.indices.clear();
  expect_unfitted(fit(points), "has no triangles");
}

TEST(DefectiveMesh, NothingButDegenerateTriangles) {
  TriangleMesh mesh = tube();
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) mesh.indices[i + 1] = mesh.indices[i];
  expect_unfitted(fit(mesh), "is left without triangles");
}

TEST(DefectiveMesh, NothingButNumbersThatAreNotFinite) {
  TriangleMesh mesh = tube();
  for (glm::vec3& p : mesh.positions) p.z = kNan;
  expect_unfitted(fit(mesh), "is left without triangles");
}

TEST(DefectiveMesh, InAnotherUnit) {
  const std::pair<float, const char*> units[] = {{1000.0f, "in millimetres"}, {100.0f, "in centimetres"},
                                                 {39.37f, "in inches"},       {0.001f, "metres given as millimetres"},
                                                 {0.01f, "metres given as centimetres"}};
  for (const auto& [scale, unit] : units) {
    TriangleMesh mesh = tube();
    for (glm::vec3& p : mesh.positions) p *= scale;
    expect_unfitted(fit(mesh), unit);
  }
}

TEST(DefectiveMesh, OfASizeThatNoUnitExplains) {
  for (const float scale : {1.0e37f, 3.0e5f, 1.0e-5f, 1.0e-30f}) {
    TriangleMesh mesh = tube();
    for (glm::vec3& p : mesh.positions) p *= scale;
    const FittedMuscle fitted = fit(mesh);
    expect_unfitted(fitted, "m across");
    EXPECT_THAT(said(fitted), Not(HasSubstr("seems"))) << scale;
  }
}

// A line that winds to and fro is as large as its mesh, however long it is.
TEST(DefectiveMesh, AWindingLineIsNoOtherUnit) {
  std::vector<glm::vec3> points;
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(i % 2 == 0 ? 0.05f : 0.25f, 0.05f, 1.0e-4f * static_cast<float>(i - 100));
  }
  const FittedMuscle fitted = fit(tube(), line_muscle(points, 12, 0));
  EXPECT_FALSE(fitted.fit.radii.empty());
  EXPECT_THAT(said(fitted), Not(HasSubstr("unit")));
}

TEST(DefectiveMesh, AVertexFarAwayIsNamed) {
  for (const float far : {12.0f, 1.0e4f, 1.0e8f, 1.0e20f}) {
    TriangleMesh mesh = tube();
    mesh.positions[500].y = far;
    const FittedMuscle fitted = fit(mesh);
    expect_unfitted(fitted, "has a vertex");
    EXPECT_THAT(said(fitted), HasSubstr("remove it"));
    EXPECT_THAT(said(fitted), Not(HasSubstr("seems")));
  }
  EXPECT_FALSE(find_stray_vertex(tube()));
  EXPECT_FALSE(find_stray_vertex({}));
}

TEST(DefectiveMesh, AnActionLineThatMissesIt) {
  expect_unfitted(fit(test::moved(tube(), glm::translate(glm::mat4(1.0f), {0.4f, 0, 0}))), "is missed");
}

TEST(DefectiveMesh, AnActionLineFarOffIt) {
  for (const glm::vec3 away : {glm::vec3(1.0f, 0, 0), glm::vec3(0, 1.0f, 0), glm::vec3(-0.3f, 0.8f, -0.8f)}) {
    expect_unfitted(fit(test::moved(tube(), glm::translate(glm::mat4(1.0f), away))),
                    "m away from the muscle's action line");
  }
  expect_unfitted(fit(test::moved(tube(), glm::translate(glm::mat4(1.0f), {0, 0, 1.02f}))), "lies 1 m away");
  const FittedMuscle beside = fit(test::moved(tube(), glm::translate(glm::mat4(1.0f), {0, 0.08f, 0})));
  EXPECT_GT(beside.sections.at(4).moved, 0.05f);
}

// Far from every attachment, but near the line between two of them.
TEST(DefectiveMesh, ALineIsNearWhereItPasses) {
  const FittedMuscle fitted = fit(tube(), line_muscle({{0.15f, 0, -1.0f}, {0.15f, 0, 1.0f}}, 12, 1));
  EXPECT_THAT(said(fitted), Not(HasSubstr("away from")));
}

TEST(DefectiveMesh, OneThatFewSectionsFindIsTold) {
  const FittedMuscle few = fit(tube(), line_muscle({{0.25f, 0, 0}, {0.85f, 0, 0}}, 12, 3));
  ASSERT_EQ(few.sections.size(), 9u);
  ASSERT_EQ(few.diagnostics.warnings.size(), 1u) << said(few);
  EXPECT_THAT(said(few), HasSubstr("round 7 of 7 inner ones there is none"));
  const FittedMuscle several = fit(tube(), line_muscle({{0.004f, 0, 0}, {0.55f, 0, 0}}, 12, 3));
  EXPECT_FALSE(several.fit.radii.empty());
  EXPECT_TRUE(several.diagnostics.warnings.empty()) << said(several);
}

TEST(DefectiveMesh, InsideOut) { expect_fitted(fit(test::inside_out(tube())), "inside out", 2e-6); }

TEST(DefectiveMesh, FlippedTriangles) {
  TriangleMesh mesh = tube();
  for (std::size_t i = 0; i < mesh.indices.size(); i += 21) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  expect_fitted(fit(mesh), "flipped", 2e-6);
}

TEST(DefectiveMesh, AVertexThatIsNotFinite) {
  TriangleMesh mesh = tube();
  mesh.positions[500].y = kNan;
  expect_fitted(fit(mesh), "finite", 4e-3);
}

TEST(DefectiveMesh, SmallHoles) {
  TriangleMesh mesh = tube();
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    if (i % 87 != 0) kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                                 mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  mesh.indices = kept;
  expect_fitted(fit(mesh), "hole", 3e-3);
}

TEST(DefectiveMesh, OneLargeHole) {
  TriangleMesh mesh = tube();
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3& p = mesh.positions[mesh.indices[i]];
    const bool gone = std::abs(p.x - 0.15f) < 0.02f && p.z > 0.012f;
    if (!gone) kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                           mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  mesh.indices = kept;
  expect_fitted(fit(mesh), "hole", 8e-3);  // closed by where the winding number is one half: a hollow
}

TEST(DefectiveMesh, WithoutItsEnds) {
  TriangleMesh mesh = tube();
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const float a = mesh.positions[mesh.indices[i]].x, b = mesh.positions[mesh.indices[i + 1]].x,
                c = mesh.positions[mesh.indices[i + 2]].x;
    if (!(a == b && b == c)) kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                                         mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  ASSERT_LT(kept.size(), mesh.indices.size());
  mesh.indices = kept;
  expect_fitted(fit(mesh), "2 holes", 1.5e-2);
}

TEST(DefectiveMesh, DoubledVerticesAndTriangles) {
  TriangleMesh mesh = tube();
  TriangleMesh shattered;  // each triangle with corners of its own, as .stl has them
  shattered.name = "shattered";
  for (const std::uint32_t index : mesh.indices) {
    shattered.indices.push_back(static_cast<std::uint32_t>(shattered.positions.size()));
    shattered.positions.push_back(mesh.positions[index]);
  }
  expect_fitted(fit(shattered), "", 2e-6);
  mesh.indices.insert(mesh.indices.end(), mesh.indices.begin(), mesh.indices.begin() + 90);
  expect_fitted(fit(mesh), "twice", 2e-6);
}

TEST(DefectiveMesh, AllTrianglesSeveralTimes) {
  const TriangleMesh once = tube();
  for (const int copies : {2, 3}) {
    TriangleMesh repeated = once, joined = once;
    for (int i = 1; i < copies; ++i) {
      repeated.indices.insert(repeated.indices.end(), once.indices.begin(), once.indices.end());
      joined = test::join(joined, once);
    }
    expect_fitted(fit(repeated), "twice", 2e-6);
    expect_fitted(fit(joined), "twice", 2e-6);
  }
  const TriangleMesh inner = test::make_sphere(0.01f, 12, 18, {0.15f, 0.05f, 0.0f});
  expect_fitted(fit(test::join(test::join(once, inner), inner)), "twice", 2e-6);
  TriangleMesh folded = once;  // a flap without a thickness, not a triangle twice
  folded.indices.insert(folded.indices.end(), {0, 1, 50, 1, 0, 50});
  expect_fitted(fit(folded), "", 2e-6);
}

TEST(DefectiveMesh, ShellsThatOverlapAreFittedAsOne) {
  const TriangleMesh mesh = test::join(tube(), test::make_sphere(0.015f, 12, 18, {0.15f, 0.05f, 0.0f}));
  expect_fitted(fit(mesh), "", 2e-6);  // all inside
  const TriangleMesh crossing = test::join(tube(), test::make_sphere(0.03f, 24, 36, {0.15f, 0.05f, 0.0f}));
  const FittedMuscle fitted = fit(crossing);
  EXPECT_FALSE(fitted.fit.radii.empty());
  EXPECT_THAT(said(fitted), HasSubstr("cross each other"));
  for (const SectionReport& section : fitted.sections) EXPECT_TRUE(section.inside);
}

TEST(DefectiveMesh, APartThatIsInsideOutDoesNotCount) {
  // It reaches out of the tube's side; lines meet its back first.
  const TriangleMesh mesh =
      test::join(tube(), test::inside_out(test::make_sphere(0.02f, 24, 36, {0.15f, 0.05f, 0.025f})));
  const FittedMuscle fitted = fit(mesh);
  ASSERT_FALSE(fitted.fit.radii.empty());
  EXPECT_EQ(fitted.diagnostics.warnings.size(), 1u);
  const MuscleDescription description = muscle();
  const auto built = build_muscle_asset(std::span(&description, 1), std::vector{glm::mat4(1.0f)},
                                        std::span(&fitted.fit, 1));
  ASSERT_TRUE(built.ok());
  const TriangleMesh whole = tube(), rest = rest_surface(**built, 0);
  const ClosestPoints surface(whole);
  for (const glm::vec3& p : rest.positions) {
    EXPECT_TRUE(surface.at(p).distance < 1e-5f || winding_number(whole, glm::dvec3(p)) > 0.5) << p.x << " " << p.y;
  }
}

TEST(DefectiveMesh, SoupStaysFinite) {
  for (std::uint32_t seed = 1; seed < 12; ++seed) {
    TriangleMesh mesh = test::moved(test::make_soup(40, seed), glm::scale(glm::mat4(1.0f), glm::vec3(0.1f)));
    mesh.name = "soup";
    const FittedMuscle fitted = fit(mesh);
    EXPECT_FALSE(fitted.diagnostics.warnings.empty());
    for (const float radius : fitted.fit.radii) ASSERT_TRUE(std::isfinite(radius));
    for (const glm::vec3& mu : fitted.fit.displacements) ASSERT_TRUE(std::isfinite(mu.x + mu.y + mu.z));
  }
}

TEST(DefectiveMesh, AMillionTrianglesAreNoHindrance) {
  TriangleMesh mesh = test::make_sphere(0.05f, 708, 708);
  ASSERT_GT(mesh.indices.size() / 3, 1'000'000u);
  const MuscleDescription description = line_muscle({{0, 0, -0.049f}, {0, 0, 0.049f}}, 12, 2);
  const FittedMuscle fitted = fit(mesh, description);
  EXPECT_TRUE(fitted.diagnostics.warnings.empty()) << said(fitted);
  ASSERT_EQ(fitted.fit.radii.size(), 12u * 5u);
  for (std::uint32_t i = 24; i < 36; ++i) EXPECT_NEAR(fitted.fit.radii[i], 0.05f, 1e-5f);
}

TEST(CheckMesh, SoundnessIsThatEverySideHasItsReverse) {
  EXPECT_TRUE(is_sound(tube()));
  EXPECT_TRUE(is_sound(test::join(tube(), test::make_torus(0.1f, 0.02f, 20, 10))));
  EXPECT_FALSE(is_sound({}));
  EXPECT_FALSE(is_sound(test::inside_out(tube())));
  for (const std::size_t at : {0u, 300u, 1200u}) {
    TriangleMesh open = tube(), flipped = open;
    open.indices.erase(open.indices.begin() + static_cast<std::ptrdiff_t>(at),
                       open.indices.begin() + static_cast<std::ptrdiff_t>(at + 3));
    EXPECT_FALSE(is_sound(open));
    std::swap(flipped.indices[at], flipped.indices[at + 1]);
    EXPECT_FALSE(is_sound(flipped));
  }
  TriangleMesh not_finite = tube();
  not_finite.positions[3].x = kNan;
  EXPECT_FALSE(is_sound(not_finite));
}

}  // namespace
}  // namespace fascicle::muscle
