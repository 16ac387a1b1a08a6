#include "modules/muscle/measure/section_areas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "modules/muscle/measure/sample_surface.hpp"
#include "tests/modules/muscle/measure/measured_shapes.hpp"

namespace fascicle::muscle {
namespace {

TEST(SectionAreas, AreThoseOfTheDrawnPolygons) {
  MuscleDescription with_tendons = test::cylinder("b", {0.1f, 0, 0}, {0.1f, 0.3f, 0}, 0.02f, 2, 12);
  with_tendons.tendon_at_origin = with_tendons.tendon_at_insertion = 0.5f;
  with_tendons.hill = {.max_isometric_force = 500.0f, .optimal_fibre_length = 0.1f, .tendon_slack_length = 0.2f};
  const test::Measured two({test::cylinder("a", {0, 0, 0}, {0, 0.2f, 0}, 0.01f, 1, 8), with_tendons}, {});
  ASSERT_TRUE(two.asset->muscles[1].tendon_drawn[0] && two.asset->muscles[1].tendon_drawn[1]);
  const RestSurfaces rest = make_rest_surfaces(two.asset, std::vector<glm::mat4>{glm::mat4(1.0f)});
  std::vector<float> areas;
  measure_section_areas(*two.asset, rest.surfaces, rest.tendons, areas);
  ASSERT_EQ(areas.size(), 3u + 5u);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double count = i < 3 ? 8.0 : 12.0, radius = i < 3 ? 0.01 : 0.02;
    EXPECT_NEAR(areas[i], 0.5 * count * radius * radius * std::sin(2.0 * std::numbers::pi / count), 1e-8) << i;
  }
  // Tendon sections have their place among the rows.
  std::vector<float> places;
  find_row_places(*two.asset, rest.tendons, 1, places);
  ASSERT_EQ(places.size(), 7u);
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
  EXPECT_EQ(places.front(), 0.0f);
  EXPECT_EQ(places.back(), 4.0f);

  std::vector<float> targets = areas;
  EXPECT_EQ(worst_area_error(*two.asset, areas, targets).relative, 0.0f);
  EXPECT_EQ(worst_area_error(*two.asset, areas, {}).relative, 0.0f);
  targets[1] *= 1.25f;
  targets[0] = 1.0f;  // ends do not count
  targets[5] = 0.0f;  // nor what has no target
  const AreaError worst = worst_area_error(*two.asset, areas, targets);
  EXPECT_NEAR(worst.relative, 0.2f, 1e-6f);
  EXPECT_EQ(worst.muscle, 0u);
  EXPECT_EQ(worst.section, 1u);
  areas[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isinf(worst_area_error(*two.asset, areas, targets).relative));
}

}  // namespace
}  // namespace fascicle::muscle
