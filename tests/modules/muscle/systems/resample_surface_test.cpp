// A level's surface in its neighbour's layout is the neighbour's own.
#include "modules/muscle/systems/5_present/resample_surface.hpp"

#include <gtest/gtest.h>

#include "tests/support/leveled_state.hpp"
#include "tests/support/synthetic_levels.hpp"

namespace fascicle::muscle {
namespace {

using test::LeveledState;

void expect_same(const std::shared_ptr<const MuscleLevels>& levels, const std::vector<glm::mat4>& bones,
                 float tolerance) {
  for (std::uint32_t level = 0; level + 1 < levels->assets.size(); ++level) {
    LeveledState fine(levels, {level, 1.0f}), coarse(levels, {level + 1, 0.0f});
    for (LeveledState* state : {&fine, &coarse}) {
      state->step(mtu_kernels(detect_simd()), bones, true);
      write_rows(state->asset(), state->sections, state->tendons, state->surfaces);
    }
    for (const bool refine : {false, true}) {
      const LeveledState& from = refine ? coarse : fine;
      const LeveledState& to = refine ? fine : coarse;
      MuscleSurfaces result;
      result.vertices.resize(to.asset().vertex_count, SurfaceVertex{glm::vec3(9.0f), 0});
      result.rows.resize(to.asset().row_count, SurfaceRow{9.0f, 99});
      resample_surface(*levels, from.detail.level, from.tendons, from.surfaces, to.detail.level, result.vertices,
                       result.rows);
      for (std::uint32_t v = 0; v < to.asset().vertex_count; ++v) {
        ASSERT_LT(glm::distance(result.vertices[v].position, to.surfaces.vertices[v].position), tolerance)
            << "level " << level << (refine ? " from the next, vertex " : " to the next, vertex ") << v;
        ASSERT_GT(glm::dot(unpack_surface_normal(result.vertices[v].normal),
                           unpack_surface_normal(to.surfaces.vertices[v].normal)),
                  0.6f)
            << "level " << level << (refine ? " from the next, vertex " : " to the next, vertex ") << v;
      }
      for (std::uint32_t row = 0; row < to.asset().row_count; ++row) {
        ASSERT_EQ(result.rows[row].muscle, to.surfaces.rows[row].muscle);
        ASSERT_NEAR(result.rows[row].tendon_coordinate, to.surfaces.rows[row].tendon_coordinate, 0.1f);
        ASSERT_EQ(result.rows[row].tendon_coordinate == 0.0f, to.surfaces.rows[row].tendon_coordinate == 0.0f);
      }
    }
  }
}

// Round, straight muscles with tendons at one end, both and none: all vertices in the middle of others.
TEST(ResampleSurface, StraightMusclesComeOutAsTheyAre) {
  std::vector<MuscleDescription> muscles(4);
  for (std::size_t m = 0; m < muscles.size(); ++m) {
    muscles[m].name = std::to_string(m);
    muscles[m].attachments = {{0, {0.1f * static_cast<float>(m), 0.0f, 0.0f}, true},
                              {1, {0.1f * static_cast<float>(m), -0.4f, 0.0f}, true}};
    muscles[m].profile = {.fractions = {0.0f, 1.0f}, .radii = {0.04f, 0.01f}, .absolute = true};
    muscles[m].hill.tendon_slack_length = 0.2f;
    muscles[m].hill.optimal_fibre_length = 0.2f;
    muscles[m].tendon_at_origin = m % 2 == 0 ? 0.0f : 0.35f;
    muscles[m].tendon_at_insertion = m < 2 ? 0.0f : 0.3f;
  }
  const std::vector<glm::mat4> bones(2, glm::mat4(1.0f));
  std::vector<std::shared_ptr<const MuscleAsset>> assets;
  for (const MuscleLevel level : {MuscleLevel{24, 3}, MuscleLevel{12, 2}, MuscleLevel{12, 1}, MuscleLevel{6, 1}}) {
    for (MuscleDescription& muscle : muscles) {
      muscle.section_vertices = level.section_vertices;
      muscle.longitudinal_subdivision = level.longitudinal_subdivision;
    }
    const auto built = build_muscle_asset(muscles, bones);
    ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
    assets.push_back(*built);
  }
  const auto levels = make_muscle_levels(assets);
  ASSERT_TRUE(levels.ok());
  expect_same(*levels, bones, 1.0e-6f);
}

// Lobed sections on bent lines: vertices on chords are not in their middle, but not far from it.
TEST(ResampleSurface, FittedMusclesComeOutNearly) {
  const auto levels = test::synthetic_levels({36, 3}, 3);
  expect_same(levels, test::rest_bones(), 5.0e-3f);
}

}  // namespace
}  // namespace fascicle::muscle
