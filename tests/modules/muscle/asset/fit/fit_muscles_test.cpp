// Whole fits: what cannot be fitted, shapes with known answers, and what a fit must not depend on.
#include "modules/muscle/asset/fit/fit_muscles.hpp"

#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/math/state_hash.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/asset/fit/compare_fit.hpp"
#include "modules/muscle/asset/fit/section_rays.hpp"
#include "tests/modules/muscle/asset/fit/fit_shapes.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using test::c_shape;
using test::ellipse;
using test::line_muscle;
using test::make_tube;
using testing::HasSubstr;

FittedMuscle fit(const MuscleDescription& muscle, const TriangleMesh& mesh, const FitOptions& options = {},
                 const glm::mat4& bone = glm::mat4(1.0f)) {
  const FitInput input{&muscle, &mesh, {}};
  return fit_muscles(std::span(&input, 1), std::span(&bone, 1), options)[0];
}

std::shared_ptr<const MuscleAsset> build(const MuscleDescription& muscle, const FittedMuscle& fitted,
                                         const glm::mat4& bone = glm::mat4(1.0f)) {
  const auto built = build_muscle_asset(std::span(&muscle, 1), std::span(&bone, 1), std::span(&fitted.fit, 1));
  EXPECT_TRUE(built.ok()) << to_text(built.diagnostics());
  return built.ok() ? *built : nullptr;
}

// How far the built muscle's vertices lie from the mesh, at most, the first and last `skipped` sections left out.
double furthest_vertex(const MuscleAsset& asset, const TriangleMesh& mesh, std::uint32_t skipped = 0) {
  const ClosestPoints surface(mesh);
  const TriangleMesh rest = rest_surface(asset, 0);
  const std::uint32_t count = asset.muscles[0].section_vertices, sections = asset.muscles[0].section_count;
  double furthest = 0.0;
  for (std::uint32_t i = skipped * count; i < (sections - skipped) * count; ++i) {
    furthest = std::max(furthest, double{surface.at(rest.positions[i]).distance});
  }
  return furthest;
}

std::vector<bool> inside_by_winding(const MuscleAsset& asset, const TriangleMesh& mesh) {
  std::vector<bool> inside;
  for (std::uint32_t k = 0; k < asset.muscles[0].section_count; ++k) {
    inside.push_back(winding_number(mesh, glm::dvec3(rest_point(asset, 0, k))) > 0.5);
  }
  return inside;
}

TriangleMesh straight_tube() {
  return make_tube([](double) { return ellipse({0.0, 0.0}, 0.03, 0.02); }, 0.3, 12);
}

// A banana: the tube's middle line is an arc that rises by `rise` above its ends.
TriangleMesh banana(double rise = 0.06) {
  return make_tube([=](double s) { return ellipse({4.0 * rise * s * (1.0 - s), 0.0}, 0.02, 0.025); }, 0.3, 40);
}

bool is_empty(const FittedMuscle& fitted) {
  return fitted.fit.radii.empty() && fitted.fit.displacements.empty() && fitted.sections.empty();
}

TEST(FitMuscles, NothingInNothingOut) { EXPECT_TRUE(fit_muscles({}, {}).empty()); }

TEST(FitMuscles, WithoutAMeshThereIsNoFitAndNothingSaid) {
  const MuscleDescription muscle = line_muscle({{0, 0, 0}, {0.3f, 0, 0}}, 8, 1);
  const FitInput input{&muscle, nullptr, {}};
  const glm::mat4 bone(1.0f);
  const FittedMuscle fitted = fit_muscles(std::span(&input, 1), std::span(&bone, 1))[0];
  EXPECT_TRUE(is_empty(fitted));
  EXPECT_TRUE(fitted.diagnostics.warnings.empty());
}

TEST(FitMuscles, DescriptionsThatTheBuilderRefusesAreNotFitted) {
  const TriangleMesh mesh = straight_tube();
  MuscleDescription muscle = line_muscle({{0, 0, 0}, {0.3f, 0, 0}}, 8, 1);
  muscle.attachments[1].position.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(is_empty(fit(muscle, mesh)));
  muscle = line_muscle({{0, 0, 0}, {0.3f, 0, 0}}, 7, 1);
  EXPECT_TRUE(is_empty(fit(muscle, mesh)));
  muscle = line_muscle({{0, 0, 0}}, 8, 1);
  EXPECT_TRUE(is_empty(fit(muscle, mesh)));
  muscle = line_muscle({{0, 0, 0}, {0, 0, 0}}, 8, 1);
  EXPECT_TRUE(is_empty(fit(muscle, mesh)));
  muscle = line_muscle({{0, 0, 0}, {0.3f, 0, 0}}, 8, 1);
  muscle.attachments[0].bone = 4;
  EXPECT_TRUE(is_empty(fit(muscle, mesh)));
}

TEST(FitMuscles, AStraightTubeIsFoundExactly) {
  const TriangleMesh mesh = straight_tube();
  const MuscleDescription muscle = line_muscle({{0.003f, 0, 0}, {0.297f, 0, 0}}, 36, 2);
  const FittedMuscle fitted = fit(muscle, mesh);
  ASSERT_EQ(fitted.sections.size(), 5u);
  for (const SectionReport& section : fitted.sections) {
    EXPECT_EQ(section.outcome, SectionOutcome::kFitted);
    EXPECT_EQ(section.hits, 36u);
    EXPECT_EQ(section.misses, 0u);
    EXPECT_EQ(section.matches, 0u);
    EXPECT_EQ(section.moved, 0.0f);
    EXPECT_TRUE(section.inside);
  }
  EXPECT_TRUE(fitted.diagnostics.warnings.empty()) << to_text(fitted.diagnostics);
  EXPECT_LT(furthest_vertex(*build(muscle, fitted), mesh), 1e-6);
}

TEST(FitMuscles, AMuscleThatOnlyItsMeshMakesThickIsFitted) {
  MuscleDescription muscle = line_muscle({{0.003f, 0, 0}, {0.297f, 0, 0}}, 8, 1);  // no force, no volume
  EXPECT_FALSE(build_muscle_asset(std::span(&muscle, 1), std::vector{glm::mat4(1.0f)}).ok());
  EXPECT_FALSE(is_empty(fit(muscle, straight_tube())));
}

TEST(FitMuscles, CentresOutsideMoveInsideAndAllVerticesLieOnTheMesh) {
  const TriangleMesh mesh = banana();
  const MuscleDescription muscle = line_muscle({{0.004f, 0, 0}, {0.296f, 0, 0}}, 36, 3);
  const FittedMuscle fitted = fit(muscle, mesh);
  const auto asset = build(muscle, fitted);
  ASSERT_NE(asset, nullptr);
  EXPECT_THAT(inside_by_winding(*asset, mesh), testing::Each(true));
  EXPECT_GT(fitted.sections[4].moved, 0.03f);
  EXPECT_GT(fitted.sections[4].matches, 0u);
  // Two sweeps: the radii were cast in the planes that the moved centres have.
  EXPECT_LT(furthest_vertex(*asset, mesh), 2e-6);
}

// Why there are two: radii cast in the planes that the sections had before their neighbours moved do not fit.
TEST(FitMuscles, OneSweepWouldNotDo) {
  const TriangleMesh mesh = banana();
  const MuscleDescription muscle = line_muscle({{0.004f, 0, 0}, {0.296f, 0, 0}}, 36, 3);
  FittedMuscle fitted = fit(muscle, mesh);
  std::vector<glm::dvec3> points;
  for (int k = 0; k <= 8; ++k) points.emplace_back(0.004 + 0.0365 * k, 0.0, 0.0);
  std::vector<SectionFrame> frames;
  rest_frames(points, glm::dmat3(1.0), {}, frames);
  for (std::size_t k = 0; k < frames.size(); ++k) frames[k].centre += glm::dvec3(fitted.fit.displacements[k]);
  SectionRays rays;
  cast_sections(FitSurface(mesh, RayScene(mesh), true), frames, ray_directions(36), rays);
  fitted.fit.radii.assign(rays.radii.begin(), rays.radii.end());
  EXPECT_GT(furthest_vertex(*build(muscle, fitted), mesh), 1e-3);
}

TEST(FitMuscles, EndsGoBackToTheModelsPlaces) {
  const TriangleMesh mesh = banana();
  const MuscleDescription muscle = line_muscle({{0.02f, -0.03f, 0}, {0.28f, -0.03f, 0}}, 12, 2);
  const FittedMuscle restored = fit(muscle, mesh);
  EXPECT_EQ(restored.fit.displacements.front(), glm::vec3(0.0f));
  EXPECT_EQ(restored.fit.displacements.back(), glm::vec3(0.0f));
  EXPECT_EQ(restored.sections.front().outcome, SectionOutcome::kOutside);
  const FittedMuscle free = fit(muscle, mesh, {.supersampling = 6, .restore_ends = false, .rescue = false});
  EXPECT_GT(glm::length(free.fit.displacements.front()), 0.01f);
  for (const SectionReport& section : free.sections) EXPECT_TRUE(section.inside);
}

TEST(FitMuscles, ConcaveSlicesGetCentresInside) {
  for (const double opening : {0.4, 1.0, 2.0}) {
    const TriangleMesh mesh = make_tube(
        [=](double s) { return c_shape({0.0, 0.0}, 0.03 + 0.01 * s, 0.006, opening); }, 0.3, 10);
    const MuscleDescription muscle = line_muscle({{0.003f, 0, 0}, {0.15f, 0.004f, 0.002f}, {0.297f, 0, 0}}, 12, 2);
    const FittedMuscle fitted = fit(muscle, mesh, {.supersampling = 3, .restore_ends = false, .rescue = false});
    const auto asset = build(muscle, fitted);
    ASSERT_NE(asset, nullptr);
    EXPECT_THAT(inside_by_winding(*asset, mesh), testing::Each(true)) << opening;
  }
}

// A Y: two branches from x = 0 that meet at x = 0.2 and go on as one, made of two tubes that overlap.
TriangleMesh two_branches() {
  const auto branch = [](double side) {
    return make_tube(
        [=](double s) { return ellipse({side * 0.04 * std::max(0.0, 1.0 - s / 0.6), 0.0}, 0.012, 0.012); }, 0.3, 40);
  };
  return test::join(branch(1.0), branch(-1.0));
}

TEST(FitMuscles, WhereAPlaneCutsSeveralLoopsOneIsFollowed) {
  const TriangleMesh mesh = two_branches();
  for (const float side : {1.0f, -1.0f}) {
    const MuscleDescription muscle =
        line_muscle({{0.002f, side * 0.0395f, 0}, {0.18f, 0, 0}, {0.298f, 0, 0}}, 16, 3);
    const FittedMuscle fitted = fit(muscle, mesh);
    const auto asset = build(muscle, fitted);
    ASSERT_NE(asset, nullptr);
    EXPECT_EQ(fitted.sections[2].loops, 2u);
    EXPECT_THAT(inside_by_winding(*asset, mesh), testing::Each(true));
    EXPECT_LT(furthest_vertex(*asset, mesh), 2e-6);
    for (std::uint32_t k = 0; k < 5; ++k) {
      for (std::uint32_t i = 0; i < 16; ++i) {
        EXPECT_LT(asset->rest_radii[asset->radius(0, k) + i], 0.02f) << "it runs over into the other branch";
      }
    }
    // The plain method does run over.
    const FittedMuscle plain = fit(muscle, mesh, {.rescue = false});
    EXPECT_GT(*std::max_element(plain.fit.radii.begin(), plain.fit.radii.begin() + 3 * 16), 0.03f);
  }
}

TEST(FitMuscles, CentresThatRaysLeaveOutsideAreRescued) {
  // Six rays from far away pass a thin tendon by: it lies half-way between two of them.
  const TriangleMesh mesh = make_tube([](double) { return ellipse({0.0, 0.0}, 0.004, 0.004); }, 0.3, 6);
  const MuscleDescription muscle = line_muscle({{0.003f, 0, 0}, {0.15f, 0.05f, 0}, {0.297f, 0, 0}}, 6, 2);
  const FittedMuscle plain = fit(muscle, mesh, {.supersampling = 1, .rescue = false});
  const FittedMuscle rescued = fit(muscle, mesh, {.supersampling = 1});
  std::size_t outside = 0, helped = 0;
  for (const SectionReport& section : plain.sections) outside += section.inside ? 0 : 1;
  for (const SectionReport& section : rescued.sections) {
    EXPECT_TRUE(section.inside);
    helped += section.rescued ? 1 : 0;
  }
  EXPECT_GT(outside, 0u);
  EXPECT_GT(helped, 0u);
  EXPECT_THAT(inside_by_winding(*build(muscle, rescued), mesh), testing::Each(true));
}

TEST(FitMuscles, ReportsSayWhatTheWindingNumberSays) {
  const TriangleMesh mesh = make_tube(
      [](double s) { return c_shape({0.01, 0.01}, 0.03, 0.004 + 0.004 * s, 0.9); }, 0.3, 10);
  test::Numbers numbers(6);
  std::size_t outside = 0;
  for (int i = 0; i < 20; ++i) {
    const MuscleDescription muscle =
        line_muscle({numbers.point(0.0f, 0.05f), numbers.point(0.1f, 0.12f), glm::vec3(0.3f, 0, 0)}, 6, 2);
    const FittedMuscle fitted = fit(muscle, mesh, {.supersampling = 1, .restore_ends = true, .rescue = false});
    if (is_empty(fitted)) continue;
    const std::vector<bool> inside = inside_by_winding(*build(muscle, fitted), mesh);
    for (std::size_t k = 0; k < inside.size(); ++k) {
      EXPECT_EQ(fitted.sections[k].inside, inside[k]) << i << " " << k;
      outside += inside[k] ? 0 : 1;
    }
  }
  EXPECT_GT(outside, 5u);
}

TEST(FitMuscles, AnyLineThroughAnyShapeStaysFinite) {
  const std::vector<TriangleMesh> meshes = {straight_tube(), banana(), two_branches(), test::make_torus(0.12f, 0.02f, 40, 16),
                                            make_tube([](double) { return c_shape({0, 0}, 0.03, 0.004, 0.5); }, 0.3, 8)};
  test::Numbers numbers(77);
  std::size_t fits = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<glm::vec3> points;
    const int count = 2 + static_cast<int>(4.0f * numbers.next());
    for (int p = 0; p < count; ++p) points.push_back(numbers.point(-0.1f, 0.3f));
    if (i % 7 == 0) points.push_back(points[points.size() - 2]);  // a hairpin
    const MuscleDescription muscle = line_muscle(points, 6 + 2 * static_cast<std::uint32_t>(i % 9), static_cast<std::uint32_t>(i % 4));
    const TriangleMesh& mesh = meshes[static_cast<std::size_t>(i) % meshes.size()];
    FitInput input{&muscle, &mesh, {}};
    if (i % 3 == 0) input.areas[0] = {0, 1, 2, 3, 4, 5};
    if (i % 5 == 0) input.areas[1] = {static_cast<std::uint32_t>(i)};
    const glm::mat4 bone(1.0f);
    const FittedMuscle fitted = fit_muscles(std::span(&input, 1), std::span(&bone, 1))[0];
    if (is_empty(fitted)) {
      EXPECT_EQ(fitted.diagnostics.warnings.size(), 1u) << i;
      continue;
    }
    ++fits;
    EXPECT_NE(build(muscle, fitted), nullptr) << i;  // which refuses what is not finite
    for (std::size_t k = 1; k + 1 < fitted.sections.size(); ++k) {
      EXPECT_TRUE(fitted.sections[k].inside || fitted.sections[k].hits == 0) << i << " " << k;
    }
  }
  EXPECT_GT(fits, 200u);
}

TEST(FitMuscles, ThePlainLoopGivesTheSameFit) {
  const TriangleMesh mesh = banana();
  const MuscleDescription muscle = line_muscle({{0.004f, 0.001f, 0}, {0.296f, 0, 0.002f}}, 36, 3);
  const FittedMuscle fast = fit(muscle, mesh), plain = fit(muscle, mesh, {.plain_rays = true});
  ASSERT_EQ(fast.fit.radii.size(), plain.fit.radii.size());
  for (std::size_t i = 0; i < fast.fit.radii.size(); ++i) {
    EXPECT_NEAR(fast.fit.radii[i], plain.fit.radii[i], 2e-6f) << i;
  }
}

TEST(FitMuscles, ARigidMotionOfEverythingChangesNothing) {
  const TriangleMesh mesh = banana();
  const MuscleDescription muscle = line_muscle({{0.004f, 0.001f, 0}, {0.296f, 0, 0.002f}}, 12, 3);
  const FittedMuscle still = fit(muscle, mesh);
  for (const float angle : {0.7f, 1.6f, 2.9f}) {
    const glm::mat4 motion =
        glm::rotate(glm::translate(glm::mat4(1.0f), {0.4f, 1.2f, -0.3f}), angle, glm::vec3(0.48f, -0.6f, 0.64f));
    const FittedMuscle moved = fit(muscle, test::moved(mesh, motion), {}, motion);
    ASSERT_EQ(moved.fit.radii.size(), still.fit.radii.size());
    for (std::size_t i = 0; i < still.fit.radii.size(); ++i) {
      EXPECT_NEAR(moved.fit.radii[i], still.fit.radii[i], 5e-6f) << angle << " " << i;
    }
    for (std::size_t k = 0; k < still.fit.displacements.size(); ++k) {
      const glm::vec3 wanted(motion * glm::vec4(still.fit.displacements[k], 0.0f));
      EXPECT_LT(glm::distance(moved.fit.displacements[k], wanted), 5e-6f);
    }
  }
}

// The same of what goes beyond the papers: several loops, holes, heads, areas.
TEST(FitMuscles, ARigidMotionChangesNothingInHardCasesEither) {
  TriangleMesh holed = banana();
  holed.indices.resize(holed.indices.size() - 60);
  const TriangleMesh branches = two_branches(), curved = banana();
  const MuscleDescription along = line_muscle({{0.004f, 0.001f, 0}, {0.296f, 0, 0.002f}}, 12, 3);
  const std::vector<MuscleDescription> heads = {line_muscle({{0.002f, 0.0395f, 0}, {0.18f, 0, 0}, {0.298f, 0, 0}}, 12, 2),
                                                line_muscle({{0.002f, -0.0395f, 0}, {0.18f, 0, 0}, {0.298f, 0, 0}}, 12, 2)};
  std::vector<std::uint32_t> cap;
  for (std::uint32_t t = static_cast<std::uint32_t>(curved.indices.size() / 3) - 40; 3 * t < curved.indices.size(); ++t) {
    cap.push_back(t);
  }
  const auto fit_all = [&](const glm::mat4& motion) {
    const TriangleMesh a = test::moved(holed, motion), b = test::moved(branches, motion), c = test::moved(curved, motion);
    const TriangleMesh alone = b;
    const std::vector<FitInput> inputs{{&along, &a, {}}, {&heads[0], &b, {}}, {&heads[1], &b, {}},
                                       {&heads[0], &alone, {}}, {&along, &c, {std::vector<std::uint32_t>{}, cap}}};
    return fit_muscles(inputs, std::span(&motion, 1));
  };
  const std::vector<FittedMuscle> still = fit_all(glm::mat4(1.0f));
  const glm::mat4 motion =
      glm::rotate(glm::translate(glm::mat4(1.0f), {0.2f, 0.4f, -0.3f}), 1.3f, glm::vec3(0.48f, -0.6f, 0.64f));
  const std::vector<FittedMuscle> moved = fit_all(motion);
  for (std::size_t m = 0; m < still.size(); ++m) {
    ASSERT_FALSE(still[m].fit.radii.empty()) << to_text(still[m].diagnostics);
    ASSERT_EQ(moved[m].fit.radii.size(), still[m].fit.radii.size()) << m;
    for (std::size_t i = 0; i < still[m].fit.radii.size(); ++i) {
      EXPECT_NEAR(moved[m].fit.radii[i], still[m].fit.radii[i], 2e-5f) << m << " " << i;
    }
  }
  EXPECT_TRUE(still[4].fit.end_normals[1].has_value());
}

TEST(FitMuscles, AUniformScaleOfEverythingScalesTheFit) {
  for (const float scale : {0.25f, 7.0f}) {
    TriangleMesh mesh = banana();
    MuscleDescription muscle = line_muscle({{0.004f, 0.001f, 0}, {0.296f, 0, 0.002f}}, 12, 3);
    const FittedMuscle before = fit(muscle, mesh);
    for (glm::vec3& p : mesh.positions) p *= scale;
    for (AttachmentDescription& attachment : muscle.attachments) attachment.position *= scale;
    const FittedMuscle after = fit(muscle, mesh);
    ASSERT_EQ(after.fit.radii.size(), before.fit.radii.size());
    for (std::size_t i = 0; i < before.fit.radii.size(); ++i) {
      EXPECT_NEAR(after.fit.radii[i], scale * before.fit.radii[i], 3e-6f * scale);
    }
  }
}

TEST(FitMuscles, TheNumberOfWorkersChangesNoBit) {
  const TriangleMesh curved = banana();
  const TriangleMesh c = make_tube([](double) { return c_shape({0, 0}, 0.03, 0.006, 1.0); }, 0.3, 10);
  const std::vector<MuscleDescription> muscles(
      24, line_muscle({{0.004f, 0.001f, 0}, {0.296f, 0, 0.002f}}, 12, 3));
  std::vector<TriangleMesh> meshes;
  for (std::size_t i = 0; i < muscles.size(); ++i) meshes.push_back(i % 2 == 0 ? curved : c);
  std::vector<FitInput> inputs;
  for (std::size_t i = 0; i < muscles.size(); ++i) inputs.push_back({&muscles[i], &meshes[i], {}});
  const glm::mat4 bone(1.0f);
  std::vector<std::uint64_t> hashes;
  for (const int workers : {1, 2, 5, 5}) {
    parallel::WorkerArena arena(workers);
    arena.execute([&] {
      StateHash hash;
      for (const FittedMuscle& fitted : fit_muscles(inputs, std::span(&bone, 1))) {
        hash.add(std::span<const float>(fitted.fit.radii));
        hash.add(std::span<const glm::vec3>(fitted.fit.displacements));
      }
      hashes.push_back(hash.value());
    });
  }
  EXPECT_THAT(hashes, testing::Each(hashes[0]));
}

}  // namespace
}  // namespace fascicle::muscle
