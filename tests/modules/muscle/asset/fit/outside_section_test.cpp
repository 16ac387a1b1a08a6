#include "modules/muscle/asset/fit/outside_section.hpp"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "modules/muscle/asset/fit/section_rays.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

// The slice of a box of 2 m by 2 m, seen from `from`.
std::vector<SectionSlice> slices_from(const glm::dvec2& from) {
  const TriangleMesh box = test::make_box({-1, -1, -1}, {1, 1, 1});
  return slice_section(box, {.centre = {from.x, from.y, 0.0}, .tangent = {0, 0, 1}, .u = {1, 0, 0}, .v = {0, 1, 0}});
}

struct Shaped {
  std::vector<double> radii = std::vector<double>(8, -5.0);
  std::vector<std::uint8_t> hits = std::vector<std::uint8_t>(8, 1);
};

Shaped shape(std::span<const SectionSlice> slices) {
  Shaped shaped;
  shape_outside_section(slices, ray_directions(8), shaped.radii, shaped.hits);
  return shaped;
}

TEST(OutsideSection, WithoutASliceAllRaysMiss) {
  EXPECT_EQ(shape({}).hits, std::vector<std::uint8_t>(8, 0));
}

TEST(OutsideSection, ASliceFartherThanItsSizeIsAnothers) {
  EXPECT_EQ(shape(slices_from({-3.5, 0.1})).hits, std::vector<std::uint8_t>(8, 0));
  EXPECT_EQ(shape(slices_from({-2.9, 0.1})).hits, std::vector<std::uint8_t>(8, 1));
}

TEST(OutsideSection, TheFarSideBoundsIt) {
  const Shaped shaped = shape(slices_from({-1.25, 0.0}));  // a quarter of a metre to the left of the box
  EXPECT_NEAR(shaped.radii[0], 2.25, 1e-6);
  EXPECT_NEAR(shaped.radii[1], std::numbers::sqrt2, 1e-6);  // out at the top
  EXPECT_NEAR(shaped.radii[7], std::numbers::sqrt2, 1e-6);
  for (const std::size_t i : {2u, 3u, 4u, 5u, 6u}) EXPECT_NEAR(shaped.radii[i], 0.02 * 2.25, 1e-6) << i;
}

}  // namespace
}  // namespace fascicle::muscle
