#include "modules/muscle/asset/fibres/fibre_bundle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/fibres/fibre_direction.hpp"
#include "modules/muscle/asset/fibres/pull_inside.hpp"
#include "modules/muscle/asset/fibres/surface_mesh.hpp"
#include "tests/modules/muscle/asset/fibres/tube_muscle.hpp"

namespace fascicle::muscle {
namespace {

using testing::HasSubstr;

constexpr float kRadius = 0.02f, kLength = 0.2f;  // m

std::shared_ptr<const SurfaceAsset> build(const SurfaceMuscleDescription& description) {
  const auto asset = build_surface_asset(description, 2);
  EXPECT_TRUE(asset.ok()) << to_text(asset.diagnostics());
  return asset ? *asset : nullptr;
}

std::shared_ptr<const FibreBundleAsset> make(const SurfaceAsset& surface, const FibreBundleSettings& settings) {
  const auto bundle = build_fibre_bundle(surface, settings);
  EXPECT_TRUE(bundle.ok()) << to_text(bundle.diagnostics());
  return bundle ? *bundle : nullptr;
}

std::string fault(const SurfaceAsset& surface, const FibreBundleSettings& settings) {
  const auto bundle = build_fibre_bundle(surface, settings);
  return bundle ? "built" : to_text(bundle.diagnostics());
}

std::span<const glm::vec3> points_of(const FibreBundleAsset& bundle, std::size_t fibre) {
  return std::span(bundle.rest_points).subspan(fibre * bundle.points_per_fibre, bundle.points_per_fibre);
}

// Lengths of the fibres when every vertex is moved by `by`.
std::vector<float> lengths_after(const SurfaceAsset& surface, const FibreBundleAsset& bundle, const glm::mat4& by) {
  AlignedVector<SurfacePoint> moved = surface.rest;
  for (SurfacePoint& p : moved) {
    const glm::vec3 there(by * glm::vec4(p.x, p.y, p.z, 1.0f));
    p = {there.x, there.y, there.z, p.inverse_mass};
  }
  std::vector<SurfacePoint> points(bundle.bindings.size());
  std::vector<float> lengths(bundle.count);
  place_fibres({bundle.bindings, bundle.points_per_fibre, moved, points, lengths});
  return lengths;
}

// A flat muscle along z, 10 cm wide and 2 cm thick, with fibres on its upper face (+y) at the places x.
SurfaceMuscleDescription describe_slab(std::initializer_list<std::pair<float, std::uint32_t>> fibres) {
  SurfaceMuscleDescription description;
  description.name = "slab";
  description.mesh = test::make_box({0, 0, 0}, {0.1f, 0.02f, 0.2f});
  for (const auto& [x, head] : fibres)
    description.fibres.push_back({{{x, 0.02f, 0.01f}, {x, 0.02f, 0.08f}, {x, 0.02f, 0.19f}}, head});
  return description;
}

TEST(FibreBundle, SettingsOutOfRangeAreToldTogether) {
  const auto tube = build(test::describe_tube());
  FibreBundleSettings settings;
  settings.count = 0;
  settings.points = 1;
  settings.pennation = std::numeric_limits<float>::quiet_NaN();
  const std::string text = fault(*tube, settings);
  EXPECT_THAT(text, HasSubstr("tube/inner_fibres: 0 fibres"));
  EXPECT_THAT(text, HasSubstr("1 points a fibre"));
  EXPECT_THAT(text, HasSubstr("a pennation of nan rad"));
  settings = {.count = 100'000, .points = 1'000};
  EXPECT_THAT(fault(*tube, settings), HasSubstr("100000000 points in all"));
}

TEST(FibreBundle, IsocontoursNeedOneOriginAndOneInsertion) {
  SurfaceMuscleDescription description = test::describe_tube();
  description.attachments.pop_back();
  EXPECT_THAT(fault(*build(description), {}), HasSubstr("no vertex is attached as its insertion"));
  description.attachments.clear();
  EXPECT_THAT(fault(*build(description), {}), HasSubstr("no vertex is attached as its origin"));

  // A second origin in the middle of the tube's side.
  description = test::describe_tube();
  SurfaceAttachment second{.bone = 0, .origin = true, .vertices = {}};
  for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
    const glm::vec3& p = description.mesh.positions[v];
    if (p.x > 0.9f * kRadius && p.z > 0.08f && p.z < 0.12f) second.vertices.push_back(v);
  }
  ASSERT_GT(second.vertices.size(), 10u);
  description.attachments.push_back(second);
  const std::string text = fault(*build(description), {});
  EXPECT_THAT(text, HasSubstr("its origin is 2 patches apart from each other: it has several heads"));
  EXPECT_THAT(text, HasSubstr("use the method \"surface\""));

  // Specks of one and the same attachment are no heads.
  description.attachments.pop_back();
  description.attachments[0].vertices.insert(description.attachments[0].vertices.end(), second.vertices.begin(),
                                             second.vertices.begin() + 3);
  EXPECT_EQ(fault(*build(description), {.count = 3}), "built");

  // Everything attached: nothing lies between.
  description = test::describe_tube();
  for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
    const float z = description.mesh.positions[v].z;
    if (z > 0.0f && z < kLength) description.attachments[z < 0.5f * kLength ? 0 : 1].vertices.push_back(v);
  }
  EXPECT_THAT(fault(*build(description), {}), HasSubstr("nothing lies between its origin and its insertion"));
}

TEST(FibreBundle, SurfaceFibresMustBeThereAndTouchTheMuscle) {
  const FibreBundleSettings settings{.method = FibreMethod::kSurface, .count = 10};
  EXPECT_THAT(fault(*build(describe_slab({})), settings), HasSubstr("it has no fibres on its surface"));
  EXPECT_THAT(fault(*build(describe_slab({{0.05f, 4}})), settings), HasSubstr("head 4 has one fibre on its surface"));
  EXPECT_THAT(fault(*build(describe_slab({{0.02f, 0}, {0.5f, 0}, {0.06f, 0}})), settings),
              HasSubstr("surface fibre 2 does not touch the muscle: it stays 400 mm off"));
  SurfaceMuscleDescription beside = describe_slab({{0.11f, 0}, {0.115f, 0}});  // near, but beside it
  EXPECT_THAT(fault(*build(beside), settings), HasSubstr("does not lie under the fibres of head 0"));
}

TEST(FibreBundle, AParallelTubeHasStraightFibresOfItsLengthEvenlySpread) {
  const auto tube = build(test::describe_tube(kRadius, kLength));
  const auto bundle = make(*tube, {.count = 400, .points = 6});
  ASSERT_NE(bundle, nullptr);
  ASSERT_EQ(bundle->count, 400u);
  ASSERT_EQ(bundle->rest_points.size(), 2400u);
  const WindingField winding(surface_mesh(*tube));
  std::array<int, 4> quadrants{};
  int inner = 0;
  for (std::size_t f = 0; f < bundle->count; ++f) {
    EXPECT_NEAR(bundle->rest_length[f], kLength, 0.02f * kLength) << "but for a margin under both caps";
    const auto points = points_of(*bundle, f);
    EXPECT_LT(points.front().z, 0.003f) << "from the origin";
    for (const glm::vec3& p : points) {
      EXPECT_TRUE(winding.inside(p));
      EXPECT_LT(glm::length(glm::vec2(p) - glm::vec2(points[0])), 0.05f * kRadius) << "straight";
    }
    const glm::vec3& p = points[3];
    ++quadrants[(p.x > 0.0f ? 1 : 0) + (p.y > 0.0f ? 2 : 0)];
    inner += glm::length(glm::vec2(p)) < 0.96f * kRadius * std::sqrt(0.5f);
  }
  for (const int count : quadrants) EXPECT_NEAR(count, 100, 12);
  EXPECT_NEAR(inner, 200, 24) << "half of the area has half of the fibres";
}

TEST(FibreBundle, APennateTubeHasItsAngle) {
  const auto tube = build(test::describe_tube(kRadius, kLength));
  for (const float pennation : {0.2f, 0.5f}) {
    const auto bundle = make(*tube, {.arrangement = FibreArrangement::kPennate, .count = 200, .points = 6,
                                     .pennation = pennation});
    ASSERT_NE(bundle, nullptr);
    double sum = 0.0;
    for (std::size_t f = 0; f < bundle->count; ++f) {
      const glm::vec3 way = glm::normalize(points_of(*bundle, f).back() - points_of(*bundle, f).front());
      sum += std::acos(static_cast<double>(way.z));
    }
    EXPECT_NEAR(sum / bundle->count, static_cast<double>(pennation), 0.06 * static_cast<double>(pennation));
  }
}

TEST(FibreBundle, AFanComesTogetherAtTheInsertion) {
  const auto tube = build(test::describe_tube(kRadius, kLength));
  const auto bundle = make(*tube, {.arrangement = FibreArrangement::kFan, .count = 50, .points = 4});
  ASSERT_NE(bundle, nullptr);
  for (std::size_t f = 0; f < bundle->count; ++f)
    EXPECT_LT(glm::length(glm::vec2(points_of(*bundle, f).back())), 0.3f * kRadius);
}

TEST(FibreBundle, FollowsRigidMotionExactlyAndStretchesWithTheMuscle) {
  const auto tube = build(test::describe_tube(kRadius, kLength));
  const auto bundle = make(*tube, {.count = 100, .points = 8});
  ASSERT_NE(bundle, nullptr);
  EXPECT_EQ(lengths_after(*tube, *bundle, glm::mat4(1.0f)), bundle->rest_length) << "to the last bit";
  const glm::mat4 rigid = glm::rotate(glm::translate(glm::mat4(1.0f), {0.3f, -0.2f, 0.1f}), 1.1f,
                                      glm::normalize(glm::vec3(1, 2, 3)));
  const std::vector<float> moved = lengths_after(*tube, *bundle, rigid);
  for (const float s : {0.7f, 1.6f}) {
    const std::vector<float> stretched = lengths_after(*tube, *bundle, glm::scale(glm::mat4(1.0f), {1.0f, 1.0f, s}));
    for (std::size_t f = 0; f < bundle->count; ++f) {
      EXPECT_NEAR(stretched[f], s * bundle->rest_length[f], 0.01f * kLength);
      EXPECT_NEAR(moved[f], bundle->rest_length[f], 2e-5f * kLength);
    }
  }
}

TEST(FibreBundle, SurfaceFibresFillWhatLiesUnderThemHeadByHead) {
  // The second head's fibres are twice as far apart: it has twice the volume.
  const auto slab = build(describe_slab({{0.01f, 1}, {0.02f, 1}, {0.03f, 1}, {0.05f, 7}, {0.07f, 7}, {0.09f, 7}}));
  const auto bundle = make(*slab, {.method = FibreMethod::kSurface, .count = 300, .points = 5});
  ASSERT_NE(bundle, nullptr);
  ASSERT_EQ(bundle->count, 300u);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(bundle->head, 1u)), 100.0, 2.0);
  int upper = 0;
  for (std::size_t f = 0; f < bundle->count; ++f) {
    const auto points = points_of(*bundle, f);
    const bool first = bundle->head[f] == 1;
    for (const glm::vec3& p : points) {
      EXPECT_GT(p.x, first ? 0.0099f : 0.0499f);
      EXPECT_LT(p.x, first ? 0.0301f : 0.0901f);
      EXPECT_GT(p.y, 0.0f);
      EXPECT_LT(p.y, 0.02f);
    }
    EXPECT_NEAR(bundle->rest_length[f], 0.18f, 0.002f);
    upper += points[2].y > 0.01f;
  }
  EXPECT_NEAR(upper, 150, 12) << "evenly through the thickness";
  EXPECT_LT(measure_direction(*bundle, slab->fibres).mean, 0.01);
}

TEST(FibreBundle, FibresThatRunTheOtherWayAreTurned) {
  SurfaceMuscleDescription description = describe_slab({{0.02f, 0}, {0.05f, 0}, {0.08f, 0}});
  description.attachments = {{.bone = 0, .origin = true, .vertices = {4, 5, 6, 7}},  // z = 0.2
                             {.bone = 1, .origin = false, .vertices = {0, 1, 2, 3}}};
  const auto bundle = make(*build(description), {.method = FibreMethod::kSurface, .count = 9, .points = 3});
  ASSERT_NE(bundle, nullptr);
  for (std::size_t f = 0; f < bundle->count; ++f)
    EXPECT_GT(points_of(*bundle, f).front().z, points_of(*bundle, f).back().z);
}

TEST(FibreBundle, ErrorOfDirectionIsTheAngleBetweenTheLines) {
  const auto tube = build(test::describe_tube(kRadius, kLength));
  const auto bundle = make(*tube, {.count = 20, .points = 3});
  ASSERT_NE(bundle, nullptr);
  const FibreLine oblique{{{0.02f, 0.0f, 0.12f}, {0.02f, 0.02f, 0.1f}}, 0};  // 45 degrees, downwards
  const DirectionError error = measure_direction(*bundle, std::span(&oblique, 1));
  EXPECT_NEAR(error.mean, 0.25 * std::numbers::pi, 0.02);
  EXPECT_EQ(error.places, 28u);
}

TEST(PullInside, MovesWhatIsOutsideOrTooShallowAndNothingElse) {
  const TriangleMesh box = test::make_box({0, 0, 0}, {1, 1, 1});
  std::vector<glm::dvec3> points{{0.5, 0.5, 0.5}, {0.5, 0.5, 1.7}, {0.3, 0.02, 0.6}, {1.2, 1.3, 1.4}, {0.5, 1.0, 0.4}};
  const PulledPoints pulled = pull_inside(box, 0.1, points);
  EXPECT_EQ(pulled.failed, 0u);
  EXPECT_GE(pulled.outside, 2u);
  EXPECT_EQ(points[0], glm::dvec3(0.5));
  EXPECT_NEAR(glm::distance(points[1], glm::dvec3(0.5, 0.5, 0.9)), 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(points[2], glm::dvec3(0.3, 0.1, 0.6)), 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(points[4], glm::dvec3(0.5, 0.9, 0.4)), 0.0, 1e-6);
  for (const glm::dvec3& p : points) EXPECT_GT(winding_number(box, p), 0.5);
  EXPECT_NEAR(pulled.furthest, 0.8f, 1e-5f);
}

}  // namespace
}  // namespace fascicle::muscle
