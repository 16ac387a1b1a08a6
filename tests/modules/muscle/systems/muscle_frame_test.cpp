// Whole frames through the schedule: rest, rigid motion, bad bones, teleports, measures.
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/ecs/world.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "tests/modules/muscle/systems/muscle_world.hpp"

namespace fascicle::muscle {
namespace {

bool all_finite(const MuscleSurfaces& surfaces) {
  for (const SurfaceVertex& vertex : surfaces.vertices) {
    if (!std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z)) return false;
  }
  for (const SurfaceRow& row : surfaces.rows) {
    if (!std::isfinite(row.tendon_coordinate)) return false;
  }
  return true;
}

TEST(MuscleFrame, RestPointsComeBackBitForBit) {
  for (const SimdLevel level : {SimdLevel::kPortable, detect_simd()}) {
    MuscleSettings settings;
    settings.simd = level;
    MuscleWorld w(1, settings);
    const auto asset = synthetic_asset();
    const ecs::Entity character = w.add_character(test::rest_bones());
    const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
    const std::uint64_t at_spawn = hash_state(w.world);
    w.pose(character, test::walk_bones(0.4f));
    w.step();
    EXPECT_NE(hash_state(w.world), at_spawn);
    w.pose(character, test::rest_bones());
    w.step();
    const ActionLines& lines = w.world.get<ActionLines>(muscles);
    for (std::uint32_t m = 0; m < asset->size(); ++m) {
      for (std::uint32_t k = 0; k < asset->muscles[m].section_count; ++k) {
        EXPECT_EQ(line_point(*asset, lines, m, k), rest_point(*asset, m, k));
      }
      EXPECT_NEAR(w.world.get<CrossSections>(muscles).twist[asset->muscles[m].lane_index], 0.0f, 1.0e-5f);
    }
  }
}

TEST(MuscleFrame, RigidMotionMovesSurfacesRigidly) {
  MuscleWorld w;
  const std::vector<glm::mat4> bones = test::walk_bones(0.35f);
  const ecs::Entity character = w.add_character(bones);
  const ecs::Entity muscles = spawn_musculature(w.world, character, synthetic_asset());
  w.step();
  const MuscleSurfaces before = w.world.get<MuscleSurfaces>(muscles);
  const MuscleMeasures measured = w.world.get<MuscleMeasures>(muscles);
  for (int i = 0; i < 12; ++i) {
    glm::mat4 motion = glm::translate(glm::mat4(1.0f), glm::vec3(0.7f, -0.3f, 1.1f));
    motion = glm::rotate(motion, 0.5f * static_cast<float>(i), glm::normalize(glm::vec3(0.3f, 1.0f, -0.4f)));
    std::vector<glm::mat4> moved;
    for (const glm::mat4& bone : bones) moved.push_back(motion * bone);
    w.pose(character, moved);
    w.step();
    const MuscleSurfaces& after = w.world.get<MuscleSurfaces>(muscles);
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
      const glm::vec3 expected = glm::vec3(motion * glm::vec4(before.vertices[v].position, 1.0f));
      ASSERT_LT(glm::distance(after.vertices[v].position, expected), 1.0e-5f) << v;
      const glm::vec3 normal = glm::mat3(motion) * unpack_surface_normal(before.vertices[v].normal);
      ASSERT_LT(glm::distance(unpack_surface_normal(after.vertices[v].normal), normal), 5.0e-3f) << v;
    }
    const MuscleMeasures& now = w.world.get<MuscleMeasures>(muscles);
    for (std::size_t m = 0; m < 48; ++m) {
      EXPECT_NEAR(now.length[m], measured.length[m], 1.0e-5f);
      EXPECT_NEAR(now.volume[m], measured.volume[m], 1.0e-4f * measured.volume[m]);
    }
  }
}

TEST(MuscleFrame, WalkIsSmooth) {
  // A hundred frames a cycle: no vertex jumps, as it would where a frame flips or a twist wraps.
  MuscleWorld w;
  const ecs::Entity character = w.add_character(test::walk_bones(0.0f));
  const ecs::Entity muscles = spawn_musculature(w.world, character, synthetic_asset());
  w.step();
  MuscleSurfaces last = w.world.get<MuscleSurfaces>(muscles);
  for (int frame = 1; frame <= 200; ++frame) {
    w.pose(character, test::walk_bones(0.01f * static_cast<float>(frame)));
    w.step();
    const MuscleSurfaces& now = w.world.get<MuscleSurfaces>(muscles);
    ASSERT_TRUE(all_finite(now));
    for (std::size_t v = 0; v < now.vertices.size(); ++v) {
      ASSERT_LT(glm::distance(now.vertices[v].position, last.vertices[v].position), 0.06f) << frame << " " << v;
    }
    last = now;
  }
}

TEST(MuscleFrame, LengthIgnoresTheLevelOfDetail) {
  std::vector<float> lengths;
  for (const std::uint32_t subdivision : {0u, 1u, 3u}) {
    MuscleWorld w;
    const ecs::Entity character = w.add_character(test::walk_bones(0.3f));
    const ecs::Entity muscles = spawn_musculature(w.world, character, synthetic_asset(8, subdivision));
    w.step();
    const MuscleMeasures& measures = w.world.get<MuscleMeasures>(muscles);
    if (lengths.empty()) lengths = measures.length;
    for (std::size_t m = 0; m < 48; ++m) {
      EXPECT_NEAR(measures.length[m], lengths[m], 1.0e-6f);
      EXPECT_NEAR(measures.drawn_length[m], measures.length[m], 1.0e-5f);  // without a fit the drawn line is the same
    }
  }
}

TEST(MuscleFrame, MeasuresAreTheMethods) {
  MuscleWorld w;
  const auto asset = synthetic_asset();
  const ecs::Entity character = w.add_character(test::rest_bones());
  const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
  w.step();
  const MuscleMeasures& measures = w.world.get<MuscleMeasures>(muscles);
  for (std::uint32_t m = 0; m < asset->size(); ++m) {
    const MuscleLayout& layout = asset->muscles[m];
    EXPECT_NEAR(measures.volume[m], layout.rest_volume, 1.0e-4f * layout.rest_volume);
    EXPECT_FLOAT_EQ(measures.mass[m], measures.volume[m] * 1059.7f);
    EXPECT_NEAR(measures.pcsa[m],
                measures.volume[m] * std::cos(layout.hill.pennation) / layout.hill.optimal_fibre_length, 1.0e-8f);
    // The radii came from F / sigma, so at rest F comes back.
    EXPECT_NEAR(measures.force[m] / layout.hill.max_isometric_force, 1.0f, 1.0e-3f);
    EXPECT_NEAR(measures.length[m], layout.rest_length, 1.0e-5f);
    const ecs::Entity muscle = muscle_entity(w.world, muscles, m);
    EXPECT_EQ(length_of(w.world, muscle), measures.length[m]);
  }
}

TEST(MuscleFrame, RowsTellTendonFromBelly) {
  MuscleWorld w;
  const auto asset = synthetic_asset();
  const ecs::Entity character = w.add_character(test::rest_bones());
  const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
  w.step();
  for (std::uint32_t m = 0; m < asset->size(); ++m) {
    const MuscleSurfaceView view = surface_of(*asset, w.world.get<MuscleSurfaces>(muscles), m);
    const LinePlace border = tendon_border(*asset, w.world.get<Tendons>(muscles), m, MuscleEnd::kInsertion);
    ASSERT_EQ(view.rows.size(), asset->muscles[m].section_count + 1);
    for (std::size_t row = 0; row < view.rows.size(); ++row) {
      EXPECT_EQ(view.rows[row].muscle, m);
      const int side = static_cast<int>(row) - (border.segment + 1);  // < 0: belly, 0: C_t, > 0: tendon
      if (side == 0) {
        EXPECT_EQ(view.rows[row].tendon_coordinate, 0.0f);
      } else if (side > 0) {
        EXPECT_LE(view.rows[row].tendon_coordinate, 0.0f);
      } else {
        EXPECT_GE(view.rows[row].tendon_coordinate, -1.0e-6f);
      }
    }
    EXPECT_NEAR(view.rows.back().tendon_coordinate, -asset->muscles[m].tendon_lengths[1], 1.0e-5f);
  }
}

TEST(MuscleFrame, BadBonesHoldTheirMusclesAlone) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {kNaN, std::numeric_limits<float>::infinity(), 1.0e20f}) {
    MuscleWorld w;
    const auto asset = synthetic_asset();
    const ecs::Entity character = w.add_character(test::walk_bones(0.1f));
    const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
    w.step();
    const MuscleSurfaces before = w.world.get<MuscleSurfaces>(muscles);
    std::vector<glm::mat4> bones = test::walk_bones(0.3f);
    bones[test::kFootLeft][3].y = bad;
    w.pose(character, bones);
    w.step();
    w.step();
    const ActionLines& lines = w.world.get<ActionLines>(muscles);
    const MuscleSurfaces& after = w.world.get<MuscleSurfaces>(muscles);
    ASSERT_TRUE(all_finite(after));
    std::uint64_t held = 0;
    for (std::uint32_t m = 0; m < asset->size(); ++m) {
      const std::span<const SurfaceVertex> old_vertices = surface_of(*asset, before, m).vertices;
      const std::span<const SurfaceVertex> new_vertices = surface_of(*asset, after, m).vertices;
      bool moved = false;
      for (std::size_t v = 0; v < old_vertices.size(); ++v) {
        moved = moved || old_vertices[v].position != new_vertices[v].position ||
                old_vertices[v].normal != new_vertices[v].normal;
      }
      EXPECT_EQ(moved, lines.held[m] == 0) << m;
      held += lines.held[m];
    }
    EXPECT_GT(held, 0u);
    EXPECT_LT(held, 48u);
    EXPECT_EQ(lines.held_steps, 2 * held);
    // And when the bone is back, so are the muscles, the same as if nothing had been.
    MuscleWorld clean;
    const ecs::Entity other = clean.add_character(test::walk_bones(0.35f));
    spawn_musculature(clean.world, other, asset);
    clean.step();
    w.pose(character, test::walk_bones(0.35f));
    w.step();
    EXPECT_EQ(hash_state(w.world), hash_state(clean.world));
  }
}

TEST(MuscleFrame, MissingBonesHoldTheRestShape) {
  MuscleWorld w;
  const auto asset = synthetic_asset();
  const ecs::Entity character = w.world.create();  // without BoneMatrices
  const ecs::Entity muscles = spawn_musculature(w.world, character, asset);
  const std::uint64_t at_spawn = hash_state(w.world);
  w.step();
  EXPECT_EQ(hash_state(w.world), at_spawn);
  EXPECT_EQ(w.world.get<ActionLines>(muscles).held_steps, 48u);
  w.world.add(character, BoneMatrices{std::vector<glm::mat4>(3, glm::mat4(1.0f)), 0});  // too few
  w.step();
  EXPECT_EQ(hash_state(w.world), at_spawn);
  w.world.get<BoneMatrices>(character).world = test::walk_bones(0.2f);
  w.step();
  EXPECT_NE(hash_state(w.world), at_spawn);
  w.world.destroy(character);
  w.step();  // the character is gone: the last shape stays
  EXPECT_TRUE(all_finite(w.world.get<MuscleSurfaces>(muscles)));
}

TEST(MuscleFrame, TeleportStartsTheTwistAfresh) {
  MuscleDescription muscle;
  muscle.name = "m";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {1, {0.0f, -0.3f, 0.0f}, true}};
  muscle.volume = 1.0e-4f;
  const auto built = build_muscle_asset(std::vector{muscle}, std::vector(2, glm::mat4(1.0f)));
  ASSERT_TRUE(built.ok());
  MuscleWorld w;
  const ecs::Entity character = w.add_character(std::vector(2, glm::mat4(1.0f)));
  const ecs::Entity muscles = spawn_musculature(w.world, character, *built);
  const auto turn = [](int degrees) {
    const float angle = glm::radians(static_cast<float>(degrees));
    return std::vector{glm::mat4(1.0f), glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.0f, -1.0f, 0.0f))};
  };
  for (int degrees = 0; degrees <= 270; degrees += 30) {
    w.pose(character, turn(degrees));
    w.step();
  }
  EXPECT_NEAR(w.world.get<CrossSections>(muscles).twist[0], glm::radians(270.0f), 1.0e-4f);
  w.world.get<BoneMatrices>(character).teleport_count += 1;
  w.step();
  EXPECT_NEAR(w.world.get<CrossSections>(muscles).twist[0], glm::radians(-90.0f), 1.0e-4f);

  // The same when the muscle is held in the very step of the jump.
  for (int degrees = -90; degrees <= 270; degrees += 30) {
    w.pose(character, turn(degrees));
    w.step();
  }
  auto broken = turn(270);
  broken[1][3][0] = std::numeric_limits<float>::quiet_NaN();
  w.pose(character, broken);
  w.world.get<BoneMatrices>(character).teleport_count += 1;
  w.step();
  w.pose(character, turn(270));
  w.step();
  EXPECT_NEAR(w.world.get<CrossSections>(muscles).twist[0], glm::radians(-90.0f), 1.0e-4f);
}

}  // namespace
}  // namespace fascicle::muscle
