// Fibres in the anatomical muscles of the hip scenes.
#include <algorithm>

#include <gtest/gtest.h>

#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/asset/fibres/fibre_direction.hpp"
#include "modules/muscle/asset/fibres/surface_mesh.hpp"
#include "tests/modules/muscle/asset/fibres/hip_muscles.hpp"

namespace fascicle::muscle {
namespace {

void expect_inside(const SurfaceAsset& surface, const FibreBundleAsset& bundle) {
  ASSERT_EQ(bundle.count, 1000u);
  ASSERT_EQ(bundle.rest_points.size(), 10'000u);
  const WindingField winding(surface_mesh(surface));
  EXPECT_TRUE(std::ranges::all_of(bundle.rest_points, [&](const glm::vec3& p) { return winding.inside(p); }));
  // As long as a part of the muscle at least, and not longer than twice round it.
  EXPECT_GT(*std::ranges::min_element(bundle.rest_length), 0.2f * surface.size);
  EXPECT_LT(*std::ranges::max_element(bundle.rest_length), 1.5f * surface.size);
  EXPECT_LT(bundle.pulled_in, 2000u) << "that is a repair, not the method";
}

TEST(RealFibres, ReadsFiveFibresOfSixPoints) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus_fibres.vtk");
  const std::vector<FibreLine> fibres = test::read_hip_fibres();
  ASSERT_EQ(fibres.size(), 5u);
  for (const FibreLine& fibre : fibres) EXPECT_EQ(fibre.points.size(), 6u);
}

TEST(RealFibres, GluteusByIsocontours) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const auto muscle = test::build_gluteus();
  ASSERT_NE(muscle, nullptr);
  const auto bundle = build_fibre_bundle(*muscle, {});
  ASSERT_TRUE(bundle.ok()) << to_text(bundle.diagnostics());
  expect_inside(*muscle, **bundle);
}

TEST(RealFibres, GluteusBySurfaceFibres) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const auto muscle = test::build_gluteus();
  ASSERT_NE(muscle, nullptr);
  const auto bundle = build_fibre_bundle(*muscle, {.method = FibreMethod::kSurface});
  ASSERT_TRUE(bundle.ok()) << to_text(bundle.diagnostics());
  expect_inside(*muscle, **bundle);
  EXPECT_LT(measure_direction(**bundle, muscle->fibres).mean, 0.26) << "15 degrees";
}

TEST(RealFibres, IliacusByIsocontours) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/iliacus.vtk");
  const auto muscle = test::build_iliacus();
  ASSERT_NE(muscle, nullptr);
  const auto bundle = build_fibre_bundle(*muscle, {});
  ASSERT_TRUE(bundle.ok()) << to_text(bundle.diagnostics());
  expect_inside(*muscle, **bundle);
}

}  // namespace
}  // namespace fascicle::muscle
